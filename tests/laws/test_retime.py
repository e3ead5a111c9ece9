"""Laws of retiming: what every method must do whatever the dance, the body and the music."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from demands import FREE, curves, demand
from onbeat.retime.bspline import Spline, basis
from onbeat.retime.demand import Demand
from onbeat.retime.measures import TOLERANCE, measure
from onbeat.retime.methods import METHODS

SEEDS = st.integers(0, 2**32 - 1)
KEEPING = ("qp", "layers-qp", "layers2007")
"""Methods that keep the limits, always."""
few = settings(max_examples=15)


def answered(method: str, asked: Demand) -> Spline:
    return METHODS[method](asked, lambda share: None).trajectory


def moderate(seed: int, frames: int, channels: int = 1, fps: float = 60.0, **more: float) -> Demand:
    """A dance of which about half is too fast, and a little is out of range."""
    wish = curves(seed, frames, channels, fps)
    fast = np.abs(np.diff(wish, axis=0)).max(axis=0) * fps
    reach = np.abs(wish).max(axis=0)
    return demand(wish, -0.95 * reach, 0.9 * reach, 0.6 * fast, 12 * fast, keyposes=(0.25, 0.75, 1.5), fps=fps, **more)


@given(st.floats(0, 1))
def test_basis_functions_sum_to_one(part: float):
    values = basis(np.array([part]))
    assert values.sum() == pytest.approx(1, abs=1e-12)
    assert (values >= -1e-15).all()
    for order in (1, 2, 3):
        assert abs(basis(np.array([part]), order).sum()) < 1e-12


@pytest.mark.parametrize("method", KEEPING)
@few
@given(
    seed=SEEDS,
    frames=st.sampled_from([1, 2, 3, 4, 5, 10, 90, 200]),
    fps=st.sampled_from([10.0, 24.0, 30.0, 60.0, 120.0]),
    beats=st.floats(0.5, 5),
    speed=st.one_of(st.just(FREE), st.floats(-6, 1.5).map(lambda power: 10**power)),
    acceleration=st.one_of(st.just(FREE), st.floats(-2, 2.5).map(lambda power: 10**power)),
    jerk=st.one_of(st.just(FREE), st.floats(0, 5).map(lambda power: 10**power)),
    middle=st.floats(-3, 3),
    room=st.one_of(st.just(FREE), st.just(0.0), st.floats(1e-9, 2)),
    side=st.sampled_from(["both", "low", "high"]),
    flat=st.booleans(),
)
def test_limits_are_kept_between_frames_whatever_they_are(
    method: str,
    seed: int,
    frames: int,
    fps: float,
    beats: float,
    speed: float,
    acceleration: float,
    jerk: float,
    middle: float,
    room: float,
    side: str,
    flat: bool,
):
    wish = curves(seed, frames, fps=fps, highest=min(3.0, fps / 6))
    wish = np.repeat(wish[:1], frames, axis=0) if flat else wish
    low = -FREE if side == "high" else middle - room
    high = FREE if side == "low" else middle + room
    asked = demand(wish, low, high, speed, acceleration, jerk, (0.0, 0.3, 0.35, 1.0), fps=fps, beats=beats)
    found = measure(asked, answered(method, asked))
    assert found.position_excess[0] <= TOLERANCE
    assert found.velocity_excess[0] <= TOLERANCE
    if method == "qp":
        # PIQP's tolerance on second and third differences of control points is all that may be left.
        controls = answered(method, asked).controls
        assert (np.abs(np.diff(controls, 2, axis=0)) <= acceleration / fps**2 + 1e-8).all()
        assert (np.abs(np.diff(controls, 3, axis=0)) <= jerk / fps**3 + 1e-8).all()


@pytest.mark.parametrize("method", ["qp", "layers-qp"])
@few
@given(SEEDS, st.sampled_from([2, 10, 150]), st.floats(0.5, 4))
def test_wide_limits_change_nothing(method: str, seed: int, frames: int, beats: float):
    wish = curves(seed, frames, 3)
    asked = demand(wish, -50, 50, 500, 1e5, 1e7, (0.1, 0.5), beats=beats)
    assert np.abs(answered(method, asked).samples - wish).max() < 1e-6


@pytest.mark.parametrize("method", METHODS)
@few
@given(SEEDS, st.integers(-40, 400))
def test_a_dance_that_begins_later_is_answered_the_same_later(method: str, seed: int, later: int):
    first = moderate(seed, 150)
    shift = later / 60
    second = Demand(
        Spline.through(first.wish.samples, 60, shift),
        first.low,
        first.high,
        first.speed,
        first.acceleration,
        first.jerk,
        first.keyposes + shift,
        type(first.rhythm).steady(2.0, -2.0 * shift),
    )
    a, b = answered(method, first), answered(method, second)
    assert b.knots.start == pytest.approx(shift)
    assert np.abs(a.controls - b.controls).max() < 1e-5


@pytest.mark.parametrize("method", KEEPING)
@few
@given(SEEDS, st.floats(0.5, 2))
def test_on_a_slower_clock_slower_limits_give_the_same(method: str, seed: int, slower: float):
    first = moderate(seed, 150)
    second = demand(
        first.wish.samples,
        first.low,
        first.high,
        first.speed / slower,
        first.acceleration / slower**2,
        keyposes=first.keyposes * slower,
        fps=60 / slower,
        beats=2 / slower,
    )
    a, b = answered(method, first).samples, answered(method, second).samples
    assert np.abs(a - b).max() < {"qp": 5e-4, "layers-qp": 5e-3, "layers2007": 1e-6}[method]


@pytest.mark.parametrize("method", METHODS)
@few
@given(SEEDS)
def test_a_mirrored_dance_is_answered_by_the_mirrored(method: str, seed: int):
    asked = moderate(seed, 150)
    other = demand(
        -asked.wish.samples,
        -asked.high,
        -asked.low,
        asked.speed,
        asked.acceleration,
        keyposes=asked.keyposes,
    )
    assert np.abs(answered(method, asked).controls + answered(method, other).controls).max() < 1e-5


@pytest.mark.parametrize("method", [name for name in METHODS if name != "uniform"])
@few
@given(SEEDS, st.booleans())
def test_channels_do_not_know_each_other(method: str, seed: int, short: bool):
    asked = moderate(seed, 12 if short else 150, 4)
    together = answered(method, asked).controls
    for k in range(4):
        alone = demand(
            asked.wish.samples[:, k],
            asked.low[k],
            asked.high[k],
            asked.speed[:, [k]],
            asked.acceleration[k],
            keyposes=asked.keyposes,
        )
        assert np.abs(answered(method, alone).controls[:, 0] - together[:, k]).max() < 1e-7


@few
@given(SEEDS, st.floats(0.3, 0.9))
def test_qp_is_never_further_away_than_what_it_is_allowed_anyway(seed: int, share: float):
    """Of all inside the limits it is the nearest: the answer to tighter limits is one of these, and is no nearer."""
    wish = curves(seed, 150)
    fast = float(np.abs(np.diff(wish, axis=0)).max() * 60)
    assume(fast > 1e-3)
    far = [
        np.square(answered("qp", demand(wish, speed=s * fast, acceleration=20 * fast)).samples - wish).sum()
        for s in (share, share * 0.8)
    ]
    assert far[0] <= far[1] * 1.02 + 1e-9
