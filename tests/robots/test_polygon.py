"""Hulls and how far inside of them points are."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from onbeat.errors import BodyError
from onbeat.robots.polygon import Polygons

SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])


def test_margins_are_those_of_an_independent_hull():
    points = np.random.default_rng(3).normal(size=(50, 8, 2))
    inside = points.mean(axis=1)
    expected = [-ConvexHull(each).equations @ np.append(p, 1) for each, p in zip(points, inside, strict=True)]
    np.testing.assert_allclose(Polygons.around(points).margins(inside), [each.min() for each in expected], atol=1e-12)


def test_outside_it_is_the_distance_to_the_nearest_corner_or_edge():
    polygons = Polygons.around(np.tile(SQUARE, (2, 1, 1)))
    np.testing.assert_allclose(polygons.margins(np.array([[4.0, 5.0], [0.5, -2.0]])), [-5, -2])


def test_points_that_do_not_touch_span_nothing():
    far = np.concatenate((SQUARE, [[9.0, 9], [9, -9]]))[None]
    touching = np.array([[True, True, True, True, False, False]])
    assert Polygons.around(far, touching).margins(np.array([[2.0, 0.5]]))[0] == pytest.approx(-1)


def test_points_on_an_edge_and_repeated_points_change_nothing():
    more = np.concatenate((SQUARE, [[0.5, 0.0], [1, 1], [0.5, 0.5]]))[None]
    assert Polygons.around(more).margins(np.array([[0.5, 0.2]]))[0] == pytest.approx(0.2)


@pytest.mark.parametrize("points", [SQUARE[[0, 1]], np.array([[0.0, 0], [1, 1], [2, 2]]), np.zeros((4, 2))])
def test_nothing_stands_on_a_line(points: np.ndarray):
    with pytest.raises(BodyError, match="frame 0: no polygon"):
        Polygons.around(points[None])
