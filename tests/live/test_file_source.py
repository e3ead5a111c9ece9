"""A song in a file, at its own pace."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.errors import AudioError
from onbeat.live.sound.file_source import FileSource
from onbeat.music.audio import AudioWarning

RATE = 8000


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def written(path: Path, seconds: float, rate: int = RATE) -> np.ndarray:
    samples = np.random.default_rng(3).uniform(-0.5, 0.5, (round(seconds * rate), 2)).astype(np.float32)
    soundfile.write(path, samples, rate, subtype="FLOAT")
    return samples


def played(source: FileSource, clock: Clock, seconds: float = 1e9) -> np.ndarray:
    """What is heard until so much of it was, or it ended; the clock stands while the decoding thread is behind."""
    out, count, limit = list[np.ndarray](), 0.0, time.monotonic() + 60.0
    blocks = [(np.zeros((0, 1), np.float32), 1)]
    while source.state == "sound" and count < seconds and time.monotonic() < limit:
        clock.now += 0.25 if blocks else 0.0
        blocks = source.read()
        out += [block for block, _ in blocks]
        count += sum(len(block) / rate for block, rate in blocks)
        if not blocks:
            time.sleep(0.001)  # the decoding thread's turn
    return np.concatenate(out)


def test_a_file_is_heard_to_its_end_sample_by_sample(tmp_path: Path):
    samples = written(tmp_path / "song.wav", 65.0)
    clock = Clock()
    source = FileSource(tmp_path / "song.wav", clock=clock)
    assert source.state == "waiting"
    assert source.read() == []
    source.start()
    clock.now = 0.1
    [(block, rate)] = source.read()
    assert (len(block), rate, source.seconds, source.position) == (800, RATE, 65.0, 0.1)
    assert np.array_equal(np.concatenate((block, played(source, clock))), samples)
    assert (source.state, source.notes()) == ("ended", [])


def test_in_a_loop_it_begins_again(tmp_path: Path):
    samples = written(tmp_path / "song.wav", 2.0)
    clock = Clock()
    source = FileSource(tmp_path / "song.wav", loop=True, clock=clock)
    source.start()
    out = played(source, clock, 9.0)
    assert np.array_equal(out, np.tile(samples, (8, 1))[: len(out)])
    assert source.position == pytest.approx(len(out) / RATE % 2.0)
    source.close()
    assert source.state == "ended"


@pytest.mark.filterwarnings("ignore::onbeat.music.audio.AudioWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_file_that_is_cut_off_late_is_heard_as_far_as_it_goes_and_that_is_said(tmp_path: Path):
    path = tmp_path / "song.flac"
    soundfile.write(path, np.random.default_rng(4).uniform(-0.5, 0.5, 90 * RATE), RATE)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    clock = Clock()
    source = FileSource(path, clock=clock)
    source.start()
    assert 55.0 < len(played(source, clock)) / RATE < 61.0
    assert [note.startswith("the song ends early") for note in source.notes()] == [True]


def test_a_sample_that_is_no_number_ends_it_with_a_note(tmp_path: Path):
    samples = written(tmp_path / "song.wav", 65.0)
    samples[62 * RATE] = np.nan
    soundfile.write(tmp_path / "song.wav", samples, RATE, subtype="FLOAT")
    clock = Clock()
    source = FileSource(tmp_path / "song.wav", clock=clock)
    source.start()
    assert len(played(source, clock)) >= 55 * RATE
    assert ["not a number at 62.00 s" in note for note in source.notes()].count(True) == 1


def test_files_that_are_no_songs_are_refused_at_once(tmp_path: Path):
    (tmp_path / "empty.wav").write_bytes(b"")
    (tmp_path / "text.wav").write_text("no sound")
    soundfile.write(tmp_path / "none.wav", np.zeros((0, 1)), RATE)
    soundfile.write(tmp_path / "long.flac", np.random.default_rng(5).uniform(-0.5, 0.5, 9 * RATE), RATE)
    (tmp_path / "cut.flac").write_bytes((tmp_path / "long.flac").read_bytes()[:5000])
    for name in ("empty.wav", "text.wav", "none.wav", "cut.flac", "missing.wav", "."):
        with pytest.raises(AudioError, match=str(tmp_path)):
            FileSource(tmp_path / name).start()


def test_the_warning_of_a_damaged_short_file_comes_at_the_start(tmp_path: Path):
    soundfile.write(tmp_path / "long.flac", np.random.default_rng(5).uniform(-0.5, 0.5, 9 * RATE), RATE)
    (tmp_path / "cut.flac").write_bytes((tmp_path / "long.flac").read_bytes()[: 60 * 1024])
    source = FileSource(tmp_path / "cut.flac")
    with pytest.warns(AudioWarning, match="cut off"):
        source.start()
    source.close()
