"""What the tests of the command line share: how commands are run, a short song and a few clips."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.cli import main
from onbeat.examples import embedded_song
from onbeat.formats import write_motion
from onbeat.moves.library import MoveLibrary

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(autouse=True)
def no_heartbeat(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is said of work that takes long would be said or not as the computer is busy."""
    monkeypatch.setattr("onbeat.cli.heartbeat.EVERY", math.inf)


@pytest.fixture
def onbeat(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs ``onbeat`` with some words in this process; gives exit status, stdout and stderr."""

    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["onbeat", *map(str, words)])
        try:
            main()
            status = 0
        except SystemExit as stop:
            status = int(stop.code or 0)
        out, err = capsys.readouterr()
        return status, out, err

    return call


@pytest.fixture
def run(onbeat: Run) -> Run:
    """Runs ``onbeat dance``, likewise."""
    return lambda *words: onbeat("dance", *words)


@pytest.fixture(scope="module")
def sound() -> tuple[np.ndarray, int]:
    """Six seconds of the embedded song."""
    _, samples, rate = embedded_song(20.0)
    return samples[: 6 * rate], rate


@pytest.fixture(scope="module")
def song(sound: tuple[np.ndarray, int], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("songs") / "song.wav"
    soundfile.write(path, *sound)
    return path


@pytest.fixture(scope="module")
def clips(troupe: MoveLibrary, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three short clips of the troupe in a folder."""
    folder = tmp_path_factory.mktemp("clips")
    for name, clip in zip("abc", troupe.clips[::2], strict=False):
        write_motion(clip.motion[:600], folder / f"{name}.npz")
    return folder


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "dance"
