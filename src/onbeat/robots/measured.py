"""How far inside the soles a simulated robot really pressed on the floor: what a trial measured of its balance."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.robots.legs.contacts import sole_corners
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot
from onbeat.robots.polygon import Polygons
from onbeat.robots.state import configurations
from onbeat.robots.trial import Trial

HAIR = 5e-5
"""Metres by which the centre of pressure may lie outside and still be on the edge: it cannot be farther, and what is
found there is the rounding of the corners."""


def pressed_at(trial: Trial) -> Array:
    """(F, 2) metres, the centre of pressure at each frame of a trial; NaN where nothing pressed."""
    return trial.pressure[_ticks(trial)]


def measured_margins(robot: Robot, trial: Trial) -> Array:
    """(F,) metres by which the centre of pressure lies inside the hull of the soles that touch the floor.

    Of each frame of the trial; NaN where no foot touches.
    """
    corners = sole_corners(Legs.of(robot), configurations(robot, trial.motion))[..., :2]
    corners = corners.reshape(len(corners), -1, 2)
    on = trial.contacts[_ticks(trial)]
    some, margin = on.any(axis=1), np.full(len(on), np.nan)
    touching = np.repeat(on, corners.shape[1] // 2, axis=1)
    margin[some] = Polygons.around(corners[some], touching[some]).margins(pressed_at(trial)[some])
    return margin


def _ticks(trial: Trial) -> np.ndarray:
    """(F,) the tick of each frame."""
    return np.minimum(np.searchsorted(trial.times, trial.motion.times), len(trial.times) - 1)
