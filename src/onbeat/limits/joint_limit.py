"""What is told of one joint's limits, as the readers of limit files gather it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from onbeat.limits.limits import Limits

Told = Mapping[str, float]
"""What is told of one joint: some of ``low``, ``high``, ``speed``, ``acceleration`` and ``jerk``, in radians."""
_UNLIMITED = {"low": -math.inf, "high": math.inf, "speed": math.inf, "acceleration": math.inf, "jerk": math.inf}


class Model(NamedTuple):
    """What a robot's description tells of its joints.

    Parameters
    ----------
    name : of the robot.
    joints : what is told of each.
    left_out : what was passed over, in words; empty if nothing.
    """

    name: str
    joints: Mapping[str, Told]
    left_out: str = ""


def without_speed(joints: Mapping[str, Told]) -> tuple[str, ...]:
    """The joints of which nothing tells how fast they are."""
    return tuple(joint for joint, told in joints.items() if "speed" not in told)


def limits_of(name: str, joints: Mapping[str, Told], source: str) -> Limits:
    """The joints' limits as arrays, in the order of the mapping; infinite is what is not told.

    Examples
    --------
    >>> arm = limits_of("arm", {"elbow": {"high": 2.5, "speed": 4.0}}, "its maker")
    >>> arm.low.tolist(), arm.high.tolist(), arm.speed.tolist()
    ([-inf], [2.5], [4.0])
    """
    whole = [{**_UNLIMITED, **told} for told in joints.values()]
    low, high, speed, acceleration, jerk = ([told[key] for told in whole] for key in _UNLIMITED)
    return Limits(name, tuple(joints), low, high, speed, acceleration, jerk, source)  # pyright: ignore[reportArgumentType]
