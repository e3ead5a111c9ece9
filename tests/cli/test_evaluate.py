"""``onbeat evaluate`` from the command line to its table and JSON."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from onbeat import cli
from onbeat.formats import write_motion
from onbeat.metrics.evaluate import evaluate_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.music import Song

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")

SIDE_JOINTS = ("humerus", "radius", "wrist", "femur", "tibia", "foot")
LEFT = [[-0.2, 0, 0.1], [0, 0, -0.3], [0, 0, -0.25], [-0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4]]
BODY = Skeleton(
    ("hips", "chest", *(side + joint for side in "lr" for joint in SIDE_JOINTS)),
    [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12],
    [[0, 0, 0], [0, 0, 0.4], *LEFT, *([-x, y, z] for x, y, z in LEFT)],
)


def swinging(seconds: float = 12.0, fps: float = 60.0) -> Motion:
    """Arms that stop at 0.25 s and every half second from there."""
    times = np.arange(round(seconds * fps)) / fps
    turns = np.tile(rot.IDENTITY, (len(times), len(BODY), 1))
    for joint in ("lhumerus", "rhumerus"):
        turns[:, BODY.index(joint)] = rot.about(np.array([1.0, 0, 0]), 0.8 * np.cos(2 * np.pi * (times - 0.25)))
    return Motion(BODY, turns, np.tile([0, 0, 0.85], (len(times), 1)), fps)


def song(first: float = 0.25, seconds: float = 12.0) -> Song:
    beats = np.arange(first, seconds, 0.5)
    return Song(seconds, 120.0, 4, beats, beats[::4], np.zeros(len(beats)), [0.0, seconds], [0.2, 0.9])


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    write_motion(swinging(), tmp_path / "dance.npz")
    (tmp_path / "song.json").write_bytes(song().to_json())
    return str(tmp_path / "dance.npz"), str(tmp_path / "song.json")


def run(monkeypatch: pytest.MonkeyPatch, *words: str) -> int:
    monkeypatch.setattr(sys, "argv", ["onbeat", "evaluate", *words])
    try:
        cli.main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def test_a_motion_on_every_beat() -> None:
    scores = evaluate_motion(swinging(), song())
    assert scores["beats"]["recall50"] > 0.9
    assert scores["beats"]["f50_jitter_z"] > 5
    assert scores["feet"]["skate"] == pytest.approx(0.0, abs=1e-6)
    assert not any("joins" in name or "source" in name for found in scores.values() for name in found)


def test_a_motion_off_every_beat() -> None:
    assert evaluate_motion(swinging(), song(first=0.5))["beats"]["f100"] == 0.0


def test_a_tempo_too_fast_to_dance_to_is_halved_and_told(files, tmp_path: Path, monkeypatch, capsys) -> None:
    beats = np.arange(0.25, 12.0, 0.25)
    fast = Song(12.0, 240.0, 4, beats, beats[::4], np.zeros(len(beats)), [0.0, 12.0], [0.2, 0.9])
    assert evaluate_motion(swinging(), fast)["beats"]["recall50"] > 0.9
    (tmp_path / "fast.json").write_bytes(fast.to_json())
    assert run(monkeypatch, files[0], "--music", str(tmp_path / "fast.json")) == 0
    assert "24 beats, half of those heard" in capsys.readouterr().err


def test_json(files, monkeypatch, capsys) -> None:
    assert run(monkeypatch, files[0], "--music", files[1], "--json") == 0
    first = capsys.readouterr().out
    document = json.loads(first)
    assert list(document) == ["version", "motion", "song", "beats", "intensity", "feet", "smoothness"]
    assert document["motion"] == "dance.npz"
    run(monkeypatch, files[0], "--music", files[1], "--json")
    assert capsys.readouterr().out == first


def test_table(files, monkeypatch, capsys) -> None:
    assert run(monkeypatch, files[0], "--music", files[1]) == 0
    shown = capsys.readouterr()
    assert "F within 50 ms" in shown.out
    assert "foot speed in contact (m/s)" in shown.out
    assert "dance.npz on song.json: " in shown.err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("missing.npz", "--music", "SONG"), "no file missing.npz"),
        (("MOTION", "--music", "missing.json"), "cannot read missing.json: No such file"),
        (("MOTION", "--music", "SONG", "--start", "99"), "the motion begins after the song has ended"),
        (("MOTION", "--music", "SONG", "--start", "-3"), "--start is -3 s"),
    ],
)
def test_mistakes_are_one_line(words, message, files, monkeypatch, capsys) -> None:
    names = dict(zip(("MOTION", "SONG"), files, strict=True))
    assert run(monkeypatch, *(names.get(word, word) for word in words)) == 1
    shown = capsys.readouterr()
    assert shown.out == ""
    assert message in shown.err
    assert shown.err.count("\n") == 1


@pytest.mark.parametrize("table", [(), ("--json",)])
def test_a_song_without_beats_is_told(
    tmp_path: Path,
    files: tuple[str, str],
    table: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):
    silent = Song(12.0, 0.0, 4, [], [], [], [0.0, 12.0], [0.2, 0.9])
    (tmp_path / "calm.json").write_bytes(silent.to_json())
    assert run(monkeypatch, files[0], "--music", str(tmp_path / "calm.json"), *table) == 0
    assert "onbeat: none of the 0 beats of calm.json falls into the motion" in capsys.readouterr().err
    assert run(monkeypatch, *files[:1], "--music", files[1], *table) == 0
    assert "say nothing" not in capsys.readouterr().err


def test_feet_that_hardly_stand_get_no_score_for_it_and_it_is_told(tmp_path, monkeypatch, capsys):
    motion = swinging()
    path = motion.root_positions.copy()
    path[:, 0] = 2.0 * np.arange(len(path)) / motion.fps  # slides on, faster than any foot that stands
    write_motion(motion.replace(root_positions=path), tmp_path / "slides.npz")
    (tmp_path / "song.json").write_bytes(song().to_json())
    assert run(monkeypatch, str(tmp_path / "slides.npz"), "--music", str(tmp_path / "song.json"), "--json") == 0
    said = capsys.readouterr()
    feet = json.loads(said.out)["feet"]
    assert feet["contact_part"] < 0.1
    assert feet["skate"] is None
    assert feet["support"] == pytest.approx(2.0, abs=0.1)
    assert "feet stand still in 0% of slides.npz" in said.err
