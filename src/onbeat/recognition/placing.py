"""A segment's points back on a body that plays: the way from recognition to a motion."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from onbeat._shapes import Array, Positions
from onbeat.errors import MetricError
from onbeat.keyposes.playable import playable
from onbeat.keyposes.vectors import PoseVectors, pose_vectors
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, facing
from onbeat.motion.motion import Motion
from onbeat.recognition.trunk import NEEDED, seen_from_trunk, trunk

_FEET = ("left_ankle", "right_ankle", "left_toe", "right_toe")
_STILL = 1e-9
_LONGEST = 600.0  # seconds of a segment


def placed(points: Positions, elements: tuple[str, ...], base: Motion, seconds: float, name: str = "") -> Motion:
    """The motion of a body whose points go where a segment's do, at the body's own size and rate.

    The body's trunk follows the points', then each joint is turned as :func:`onbeat.keyposes.playable.playable` tells.
    It starts where ``base`` starts and faces where it faces, its feet as low as those of ``base``. What the points do
    not tell (fingers, twists about bones) is as in ``base``, stretched to the same length; so is the trunk's path where
    they are seen from each moment and have none.

    Parameters
    ----------
    points : (T, E, 3) body sizes, seen from the segment's start (``frame="start"``), or each moment ("body", "ground").
    elements : E names; hips, shoulders and hip joints are needed.
    base : a motion of the body, best one of the same task.
    seconds : how long the motion is to be.
    name : of the new motion.

    Raises
    ------
    MetricError
        If a point that is needed is missing, a value is no number, or the length is not above 0 or past ten minutes.
    BodyError
        If the body lacks a role.
    """
    points = np.asarray(points, np.float64)
    missing = [role for role in NEEDED if role not in elements]
    if missing:
        raise MetricError(f"the segment has no {', '.join(missing)}: a body cannot be placed by the other points")
    if points.shape[1:] != (len(elements), 3) or len(points) < 2 or not np.isfinite(points).all():
        raise MetricError(
            f"points of shape {points.shape} found; (moments, {len(elements)}, 3), all numbers, is needed"
        )
    if not 0 < seconds <= _LONGEST:
        raise MetricError(f"a length of {seconds} s found; above 0 and up to {_LONGEST:g} s is needed")
    frames = max(2, int(np.round(seconds * base.fps)) + 1)
    shares = np.linspace(0.0, 1.0, frames)
    stretched = base.at(shares * (len(base) - 1) / base.fps)
    (own,) = pose_vectors([stretched])
    paths = _between(points, shares)
    moved = stretched
    if _has_path(points, elements):
        moved = _carried(stretched, own, paths * own.size, elements, _on_the_spot(points, elements))
    (own,) = pose_vectors([moved])
    inside = seen_from_trunk(paths, elements)
    values = own.values.reshape(frames, -1, 3).copy()
    for element, name_ in enumerate(elements):
        if name_ in own.points:
            values[:, own.points.index(name_)] = inside[:, element]
    made = playable(values.reshape(frames, -1), own, moved, name or base.name)
    return _grounded(made, base)


def _between(points: Positions, shares: Array) -> Positions:
    """(F, E, 3) the points at shares of the segment, smooth between its moments (a jerk at each would be seen)."""
    return CubicSpline(np.linspace(0.0, 1.0, len(points)), points, axis=0)(shares)


def _has_path(points: Positions, elements: tuple[str, ...]) -> bool:
    """Whether the trunk goes or turns at all: seen from its own frame it does not."""
    frames, origins = trunk(points, elements)
    turned = 1.0 - np.abs(np.sum(frames * frames[:1], axis=-1))
    return bool(turned.max() > _STILL or np.abs(origins - origins[:1]).max() > _STILL)


def _on_the_spot(points: Positions, elements: tuple[str, ...]) -> bool:
    """Whether the trunk leans and rises, but neither goes nor turns: so it is seen from the ground below it."""
    frames, origins = trunk(points, elements)
    return bool(np.ptp(origins[:, :2], axis=0).max() <= _STILL and np.abs(np.sin(facing(frames))).max() <= _STILL)


def _carried(
    motion: Motion, own: PoseVectors, points: Positions, elements: tuple[str, ...], on_the_spot: bool
) -> Motion:
    """The motion carried as a whole so that its trunk is where the points' is, from where it itself starts.

    Of points on the spot it keeps its own way and front.
    """
    frames, origins = trunk(points, elements)
    first = slice(None) if on_the_spot else slice(1)
    yaw = rot.yaw(facing(own.frames[first]) - facing(frames[first]))
    wanted = rot.multiply(yaw, frames)
    place = own.origins[:1] + rot.rotate(yaw, origins - origins[:1])
    if on_the_spot:
        place[:, :2] = own.origins[:, :2]
    turn = rot.multiply(wanted, rot.inverse(own.frames))
    rotations = motion.rotations.copy()
    rotations[:, 0] = rot.continuous(rot.normalise(rot.multiply(turn, rotations[:, 0])))
    root = place + rot.rotate(turn, motion.root_positions - own.origins)
    return motion.replace(rotations=rotations, root_positions=root)


def _grounded(motion: Motion, base: Motion) -> Motion:
    """The motion raised or lowered as a whole so that its feet are as low as those of ``base``."""
    body = Body.of(base.skeleton)
    feet = body.indices(*(role for role in _FEET if role in body))
    lift = base.positions[:, feet, 2].min() - motion.positions[:, feet, 2].min()
    return motion.replace(root_positions=motion.root_positions + np.array([0.0, 0.0, float(lift)]))
