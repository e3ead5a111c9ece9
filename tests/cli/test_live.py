"""``onbeat live``: heard, danced, kept, danced again; what cannot be is refused in a line."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from onbeat.cli.live_flags import HearFlags, SendFlags
from onbeat.cli.live_screen import words
from onbeat.errors import OnbeatError

LIVE = [sys.executable, "-c", "from onbeat.cli import main; main()", "live"]


def live(*words: str, seconds: float = 600) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "COLUMNS": "200"}
    return subprocess.run(
        [*LIVE, *words], capture_output=True, text=True, timeout=seconds, env=environment, check=False
    )


@pytest.fixture(scope="module")
def dance(tmp_path_factory) -> Path:
    """One choreography of the troupe, in a file."""
    from onbeat.examples.troupe import dance_library
    from onbeat.formats.write import write_motion

    path = tmp_path_factory.mktemp("live") / "bounce.bvh"
    write_motion(dance_library()[0].motion, path)
    return path


def test_how_it_went_says_of_what_a_share_is_and_whether_that_is_bad():
    told = {
        "ticks": 4020,
        "without_sound": 0,
        "cpu": 0.2,
        "mouths": [{"name": "page", "sent": 4020, "punctual": 0.2167}],
    }
    assert "page: 4020 poses, 21.7% of them sent within 10 ms of when they were due: too few" in words(told)
    told["mouths"] = [{"name": "page", "sent": 4020, "punctual": 0.9991}, {"name": "osc", "sent": 9}]
    assert words(told).endswith("page: 4020 poses, 99.9% of them sent within 10 ms of when they were due; osc: 9 poses")


def test_a_session_is_kept_and_danced_again_to_the_bit(tmp_path, dance):
    folder = tmp_path / "kept"
    first = live(str(dance), "--no-page", "--seconds", "8", "--speed-up", "20", "--record", str(folder), "--json")
    assert first.returncode == 0, first.stderr
    told = json.loads(first.stdout)
    assert told["ticks"] == pytest.approx(800, abs=5)
    assert told["poses"] >= 800
    again = live("--replay", str(folder), "--no-page", "--speed-up", "50", "--json")
    assert again.returncode == 0, again.stderr
    assert json.loads(again.stdout)["same"] is True


def test_poses_come_as_lines_and_nothing_else_is_on_stdout(dance):
    done = live(str(dance), "--no-page", "--seconds", "2", "--speed-up", "10", "--lines", "csv")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].startswith("time,root.x")
    assert len(lines) > 150
    assert len({line.count(",") for line in lines}) == 1


def test_the_page_is_served_and_ctrl_c_ends_it_well(dance):
    process = subprocess.Popen([*LIVE, str(dance), "--port", "0"], stderr=subprocess.PIPE, text=True)
    try:
        lines = iter(process.stderr.readline, "")
        port = next(int(found[1]) for line in lines if (found := re.search(r"http://127\.0\.0\.1:(\d+)/", line)))
        with socket.create_connection(("127.0.0.1", port), timeout=120) as page:
            page.sendall(f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n".encode())
            assert page.recv(4096).startswith(b"HTTP/1.1 200")
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=120)[1]
        assert process.returncode == 0
        assert "poses" in told
        assert "Traceback" not in told
    finally:
        process.kill()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--latency", "-5"], "--latency -5"),
        (["--latency", "nan"], "--latency nan"),
        (["--device", "3"], "--input mic"),
        (["--speed-up", "0"], "--speed-up 0"),
        (["--speed-up", "2", "--input", "mic"], "microphone"),
        (["--seconds", "0"], "--seconds 0"),
        (["--tempo", "fast"], "two numbers"),
        (["--input", "none.wav"], "none.wav"),
        (["none.bvh"], "none.bvh"),
        (["--simulate"], "--robot"),
        (["--moves", "none"], "none"),
        (["--osc", "9000"], "HOST:PORT"),
        (["--osc", "localhost:²"], "HOST:PORT"),
        (["--osc-in", "0"], "--osc-in"),
        (["--tempo", "140-70"], "--tempo 140-70"),
        (["--replay", ".", "--latency", "20"], "other flags"),
        (["--replay", "none"], "no recording"),
        (["--robot", "asimo"], "asimo"),
    ],
)
def test_what_cannot_be_is_refused_in_a_line(words, said, capsys, monkeypatch, tmp_path):
    from onbeat.cli.commands import app

    monkeypatch.chdir(tmp_path)
    with pytest.raises(OnbeatError) as refused:
        app(["live", "--no-page", *words], exit_on_error=False, print_error=False, result_action="return_value")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_flags_are_read():
    assert HearFlags(tempo="80-120").tempi == (80, 120)
    assert SendFlags(osc="[::1]:9000").osc_address == ("::1", 9000)
    assert SendFlags().osc_address is None
