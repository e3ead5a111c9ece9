"""The figures of a dance: what they are made of, and that they are what the metrics say of the finished motion."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.make import Dance, make_dance
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.report import shown_stretches
from onbeat.dance.search import Found
from onbeat.dance.warp import FASTEST, SLOWEST
from onbeat.metrics import beats
from onbeat.motion.features import hand_features
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

GROUPS = ["search", "beats_before_warp", "beats", "warp", "intensity", "feet", "smoothness", "variety"]


@pytest.fixture(scope="module")
def few(troupe: MoveLibrary) -> MoveLibrary:
    return MoveLibrary.of(troupe.clips[:6])


@pytest.fixture(scope="module")
def dance(few: MoveLibrary) -> Dance:
    at, clock = np.arange(0.3, 9.0, 0.6), np.arange(0.0, 9.0, 0.1)
    loud = 0.5 + 0.3 * np.sin(clock)
    return make_dance(Song(9.0, 100.0, 4, at, at[::4], np.zeros(len(at)), clock, loud), few, fps=60, seed=3)


def test_groups_of_plain_numbers(dance: Dance) -> None:
    metrics = dance.document.metrics
    assert list(metrics) == GROUPS
    for scores in metrics.values():
        assert all(value is None or np.isfinite(value) for value in scores.values())


def test_beat_scores_are_those_of_the_finished_motion(dance: Dance) -> None:
    stops = hand_features(dance.motion).body_stops
    rng = np.random.default_rng(3)
    expected = beats.evaluate(stops, dance.song.beats, 9.0, rng, dance.song.downbeats)
    found = dance.document.metrics["beats"]
    assert found == {
        name: None if value is None else pytest.approx(value, abs=1e-5) for name, value in expected.items()
    }


def test_the_search_is_held_against_the_optimum(dance: Dance) -> None:
    said = dance.document.metrics["search"]
    assert said["of_optimum"] == pytest.approx(said["objective"] / said["optimum_with_repeats"], abs=1e-4)
    assert said["of_optimum"] <= 1.001


def test_playback_stays_within_the_bounds_of_the_warp(dance: Dance) -> None:
    said = dance.document.metrics["warp"]
    assert SLOWEST - 0.01 <= said["playback_min"] <= 1 <= said["playback_max"] <= FASTEST + 0.01
    assert said["rate_min"] <= 1 <= said["rate_max"]


def test_joins_are_counted(dance: Dance) -> None:
    joins = len(dance.plan.moves) - 1
    assert dance.document.metrics["variety"]["joins_per_minute"] == pytest.approx(joins / 9.0 * 60, abs=1e-3)
    errors = [join.link_error_deg for join in dance.document.joins]
    assert dance.document.metrics["smoothness"]["link_error_deg"] == pytest.approx(np.mean(errors), abs=0.01)


def test_shown_stretches_are_the_moves(few: MoveLibrary) -> None:
    plan = DancePlan((Move(0, 1.0, 3.0, 0.0), Move(2, 2.0, 4.2, 2.0, 1.1)), 4.0)
    shown = shown_stretches(few, Found(plan, 0.0, None, 0.0))
    for (motion, contacts), move in zip(shown, plan.moves, strict=True):
        clip = few.clips[move.clip].motion
        assert motion.duration == pytest.approx(move.to_s - move.from_s, abs=3 / clip.fps)
        assert contacts.shape == (len(motion), 2)
        first = round(move.from_s * clip.fps)
        assert np.array_equal(motion.rotations[0], clip.rotations[first])
