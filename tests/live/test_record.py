"""Recordings: kept whole, read again as they were, and refused where they are damaged."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.live.protocol import Clocked, Command, Pose
from onbeat.live.record import Digest, Recording, Replay
from onbeat.live.recorded import Recorded
from onbeat.live.session import NOTHING_TOLD, Told

POSE = Pose(0, 0.0, np.zeros(3), np.eye(4)[:1], np.ones(2), np.zeros((1, 3), np.float32))


def kept(folder, ticks: int = 6):
    """A recording of ticks of which every third is without sound."""
    rng, recording, sounds = np.random.default_rng(0), Recording(folder, {"tempo": "70-140"}), []
    for k in range(ticks):
        sound = None if k % 3 == 2 else rng.standard_normal(441).astype(np.float32)
        told = Told((Command("next"),), (Clocked(0.01, 0.5),)) if k == 1 else NOTHING_TOLD
        recording.add(sound, told, [POSE] * (k % 2))
        sounds.append(sound)
    recording.close()
    return sounds


def test_what_was_kept_is_read_again_to_the_bit(tmp_path):
    sounds = kept(tmp_path / "one")
    replay = Replay(tmp_path / "one")
    again = list(replay.ticks())
    assert len(again) == len(sounds) == len(replay)
    for (sound, told), (k, before) in zip(again, enumerate(sounds), strict=True):
        assert (sound is None) == (before is None)
        assert before is None or np.array_equal(sound, before)
        assert told == (Told((Command("next"),), (Clocked(0.01, 0.5),)) if k == 1 else NOTHING_TOLD)
    digest = Digest()
    digest.add(None, NOTHING_TOLD, [POSE] * 3)
    assert replay.kept.poses == digest.hexdigest()


def test_nothing_of_its_name_is_written_over_and_nothing_is_left_of_one_that_was_dropped(tmp_path):
    kept(tmp_path / "one")
    with pytest.raises(OnbeatError, match="there already"):
        Recording(tmp_path / "one", {})
    other = Recording(tmp_path / "two", {})
    other.drop()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one"]


def test_one_that_was_killed_can_be_danced_again(tmp_path):
    recording = Recording(tmp_path / "one", {})
    for k in range(5):
        recording.add(np.full(441, k, np.float32), NOTHING_TOLD, [POSE])
    replay = Replay(tmp_path / "one.part")
    assert len(replay) == len(list(replay.ticks())) == 5
    assert replay.kept.poses == ""
    recording.drop()


def test_on_a_full_disk_what_was_kept_is_kept_and_the_session_goes_on(tmp_path, monkeypatch):
    recording = Recording(tmp_path / "one", {})
    write = Recording._write

    def full(self, name, data):
        if self.ticks == 3 and name == "ticks.bin":
            raise OSError(28, "No space left on device")
        write(self, name, data)

    monkeypatch.setattr(Recording, "_write", full)
    for _ in range(6):
        recording.add(np.zeros(441, np.float32), NOTHING_TOLD, [POSE])
    assert "No space left" in recording.failed
    recording.close()
    replay = Replay(tmp_path / "one")
    assert [len(sound) for sound, _ in replay.ticks()] == [441] * 3


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("session.json", b"{"),
        ("session.json", b'{"version": 9, "settings": {}, "ticks": 6, "poses": ""}'),
        ("ticks.bin", b"\1"),
        ("sound.f32", b"\0" * 40),
        ("told.jsonl", b"[]\n"),
    ],
)
def test_a_damaged_one_is_refused_in_a_line(tmp_path, name, data):
    kept(tmp_path / "one")
    (tmp_path / "one" / name).write_bytes(data)
    with pytest.raises(OnbeatError, match="one is "):
        Replay(tmp_path / "one")


def test_no_recording_is_told(tmp_path):
    with pytest.raises(OnbeatError, match="no recording"):
        Replay(tmp_path)


def test_its_ticks_come_when_they_are_due(tmp_path):
    kept(tmp_path / "one")
    now = [0.0]
    ticks = Recorded(Replay(tmp_path / "one"), lambda: now[0])
    ticks.start()
    assert ticks.tick() is not None
    assert ticks.tick() is None
    assert not ticks.given
    now[0] = 0.021
    assert ticks.tick() is not None
    assert ticks.told().commands == (Command("next"),)
    assert ticks.tick() is None
    assert ticks.given
    now[0] = 1.0
    while not ticks.over:
        ticks.tick()
    assert ticks.tick() is None
