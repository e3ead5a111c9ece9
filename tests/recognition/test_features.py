"""What the views keep and what they drop."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.motion import rotations as rot
from onbeat.recognition.features import VIEWS, in_body, views_of
from recognition_takes import REST, takes


def test_where_the_body_stands_and_faces_is_in_no_view():
    some = takes(1)
    turned = rot.rotate(rot.yaw(np.array(1.1)), some.positions) + np.array([3.0, -2.0, 0.0])
    for name, view in views_of(replace(some, positions=turned), VIEWS).items():
        np.testing.assert_allclose(view, views_of(some, VIEWS)[name], atol=1e-9)


def test_the_course_knows_neither_posture_nor_size():
    some = takes(1, noise=0.0)
    stance = np.zeros_like(REST)
    stance[5:] = [0.1, 0.2, -0.1]
    mean = some.positions.mean(axis=1, keepdims=True)
    other = replace(some, positions=mean + 1.7 * (some.positions - mean) + stance)
    for name in ("course", "elastic course"):
        np.testing.assert_allclose(views_of(some, [name])[name], views_of(other, [name])[name], atol=1e-9)
    assert not np.allclose(views_of(some, ["posture"])["posture"], views_of(other, ["posture"])["posture"])


def test_a_body_that_stands_still_has_finite_views():
    some = takes(1)
    still = replace(some, positions=np.tile(REST, (len(some), 16, 1, 1)))
    assert all(np.isfinite(view).all() for view in views_of(still, VIEWS).values())


def test_seen_from_the_body_twice_is_as_once():
    some = takes(1)
    once = in_body(some)
    np.testing.assert_allclose(in_body(replace(some, positions=once)), once, atol=1e-9)


def test_a_missing_hip_is_named():
    some = takes(1)
    fewer = replace(some, positions=some.positions[:, :, :4], elements=some.elements[:4], links=some.links[:4])
    with pytest.raises(MetricError, match="no right_hip"):
        in_body(fewer)
