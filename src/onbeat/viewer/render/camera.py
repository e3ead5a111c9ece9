"""A pinhole camera, and one that follows a dancer without haste."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from onbeat._shapes import Array, Positions
from onbeat.errors import BodyError
from onbeat.motion import Body, Motion, body_frames
from onbeat.motion.body import facing
from onbeat.viewer.figure import Figure

Size = tuple[int, int]
"""Width and height in pixels."""


@dataclass(frozen=True)
class Camera:
    """A camera that stands upright: ``position`` and ``target`` in metres, ``view_angle`` in radians from the lower
    to the upper edge of the picture. ``shift`` moves the picture up by this part of its height.

    Examples
    --------
    >>> camera = Camera((0.0, -4.0, 1.0), (0.0, 0.0, 1.0))
    >>> camera.project(np.array([0.0, 0.0, 1.0]), (160, 90)).tolist()
    [80.0, 45.0]
    """

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    view_angle: float = 0.5
    shift: float = 0.0

    @property
    def axes(self) -> Array:
        """(3, 3) rows: right, up and forward in the world."""
        forward = np.subtract(self.target, self.position)
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 0.0, 1.0))
        right = right / np.linalg.norm(right)
        return np.array([right, np.cross(right, forward), forward])

    def focal(self, size: Size) -> float:
        """Focal length in pixels."""
        return 0.5 * size[1] / float(np.tan(self.view_angle / 2))

    def centre(self, size: Size) -> tuple[float, float]:
        """Pixel coordinates of the target."""
        return size[0] / 2, size[1] * (0.5 - self.shift)

    def to_camera(self, points: Positions) -> Positions:
        """World points (..., 3) as right, up and forward of the camera, metres."""
        return (points - np.asarray(self.position)) @ self.axes.T

    def project(self, points: Positions, size: Size) -> Array:
        """(..., 2) pixel coordinates of world points in front of the camera, x right, y down from the upper left."""
        seen = self.to_camera(points)
        x, y = self.centre(size)
        return np.stack(
            (
                x + self.focal(size) * seen[..., 0] / seen[..., 2],
                y - self.focal(size) * seen[..., 1] / seen[..., 2],
            ),
            axis=-1,
        )


@dataclass(frozen=True, eq=False)
class CameraPath:
    """Where a camera of fixed direction looks, frame by frame.

    Parameters
    ----------
    targets : (F, 3) metres.
    distances : (F,) metres from camera to target.
    azimuth, elevation : radians, the direction from target to camera: 0 is along +X, and above the ground.
    """

    targets: Positions
    distances: Array
    azimuth: float
    elevation: float
    view_angle: float = 0.5
    shift: float = 0.0

    def __getitem__(self, frame: int) -> Camera:
        """The camera of one frame."""
        target = self.targets[frame]
        position = target + self.distances[frame] * _direction(self.azimuth, self.elevation)
        x, y, z = position.tolist()
        tx, ty, tz = target.tolist()
        return Camera((x, y, z), (tx, ty, tz), self.view_angle, self.shift)


def _direction(azimuth: float, elevation: float) -> Array:
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def follow(
    motion: Motion,
    figure: Figure,
    ground: float = 0.0,
    *,
    size: Size = (1280, 720),
    smoothing: float = 0.5,
    side: float = 0.35,
    elevation: float = 0.2,
    margin: float = 1.1,
    shift: float = 0.0,
) -> CameraPath:
    """A camera that follows the dancer and keeps all of the figure in view in every frame.

    The target is the figure's middle, low-passed with a Gaussian of ``smoothing`` seconds; its height is constant.
    The distance is what the figure needs, its largest within 2.5 ``smoothing`` seconds, low-passed over no more
    than that: so it is never less than needed.

    Parameters
    ----------
    motion, figure, ground : the dancer, and the height of the floor in metres.
    size : picture in pixels.
    smoothing : seconds.
    side, elevation : radians that the camera stands off the dancer's front, and above it.
    margin : picture over figure.
    shift : see :class:`Camera`.
    """
    low, high = figure.bounds(motion.positions)
    sigma = max(smoothing * motion.fps, 1e-3)
    middle = gaussian_filter1d((low + high)[:, :2] / 2, sigma, axis=0, mode="nearest")
    tall = float(np.percentile(high[:, 2], 95)) - ground
    targets = np.column_stack((middle, np.full(len(motion), ground + 0.5 * tall)))
    still = CameraPath(targets, np.zeros(len(motion)), _front(motion) + side, elevation, shift=shift)
    needed = distance_needed(motion.positions, figure, still, size[0] / size[1]) * margin
    window = round(2.5 * sigma)
    widest = maximum_filter1d(needed, 2 * window + 1, mode="nearest")
    return replace(still, distances=gaussian_filter1d(widest, sigma, mode="nearest", radius=window))


def distance_needed(positions: Positions, figure: Figure, path: CameraPath, aspect: float) -> Array:
    """(F,) metres: the distance at which the figure just fits the picture, from a few hundred frames at a time."""
    towards = _direction(path.azimuth, path.elevation)
    right = np.array([-np.sin(path.azimuth), np.cos(path.azimuth), 0.0])
    up = np.cross(towards, right)
    slope = np.tan(path.view_angle / 2)
    usable = 1 - 2 * abs(path.shift)
    distances = np.empty(len(positions))
    for first in range(0, len(positions), 256):
        part = slice(first, first + 256)
        ends = figure.ends(positions[part]) - path.targets[part, None, None]
        vertical = (np.abs(ends @ up) + figure.radii) / (slope * usable)
        sideways = (np.abs(ends @ right) + figure.radii) / (slope * aspect)
        distances[part] = (np.maximum(vertical, sideways) + ends @ towards).max((1, 2))
    return distances


def _front(motion: Motion) -> float:
    """Azimuth in radians of the direction the dancer mostly faces; -Y where the body's roles are not known."""
    try:
        yaw = facing(body_frames(motion, Body.of(motion.skeleton))[0])
    except BodyError:
        return -np.pi / 2
    mean = np.exp(1j * yaw).mean()
    # Facing is an angle from +Y.
    return float(np.angle(mean if abs(mean) > 0.2 else np.exp(1j * yaw[0]))) + np.pi / 2
