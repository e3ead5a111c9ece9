"""Lowering the pelvis where a leg would be too short for where its foot should stand."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from onbeat._shapes import Array, Bools, Positions, Rotations, Times
from onbeat.motion.body import Body, chain_length

STRAIGHT = 0.985
"""Part of its length to which a leg may be stretched, unless the clips' own pose stretches it more."""
DEEPEST = 0.1
"""Metres the pelvis sinks at most."""
SPREAD = 0.12
"""Seconds before and after over which it sinks and rises again."""


def sunk(
    body: Body,
    world: tuple[Rotations, Positions],
    ankles: Mapping[str, Positions],
    changed: Bools,
    times: Times,
) -> Positions:
    """(F, 3) metres to lower the root by, smooth in time and never less than the legs need (up to ``DEEPEST``).

    Parameters
    ----------
    body : roles of the skeleton.
    world : world rotations and positions of the poses.
    ankles : for each side, (F, 3) where its ankle should be.
    changed : (F,) true where an ankle should be elsewhere than it is.
    times : (F,) seconds.
    """
    need = np.zeros(len(times))
    for side, targets in ankles.items():
        hip, knee, ankle = (body[f"{side}_{role}"] for role in ("hip", "knee", "ankle"))
        length = chain_length(body.skeleton, hip, knee) + chain_length(body.skeleton, knee, ankle)
        now = np.linalg.norm(world[1][:, ankle] - world[1][:, hip], axis=1)
        need = np.maximum(need, _drop(world[1][:, hip], targets, np.maximum(now, STRAIGHT * length)))
    down = np.zeros((len(times), 3))
    if len(times) > 1:
        down[:, 2] = _smooth(np.where(changed, np.minimum(need, DEEPEST), 0.0), SPREAD / (times[1] - times[0]))
    return down


def _drop(hips: Positions, ankles: Positions, reach: Array) -> Array:
    """Metres by which hips (F, 3) must sink for ankles (F, 3) to come within ``reach`` (F,)."""
    apart = hips - ankles
    flat = np.linalg.norm(apart[:, :2], axis=1)
    return np.maximum(apart[:, 2] - np.sqrt(np.maximum(reach**2 - flat**2, 0.0)), 0.0)


def _smooth(need: Array, width: float) -> Array:
    """A smooth curve never under ``need``: its running maximum, averaged by a kernel that fits inside it."""
    if not need.any():
        return need
    half = max(1, round(width))
    widened = maximum_filter1d(need, 2 * half + 1)
    return gaussian_filter1d(widened, half / 3, radius=half, mode="nearest")
