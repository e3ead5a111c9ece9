"""The body's own frame of points: it goes and turns with the body, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.motion import rotations as rot
from onbeat.recognition.trunk import NEEDED, seen_from_trunk, trunk
from recognition_takes import ELEMENTS, REST


def test_a_body_that_goes_and_turns_is_seen_the_same():
    rng = np.random.default_rng(0)
    turns = rot.exp(rng.normal(size=(6, 3)))
    points = rot.rotate(turns[:, None], REST) + rng.normal(size=(6, 1, 3))
    np.testing.assert_allclose(seen_from_trunk(points, ELEMENTS), np.tile(REST, (6, 1, 1)), atol=1e-9)
    frames, origins = trunk(points, ELEMENTS)
    assert np.allclose(np.abs((frames * turns).sum(axis=-1)), 1)
    assert np.array_equal(origins, points[:, ELEMENTS.index("hips")])


def test_the_elements_may_come_in_any_order_and_shape():
    points, back = np.tile(REST, (2, 3, 1, 1)), slice(None, None, -1)
    there = seen_from_trunk(points[..., back, :], ELEMENTS[back])
    np.testing.assert_allclose(there[..., back, :], seen_from_trunk(points, ELEMENTS), atol=1e-12)


def test_what_is_missing_is_named():
    with pytest.raises(MetricError, match="no right_hip"):
        trunk(REST[:4], NEEDED[:4])
