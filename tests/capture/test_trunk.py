from __future__ import annotations

import numpy as np
import pytest

from onbeat.capture.body import template
from onbeat.capture.trunk import pelvis, waist
from onbeat.motion import rotations as rot


def spines(width: float, depth: float) -> dict[str, np.ndarray]:
    """A pelvis that leans as a standing one's does and looks along +Y."""
    forwards = np.array([0, np.cos(np.radians(10)), -np.sin(np.radians(10))])
    front = np.array([0, 0, 1.0])
    at = {"left_asis": [-width / 2, 0, 0], "right_asis": [width / 2, 0, 0]}
    at |= {"left_psis": [-0.05, 0, 0], "right_psis": [0.05, 0, 0]}
    return {name: (front + p + (0 if "asis" in name else -depth) * forwards)[None] for name, p in at.items()}


def test_hips_are_where_the_regression_has_them():
    width, depth = 0.25, 0.16
    seen, body = spines(width, depth), template()
    offsets, _ = pelvis(seen, body)
    turns, origin = waist(seen, body)
    hips = [
        origin[0] + rot.rotate(turns[0], offsets[body.skeleton.index(f"{side}UpLeg")]) for side in ("Left", "Right")
    ]
    forwards = np.array([0, np.cos(np.radians(10)), -np.sin(np.radians(10))])
    upwards = np.array([0, np.sin(np.radians(10)), np.cos(np.radians(10))])
    for hip, sign in zip(hips, (-1, 1), strict=True):
        from_front = hip - np.array([0, 0, 1.0])
        assert from_front[0] == pytest.approx(sign * (0.33 * width + 0.0073), abs=1e-9)
        assert from_front @ forwards == pytest.approx(-0.24 * depth - 0.0099, abs=1e-9)
        assert from_front @ upwards == pytest.approx(-0.30 * width - 0.0109, abs=1e-9)


def test_a_standing_pelvis_is_upright():
    turns, _ = waist(spines(0.25, 0.16), template())
    assert rot.angle_between(turns, rot.IDENTITY).max() < 1e-6
