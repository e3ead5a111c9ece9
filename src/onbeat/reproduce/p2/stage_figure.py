"""Figs. 7 and 9 of 2007: the robot at the keyposes of a dance, below the dancer, and how safely it stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames, facing
from onbeat.reproduce.p2.stage import Danced, margins
from onbeat.reproduce.p2.takes import Solo
from onbeat.robots.model import Robot
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.keypose.poses import Poses, pose_pictures, poses_at
from onbeat.viewer.plots.files import new_figure
from onbeat.viewer.plots.retime import GRID, LIMIT, colour_of
from onbeat.viewer.robot_shape import ROBOT, robot_shape

PICTURE = (140, 205)
"""Pixels of a posture."""
COLUMNS = 8
"""Postures in a row: a cycle of the troupe's dance has as many keyposes."""
DEEPEST = -30.0
"""Millimetres under which a margin is not drawn."""


def stage_figure(robot: Robot, solo: Solo, danced: Sequence[Danced]) -> Any:
    """The dancer and each simulated robot at the first keyposes, and the margin of the floor's pressure over time.

    Parameters
    ----------
    robot : the model.
    solo : what the dancer does.
    danced : the robot's dances at one speed, one or more.
    """
    times = solo.keyposes[:COLUMNS]
    rows = [("the dancer", pose_pictures(poses_at(solo.motion, times), PICTURE))]
    rows += [(one.method, _robot_pictures(robot, one, times / one.speed)) for one in danced]
    figure = new_figure((11.0, 2.05 * len(rows) + 2.3))
    grid = figure.add_gridspec(len(rows) + 1, COLUMNS, height_ratios=[*([1.0] * len(rows)), 1.05])
    for row, (name, pictures) in enumerate(rows):
        for column, picture in enumerate(pictures):
            axes = figure.add_subplot(grid[row, column])
            axes.imshow(picture, interpolation="none")
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[["top", "right", "left", "bottom"]].set_visible(False)
            if column == 0:
                axes.set_ylabel(name, fontsize=9)
            if row == 0:
                axes.set_title(f"{times[column] / danced[0].speed:.2f} s", fontsize=8)
    _standing(figure.add_subplot(grid[len(rows), :]), robot, danced, times / danced[0].speed)
    return figure


def _robot_pictures(robot: Robot, danced: Danced, times: Times) -> list[np.ndarray]:
    """The simulated robot at seconds of the music; white where it had fallen before."""
    motion = danced.trial.motion
    seconds = times - danced.staged.start
    inside = seconds <= motion.times[-1]
    pictures = pose_pictures(_poses(robot, motion, seconds[inside]), PICTURE) if inside.any() else []
    return [*pictures, *([np.full((PICTURE[1], PICTURE[0], 3), 255, np.uint8)] * int((~inside).sum()))]


def _poses(robot: Robot, motion: Motion, times: Times) -> Poses:
    """A robot's poses in its own shape, each turned to face +Y."""
    dressed, shape = robot_shape(motion, robot)
    figure = Figure.from_capsules(shape, ROBOT)
    moments = dressed.at(np.clip(times, 0.0, dressed.times[-1]))
    yaws = facing(body_frames(moments, Body.of(dressed.skeleton))[0])
    positions = rot.rotate(rot.yaw(-yaws)[:, None], moments.positions)
    return Poses(positions, figure, ground_height(figure, dressed), yaws)


def _standing(axes: Any, robot: Robot, danced: Sequence[Danced], keyposes: Times) -> None:
    """How far inside the soles the floor's pressure is."""
    top = 0.0
    for one in danced:
        values: Array = 1000 * margins(robot, one)
        times = one.staged.start + one.trial.motion.times
        label = f"{one.method}, {one.fell}"
        axes.plot(times, np.maximum(values, DEEPEST), color=colour_of(one.method), lw=1.2, label=label)
        top = max(top, float(np.nanmax(values)))
    axes.axhline(0.0, color=LIMIT, lw=1.1, ls=(0, (5, 2)), label="edge of the soles")
    for beat in keyposes.tolist():
        axes.axvline(beat, color=GRID, lw=1.0, zorder=0)
    axes.set_ylim(DEEPEST, 1.1 * top)
    start = danced[0].staged.start
    axes.set_xlim(start, start + max(one.staged.motion.duration for one in danced))
    axes.set(xlabel="time of the music [s]", ylabel="inside the soles [mm]")
    axes.set_title("where the floor presses on the robot: the measured zero-moment point", fontsize=9, loc="left")
    axes.grid(color=GRID, lw=0.6, axis="y")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.28), ncols=len(danced) + 1, frameon=False, fontsize=8)
