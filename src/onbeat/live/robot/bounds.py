"""What a robot's hinges keep to while it dances live."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat.retime.stream import Bounds
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot
from onbeat.robots.perform import limits_of

LEGS = 400.0
"""rad/s² of a hinge of the legs: their angles follow from where the hips are, whose own acceleration is bounded, and a
knee that is nearly straight has to turn quickly for little."""


def bounds_of(robot: Robot) -> Bounds:
    """Ranges and speeds of the model, and accelerations that it can balance.

    Raises
    ------
    BodyError
        If it has not two legs.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> sorted(set(bounds_of(robot_named("g1")).acceleration.tolist()))
    [80.0, 400.0]
    """
    bounds = Bounds.of(limits_of(robot))
    acceleration = bounds.acceleration.copy()
    acceleration[np.concatenate([leg.hinges for leg in Legs.of(robot).both])] = LEGS
    return replace(bounds, acceleration=acceleration)
