"""A film's scene: the dancer in front of a camera that follows calmly, and what each picture shows."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.motion import Motion
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.film.flashes import Flashes
from onbeat.viewer.film.planes import yuv420
from onbeat.viewer.film.strip import Strip
from onbeat.viewer.render.camera import CameraPath, Size, follow
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage

CALM = 1.5
"""Seconds over which the camera's way is smoothed: it goes with the dancer, not with each step and gesture."""


@dataclass(frozen=True, eq=False)
class Scene:
    """What is filmed.

    Parameters
    ----------
    positions : (F, J, 3) metres, the joints in each picture.
    figure, stage, strip : the dancer, the light and floor, and what is below.
    path : where the camera is.
    size : of the pictures, in pixels.
    frame : seconds from one picture to the next.
    flashes, places : flashes, and where on the floor (B, 2) each is, in metres.
    """

    positions: Positions
    figure: Figure
    stage: Stage
    strip: Strip
    path: CameraPath
    size: Size
    frame: float
    flashes: Flashes | None
    places: Array

    @classmethod
    def of(cls, motion: Motion, figure: Figure, strip: Strip, fps: float, size: Size, flashes: Flashes | None) -> Scene:
        """The scene of a dance: the camera keeps all of the dancer in view, above the strip."""
        ground = ground_height(figure, motion)
        poses = motion.at(np.arange(max(1, round(motion.duration * fps))) / fps).replace(fps=fps)
        # The strip takes the lower part: the dancer stands in the middle of what is left, rings have some room below.
        shift = strip.height / size[1] / 2
        margin = 1.1 if flashes is None else 1.2
        path = follow(poses, figure, ground, size=size, shift=shift, smoothing=CALM, margin=margin)
        stage = Stage.lit_from(path.azimuth, ground)
        places = np.zeros((0, 2))
        if flashes is not None and len(flashes.times):
            places = figure.ends(motion.at(flashes.times).positions).mean(axis=(1, 2))[:, :2]
        return cls(poses.positions, figure, stage, strip, path, size, 1 / fps, flashes, places)

    def picture(self, number: int) -> np.ndarray:
        """(H, W, 3) sRGB, 0…255."""
        time, stage = number * self.frame, self.stage
        if self.flashes is not None:
            stage = replace(stage, rings=self.flashes.rings(time, self.places, self.frame))
        picture = render_frame(self.positions[number], self.figure, self.path[number], self.size, stage)
        self.strip.draw(picture, time)
        return picture

    def planes(self, number: int) -> np.ndarray:
        """The picture as video has it; see :func:`yuv420`."""
        return yuv420(self.picture(number))
