"""The paper's experiments at 1.0 × and 1.2 ×: a robot dances in simulation, its upper body by each method.

The legs are the robot's own: tasks after Nakaoka et al., as the paper has them, and time-scaled as the paper scales
them. Balance is the whole model's, and onbeat's own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array
from onbeat.motion import Motion
from onbeat.reproduce.p2.methods import OURS, PUBLISHED
from onbeat.reproduce.p2.takes import Solo
from onbeat.retime.lock import TimeMap
from onbeat.robots.document import RobotDocument, robot_document
from onbeat.robots.legs.contacts import sole_corners
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot
from onbeat.robots.perform import Feet, Staged, stage
from onbeat.robots.polygon import Polygons
from onbeat.robots.simulate import simulate
from onbeat.robots.state import configurations
from onbeat.robots.trial import Trial

WAYS = (PUBLISHED, OURS)
"""Methods by which a robot dances: that of the paper, on angles as captured, and onbeat's, on angles as planned."""


@dataclass(frozen=True, eq=False)
class Danced:
    """A dance in simulation.

    Parameters
    ----------
    method, speed, feet : how.
    staged : what the robot was told.
    trial : what it did.
    document : both in numbers.
    """

    method: str
    speed: float
    feet: Feet
    staged: Staged
    trial: Trial
    document: RobotDocument

    @property
    def fell(self) -> str:
        """Whether it stood to the end, in words."""
        tried = self.document.trial
        if tried is None or tried.fell_at is None:
            return "upright"
        return f"fell at {tried.fell_at:.1f} s: {tried.why}"


def dance_on(robot: Robot, own: Motion, solo: Solo, speed: float, method: str, feet: Feet, seed: int = 0) -> Danced:
    """A robot dances its own motion at a speed, upper body by a method, in MuJoCo with sensors and friction.

    Parameters
    ----------
    robot, own : the robot, and the dance as its own angles.
    solo : the dance's beats and keyposes.
    speed, method, feet : how; see :func:`onbeat.robots.perform.stage`.
    seed : of the sensors' noise.
    """
    warp = TimeMap.steady(speed)
    staged = stage(own, robot, warp, solo.beats, solo.keyposes, feet, method=method)
    trial = simulate(robot, staged.motion, rng=np.random.default_rng(seed))
    return Danced(method, speed, feet, staged, trial, robot_document(robot, staged, trial, feet))


def margins(robot: Robot, danced: Danced) -> Array:
    """(F,) metres by which the floor's pressure on the simulated robot is inside its soles, at its motion's frames.

    NaN where no foot touches. The paper's simulation shows the zero-moment point for this.
    """
    trial, legs = danced.trial, Legs.of(robot)
    at = np.minimum(np.searchsorted(trial.times, trial.motion.times), len(trial.times) - 1)
    corners = sole_corners(legs, configurations(robot, trial.motion))[..., :2].reshape(len(at), -1, 2)
    on = trial.contacts[at]
    some, out = on.any(axis=1), np.full(len(at), np.nan)
    if some.any():
        touching = np.repeat(on, corners.shape[1] // 2, axis=1)
        out[some] = Polygons.around(corners[some], touching[some]).margins(trial.pressure[at][some])
    return out
