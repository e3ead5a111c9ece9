"""How far a pupil is from a master."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_segments import POINTS, made
from onbeat.errors import MetricError
from onbeat.recognition.pupil import alignment, compare, lateness_by_element, pairing
from onbeat.recognition.segments import Segments


def smooth(moments: int = 32, shift: float = 0.0, warp: float = 0.0) -> Segments:
    """One segment of six points on smooth ways."""
    u = np.linspace(0, 1, moments)
    u = u + warp * np.sin(np.pi * u)
    waves = np.sin(2 * np.pi * (u[:, None, None] + np.arange(6)[:, None] / 6 + np.arange(3) / 3))
    return Segments(waves[None] + shift, [2.0], ("",), ("",), [0], POINTS, np.arange(6), [1.5])


def test_a_master_is_no_way_from_itself():
    same = compare(made(), made())
    assert np.abs(same.errors).max() == 0
    assert np.abs(same.lateness).max() == 0


def test_what_is_only_late_is_no_distance_but_lateness():
    late = compare(smooth(warp=-0.06), smooth())
    stiff = compare(smooth(warp=-0.06), smooth(), band=0.0)
    assert late.distances.mean() < 0.3 * stiff.distances.mean()
    assert 0.05 < late.lateness[0, 10:22].mean() < 0.2  # a sixteenth of 2 s is 0.12 s
    assert compare(smooth(warp=0.06), smooth()).lateness[0, 10:22].mean() < -0.05


def test_the_element_that_is_wrong_is_the_farthest():
    wrong = smooth().positions.copy()
    wrong[:, :, 3] += [0.0, 0.0, 0.2]
    found = compare(replace(smooth(), positions=wrong), smooth(), band=0.0)
    assert found.farthest[0] == POINTS[3]
    assert found.distances.round(9).tolist() == [0, 0, 0, 0.2, 0, 0]
    assert found.centimetres.round(9).tolist() == [0, 0, 0, 30, 0, 0]


def test_only_the_points_that_both_have_are_compared():
    fewer = replace(smooth(), positions=smooth().positions[:, :, 2:], elements=POINTS[2:], links=np.arange(4))
    assert compare(fewer, smooth()).elements == POINTS[2:]
    assert compare(smooth(), fewer).distances.tolist() == [0, 0, 0, 0]


def test_the_way_is_the_cheapest_and_stays_in_its_band():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 3, 9, 2, 3))
    ways = alignment(a, b, 0.3)
    for way, pupil, master in zip(ways, a, b, strict=True):
        costs = np.square(master[:, None] - pupil).sum(axis=(2, 3))
        assert way[0, 0] == way[-1, -1] == 1
        assert np.abs(np.subtract(*np.nonzero(way))).max() <= 3
        assert (way * costs).sum() == pytest.approx(cheapest(costs, 3))


def cheapest(costs: np.ndarray, band: int) -> float:
    """The textbook's way."""
    total = np.full((len(costs) + 1, len(costs) + 1), np.inf)
    total[0, 0] = 0
    for i in range(len(costs)):
        for j in range(len(costs)):
            if abs(i - j) <= band:
                total[i + 1, j + 1] = costs[i, j] + min(total[i, j], total[i, j + 1], total[i + 1, j])
    return float(total[-1, -1])


def test_what_cannot_be_compared_is_refused():
    one = smooth()
    with pytest.raises(MetricError, match="one at least"):
        compare(one[[]], one[[]])
    with pytest.raises(MetricError, match="32 moments beside 1 of the master at 8"):
        compare(one, smooth(8))
    with pytest.raises(MetricError, match="no point in common"):
        compare(replace(one, elements=tuple("abcdef")), one)
    for band in (-0.1, 1.1, np.nan):
        with pytest.raises(MetricError, match="band"):
            compare(one, one, band)


def test_the_part_that_is_late_is_told_from_those_that_are_not():
    u = np.linspace(0, 1, 41)
    places = np.array(smooth(41).positions)
    places[0, :, 2] = np.stack([np.interp(u - 0.1, u, axis) for axis in places[0, :, 2].T], axis=1)  # a tenth of 2 s
    places[:, :, 4] = 0.3
    master = smooth(41).positions.copy()
    master[:, :, 4] = 0.3
    late = lateness_by_element(replace(smooth(41), positions=places), replace(smooth(41), positions=master))
    assert late[2] == pytest.approx(0.2, abs=0.05)
    assert np.isnan(late[4])
    assert np.abs(late[[0, 1, 3, 5]]).max() == 0


def test_the_pairs_go_from_the_first_moment_to_the_last_and_never_back():
    pairs = pairing(smooth(warp=-0.06), smooth())
    assert pairs.shape == (1, 32)
    assert pairs[0, 0] < 1
    assert pairs[0, -1] > 30
    assert (np.diff(pairs[0]) >= 0).all()
    assert pairs[0, 10:22].mean() < np.arange(10, 22).mean() - 1  # who is late is met earlier in the master's time
    with pytest.raises(MetricError, match="a band of -1"):
        pairing(smooth(), smooth(), -1)
