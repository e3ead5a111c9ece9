import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.keyposes.space import KeyposeSpace, uniform_times


@pytest.fixture
def poses():
    return np.random.default_rng(1).normal(size=(12, 9)) * np.arange(9, 0, -1)


def test_axes_are_square_to_each_other_and_sorted(poses):
    space = KeyposeSpace.of(poses)
    assert np.allclose(space.axes @ space.axes.T, np.eye(len(space)), atol=1e-12)
    assert (np.diff(space.variances) <= 0).all()
    assert space.variances.sum() == pytest.approx(poses.var(axis=0).sum())
    assert np.allclose(space.project(poses, 9).var(axis=0), space.variances)


def test_the_axes_are_eigenvectors_of_the_covariance(poses):
    space = KeyposeSpace.of(poses)
    covariance = np.cov(poses.T, bias=True)
    assert np.allclose(covariance @ space.axes.T, space.axes.T * space.variances, atol=1e-9)


def test_all_dimensions_give_the_poses_back(poses):
    space = KeyposeSpace.of(poses)
    assert np.allclose(space.reduced(poses, len(space)), poses, atol=1e-12)


def test_more_dimensions_are_never_further_off(poses):
    space = KeyposeSpace.of(poses)
    unseen = np.random.default_rng(2).normal(size=(20, 9))
    errors = [np.linalg.norm(space.reduced(unseen, dims) - unseen) for dims in range(1, len(space) + 1)]
    assert (np.diff(errors) <= 1e-12).all()


def test_few_poses_span_one_dimension_less_than_they_are(poses):
    space = KeyposeSpace.of(poses[:4])
    assert len(space) == 3
    assert np.allclose(space.reduced(poses[:4], 8), poses[:4], atol=1e-12)
    assert space.project(poses, 8).shape == (12, 3)


def test_the_order_of_the_poses_does_not_count(poses):
    a, b = KeyposeSpace.of(poses), KeyposeSpace.of(poses[::-1])
    assert np.allclose(a.axes, b.axes, atol=1e-9)


def test_dimensions_for_a_share_of_the_variance():
    space = KeyposeSpace.of(np.array([[3.0, 0, 0], [-3, 0, 0], [0, 2, 0], [0, -2, 0], [0, 0, 1], [0, 0, -1]]))
    assert np.allclose(space.cumulative, [9 / 14, 13 / 14, 1.0])
    assert [space.dims_for(rho) for rho in (0.1, 9 / 14, 0.65, 0.93, 1.0)] == [1, 1, 2, 3, 3]


@pytest.mark.parametrize("rho", [0.0, -1.0, 1.5, float("nan")])
def test_a_share_that_cannot_be_is_refused(poses, rho):
    with pytest.raises(MetricError, match="cannot be"):
        KeyposeSpace.of(poses).dims_for(rho)


@pytest.mark.parametrize(
    ("poses", "told"),
    [
        (np.zeros((1, 9)), "span no space"),
        (np.zeros((0, 9)), "span no space"),
        (np.zeros(9), "span no space"),
        (np.ones((5, 9)), "all 5 poses are alike"),
        (np.array([[0.0, 1], [np.nan, 2]]), "pose 1 of 2 is not finite"),
    ],
)
def test_poses_that_span_no_space_are_refused(poses, told):
    with pytest.raises(MetricError, match=told):
        KeyposeSpace.of(poses)


def test_no_dimension_holds_nothing(poses):
    with pytest.raises(MetricError, match="0 dimensions"):
        KeyposeSpace.of(poses).project(poses, 0)


def test_uniform_sampling_parts_a_cycle_evenly():
    times = uniform_times(2.0, 4.0, 8, 0.25)
    assert np.allclose(np.diff(times), 0.25)
    assert times[0] == pytest.approx(2.0625)
    assert np.allclose(uniform_times(2.0, 4.0, 8, 1.0)[:-1], uniform_times(2.0, 4.0, 8)[1:])


@pytest.mark.parametrize("given", [(1.0, 1.0, 3), (2.0, 1.0, 3), (0.0, 1.0, 0), (0.0, np.nan, 2), (0.0, np.inf, 2)])
def test_a_cycle_without_length_is_refused(given):
    with pytest.raises(MetricError, match="cannot be"):
        uniform_times(*given)
