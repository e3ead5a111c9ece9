"""The mp4: its length, its streams, sound and pictures in step, and nothing left behind."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import MissingExtraError, OnbeatError
from onbeat.motion import Motion, Skeleton
from onbeat.music.song import Song
from onbeat.viewer import video
from onbeat.viewer.film import in_order
from onbeat.viewer.film.flashes import Flashes
from onbeat.viewer.film.strip import HEAD
from onbeat.viewer.video import write_video

SIZE = (160, 90)
RATE = 44100


def pole(seconds: float = 2.0, fps: float = 20.0) -> Motion:
    """A pole that stands still."""
    skeleton = Skeleton(("foot", "head"), [-1, 0], [[0, 0, 0], [0, 0, 1.7]])
    frames = round(seconds * fps)
    return Motion(skeleton, np.tile([1.0, 0, 0, 0], (frames, 2, 1)), np.zeros((frames, 3)), fps)


def click_at(second: float, seconds: float, rate: int = RATE, channels: int = 2) -> np.ndarray:
    samples = np.zeros((round(seconds * rate), channels), np.float32)
    samples[round(second * rate) :][:60] = 0.9
    return samples


def heard(path: Path) -> tuple[float, float]:
    """When the loudest sound begins, and how long the sound is, in seconds as a player has them."""
    av = pytest.importorskip("av")
    times, levels = [], []
    with av.open(str(path)) as container:
        for frame in container.decode(audio=0):
            block = np.abs(frame.to_ndarray()).max(0)
            times.append(float(frame.pts * frame.time_base) + np.arange(len(block)) / frame.sample_rate)
            levels.append(block)
    time, level = np.concatenate(times), np.concatenate(levels)
    return float(time[np.argmax(level > 0.5 * level.max())]), float(time[-1] - max(time[0], 0.0))


def seen(path: Path) -> list[tuple[float, float]]:
    """For each picture when it is shown, and the time at which its play head stands, as a part of the whole."""
    av = pytest.importorskip("av")
    found = []
    with av.open(str(path)) as container:
        for frame in container.decode(video=0):
            strip = frame.to_ndarray(format="rgb24")[-8:].astype(int)
            column = int(np.argmin(np.abs(strip - HEAD.astype(int)).sum((0, 2))))
            found.append((float(frame.pts * frame.time_base), column / SIZE[0]))
    return found


@pytest.mark.parametrize(("rate", "channels"), [(44100, 2), (8000, 1), (48000, 6)])
def test_sound_and_pictures_are_in_step_and_as_long_as_the_dance(tmp_path: Path, rate: int, channels: int) -> None:
    av = pytest.importorskip("av")
    path = tmp_path / "dance.mp4"
    write_video(path, pole(2.0), None, (click_at(1.0, 2.0, rate, channels), rate), fps=25, size=SIZE)
    onset, _ = heard(path)
    frames = seen(path)
    assert onset == pytest.approx(1.0, abs=0.01)
    assert len(frames) == 50
    for time, part in frames:
        assert part * 2.0 == pytest.approx(time, abs=0.03)
    with av.open(str(path)) as container:
        assert [stream.codec_context.name for stream in container.streams] == ["h264", "aac"]
        assert container.streams.video[0].codec_context.pix_fmt == "yuv420p"
        assert container.duration / 1e6 == pytest.approx(2.0, abs=0.002)
    head = path.read_bytes()
    assert head.index(b"moov") < head.index(b"mdat")  # the index comes first: it plays while it loads


def test_short_sound_is_followed_by_silence_and_long_sound_is_cut(tmp_path: Path) -> None:
    av = pytest.importorskip("av")
    for seconds in (0.5, 3.0):
        path = tmp_path / f"{seconds}.mp4"
        write_video(path, pole(1.2), None, (click_at(0.2, seconds), RATE), fps=20, size=SIZE)
        with av.open(str(path)) as container:
            for stream in container.streams:
                assert float(stream.duration * stream.time_base) == pytest.approx(1.2, abs=0.002)


def test_a_silent_film_with_a_strip(tmp_path: Path) -> None:
    av = pytest.importorskip("av")
    beats = np.arange(0.25, 2.0, 0.5)
    song = Song(2.0, 120.0, 4, beats, beats[::4], np.zeros(4), np.array([0.0, 2.0]), np.array([0.0, 1.0]))
    told: list[float] = []
    path = tmp_path / "silent.mp4"
    write_video(path, pole(), song, None, fps=10, size=SIZE, stops=beats, progress=told.append)
    assert told == pytest.approx(np.arange(1, 21) / 20)
    with av.open(str(path)) as container:
        assert len(container.streams) == 1
        assert container.streams.video[0].frames == 20


def test_the_same_dance_gives_the_same_bytes(tmp_path: Path) -> None:
    pytest.importorskip("av")
    made, held = set(), []
    for size in range(12):
        held.append(np.ones(5000 * size + 1, np.uint8))  # so that each is made somewhere else in memory
        write_video(tmp_path / "a.mp4", pole(0.4), None, (click_at(0.2, 0.4), RATE), size=(160, 96))
        made.add((tmp_path / "a.mp4").read_bytes())
    assert len(made) == 1


def test_the_number_of_threads_does_not_change_the_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("av")
    made = set()
    flashes = Flashes.on(np.array([0.1, 0.3]), np.array([0.1]))
    for threads in (1, 3):
        monkeypatch.setattr(in_order, "usable_cores", lambda threads=threads: threads)
        write_video(tmp_path / "a.mp4", pole(0.5), None, None, size=(160, 96), flashes=flashes)
        made.add((tmp_path / "a.mp4").read_bytes())
    assert len(made) == 1


def test_the_floor_flashes_when_the_click_is_heard_to_a_picture(tmp_path: Path) -> None:
    av = pytest.importorskip("av")
    beats, fps = np.array([0.517, 1.127, 1.741]), 25
    clicks = sum(click_at(beat, 2.2) for beat in beats)
    path = tmp_path / "flash.mp4"
    write_video(path, pole(2.2), None, (clicks, RATE), fps=fps, size=SIZE, flashes=Flashes.on(beats, beats[1:2]))
    with av.open(str(path)) as container:
        pictures = [(float(f.pts * f.time_base), f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]
    with av.open(str(path)) as container:
        blocks = list(container.decode(audio=0))
    sound = np.concatenate([np.abs(block.to_ndarray()).max(0) for block in blocks])
    first = float(blocks[0].pts * blocks[0].time_base)
    # The pole stands still: what changes above the strip is the floor.
    changes = np.array([np.abs(b[1].astype(int) - a[1])[:-9].mean() for a, b in itertools.pairwise(pictures)])
    strength = []
    for beat in beats:
        about = np.arange(round((beat - 0.2) * fps), round((beat + 0.3) * fps))
        jump = about[np.argmax(changes[about])]
        near = np.arange(round((beat - first - 0.2) * RATE), round((beat - first + 0.2) * RATE))
        heard_at = first + near[np.argmax(sound[near] > 0.5 * sound[near].max())] / RATE
        assert abs(pictures[jump + 1][0] - heard_at) <= 1 / fps
        strength.append(changes[jump])
    assert strength[1] > 1.2 * max(strength[0], strength[2])  # the downbeat


def test_an_interrupted_video_leaves_what_was_there(tmp_path: Path) -> None:
    pytest.importorskip("av")
    path = tmp_path / "dance.mp4"
    path.write_bytes(b"older")

    def interrupt(part: float) -> None:
        if part > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(path, pole(), None, (click_at(0.2, 2.0), RATE), size=SIZE, progress=interrupt)
    assert [file.name for file in tmp_path.iterdir()] == ["dance.mp4"]
    assert path.read_bytes() == b"older"


def test_a_missing_extra_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(video.importlib, "import_module", absent)
    with pytest.raises(MissingExtraError, match=r"pip install 'onbeat\[video\]'"):
        write_video(tmp_path / "dance.mp4", pole())


def test_errors_are_one_clear_line(tmp_path: Path) -> None:
    pytest.importorskip("av")
    with pytest.raises(OnbeatError, match="161 x 90"):
        write_video(tmp_path / "dance.mp4", pole(), size=(161, 90))
    for fps in (0.0, -1.0, float("nan"), 1e9):
        with pytest.raises(OnbeatError, match="pictures a second cannot be made"):
            write_video(tmp_path / "dance.mp4", pole(), size=SIZE, fps=fps)
    with pytest.raises(OnbeatError, match="cannot write"):
        write_video(tmp_path / "nowhere" / "dance.mp4", pole(), size=SIZE)
