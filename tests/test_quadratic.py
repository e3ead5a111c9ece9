import warnings

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.sparse import csc_matrix, csr_array, eye_array, triu

from onbeat.quadratic import minimise


def random_programme(seed: int, n: int = 6, m: int = 8) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, n))
    return root @ root.T + 0.1 * np.eye(n), 3 * rng.normal(size=n), rng.normal(size=(m, n)), rng.uniform(0.1, 1, m)


@pytest.mark.parametrize("seed", range(5))
def test_a_programmes_answer_is_that_of_another_solver(seed: int):
    cost, linear, rows, room = random_programme(seed)
    found = minimise(csc_matrix(cost), linear, csr_array(rows), (-room, room))
    assert found is not None
    inside = [{"type": "ineq", "fun": lambda x, s=s: room - s * rows @ x} for s in (1, -1)]
    other = minimize(lambda x: x @ cost @ x / 2 + linear @ x, np.zeros(6), constraints=inside, tol=1e-12)
    np.testing.assert_allclose(found, other.x, atol=1e-5)
    assert (np.abs(rows @ found) <= room + 1e-8).all()


def test_without_rows_in_the_way_it_is_the_linear_systems_answer():
    cost, linear, rows, _ = random_programme(7)
    free = np.full(8, np.inf)
    found = minimise(csc_matrix(cost), linear, csr_array(rows), (-free, free))
    np.testing.assert_allclose(found, np.linalg.solve(cost, -linear), atol=1e-6)


def test_the_upper_triangle_is_enough():
    cost, linear, rows, room = random_programme(3)
    whole, half = (minimise(c, linear, csr_array(rows), (-room, room)) for c in (csc_matrix(cost), triu(cost)))
    np.testing.assert_array_equal(whole, half)


def test_row_indices_out_of_order_and_twice_are_the_same_programme():
    cost, linear, rows, room = random_programme(4)
    tidy = csc_matrix(rows)
    data, indices = tidy.data.copy(), tidy.indices.copy()
    for start, end in zip(tidy.indptr[:-1], tidy.indptr[1:], strict=True):
        data[start:end], indices[start:end] = data[start:end][::-1], indices[start:end][::-1]
    messy = csc_matrix((data, indices, tidy.indptr), shape=rows.shape)
    twice = csc_matrix(
        (np.concatenate((rows.T.ravel() / 2,) * 2), (np.tile(np.arange(8), 12), np.repeat(np.tile(range(6), 2), 8)))
    )
    wanted = minimise(csc_matrix(cost), linear, tidy, (-room, room))
    for given in (messy, twice):
        before = given.data.copy()
        np.testing.assert_allclose(minimise(csc_matrix(cost), linear, given, (-room, room)), wanted, atol=1e-9)
        np.testing.assert_array_equal(given.data, before)


def test_what_has_to_be_equal_is_equal_and_boxes_hold():
    total = csr_array(np.ones((1, 3)))
    free = np.array([np.inf])
    found = minimise(
        eye_array(3),
        np.array([-5.0, 0, 0]),
        csr_array(np.ones((1, 3))),
        (-free, free),
        equal=(total, np.array([1.0])),
        box=(np.zeros(3), np.array([0.6, 1, 1])),
    )
    np.testing.assert_allclose(found, [0.6, 0.2, 0.2], atol=1e-6)


@pytest.mark.parametrize(
    ("rows", "low", "high"),
    [([[1.0, 0], [1, 0]], [1.0, -9], [9.0, 0]), ([[1.0, 0]], [1.0], [0.0])],
    ids=["two rows exclude each other", "a row's own bounds are crossed"],
)
def test_where_there_is_none_none_is_the_answer(rows: list, low: list, high: list):
    assert minimise(eye_array(2), np.zeros(2), csr_array(np.array(rows)), (np.array(low), np.array(high))) is None


def test_a_programme_without_a_least_is_none():
    free = np.array([np.inf])
    assert minimise(csc_matrix((1, 1)), np.array([-1.0]), csr_array(np.ones((1, 1))), (-free, free)) is None


def test_numbers_that_are_none_are_no_programme():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert minimise(eye_array(1), np.array([np.nan]), eye_array(1), (np.array([-1.0]), np.array([1.0]))) is None


def test_equal_bounds_are_met_within_the_tolerance():
    found = minimise(eye_array(2), np.zeros(2), eye_array(2), (np.array([0.3, -1]), np.array([0.3, 1])), tolerance=1e-9)
    assert found is not None
    assert abs(found[0] - 0.3) < 1e-8


def test_few_iterations_are_no_answer_unless_one_inside_will_do():
    cost, linear, rows, room = random_programme(5)
    given = (csc_matrix(cost), linear, csr_array(rows), (-room, room))
    assert minimise(*given, iterations=1) is None
    late = minimise(*given, iterations=1, tolerance=10.0, gap=1e-12, creeping=True)
    assert late is not None
