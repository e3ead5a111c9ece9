"""Whether a body is its own mirror image, as files of left-handed axes make it: its toes and knees point backwards."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.motion.body import Body
from onbeat.motion.motion import Motion

_SAMPLES = 64
_TOES, _KNEES = -0.2, -0.005
"""Toes to the front, as part of the foot; knees before the line from hip to ankle, as part of the leg.

Captured bodies have .2 and more (dancers who point their toes) and .02 and more, mean of a take and of both sides.
"""
_KNEES_ALONE = -0.03
"""Of bodies without toes."""
MIRRORED = (
    "toes and knees point backwards, seen from its left side and its head: the body is mirrored, as left-handed axes "
    "make it, or left and right are exchanged; export it again with right-handed axes"
)
"""What to say of such a body."""


def is_mirrored(motion: Motion, body: Body) -> bool:
    """Whether knees bend, and toes point, to what is the back by the body's left side and head.

    It does not depend on which axis is up, nor on how the body lies or turns: ``left × up`` is the front of a body
    in right-handed axes. Some frames over the take tell; where limbs have no length nothing does.

    Parameters
    ----------
    motion : in any unit.
    body : its roles.

    Examples
    --------
    >>> from onbeat.motion.skeleton import Skeleton
    >>> names = ["hips", "chest", *(s + n for s in "lr" for n in
    ...          ("humerus", "radius", "wrist", "femur", "tibia", "foot", "toes"))]
    >>> parents = [-1, 0, 1, 2, 3, 0, 5, 6, 7, 1, 9, 10, 0, 12, 13, 14]
    >>> arm, leg = [[-0.2, 0, 0.2], [0, 0, -0.3], [0, 0, -0.3]], [[-0.1, 0, 0], [0, 0.05, -0.4], [0, -0.05, -0.4]]
    >>> left = np.array([*arm, *leg, [0, 0.2, 0]])
    >>> offsets = np.array([[0, 0, 0], [0, 0, 0.4], *left, *(left * [-1, 1, 1])])
    >>> person, other = Skeleton(names, parents, offsets), Skeleton(names, parents, offsets * [-1, 1, 1])
    >>> stands = np.tile([1.0, 0, 0, 0], (1, 16, 1)), np.zeros((1, 3))
    >>> [is_mirrored(Motion(body, *stands, fps=30), Body.of(body)) for body in (person, other)]
    [False, True]
    """
    some = motion[:: max(1, len(motion) // _SAMPLES)].positions
    shoulders, hips = (some[:, body.indices(f"left_{part}", f"right_{part}")] for part in ("shoulder", "hip"))
    across = (shoulders + hips)[:, 0] - (shoulders + hips)[:, 1]
    front: Array = np.asarray(_unit(np.cross(across, shoulders.mean(1) - hips.mean(1)).real))
    knees, toes = [], []
    for side in ("left", "right"):
        hip, knee, ankle = (some[:, body[f"{side}_{part}"]] for part in ("hip", "knee", "ankle"))
        line = _unit(ankle - hip)
        bend = (knee - hip) - line * _dot(knee - hip, line)[:, None]
        knees.append(_dot(bend, front).mean())
        if f"{side}_toe" in body:
            toes.append(_dot(_unit(some[:, body[f"{side}_toe"]] - ankle), front).mean())
    bent = float(np.mean(knees)) / max(body.leg_length, 1e-9)
    return bent < _KNEES and float(np.mean(toes)) < _TOES if toes else bent < _KNEES_ALONE


def _unit(v: Array) -> Array:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)


def _dot(a: Array, b: Array) -> Array:
    return np.sum(a * b, axis=-1)
