"""Elastic distances against a plain dynamic programme, and at the ends of the band."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition.alignment import elastic_distances


def plain(a: np.ndarray, b: np.ndarray) -> float:
    total = np.full((len(a) + 1, len(b) + 1), np.inf)
    total[0, 0] = 0
    for i in range(len(a)):
        for j in range(len(b)):
            total[i + 1, j + 1] = ((a[i] - b[j]) ** 2).sum() + min(total[i, j], total[i, j + 1], total[i + 1, j])
    return float(np.sqrt(total[-1, -1]))


def test_with_the_whole_band_it_is_dynamic_time_warping():
    a, b = np.random.default_rng(0).normal(size=(2, 3, 9, 4))
    expected = [[plain(one, other) for other in b] for one in a]
    np.testing.assert_allclose(elastic_distances(a, b, 1.0), expected, rtol=1e-5)


def test_without_a_band_it_is_euclidean():
    a, b = np.random.default_rng(0).normal(size=(2, 3, 9, 4))
    expected = np.linalg.norm((a[:, None] - b[None]).reshape(3, 3, -1), axis=-1)
    np.testing.assert_allclose(elastic_distances(a, b, 0.0), expected, rtol=1e-5)


def test_a_wider_band_is_never_farther():
    a, b = np.random.default_rng(1).normal(size=(2, 4, 12, 3))
    found = [elastic_distances(a, b, band) for band in (0.0, 0.1, 0.3, 1.0)]
    assert all((wide <= narrow + 1e-6).all() for narrow, wide in pairwise(found))


def test_shapes_that_do_not_go_together_are_named():
    with pytest.raises(MetricError, match=r"\(1, 4, 2\) and \(1, 5, 2\)"):
        elastic_distances(np.zeros((1, 4, 2)), np.zeros((1, 5, 2)))
