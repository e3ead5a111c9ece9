"""Limits of characters: as fast as each joint ever turns in motions that are known to look right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import LimitError
from onbeat.limits.limits import Limits, listed
from onbeat.limits.turning import RATE, angular_velocities
from onbeat.motion import Motion, Skeleton
from onbeat.motion.roles import find_roles

_APART = 2
"""Steps of ``RATE`` before and after, between which an acceleration is read: it is the mean over a thirtieth second."""
_STILL = 1e-3
"""rad/s and rad/s², the limit of a joint that never turns."""


def learned_limits(motions: Sequence[Motion], quantile: float = 1.0, skeleton: Skeleton | None = None) -> Limits:
    """How fast each joint of a body turns at most, and how quickly its velocity changes, in some motions.

    Angles are not limited. Single bad frames and jumps of the recordings do not count
    (:mod:`onbeat.limits.turning`); accelerations are means over 1/30 s.

    Parameters
    ----------
    motions : of one body or several. A joint learns from the joint of its name, else from that of its role.
    quantile : 0.99 passes over the fastest hundredth of the time.
    skeleton : the body whose joints the limits are of; the first motion's without it.

    Raises
    ------
    LimitError
        If there is no motion of two frames or more, no joint of the body but its root is in any of them, or the
        quantile is not in 0…1. A joint that is in none has infinite limits.

    Examples
    --------
    >>> times = np.arange(90) / 30
    >>> body = Skeleton(("hips", "arm"), [-1, 0], [[0, 0, 1], [0, 0, 0.5]])
    >>> wave = np.zeros((90, 2, 4))
    >>> wave[..., 0], wave[:, 1, 0], wave[:, 1, 3] = 1, np.cos(times), np.sin(times)
    >>> learned_limits([Motion(body, wave, np.zeros((90, 3)), 30)]).of(["arm"]).speed.round(6).tolist()
    [2.0]
    """
    if not 0 < quantile <= 1:
        raise LimitError(f"quantile {quantile}: a number over 0, up to 1 for the fastest, is expected")
    moving = [motion for motion in motions if len(motion) > 1]
    if not moving:
        given = f"{len(motions)} given, none of two frames or more" if motions else "none given"
        raise LimitError(f"no motion to learn limits from ({given}); at least one that moves is needed")
    skeleton = moving[0].skeleton if skeleton is None else skeleton
    names = [name for name, end in zip(skeleton.names, skeleton.end_sites.tolist(), strict=True) if not end]
    speeds: dict[str, list[Array]] = {name: [] for name in names}
    changes: dict[str, list[Array]] = {name: [] for name in names}
    for motion in moving:
        found = counterparts(skeleton, names, motion.skeleton)
        velocities = angular_velocities(motion.rotations[:, list(found.values())], motion.fps)
        change = (velocities[2 * _APART :] - velocities[: -2 * _APART]) * (RATE / (2 * _APART))
        for name, v, a in zip(found, np.moveaxis(velocities, 1, 0), np.moveaxis(change, 1, 0), strict=True):
            speeds[name].append(_fastest(np.linalg.norm(v, axis=-1), quantile))
            changes[name].append(_fastest(np.linalg.norm(a, axis=-1), quantile))
    below = [name for name in names if skeleton.parents[skeleton.index(name)] >= 0]
    if below and not any(speeds[name] for name in below):
        raise LimitError(f"none of the joints {listed(below)} is in the motions, by its name or by its role")
    seconds = sum(motion.duration for motion in moving)
    return Limits(
        "the learned limits",
        tuple(names),
        np.array(-np.inf),
        np.array(np.inf),
        np.array([_highest(speeds[name], quantile) for name in names]),
        np.array([_highest(changes[name], quantile) for name in names]),
        source=f"learned from {len(moving)} motions, {seconds:.0f} s, quantile {quantile:g}",
    )


def counterparts(skeleton: Skeleton, names: Sequence[str], other: Skeleton) -> Mapping[str, int]:
    """For joints of a skeleton, those of another with the same name, else with the same role; others are left out."""
    place = {name: joint for joint, name in enumerate(other.names) if not other.end_sites[joint]}
    if all(name in place for name in names):
        return {name: place[name] for name in names}
    mine, theirs = find_roles(skeleton).joints, find_roles(other).joints
    roles = {skeleton.names[joint]: role for role, joint in mine.items()}
    found = {name: place.get(name, theirs.get(roles.get(name, ""), -1)) for name in names}
    return {name: joint for name, joint in found.items() if joint >= 0}


def _fastest(values: Array, quantile: float) -> Array:
    """What may be among the highest of all motions: the highest alone where only that counts."""
    return values.max(keepdims=True) if quantile == 1 and len(values) else values


def _highest(values: Sequence[Array], quantile: float) -> float:
    """The quantile of the values of all motions; infinite of none."""
    together = np.concatenate(values) if values else np.zeros(0)
    return max(float(np.quantile(together, quantile)), _STILL) if len(together) else np.inf
