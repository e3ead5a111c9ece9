"""Pictures of a robot's motion, drawn by MuJoCo without a window: by EGL where there is one, else by OSMesa."""

from __future__ import annotations

import ctypes.util
import importlib
import os
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Positions
from onbeat.errors import BodyError, MissingExtraError
from onbeat.motion.motion import Motion
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations

SMALLEST, LARGEST = 16, 4096
"""Pixels of a side."""
DISTANCE = 3.6
"""How far the camera stands away, in heights of the root over the floor."""
GEOMS = 1000
"""Shapes in a picture at most."""
FOLLOWING = 1.0
"""Seconds over which the camera's way is smoothed."""
AZIMUTH, ELEVATION = 160.0, -12.0
"""Degrees: from the robot's front, a little to its side and from above; the robot faces +X."""


def pictures(
    robot: Robot, motion: Motion, fps: float = 30, size: tuple[int, int] = (1280, 720)
) -> Iterator[np.ndarray]:
    """Pictures (height, width, 3) of bytes, one by one; picture i shows the motion at ``i / fps`` seconds.

    Parameters
    ----------
    robot : the model.
    motion : of the robot; of a trial or as it was meant.
    fps : pictures a second.
    size : width and height in pixels.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or the rate or the size cannot be.
    MissingExtraError
        If MuJoCo is not installed, or nothing that it can draw with is.
    """
    if not (np.isfinite(fps) and 0 < fps <= 1000 and all(SMALLEST <= side <= LARGEST for side in size)):
        raise BodyError(
            f"pictures of {size[0]} x {size[1]} pixels at {fps:g} a second cannot be drawn; "
            f"{SMALLEST} to {LARGEST} pixels and a rate above 0 and up to 1000 are expected"
        )
    count = max(1, round(motion.duration * fps))
    poses = configurations(robot, motion.at(np.arange(count) / fps).replace(fps=fps))
    return _drawn(robot, poses, fps, size)


def _drawn(robot: Robot, poses: np.ndarray, fps: float, size: tuple[int, int]) -> Iterator[np.ndarray]:
    mujoco = engine()
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    model.vis.global_.offwidth, model.vis.global_.offheight = size
    data, looks = mujoco.MjData(model), _looks(mujoco)
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
    camera.distance = DISTANCE * float(np.median(poses[:, 2]))
    path = _followed(poses[:, :3], fps)
    canvas = _Canvas(model, size)
    try:
        for pose, at in zip(poses, path, strict=True):
            data.qpos[:] = pose
            mujoco.mj_forward(model, data)
            camera.lookat[:] = at
            yield canvas.drawn(data, camera, looks)
    finally:
        canvas.close()


def _looks(mujoco: Any) -> Any:
    """All groups of geoms are shown: the capsules that touch are what the robot looks like."""
    looks = mujoco.MjvOption()
    looks.geomgroup[:] = 1
    return looks


def _followed(root: Positions, fps: float) -> Positions:
    """Where the camera looks (F, 3): at the root, smoothly, and always at the same height."""
    path = gaussian_filter1d(root, FOLLOWING * fps, axis=0, mode="nearest")
    path[:, 2] = 0.95 * np.median(root[:, 2])
    return path


class _Canvas:
    """Where MuJoCo draws: a context of a graphics system, a scene and a buffer."""

    def __init__(self, model: Any, size: tuple[int, int]) -> None:
        mujoco = self._mujoco = engine()
        self._model, self._size = model, size
        self._system = drawing_system(*size)
        self._scene = mujoco.MjvScene(model, GEOMS)
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)

    def drawn(self, data: Any, camera: Any, looks: Any) -> np.ndarray:
        """A picture (height, width, 3)."""
        mujoco, (width, height) = self._mujoco, self._size
        self._system.make_current()
        mujoco.mjv_updateScene(self._model, data, looks, None, camera, mujoco.mjtCatBit.mjCAT_ALL, self._scene)
        view, picture = mujoco.MjrRect(0, 0, width, height), np.empty((height, width, 3), np.uint8)
        mujoco.mjr_render(view, self._scene, self._context)
        mujoco.mjr_readPixels(picture, None, view, self._context)
        return picture[::-1].copy()

    def close(self) -> None:
        """Give everything back."""
        self._context.free()
        self._system.free()


def drawing_system(width: int, height: int) -> Any:
    """The current context (``GLContext``) of what draws without a window; ``MUJOCO_GL`` chooses: egl, osmesa or glfw.

    Raises
    ------
    MissingExtraError
        If there is none.
    """
    has_egl = not sys.platform.startswith("linux") or ctypes.util.find_library("EGL")
    usual = {"darwin": "cgl", "win32": "glfw"}.get(sys.platform, "egl" if has_egl else "osmesa")
    chosen = os.environ.get("MUJOCO_GL", "").lower() or usual
    try:
        context = importlib.import_module(f"mujoco.{chosen}").GLContext(width, height)
        context.make_current()
    except Exception as error:  # whatever a missing or broken graphics library makes PyOpenGL raise
        raise MissingExtraError(
            f"MuJoCo cannot draw with {chosen} ({type(error).__name__}: {str(error)[:120]}); install EGL (Debian: "
            "libegl1) or OSMesa (libosmesa6) and set MUJOCO_GL to egl or osmesa"
        ) from None
    return context
