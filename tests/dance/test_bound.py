"""The bound on the best dance of all is above the best dance, and no higher than it has to be."""

from __future__ import annotations

import numpy as np

from onbeat.dance.bound import most_earned
from onbeat.dance.optimal import ValueToGo
from onbeat.dance.search import make_problem
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song


def song_of(beats: list[float], seconds: float = 12.0) -> Song:
    clock = np.arange(0.0, seconds, 0.1)
    times = np.array(beats)
    return Song(seconds, 110.0, 4, times, times[::4], np.zeros(len(times)), clock, 0.5 + 0.4 * np.sin(clock))


def test_the_optimum_is_not_above_the_bound(troupe: MoveLibrary) -> None:
    few = MoveLibrary.of(troupe.clips[:6])
    problem = make_problem(few, song_of(np.arange(0.3, 12.0, 0.55).tolist()))
    optimum, bound = ValueToGo(problem).optimum, most_earned(problem.music, problem.frames.intensity).sum()
    assert 0.4 * bound < optimum < bound


def test_without_intensity_it_counts_the_beats(troupe: MoveLibrary) -> None:
    few = MoveLibrary.of(troupe.clips[:2])
    beats = [1.0, 1.6, 2.2, 4.0]
    music = make_problem(few, song_of(beats), rhythm_only=True).music
    earned = most_earned(music, np.array([-1.0, 1.0]))
    assert np.flatnonzero(earned).tolist() == [30, 48, 66, 120]
    np.testing.assert_allclose(earned[earned > 0], music.beat_worth.max(), atol=0.01)
