"""What joins do to stops: told before the search as it is found on the finished dance."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat._shapes import Array, Ints, Times
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.realise import realise
from onbeat.dance.score import FINE
from onbeat.dance.seams import CHANGED, Seams, find_seams
from onbeat.motion import rotations as rot
from onbeat.motion.features import hand_features
from onbeat.motion.motion import Motion
from onbeat.moves.graph import GRID
from onbeat.moves.library import Clip, MoveLibrary
from walkable import graph

NEAR = 0.04
SWING = 1.0  # s from stop to stop


def arms(motion: Motion, angles: Array, name: str) -> Motion:
    """A body that stands still and lifts both arms by ``angles`` (F,)."""
    rotations = np.tile(rot.IDENTITY, (len(angles), len(motion.skeleton), 1))
    for joint, sign in (("LeftArm", -1.0), ("RightArm", 1.0)):
        rotations[:, motion.skeleton.index(joint)] = rot.about(np.array([0, 1.0, 0]), sign * angles)
    root = np.tile([0.0, 0.0, -motion.skeleton.rest_positions[:, 2].min()], (len(angles), 1))
    return Motion(motion.skeleton, rotations, root, motion.fps, name)


@pytest.fixture(scope="module")
def clips(swinger: Motion) -> list[Clip]:
    """Arms that swing and stop at 1, 2, … 5 s, and arms that are held where those stop at 2 s."""
    times = np.arange(360) / swinger.fps
    swinging = arms(swinger, 0.7 + 0.5 * np.cos(np.pi * times / SWING), "swinging")
    held = arms(swinger, np.full(360, 1.2), "held")
    return [Clip.of(swinging, source=0), Clip.of(held, source=1)]


def changes(clips: list[Clip], *joins: tuple[int, float, int, float]) -> list[list[tuple[float, float]]]:
    """For each join (clip, second, clip, second) the stops (seconds after it, ±1) that it makes or unmakes."""
    lengths = [len(clip.poses) for clip in clips]
    starts = np.concatenate(([0], np.cumsum(lengths)))
    pairs = [
        (int(starts[a]) + round(leave * GRID), int(starts[b]) + round(enter * GRID)) for a, leave, b, enter in joins
    ]
    assert pairs == sorted(pairs)
    seams = find_seams(MoveLibrary(tuple(clips), graph(lengths, pairs)))
    return [stops_of(seams, join) for join in range(len(pairs))]


def stops_of(seams: Seams, join: int) -> list[tuple[float, float]]:
    low, high = seams.indptr[join : join + 2].tolist()
    return list(zip((seams.at[low:high] / (GRID * FINE)).tolist(), seams.sign[low:high].tolist(), strict=True))


def test_the_clips_stop_where_they_should(clips: list[Clip]) -> None:
    assert clips[0].stops == pytest.approx([1, 2, 3, 4, 5], abs=0.005)
    assert len(clips[1].stops) == 0


def test_a_join_to_the_same_moment_changes_nothing(clips: list[Clip]) -> None:
    assert changes([clips[0], clips[0]], (0, 2.1, 1, 2.1), (0, 3.5, 1, 3.5)) == [[], []]


def test_after_the_last_movement_a_stop_is_unmade(clips: list[Clip]) -> None:
    (found,) = changes(clips, (0, 2.1, 1, 2.5))
    assert found == [(pytest.approx(-0.1, abs=0.01), -1.0)]


def test_a_join_against_the_movement_makes_a_stop(clips: list[Clip]) -> None:
    up, down = 1.5, 2.5
    (found,) = changes([clips[0], clips[0]], (0, up, 1, down))
    assert found == [(pytest.approx(0.0, abs=0.03), 1.0)]


@pytest.mark.parametrize("joins", [None, (np.zeros(0, np.int64), np.zeros(0, np.int64))])
def test_seams_without_joins(clips: list[Clip], joins: tuple[Ints, Ints] | None) -> None:
    seams = find_seams(MoveLibrary(tuple(clips), graph([len(clip.poses) for clip in clips], [])), joins)
    assert seams.indptr.tolist() == [0]
    assert len(seams.at) == len(seams.sign) == 0


def test_each_change_lies_beside_its_join(troupe: MoveLibrary) -> None:
    seams = find_seams(troupe)
    assert len(seams.indptr) == troupe.graph.join_count + 1
    assert seams.indptr[-1] == len(seams.at) == len(seams.sign)
    assert np.all(np.diff(seams.indptr) >= 0)
    assert np.abs(seams.at).max() <= CHANGED * GRID * FINE + 1
    assert set(np.unique(seams.sign).tolist()) == {-1.0, 1.0}


def test_what_is_told_is_what_is_danced(troupe: MoveLibrary) -> None:
    """Of the stops told or found around rendered joins, most are both; without looking at joins, fewer are."""
    seams = find_seams(troupe)
    changing = np.flatnonzero(np.diff(seams.indptr))
    some = np.random.default_rng(4).choice(changing, 40, replace=False)
    told = found = both = plain = plain_both = 0
    for join in some.tolist():
        own, here = around(troupe, join)
        gone = [at for at, sign in stops_of(seams, join) if sign < 0]
        made = [at for at, sign in stops_of(seams, join) if sign > 0]
        predicted = np.array(sorted([at for at in own if min((abs(at - g) for g in gone), default=1) > 0.01] + made))
        inside = here[np.abs(here) < CHANGED - NEAR]
        told += len(predicted)
        found += len(inside)
        plain += len(own)
        both += matched(predicted, here)
        plain_both += matched(np.array(own), here)
    assert both >= 0.7 * told
    assert both >= 0.7 * found
    assert plain_both / plain < both / told


def around(library: MoveLibrary, join: int) -> tuple[list[float], Times]:
    """Seconds after a join: of the stops its clips have beside it by themselves, and of those of the finished dance."""
    net = library.graph
    ends: Ints = np.array([net.sources[join], net.targets[join]])
    a, b = net.clip_of[ends].tolist()
    leave, enter = ((ends - library.starts[[a, b]]) / GRID).tolist()
    early = min(2.0, leave)
    late = min(2.0, library.clips[b].motion.duration - enter - 0.02)
    plan = DancePlan((Move(a, leave - early, leave, 0.0), Move(b, enter, enter + late, early)), early + late)
    motion = realise([clip.motion for clip in library.clips], plan, 60.0).motion
    own = [t - leave for t in library.clips[a].stops.tolist() if -CHANGED < t - leave < 0]
    own += [t - enter for t in library.clips[b].stops.tolist() if 0 <= t - enter < CHANGED]
    return own, hand_features(motion).body_stops - early


def matched(told: Times, found: Times) -> int:
    """How many of the told stops are found within ``NEAR``."""
    return sum(bool(len(found)) and float(np.abs(found - at).min()) <= NEAR for at in told.tolist())
