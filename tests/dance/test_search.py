"""From a library and a song to a plan, by each method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance import search as module
from onbeat.dance.frames import RATES
from onbeat.dance.plan import DancePlan
from onbeat.dance.search import METHODS, make_problem, search
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID, STRETCH
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song


def song_of(seconds: float, tempo: float = 105.0) -> Song:
    """A steady song whose intensity goes up and down."""
    beats, clock = np.arange(0.4, seconds, 60 / tempo), np.arange(0.0, seconds, 0.1)
    loud = 0.5 + 0.4 * np.sin(clock)
    return Song(seconds, tempo, 4, beats, beats[::4], np.zeros(len(beats)), clock, loud, title="steady")


@pytest.fixture(scope="module")
def few(troupe: MoveLibrary) -> MoveLibrary:
    """Six clips of the troupe."""
    return MoveLibrary.of(troupe.clips[:6])


def check(plan: DancePlan, library: MoveLibrary, seconds: float) -> None:
    """Assert that a plan fills the song with moves of the library, joined where the graph joins them."""
    joins = set(zip(library.graph.sources.tolist(), library.graph.targets.tolist(), strict=True))
    assert plan.duration == seconds
    for move in plan.moves:
        assert 0 <= move.from_s < move.to_s <= library.clips[move.clip].motion.duration + 0.1
        assert min(abs(move.rate - rate) for rate in RATES) < 1e-9
    for before, after in zip(plan.moves, plan.moves[1:], strict=False):
        leave = library.starts[before.clip] + np.arange(-2, 3) + round(before.to_s * GRID)
        enter = library.starts[after.clip] + np.arange(-2, 3) + round(after.from_s * GRID)
        assert any((int(i), int(j)) in joins for i in leave for j in enter)
        assert before.at_s < after.at_s
    for move in plan.moves[1:-1]:
        assert (move.to_s - move.from_s) / move.rate >= STRETCH - 1.5 / GRID


@pytest.mark.parametrize("method", METHODS)
def test_every_method_fills_the_song(few: MoveLibrary, method: str) -> None:
    found = search(few, song_of(9.0), method=method)
    check(found.plan, few, 9.0)
    assert np.isfinite(found.objective)
    assert (found.optimum is not None) == (method == "optimal")


def test_the_optimum_is_above_all(few: MoveLibrary) -> None:
    song = song_of(12.0)
    best = search(few, song, variety=False)
    varied = search(few, song)
    assert best.optimum == pytest.approx(best.objective, abs=0.02)
    assert varied.optimum == pytest.approx(best.optimum)
    for other in (varied, search(few, song, method="greedy"), search(few, song, method="walk")):
        assert other.objective <= best.objective + 0.02
    assert varied.objective > search(few, song, method="walk").objective


def test_a_song_in_chapters_is_danced_whole(few: MoveLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    song, shares = song_of(24.0), []
    whole = search(few, song)
    monkeypatch.setattr(module, "CHAPTER", 7.0)
    monkeypatch.setattr(module, "AHEAD", 3.0)
    parts = search(few, song, step=shares.append)
    check(parts.plan, few, 24.0)
    assert parts.objective > 0.7 * whole.objective
    assert shares == sorted(shares)
    assert 0 < shares[0] < shares[-1] < 1


def test_seeds_and_repeats(few: MoveLibrary) -> None:
    song = song_of(8.0)
    assert search(few, song).plan == search(few, song, seed=5).plan
    walks = [search(few, song, method="walk", seed=seed).plan for seed in (1, 1, 2)]
    assert walks[0] == walks[1]
    assert walks[0] != walks[2]


def test_rhythm_only_does_not_hear_intensity(few: MoveLibrary) -> None:
    song = song_of(8.0)
    louder = replace(song, intensity=song.intensity[::-1])
    assert not make_problem(few, song, rhythm_only=True).music.intensity.any()
    assert search(few, song, rhythm_only=True).plan == search(few, louder, rhythm_only=True).plan


@pytest.mark.parametrize(
    ("method", "seconds", "message"),
    [("knit", 4.0, "no search method 'knit'; there are optimal"), ("optimal", 0.0, "has no length")],
)
def test_refusals(few: MoveLibrary, method: str, seconds: float, message: str) -> None:
    with pytest.raises(PlanError, match=message):
        search(few, song_of(seconds), method=method)


def test_clips_without_joins_cannot_dance_longer_than_they_are(troupe: MoveLibrary) -> None:
    alone = MoveLibrary.of(troupe.clips[:1], reach=0.0)
    seconds = troupe.clips[0].motion.duration
    check(search(alone, song_of(seconds - 4.0)).plan, alone, seconds - 4.0)
    with pytest.raises(PlanError, match="add clips"):
        search(alone, song_of(2 * seconds))
