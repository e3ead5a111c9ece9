import tracemalloc

import numpy as np
import pytest

from demands import curves
from onbeat.errors import PlanError
from onbeat.retime.bspline import Spline
from onbeat.retime.hierarchy import LAYERS, _sampled, decompose  # pyright: ignore[reportPrivateUsage]
from onbeat.retime.lock import TimeMap, lock

RHYTHM = TimeMap.steady(2.0)
NONE = np.zeros(0)


def curve(seed: int = 0, seconds: float = 10.0, channels: int = 2, highest: float = 3.0) -> Spline:
    return Spline.through(curves(seed, int(seconds * 60) + 1, channels, highest=highest), 60.0)


def test_layers_sum_to_the_curve():
    wish, times = curve(), np.linspace(0, 10, 601)
    layers = decompose(wish, RHYTHM, NONE)
    beats = RHYTHM(times)
    error = np.abs(layers(beats).sum(axis=0) - wish(times))
    assert error.max() < 2e-3 * np.ptp(wish.samples)
    np.testing.assert_allclose(layers.upto(LAYERS, beats), layers(beats).sum(axis=0))


def test_each_layer_halves_the_spacing_and_comes_nearer():
    wish = curve(1)
    layers = decompose(wish, RHYTHM, NONE, layers=6, spacing=4.0)
    assert [layer.knots.step for layer in layers.splines] == [4 / 2**k for k in range(6)]
    assert len({(layer.knots.start, layer.knots.end) for layer in layers.splines}) == 1
    beats = RHYTHM(wish.knots.times)
    errors = [np.square(layers.upto(k, beats) - wish.samples).sum() for k in range(7)]
    assert (np.diff(errors) < 0).all()
    assert errors[-1] < 1e-3 * errors[0]


def test_a_fast_swing_is_in_the_fine_layers_and_a_slow_one_in_the_coarse():
    times = np.arange(601) / 60
    both = np.stack((np.sin(2 * np.pi * 0.25 * times), np.sin(2 * np.pi * 4.0 * times)), axis=1)
    layers = decompose(Spline.through(both, 60.0), RHYTHM, NONE)
    energy = np.square(layers(RHYTHM(times))).mean(axis=1)
    assert energy[0, 0] > 0.99 * energy[:, 0].sum()
    assert energy[:2, 1].sum() < 0.2 * energy[2:, 1].sum()


def test_knots_are_on_the_beats_whatever_the_rhythm():
    beats = np.cumsum(np.linspace(0.6, 0.4, 24))
    rhythm = lock(beats, np.arange(24, dtype=float))
    layers = decompose(curve(2), rhythm, NONE)
    at = rhythm.inverse(layers.splines[0].knots.times)
    inside = at[(at > beats[0]) & (at < beats[-1])]
    assert len(inside) > 10
    assert np.abs(inside[:, None] - beats).min(axis=1).max() < 0.01


def test_all_layers_stand_still_at_keyposes_and_more_so_the_more_it_weighs():
    wish, keyposes = curve(3), np.array([2.0, 5.0, 9.0, 14.5])
    speeds = [
        np.abs(decompose(wish, RHYTHM, keyposes, still=still)(keyposes, 1)).max() for still in (0.0, 1.0, 100.0, 1e6)
    ]
    assert speeds[0] > 0.3, "else there is nothing to bring to rest"
    assert (np.diff(speeds) < 0).all()
    assert speeds[-1] < 1e-3


def test_near_keyposes_the_curve_is_sampled_densely():
    beats = _sampled(0.0, 16.0, np.array([4.0, 10.0]), 1 / 16)
    near = np.min(np.abs(beats[:, None] - [4.0, 10.0]), axis=1) <= 0.25
    assert np.allclose(np.diff(beats)[near[1:] & near[:-1]], 1 / 64)
    assert np.allclose(np.diff(beats)[~near[1:] & ~near[:-1]], 1 / 16)
    assert (beats[0], beats[-1]) == (0.0, 16.0)
    assert (np.diff(beats) > 0).all()


