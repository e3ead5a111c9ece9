"""The vote of the elements."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition.voting import Matches, checked_weights, distances, reference, votes, weights_by_links


def test_distances_are_those_of_each_pair():
    rng = np.random.default_rng(0)
    probes, cells = rng.normal(size=(5, 3, 4)) + 1e3, rng.normal(size=(2, 3, 4)) + 1e3
    pairs = np.square(probes[:, :, None] - cells.transpose(1, 0, 2)).sum(-1)
    assert np.allclose(distances(probes, reference(cells)), pairs, atol=1e-9)
    assert distances(cells, reference(cells))[0, :, 0].max() < 1e-9


def test_every_element_votes_for_its_nearest_with_its_weight():
    least = np.array([[[1.0, 2, 3], [5, 1, 2], [9, 8, 7]]])
    assert votes(least, np.array([0.2, 0.3, 0.5])).tolist() == [[0.2, 0.3, 0.5]]


def test_categories_that_are_as_near_share_the_vote():
    assert votes(np.zeros((1, 1, 4)), np.ones(1)).tolist() == [[0.25] * 4]


def test_as_many_votes_are_told_apart_by_distance():
    matches = Matches("task", ("a", "b", "c"), np.array([[0.4, 0.4, 0.2]]), np.array([[2.0, 1.0, 0.5]]))
    assert matches.order.tolist() == [[1, 0, 2]]
    assert (matches.best, matches.nearest, len(matches)) == (("b",), ("c",), 1)


def test_weights_rise_with_the_links_and_the_centre_has_none():
    assert weights_by_links(np.array([0, 2, 4])).tolist() == [0, 2, 4]
    assert checked_weights(np.array([0.0, 1, 3]), 3).tolist() == [0, 0.25, 0.75]
    assert checked_weights(np.array([1e308, 1e308]), 2).tolist() == [0.5, 0.5]


@pytest.mark.parametrize("weights", [[1.0], [-1.0, 1], [0.0, 0], [np.nan, 1], [np.inf, 1]])
def test_weights_that_are_none_are_refused(weights: list[float]):
    with pytest.raises(MetricError, match="2 numbers from 0"):
        checked_weights(np.array(weights), 2)
