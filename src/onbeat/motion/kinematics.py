"""Forward kinematics on batches of frames."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.skeleton import Skeleton

PART = 1024
"""Frames that are gone through together."""


def forward_kinematics(
    skeleton: Skeleton,
    rotations: Rotations,
    root_positions: Positions,
    translations: Positions | None = None,
) -> tuple[Rotations, Positions]:
    """World rotations and positions of all joints.

    ``R_j = R_parent R_j,local`` and ``p_j = p_parent + R_parent offset_j``.

    Parameters
    ----------
    skeleton : J joints.
    rotations : (..., J, 4) wxyz, local.
    root_positions : (..., 3) metres.
    translations : (..., J, 3) metres or None, offsets that replace the skeleton's.

    Returns
    -------
    (..., J, 4) world rotations and (..., J, 3) world positions in metres.

    Examples
    --------
    >>> arm = Skeleton(("shoulder", "hand"), [-1, 0], [[0, 0, 0], [1, 0, 0]])
    >>> turned = np.array([[np.sqrt(0.5), 0, 0, np.sqrt(0.5)], [1, 0, 0, 0]])  # 90° about Z
    >>> (forward_kinematics(arm, turned, np.zeros(3))[1][1].round(6) + 0.0).tolist()
    [0.0, 1.0, 0.0]
    """
    world_rotations = np.empty_like(rotations)
    positions = np.empty((*rotations.shape[:-1], 3))
    world_rotations[..., 0, :] = rotations[..., 0, :]
    positions[..., 0, :] = root_positions
    for part in _parts(rotations):
        moved = None if translations is None else translations[part]
        _down(skeleton, rotations[part], moved, world_rotations[part], positions[part])
    return world_rotations, positions


def _parts(rotations: Rotations) -> list[Any]:
    """Frames in parts whose poses a processor keeps at hand, which takes half the time; all of any other shape."""
    if rotations.ndim != 3:
        return [...]
    return [slice(first, first + PART) for first in range(0, len(rotations), PART)]


def _down(
    skeleton: Skeleton, rotations: Rotations, translations: Positions | None, world: Rotations, positions: Positions
) -> None:
    """Fill ``world`` and ``positions``, whose roots are filled, from parents to children."""
    for joint in range(1, len(skeleton)):
        parent = skeleton.parents[joint]
        above = world[..., parent, :]
        offset = skeleton.offsets[joint] if translations is None else translations[..., joint, :]
        world[..., joint, :] = rot.multiply(above, rotations[..., joint, :])
        positions[..., joint, :] = positions[..., parent, :] + rot.rotate(above, offset)


def local_rotations(skeleton: Skeleton, world_rotations: Rotations) -> Rotations:
    """The inverse of the rotation part of :func:`forward_kinematics`: (..., J, 4) world to local."""
    local = world_rotations.copy()
    above = world_rotations[..., skeleton.parents[1:], :]
    local[..., 1:, :] = rot.multiply(rot.inverse(above), world_rotations[..., 1:, :])
    return local
