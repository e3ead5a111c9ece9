"""Tables of cells, and what is put where nobody danced."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition.cells import cells_of, filled


def additive(people: int = 4, tasks: int = 5, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(7, people, 1)) + rng.normal(size=(7, 1, tasks))


def table(values: np.ndarray, seen: np.ndarray):
    people, tasks = np.nonzero(seen)
    factors = {"person": [f"p{i}" for i in people], "task": [f"t{i}" for i in tasks]}
    return cells_of(values[:, people, tasks].T, factors)


def test_what_is_additive_is_filled_exactly():
    values, seen = additive(), np.ones((4, 5), bool)
    seen[[0, 1, 2, 3, 3], [0, 2, 4, 1, 3]] = False
    assert np.allclose(filled(table(values, seen), shrinkage=0.0), values, atol=1e-6)


def test_shrinkage_draws_unknown_people_to_what_is_common():
    values, seen = additive(), np.ones((4, 5), bool)
    seen[3, 1:] = False
    errors = [np.abs(filled(table(values, seen), s)[:, 3, 1:] - values[:, 3, 1:].mean()).mean() for s in (0.0, 1e6)]
    assert errors[1] < errors[0]
    assert np.isfinite(filled(table(values, seen), 1e6)).all()


def test_people_who_share_no_task_are_filled_with_numbers():
    seen = np.zeros((4, 5), bool)
    seen[:2, :2] = seen[2:, 2:] = True
    for shrinkage in (0.0, 0.3):
        whole = filled(table(additive(), seen), shrinkage)
        assert np.isfinite(whole).all()
        assert np.abs(whole).max() < 20


def test_cells_that_are_seen_stay():
    seen = np.random.default_rng(1).random((4, 5)) < 0.6
    seen[np.arange(4), np.arange(4)] = seen[0, 4] = True
    cells = table(additive(), seen)
    assert np.array_equal(filled(cells)[:, cells.seen], cells.values[:, cells.seen])


def test_a_cell_is_the_mean_of_its_segments():
    cells = cells_of(np.array([[0.0, 1], [2, 3], [9, 9]]), {"person": "bba", "task": "xxx", "tempo": "ssf"})
    assert cells.counts.shape == (2, 1, 2)
    assert cells.values[:, 1, 0, 1].tolist() == [1.0, 2.0]
    assert cells.names == (("a", "b"), ("x",), ("f", "s"))


def test_more_than_two_modes_are_filled_additively():
    rng = np.random.default_rng(0)
    values = rng.normal(size=(6, 3, 1, 1)) + rng.normal(size=(6, 1, 4, 1)) + rng.normal(size=(6, 1, 1, 2))
    at = np.array(np.nonzero(rng.random((3, 4, 2)) < 0.8))
    factors = {name: [str(i) for i in row] for name, row in zip(("person", "task", "tempo"), at, strict=True)}
    cells = cells_of(values[:, at[0], at[1], at[2]].T, factors)
    assert np.allclose(filled(cells, 0.0), values, atol=1e-6)


def test_what_makes_no_table_is_refused():
    with pytest.raises(MetricError, match="0 segments"):
        cells_of(np.zeros((0, 3)), {"person": [], "task": []})
    with pytest.raises(MetricError, match="the task of segment 1 is not known"):
        cells_of(np.zeros((2, 3)), {"person": "ab", "task": ["x", ""]})
    with pytest.raises(MetricError, match="1 names of mode task"):
        cells_of(np.zeros((2, 3)), {"person": "ab", "task": "x"})
    names = [str(i) for i in range(40_000)]
    with pytest.raises(MetricError, match="40000 × 40000 cells is too large"):
        cells_of(np.zeros((40_000, 3)), {"person": names, "task": names})
    with pytest.raises(MetricError, match="shrinkage"):
        filled(cells_of(np.zeros((1, 3)), {"person": "a"}), float("nan"))
