"""The poses of all frames, when the body is known: coarse frames first, then the others, then what nobody saw."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat._shapes import Bools, Ints, Rotations
from onbeat.capture.gaps import trust
from onbeat.capture.model import Model, Pose
from onbeat.capture.pose import between_times, bridge, bridge_places
from onbeat.capture.solve import settle
from onbeat.motion import rotations as rot
from onbeat.motion.markers import Markers

_SWING_S = 0.5
"""Seconds over which a joint that is lost from sight goes on as it went."""


def follow(
    model: Model, markers: Markers, coarse: Ints, poses: Pose, progress: Callable[[float], None] | None = None
) -> Pose:
    """The poses of all frames.

    The coarse frames are solved from their guess, the others from between them; a joint below which nothing is seen
    then moves from where it was last to where it is next.

    Parameters
    ----------
    model : the body with its markers, M of them.
    markers : (F, M), gaps filled as far as they can be.
    coarse : frames with a guess, increasing.
    poses : the guess of those.
    progress : is told the part done, 0…1.
    """
    weights, seen = trust(markers.seen, markers.fps), markers.positions
    told = told_joints(model, markers.seen)
    rest = np.zeros_like(poses.rotations)
    rest[..., 0] = 1.0
    few = settle(model, poses, seen[coarse], weights[coarse], Pose(rest, poses.root), outlier_m=0.5, rounds=8)
    few = settle(model, few, seen[coarse], weights[coarse], Pose(rest, few.root), rounds=25)
    few = held(model, few, told[coarse])
    times, every = coarse.astype(float), np.arange(len(markers), dtype=float)
    root = np.stack([np.interp(every, times, few.root[:, axis]) for axis in range(3)], axis=1)
    begin = Pose(between_times(times, few.rotations, every), root)
    pose = settle(model, begin, seen, weights, begin, rounds=8, progress=progress)
    blind = np.flatnonzero(~told[:, told.any(axis=0)].all(axis=1))
    if len(blind):
        pose = held(model, pose, told, markers.fps)
        again = pose.chosen(blind)
        again = settle(model, again, seen[blind], weights[blind], again, rounds=8)
        pose.rotations[blind], pose.root[blind] = again.rotations, again.root
    return pose


def told_joints(model: Model, seen: Bools) -> Bools:
    """(F, J) whether some marker that a joint moves is seen."""
    below = model.above[model.segments]
    return (seen.astype(np.float64) @ below.astype(np.float64)) > 0.5


def held(model: Model, pose: Pose, told: Bools, fps: float | None = None) -> Pose:
    """Poses in which each joint that nothing tells goes from where it was last told to where it is told next.

    Where the rate is given, it leaves and arrives at the speeds it has there.
    """
    rotations = pose.rotations.copy()
    for joint in model.moving:
        known = told[:, joint]
        if not known.all():
            path = bridge(rotations[:, joint], known)
            rotations[:, joint] = path if fps is None else _swung(path, known, fps)
    return Pose(rotations, bridge_places(pose.root, told[:, 0]))


def _swung(path: Rotations, told: Bools, fps: float) -> Rotations:
    """A bridged path that leaves and enters its gaps at the speeds it has beside them, as Hermite's cubic does."""
    edges = np.flatnonzero(np.diff(np.concatenate(([True], told, [True])).astype(np.int8))).reshape(-1, 2)
    path = path.copy()
    near = 1 + int(0.03 * fps)
    for first, end in edges.tolist():
        a, b = first - 1, end
        beside = np.concatenate((told[max(a - near, 0) : first], told[b : b + near + 1]))
        if a < near or b + near >= len(path) or not beside.all():
            continue
        span = b - a
        whole = rot.log(rot.multiply(rot.inverse(path[a]), path[b]))
        reach = min(span, _SWING_S * fps) / near
        out = rot.log(rot.multiply(rot.inverse(path[a - near]), path[a])) * reach
        into = rot.log(rot.multiply(rot.inverse(path[b]), path[b + near])) * reach
        t = (np.arange(1, span) / span)[:, None]
        turn = out * (t**3 - 2 * t**2 + t) + whole * (3 * t**2 - 2 * t**3) + into * (t**3 - t**2)
        path[first:end] = rot.multiply(path[a], rot.exp(turn))
    return path
