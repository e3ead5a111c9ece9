"""What decoders write to the screen is kept from it, and nothing else is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import soundfile

SAYS = """
import os, sys, threading
from onbeat.music.undertone import unheard
{own}
def words():
    with unheard():
        os.write(2, b"decoder ")
        print("ours", file=sys.stderr, flush=True)
threads = [threading.Thread(target=words) for _ in range(3)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
os.write(2, b"after")
"""
OWN = "from onbeat.cli.own_stderr import own_stderr; own_stderr()"


def said(*words: str) -> str:
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, timeout=120, check=True).stderr


def test_only_decoders_are_unheard() -> None:
    assert said("-c", SAYS.format(own=OWN)) == "ours\n" * 3 + "after"


def test_where_python_has_no_stderr_of_its_own_nothing_is() -> None:
    heard = said("-c", SAYS.format(own=""))
    assert heard.count("ours") == heard.count("decoder ") == 3


def test_the_command_line_tells_of_a_damaged_song_in_its_own_words(tmp_path: Path) -> None:
    path = tmp_path / "song.mp3"
    soundfile.write(path, 0.1 * np.random.default_rng(0).standard_normal(8 * 22050), 22050)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    lines = said("-c", "from onbeat.cli import main; main()", "listen", str(path)).splitlines()
    assert all(line.startswith("onbeat: ") for line in lines)
    path.write_bytes(bytes(5000))
    code = [sys.executable, "-c", "from onbeat.cli import main; main()", "listen", str(path)]
    refused = subprocess.run(code, capture_output=True, text=True, timeout=120, check=False)
    assert refused.returncode == 1
    [line] = refused.stderr.splitlines()
    reason = "not a sound file that can be read (there is no sound in it); expected wav, flac, ogg or mp3"
    assert line == f"onbeat: {path}: {reason}"


@pytest.mark.parametrize("times", [1, 3])
def test_descriptors_are_given_back(times: int) -> None:
    code = f"""
import os, sys
{OWN}
from onbeat.music.undertone import unheard
before = len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0
for _ in range({times}):
    with unheard(), unheard():
        pass
after = len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0
print(after - before, file=sys.stderr)
"""
    assert said("-c", code) == "0\n"
