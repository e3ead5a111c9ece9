"""Pictures of poses, each from the dancer's front and a little from the side, all in the same scale."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Positions, Rotations, Times
from onbeat.capture import fit_body, marker_body_frames
from onbeat.errors import OnbeatError
from onbeat.keyposes.points import bridged
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames, facing
from onbeat.motion.markers import Markers
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.render.camera import CameraPath, Size, distance_needed
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage
from onbeat.viewer.shape import Capsule

SIDE, ELEVATION = 0.5, 0.14
"""Radians that the camera stands off the dancer's front, and above it."""
DOT = 0.018
"""Metres, the radius of a marker that is drawn as such."""
FIT_RATE, FIT_LONGEST = 30.0, 120.0
"""Hz at which a body is fitted to markers to be looked at, and seconds above which markers are drawn as dots."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of a dancer, each turned to face +Y.

    Parameters
    ----------
    positions : (K, J, 3) metres.
    figure : what hangs on the joints.
    ground : metres, the height on which it stands.
    yaws : (K,) radians, where each faces on the floor, 0 along +Y.
    """

    positions: Positions
    figure: Figure
    ground: float
    yaws: Array


def fitted(source: Motion | Markers) -> Motion | Markers:
    """A body to look at: that of a motion, or one fitted to markers; the markers themselves where none fits them."""
    if isinstance(source, Motion) or source.duration > FIT_LONGEST:
        return source
    every = max(1, round(source.fps / FIT_RATE))
    try:
        motion = fit_body(Markers(source.names, source.positions[::every], source.fps / every, source.name)).motion
    except OnbeatError:
        return source
    return motion


def poses_at(source: Motion | Markers, times: Times) -> Poses:
    """The poses of a motion, or of markers as dots, at some seconds (K,)."""
    if isinstance(source, Markers):
        return _of_markers(source, times)
    figure = Figure.of(source.skeleton)
    moments = source.at(times)
    try:
        frames = body_frames(moments, Body.of(source.skeleton))[0]
    except OnbeatError:
        frames = np.tile(rot.IDENTITY, (len(moments), 1))
    return _turned(moments.positions, frames, figure, ground_height(figure, source))


def _of_markers(markers: Markers, times: Times) -> Poses:
    """Dots; where a marker is not seen for long it stays where it was last."""
    paths, _ = bridged(markers.positions[:, markers.seen.any(axis=0)], markers.fps)
    at = np.rint(times * markers.fps).astype(np.int64).clip(0, len(markers) - 1)
    try:
        frames = marker_body_frames(markers)[0][at]
    except OnbeatError:
        frames = np.tile(rot.IDENTITY, (len(at), 1))
    lowest = paths[..., 2].min(axis=1)
    return _turned(paths[at], frames, dots(paths.shape[1]), float(np.percentile(lowest, 5)) - DOT)


def dots(count: int) -> Figure:
    """A figure of balls, one at each of ``count`` points."""
    return Figure.from_capsules([Capsule(k, k, DOT, DOT, "hips") for k in range(count)])


def _turned(positions: Positions, frames: Rotations, figure: Figure, ground: float) -> Poses:
    yaws = facing(frames)
    return Poses(rot.rotate(rot.yaw(-yaws)[:, None], positions), figure, ground, yaws)


def pose_pictures(poses: Poses, size: Size) -> list[np.ndarray]:
    """A picture (H, W, 3) uint8 of each pose on white paper, with the floor under its feet."""
    if not len(poses.positions):
        return []
    low, high = poses.figure.bounds(poses.positions)
    top = float(high[:, 2].max())
    middle = np.full(len(low), (poses.ground + top) / 2)
    targets = np.column_stack(((low + high)[:, :2] / 2, middle))
    path = CameraPath(targets, np.zeros(len(low)), np.pi / 2 + SIDE, ELEVATION)
    needed = distance_needed(poses.positions, poses.figure, path, size[0] / size[1])
    path = replace(path, distances=np.full(len(low), 1.04 * float(needed.max())))
    stage = replace(
        Stage.lit_from(path.azimuth, poses.ground, fine=3),
        floor=(238, 236, 232), tile=(228, 226, 222), backdrop=(255, 255, 255), horizon=(255, 255, 255),
    )  # fmt: skip
    return [render_frame(pose, poses.figure, path[k], size, stage) for k, pose in enumerate(poses.positions)]