def test_samples_near_keyposes_fit_better_there():
    wish, keyposes = curve(4, highest=8.0), np.array([3.0, 8.0, 12.0])
    at = RHYTHM.inverse(keyposes)[:, None] + np.linspace(-0.1, 0.1, 21)
    dense, even = (
        np.abs(decompose(wish, RHYTHM, k, 3, still=0.0)(RHYTHM(at.ravel())).sum(axis=0) - wish(at.ravel())).mean()
        for k in (keyposes, NONE)
    )
    assert dense < even


def test_work_and_memory_grow_with_the_length_alone():
    """Ten times the dance, ten times the memory at the peak: nothing is a square of frames."""

    def peak(seconds: float) -> int:
        wish = curve(0, seconds)
        tracemalloc.start()
        decompose(wish, RHYTHM, np.arange(1.0, 2 * seconds, 2.0))
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    peak(5)
    assert peak(200) < 12 * peak(20)


def test_a_change_stays_near_where_it_is():
    wish = curve(5)
    moved = wish.controls.copy()
    moved[300:303] += 0.5
    a, b = (decompose(w, RHYTHM, NONE) for w in (wish, wish.with_controls(moved)))
    far = RHYTHM(np.concatenate((np.linspace(0, 1, 50), np.linspace(9, 10, 50))))
    assert np.abs(a(far) - b(far)).max() < 1e-3


def test_a_curve_that_begins_a_rounding_error_before_a_beat_needs_no_other_knots():
    samples = curve(6).samples
    starts = [Spline.through(samples, 60.0, shift) for shift in (0.0, 1 / 3)]
    maps = [TimeMap.steady(3.0, at) for at in (0.0, -1.0 - 1e-15)]
    first, second = (decompose(c, m, NONE) for c, m in zip(starts, maps, strict=True))
    assert [s.knots.intervals for s in first.splines] == [s.knots.intervals for s in second.splines]
    at = np.linspace(0, 30, 100)
    np.testing.assert_allclose(first(at), second(at), atol=1e-6)


@pytest.mark.parametrize("frames", [1, 2, 3, 10])
@pytest.mark.parametrize("layers", [1, 5, 7])
def test_a_few_frames_are_enough(frames: int, layers: int):
    wish = Spline.through(curves(0, frames), 60.0)
    found = decompose(wish, RHYTHM, np.array([0.0]), layers, 4.0, still=0.0)
    # Spread thinner than the smallest knot: a line through them is all that can be told.
    assert np.isfinite(found(RHYTHM(wish.knots.times))).all()
    straight = Spline.through(np.linspace(0, 1, frames)[:, None], 60.0)
    whole = decompose(straight, RHYTHM, NONE, layers, 4.0)
    np.testing.assert_allclose(whole.upto(layers, RHYTHM(straight.knots.times)), straight.samples, atol=1e-3)


def test_a_constant_is_in_the_coarsest_layer_alone():
    layers = decompose(Spline.through(np.full((300, 1), 1.7), 60.0), RHYTHM, np.array([3.0]))
    parts = layers(np.linspace(0, 9, 50))
    np.testing.assert_allclose(parts[0], 1.7, atol=1e-9)
    np.testing.assert_allclose(parts[1:], 0, atol=1e-9)


def test_keyposes_outside_and_twice_do_not_matter():
    wish = curve(7)
    a = decompose(wish, RHYTHM, np.array([3.0]))
    b = decompose(wish, RHYTHM, np.array([-50.0, 3.0, 999.0]))
    at = np.linspace(0, 20, 99)
    np.testing.assert_allclose(a(at), b(at), atol=1e-12)
    assert np.isfinite(decompose(wish, RHYTHM, np.array([3.0, 3.0]))(at)).all()


@pytest.mark.parametrize(("layers", "spacing"), [(0, 1.0), (-1, 1.0), (5, 0.0), (5, -1.0), (5, np.nan)])
def test_layers_that_cannot_be_are_said_so(layers: int, spacing: float):
    with pytest.raises(PlanError, match="1 or more layers and a spacing above 0"):
        decompose(curve(), RHYTHM, NONE, layers, spacing)
