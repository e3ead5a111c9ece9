from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.frames import BLOCK, lay_frames
from onbeat.dance.score import FINE, STANDING
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph

RATES = (1.0, 0.87, 1.1)


@pytest.fixture
def library() -> MoveLibrary:
    rng = np.random.default_rng(0)
    clips = (
        clip(40, [0.31, 0.7], rng.uniform(0, 2, 40), source=0),
        clip(40, [0.31, 0.7], rng.uniform(0, 2, 40), source=0, mirrored=True),
        clip(25, [0.0, 0.5, 24 / GRID], rng.uniform(0, 2, 25), source=1),
    )
    return MoveLibrary(clips, graph([40, 40, 25], [(5, 50)]))


def test_each_rate_plays_each_clip_to_its_end(library: MoveLibrary) -> None:
    laid = lay_frames(library, RATES)
    ends = np.flatnonzero(laid.left == 0)
    assert len(ends) == len(RATES) * len(library.clips)
    assert len(laid) == sum(int((n - 1) / rate) + 1 for rate in RATES for n in (40, 40, 25))
    for start, end in zip([0, *(ends[:-1] + 1)], ends, strict=True):
        run = slice(int(start), int(end) + 1)
        np.testing.assert_array_equal(laid.left[run], np.arange(end - start, -1, -1))
        assert len(set(laid.rate[run].tolist())) == 1
        assert len(set(library.graph.clip_of[laid.base[run]].tolist())) == 1
        np.testing.assert_allclose(np.diff(laid.second[run]), laid.rate[start] / GRID)


def test_rate_one_shows_the_graph_itself(library: MoveLibrary) -> None:
    laid = lay_frames(library, (1.0,))
    np.testing.assert_array_equal(laid.base, np.arange(105))
    np.testing.assert_array_equal(laid.entry[0], np.arange(105))


def test_entries_show_the_frame_they_are_of_to_half_a_frame(library: MoveLibrary) -> None:
    laid = lay_frames(library, RATES)
    for number, rate in enumerate(RATES):
        entry = laid.entry[number]
        np.testing.assert_array_equal(laid.rate[entry], rate)
        inside = laid.left[entry] > 0
        second = (np.arange(105) - library.starts[library.graph.clip_of]) / GRID
        assert np.max(np.abs(laid.second[entry] - second)[inside]) <= 0.5 * max(rate, 1) / GRID + 1e-9


@pytest.mark.parametrize("rate", RATES)
def test_stops_are_at_their_place_between_frames(library: MoveLibrary, rate: float) -> None:
    """A stop at s seconds of a clip, entered at its beginning, is heard s / rate seconds later, to 1/480 s."""
    laid = lay_frames(library, (rate,))
    starts = np.concatenate(([0], np.flatnonzero(laid.left == 0)[:-1] + 1))
    for start, own in zip(starts, library.clips, strict=True):
        run = np.arange(start, start + laid.left[start] + 1)
        at = run[laid.stop_worth[run] > 0]
        heard = (at - start + laid.stop_shift[at] / FINE) / GRID
        assert len(heard) == len(own.stops)
        np.testing.assert_allclose(heard, own.stops / rate, atol=0.5 / (GRID * FINE) + 1e-9)
        assert np.all(np.abs(laid.stop_shift[at]) <= FINE)


def test_blocks_are_quarter_seconds_of_a_clip_at_any_rate(library: MoveLibrary) -> None:
    laid = lay_frames(library, RATES)
    assert laid.block.min() == 0
    assert laid.block.max() == laid.blocks - 1
    for block in range(laid.blocks):
        shown = laid.base[laid.block == block]
        assert len(set(library.graph.clip_of[shown].tolist())) == 1
        assert np.ptp(shown) < BLOCK * GRID


def test_a_mirror_image_is_another_stretch(library: MoveLibrary) -> None:
    laid = lay_frames(library, (1.0,))
    assert not set(laid.block[:40].tolist()) & set(laid.block[40:80].tolist())


def test_intensity_is_ranked_over_the_library(library: MoveLibrary) -> None:
    laid = lay_frames(library, (1.0,))
    np.testing.assert_array_equal(np.argsort(laid.intensity), np.argsort(library.intensity))
    assert float(laid.intensity.std()) == pytest.approx(1, rel=1e-5)


def test_standing_about_costs_and_dancing_does_not() -> None:
    lively, still, pausing = np.ones(180), np.zeros(180), np.repeat([1.0, 0.0, 1.0], 60)
    clips = tuple(clip(180, [], values, source=n) for n, values in enumerate((lively, still, pausing)))
    idle = lay_frames(MoveLibrary(clips, graph([180] * 3, [(5, 200)])), (1.0,)).idle
    np.testing.assert_array_equal(idle[:180], 0)
    np.testing.assert_allclose(idle[180:360], STANDING / GRID, rtol=1e-6)
    assert idle[360 + 90] > 0
    assert idle[360] == idle[-1] == 0
