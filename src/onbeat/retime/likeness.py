"""Whether repetitions are of one dance: how alike they move on musical time, beside the same shifted against it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array
from onbeat.retime.takes import DENSITY, Repetitions

COARSE = 2
"""The coarsest layers, by which repetitions are compared: what is left of a dance at any speed."""
ALIKE = 0.5
"""The likeness under which repetitions are hardly of one dance. Different dances (CMU's subjects 5, 60 and 131, the
embedded troupe's) are at 0.37 and under; takes of one gesture in one style (Bandai-Namco's, aligned by their ends
alone) at 0.62 and over, nineteen in twenty at 0.74; takes of the embedded troupe at 0.94."""
_STILL = 1e-6  # radians, root of the mean square


class Likeness(NamedTuple):
    """How alike repetitions are.

    Parameters
    ----------
    each : (N,) of each repetition the mean of its correlations with the others; no number for one that does not move.
    shifted : the mean of all correlations of two, one of them shifted by whole beats: what chance gives.
    deviation : and their standard deviation.
    """

    each: Array
    shifted: float
    deviation: float


def likeness(repeated: Repetitions) -> Likeness:
    """Correlations of the rotations of all joints over the repetition, each joint's own mean taken out.

    Examples
    --------
    >>> turn = 2 * np.pi * np.arange(8 * DENSITY + 1)[:, None] / (8 * DENSITY)
    >>> swings = np.stack([np.sin(turn), 2 * np.sin(turn), np.cos(turn)])[:, None, :, :, None] * [1.0, 0, 0]
    >>> some = Repetitions(turn[:, 0], ("arm",), swings, np.ones(3), np.arange(3), 0)
    >>> likeness(some).each.round(2).tolist()
    [0.5, 0.5, 0.0]
    """
    turns = repeated.layers[:, :COARSE].sum(axis=1)
    turns = (turns - turns.mean(axis=1, keepdims=True)).reshape(*turns.shape[:2], -1)
    sizes = np.sqrt(np.mean(turns**2, axis=(1, 2)))
    moving = sizes > _STILL
    unit = turns[moving] / (sizes[moving, None, None] * np.sqrt(turns[0].size))
    each = np.full(len(turns), np.nan)
    if len(unit) < 2:
        return Likeness(each, float("nan"), float("nan"))
    flat = unit.reshape(len(unit), -1)
    each[moving] = ((flat @ flat.T).sum(axis=1) - 1) / (len(flat) - 1)
    chance = _shifted(unit)
    return Likeness(each, float(chance.mean()), float(chance.std())) if len(chance) else Likeness(each, 0.0, 0.0)


def _shifted(unit: Array) -> Array:
    """The correlations of each two repetitions, one of them shifted round by one beat, two, and so on."""
    count, points = unit.shape[:2]
    flat, others = unit.reshape(count, -1), ~np.eye(count, dtype=bool)
    shifts = range(DENSITY, points - DENSITY // 2, DENSITY)
    return np.array([(flat @ np.roll(unit, shift, axis=1).reshape(count, -1).T)[others] for shift in shifts]).ravel()
