import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline

from onbeat.errors import PlanError
from onbeat.retime.bspline import LARGEST, Knots, Spline, basis, differences

PARTS = np.linspace(0, 1, 21)
KNOTS = Knots(-0.7, 0.3, 9)
FULL = KNOTS.start + KNOTS.step * np.arange(-3, KNOTS.intervals + 4)
"""The knots with the three before and after that a cubic needs."""


def random_spline(seed: int = 0, intervals: int = 9, channels: int = 3) -> Spline:
    controls = np.random.default_rng(seed).normal(size=(intervals + 3, channels))
    return Spline(Knots(-0.7, 0.3, intervals), controls)


def test_the_basis_is_that_of_the_paper():
    t = PARTS
    wanted = np.stack(
        [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3],
        axis=1,
    )
    np.testing.assert_allclose(basis(t), wanted / 6, atol=1e-15)


def test_derivatives_of_the_basis_sum_to_nothing_and_end():
    for order in (1, 2, 3, 4, 5):
        np.testing.assert_allclose(basis(PARTS, order).sum(axis=1), 0, atol=1e-14)
    assert np.abs(basis(PARTS, 3)).max() == 3
    assert not basis(PARTS, 4).any()


def test_the_design_is_scipys():
    times = np.sort(np.random.default_rng(1).uniform(KNOTS.start, KNOTS.end, 40))
    wanted = BSpline.design_matrix(times, FULL, 3).toarray()
    np.testing.assert_allclose(KNOTS.design(times).toarray(), wanted, atol=1e-13)
    np.testing.assert_allclose(KNOTS.design(times).sum(axis=1), 1, atol=1e-14)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_values_and_derivatives_are_scipys(order: int):
    spline = random_spline()
    times = np.linspace(KNOTS.start, KNOTS.end, 100)[:-1] + 1e-4
    other = BSpline(FULL, np.array(spline.controls), 3)
    np.testing.assert_allclose(spline(times, order), other(times, order), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(KNOTS.design(times, order) @ spline.controls, spline(times, order), atol=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_derivatives_are_finite_differences(order: int):
    spline, h = random_spline(4), 1e-5
    times = np.linspace(KNOTS.start + 0.01, KNOTS.end - 0.01, 57)
    rise = (spline(times + h, order - 1) - spline(times - h, order - 1)) / (2 * h)
    np.testing.assert_allclose(spline(times, order), rise, rtol=1e-3, atol=2e-3)


def test_control_points_of_derivatives_bound_and_make_them():
    spline = random_spline(2)
    times = np.linspace(KNOTS.start, KNOTS.end, 2000)
    for order in (1, 2, 3):
        points = spline.differences(order)
        assert len(points) == KNOTS.controls - order
        assert (spline(times, order).max(axis=0) <= points.max(axis=0) + 1e-9).all()
        assert (spline(times, order).min(axis=0) >= points.min(axis=0) - 1e-9).all()
    np.testing.assert_allclose(spline(KNOTS.times, 2)[:-1], spline.differences(2)[:-1], atol=1e-9)
    middles = KNOTS.times[:-1] + KNOTS.step / 2
    np.testing.assert_allclose(spline(middles, 3), spline.differences(3), rtol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_the_hull_bounds_each_interval_and_is_nearer_than_the_control_points(seed: int):
    spline = random_spline(seed)
    hull = spline.hull
    for k in range(KNOTS.intervals):
        values = spline(np.linspace(KNOTS.times[k], KNOTS.times[k + 1], 50))
        near = np.concatenate(hull[:, k : k + 3])
        assert (values <= near.max(axis=0) + 1e-12).all()
        assert (values >= near.min(axis=0) - 1e-12).all()
    assert np.ptp(hull[:, :, 0]) < np.ptp(spline.controls[:, 0])


def test_differences_are_numpys():
    values = np.random.default_rng(0).normal(size=(9, 2))
    for order in (0, 1, 2, 3):
        np.testing.assert_allclose(differences(9, order) @ values, np.diff(values, order, axis=0), atol=1e-14)
    assert differences(2, 3).shape == (0, 2)


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 5, 50])
def test_it_goes_through_all_samples(frames: int):
    samples = np.random.default_rng(frames).normal(size=(frames, 2))
    spline = Spline.through(samples, 24.0, start=3.0)
    np.testing.assert_allclose(spline(3.0 + np.arange(frames) / 24), samples, atol=1e-12)
    np.testing.assert_allclose(spline.samples[:frames], samples, atol=1e-12)
    ends = np.array([spline.knots.start, spline.knots.end])
    np.testing.assert_allclose(spline(ends, 2), 0, atol=1e-8)


def test_through_is_the_natural_cubic_spline():
    samples = np.random.default_rng(3).normal(size=(20, 1))
    other = CubicSpline(np.arange(20) / 10, samples, bc_type="natural")
    times = np.linspace(0, 1.9, 333)
    np.testing.assert_allclose(Spline.through(samples, 10.0)(times), other(times), atol=1e-12)


def test_one_frame_stands_still_for_a_frame():
    spline = Spline.through(np.array([[1.5, -2.0]]), 30.0)
    assert spline.knots.intervals == 1
    np.testing.assert_allclose(spline(np.array([-1.0, 0, 0.02, 9])), [[1.5, -2.0]] * 4, atol=1e-15)
    np.testing.assert_allclose(spline(np.array([0.01]), 1), 0, atol=1e-12)


def test_two_frames_are_a_line():
    spline = Spline.through(np.array([[0.0], [3.0]]), 10.0)
    np.testing.assert_allclose(spline(np.array([0.05, 0.1]))[:, 0], [1.5, 3.0], atol=1e-12)
    np.testing.assert_allclose(spline.differences(2), 0, atol=1e-9)


def test_outside_its_time_it_is_what_it_is_at_its_ends():
    spline = random_spline(5)
    out = np.array([-100.0, 100.0, -np.inf, np.inf])
    np.testing.assert_allclose(spline(out), spline(np.array([KNOTS.start, KNOTS.end] * 2)), atol=1e-12)


def test_a_knot_belongs_to_the_interval_after_it_and_the_last_to_the_last():
    interval, part = KNOTS.places(KNOTS.times)
    assert interval[-1] == KNOTS.intervals - 1
    np.testing.assert_allclose(part[-1], 1.0, atol=1e-9)
    np.testing.assert_allclose(interval + part, np.arange(KNOTS.intervals + 1), atol=1e-9)


def test_no_times_are_no_values():
    assert random_spline()(np.zeros(0)).shape == (0, 3)
    assert KNOTS.design(np.zeros(0)).shape == (0, KNOTS.controls)


def test_a_spline_is_not_changed_by_its_maker():
    controls = np.zeros((KNOTS.controls, 1))
    spline = Spline(KNOTS, controls)
    controls[0] = 9
    assert spline.controls[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        spline.controls[0] = 1


@pytest.mark.parametrize(
    ("samples", "fps", "said"),
    [
        (np.zeros((0, 2)), 30.0, "one frame or more"),
        (np.zeros(3), 30.0, "shape"),
        (np.array([[0.0, 1], [0, np.nan]]), 30.0, "channel 1 is nan at frame 1"),
        (np.array([[0.0], [-np.inf]]), 30.0, "channel 0 is -inf at frame 1"),
        (np.array([[0.0], [10 * LARGEST], [0.0]]), 30.0, "channel 0"),
        (np.zeros((3, 1)), 0.0, "0.0 samples a second"),
        (np.zeros((3, 1)), -30.0, "above 0"),
        (np.zeros((3, 1)), np.nan, "above 0"),
        (np.zeros((3, 1)), np.inf, "above 0"),
    ],
)
def test_what_is_no_curve_is_said_so(samples: np.ndarray, fps: float, said: str):
    with pytest.raises(PlanError, match=said):
        Spline.through(samples, fps)


def test_control_points_have_to_fit_their_knots():
    with pytest.raises(PlanError, match=r"\(12, channels\) are needed"):
        Spline(KNOTS, np.zeros((11, 2)))
    with pytest.raises(PlanError, match="12"):
        Spline(KNOTS, np.zeros(12))


def test_a_time_that_is_no_number_is_said_so():
    with pytest.raises(PlanError, match="time 1 is not a number"):
        random_spline()(np.array([0.0, np.nan]))
