"""The part of a great library that is searched: small, and nearly as good as the whole."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance import search as module
from onbeat.dance.make import make_dance
from onbeat.dance.part import Part
from onbeat.dance.score import score_music
from onbeat.dance.search import candidates, fits, search
from onbeat.dance.sublibrary import sublibrary
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song


def song_of(seconds: float, tempo: float = 105.0) -> Song:
    beats, clock = np.arange(0.4, seconds, 60 / tempo), np.arange(0.0, seconds, 0.1)
    return Song(seconds, tempo, 4, beats, beats[::4], np.zeros(len(beats)), clock, 0.5 + 0.4 * np.sin(clock))


@pytest.fixture(scope="module")
def some(troupe: MoveLibrary) -> MoveLibrary:
    return MoveLibrary.of(troupe.clips[:16])


def test_a_quarter_of_a_library_gives_nearly_its_best_dance(some: MoveLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    song = song_of(20.0)
    whole = search(some, song, variety=False)
    assert fits(some)
    assert whole.searched is None
    monkeypatch.setattr(module, "LARGEST", 1000)
    monkeypatch.setattr(module, "PART", len(some.graph) // 4)
    part = search(some, song, variety=False)
    assert part.searched is not None
    assert part.optimum is not None
    assert whole.optimum is not None
    assert part.searched.seconds < 0.3 * part.searched.whole == pytest.approx(0.3 * len(some.graph) / GRID)
    assert 0.93 * whole.optimum < part.optimum <= whole.optimum + 0.01 < part.searched.bound


def test_with_room_for_all_that_is_passed_the_part_grows(some: MoveLibrary) -> None:
    music = score_music(song_of(6.0))
    sizes = [len(candidates(some, music, frames)) for frames in (500, 1500, 10**6)]
    assert sizes == sorted(sizes)
    assert 500 <= sizes[0] < 1000
    assert sizes[2] <= len(some.graph)


def test_the_same_part_is_found_again(some: MoveLibrary) -> None:
    music = score_music(song_of(6.0))
    one, two = (candidates(some, music, 1500) for _ in range(2))
    np.testing.assert_array_equal(one.frames, two.frames)


@pytest.mark.parametrize("method", ["greedy", "shiratori2006", "walk"])
def test_every_method_dances_out_of_a_part(some: MoveLibrary, monkeypatch: pytest.MonkeyPatch, method: str) -> None:
    monkeypatch.setattr(module, "LARGEST", 1000)
    monkeypatch.setattr(module, "PART", 2500)
    found = search(some, song_of(8.0), method=method)
    assert found.searched is not None
    inside = set(zip(*_seconds(found.searched.part, some), strict=True))
    for move in found.plan.moves:
        assert (move.clip, round(move.from_s * GRID)) in inside
        assert move.to_s <= some.clips[move.clip].seconds + 0.1


def _seconds(part: Part, library: MoveLibrary) -> tuple[list[int], list[int]]:
    clips = library.graph.clip_of[part.frames]
    return clips.tolist(), (part.frames - library.starts[clips]).tolist()


def test_a_dance_tells_what_part_was_searched(some: MoveLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = make_dance(song_of(8.0), some, fps=30).document.metrics["search"]
    monkeypatch.setattr(module, "LARGEST", 1000)
    monkeypatch.setattr(module, "PART", 2500)
    part = make_dance(song_of(8.0), some, fps=30).document.metrics["search"]
    assert set(whole) == {"objective", "optimum_with_repeats", "of_optimum"}
    assert part["library_s"] == pytest.approx(len(some.graph) / GRID, abs=0.01)
    assert 2500 / GRID <= part["searched_s"] < 3300 / GRID
    assert 0 < part["gap_at_most"] == pytest.approx(1 - part["optimum_with_repeats"] / part["bound"], abs=1e-4)


def test_a_sublibrary_can_be_danced_and_is_its_library_where_that_is_small(some: MoveLibrary) -> None:
    small = sublibrary(some, 110.0, 60.0)
    assert 60 * GRID <= len(small.graph) < 75 * GRID
    assert search(small, song_of(15.0)).plan.duration == 15.0
    assert sublibrary(some, song_of(15.0), 1e5) is some
    for tempo, seconds, message in ((0.0, 60.0, "tempo of 0"), (100.0, float("nan"), "part of nan s")):
        with pytest.raises(PlanError, match=message):
            sublibrary(some, tempo, seconds)
