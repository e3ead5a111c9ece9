"""The embedded troupe's library: made once, then opened, the same each time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from onbeat.examples import embedded_motions
from onbeat.moves import embedded
from onbeat.moves.embedded import embedded_library
from onbeat.moves.library import MoveLibrary


def test_everyone_dances_and_their_mirror_images(troupe: MoveLibrary) -> None:
    names = [motion.name for motion in embedded_motions()]
    assert [clip.name for clip in troupe.clips if not clip.mirrored] == names
    assert sum(clip.mirrored for clip in troupe.clips) == len(names)
    assert troupe.problems == ()
    assert troupe.seconds == pytest.approx(sum(motion.duration for motion in embedded_motions()))


def test_one_can_dance_with_it_without_end(troupe: MoveLibrary) -> None:
    assert troupe.graph.join_count > 1000
    assert troupe.graph.core.mean() > 0.8


def test_a_second_time_it_is_opened(troupe: MoveLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(embedded, "embedded_motions", lambda seed: pytest.fail("made again"))
    again = embedded_library()
    assert np.array_equal(again.graph.targets, troupe.graph.targets)
    assert np.array_equal(again.graph.costs, troupe.graph.costs)
    for clip, kept in zip(again.clips, troupe.clips, strict=True):
        assert clip.name == kept.name
        assert np.array_equal(clip.poses, kept.poses)
        assert clip.motion.rotations.tobytes() == kept.motion.rotations.tobytes()


def test_built_and_opened_libraries_are_equal_to_the_last_bit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ONBEAT_CACHE", str(tmp_path))
    monkeypatch.setattr(embedded, "embedded_motions", lambda seed: [m[:300] for m in embedded_motions(seed)[:2]])
    said: list[str] = []
    built = embedded_library(step=lambda what, share: said.append(what))
    opened = embedded_library(step=lambda what, share: pytest.fail(f"built again: {what}"))
    assert said
    for one, other in zip(built.clips, opened.clips, strict=True):
        for name in ("rotations", "root_positions"):
            assert getattr(one.motion, name).tobytes() == getattr(other.motion, name).tobytes()
        assert one.poses.tobytes() == other.poses.tobytes()
        assert one.intensity.tobytes() == other.intensity.tobytes()
    assert built.graph.costs.tobytes() == opened.graph.costs.tobytes()


def test_with_and_without_mirror_images_are_kept_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ONBEAT_CACHE", str(tmp_path))
    monkeypatch.setattr(embedded, "embedded_motions", lambda seed: [m[:240] for m in embedded_motions(seed)[:2]])
    assert [clip.mirrored for clip in embedded_library(mirror=False).clips] == [False, False]
    assert [clip.mirrored for clip in embedded_library().clips] == [False, True, False, True]
    assert len(embedded_library(mirror=False).clips) == 2
