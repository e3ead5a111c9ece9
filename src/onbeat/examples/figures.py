"""The troupe's figures: where hands, feet and trunk are on which beat.

Hands are named places, "left right", to be reached on a beat; both hands stop there. Feet are steps that land on a
beat, in shares of the leg's length about the place where the figure begins, to the right and to the front. The trunk
has poses. Everything between is up to the dancer.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

STANCE = 0.13
"""Half the distance of the feet at rest, a share of the leg's length."""


class Place(NamedTuple):
    """A place for a hand: out, to the front and up from its shoulder in arm lengths; and how the arm is turned.

    ``swivel`` lifts the elbow outward; ``roll``, ``flex`` and ``deviate`` turn the hand; all in radians.
    """

    out: float
    front: float
    up: float
    swivel: float = 0.0
    roll: float = 0.0
    flex: float = 0.0
    deviate: float = 0.0


PLACES: Mapping[str, Place] = {
    "down": Place(0.22, 0.10, -0.90),
    "loose": Place(0.26, 0.30, -0.76, swivel=0.2),
    "waist": Place(0.05, 0.10, -0.62, swivel=1.0, flex=-0.3, deviate=-0.5),
    "back": Place(0.26, -0.26, -0.86),
    "low": Place(0.12, 0.55, -0.68, flex=-0.3),
    "low side": Place(0.66, 0.18, -0.62, flex=-0.3),
    "hip side": Place(0.48, 0.22, -0.66, swivel=0.2),
    "belly": Place(-0.06, 0.50, -0.48, swivel=0.5),
    "chest": Place(-0.08, 0.50, -0.20, swivel=0.7),
    "guard": Place(0.00, 0.42, 0.02, swivel=0.1),
    "front": Place(0.02, 0.93, -0.06),
    "punch": Place(-0.06, 0.92, 0.24, swivel=0.2),
    "open": Place(0.55, 0.70, -0.20, roll=-0.6),
    "across": Place(-0.34, 0.66, -0.22, swivel=0.4),
    "across high": Place(-0.30, 0.62, 0.42, swivel=0.3),
    "side": Place(0.95, 0.16, -0.04),
    "side up": Place(0.80, 0.18, 0.34),
    "side low": Place(0.82, 0.18, -0.30),
    "brow": Place(0.02, 0.46, 0.40, swivel=0.7, flex=0.3),
    "high": Place(0.50, 0.22, 0.80),
    "high front": Place(0.06, 0.70, 0.65),
    "up": Place(0.14, 0.16, 0.945),
    "clap": Place(-0.24, 0.62, -0.12, swivel=0.35, flex=-0.58),
    "clap low": Place(-0.24, 0.52, -0.52, swivel=0.35, flex=-0.58),
    "clap high": Place(-0.22, 0.48, 0.52, swivel=0.35, flex=-0.58),
}


class Pose(NamedTuple):
    """A pose of the trunk, in radians and (``aside``, ``ahead``, ``sink``) shares of the leg's length.

    ``bow`` to the front, ``lean`` to the right, ``twist`` of the chest to the left, ``hip`` raised on the right,
    ``turn`` of the hips to the left; the head's ``nod`` down, ``tip`` to the right, ``look`` to the left.
    """

    bow: float = 0.0
    lean: float = 0.0
    twist: float = 0.0
    hip: float = 0.0
    turn: float = 0.0
    aside: float = 0.0
    ahead: float = 0.0
    sink: float = 0.0
    nod: float = 0.0
    tip: float = 0.0
    look: float = 0.0


class Step(NamedTuple):
    """A foot that arrives on a beat.

    Parameters
    ----------
    beat : when it arrives.
    foot : "L" or "R".
    x, y : where, shares of the leg's length to the right and to the front of the figure's beginning.
    kind : "step" takes the weight, "close" shares it, "tap" takes none, "heel" taps the heel, "air" hangs; "shift" only
        takes the weight where the foot is.
    turn : yaw of the foot in degrees, to the left.
    z : how high the foot hangs ("air") or passes ("step"), a share of the leg's length.
    around : how far the foot goes to the front of the straight way to pass the other, a share of the leg's length.
    """

    beat: float
    foot: str
    x: float
    y: float = 0.0
    kind: str = "step"
    turn: float = 0.0
    z: float = 0.0
    around: float = 0.0


@dataclass(frozen=True)
class Figure:
    """One cycle of a figure.

    Parameters
    ----------
    name : the task's name.
    beats : length of a cycle.
    hands : on which beats which places, "left | right"; beat 0 is the end of the last cycle, too.
    steps : the feet.
    trunk : on which beats which pose.
    through : on half-way beats, the places by which the hands pass without a stop.
    travel : where the next cycle begins: to the right, to the front (shares of the leg's length), turn in degrees.
    bounce : depth of the bounce on each beat, a share of the leg's length.
    circle : radius of hip circles of two beats each, a share of the leg's length.
    """

    name: str
    beats: int
    hands: Mapping[float, str]
    steps: tuple[Step, ...] = ()
    trunk: Mapping[float, Pose] = field(default_factory=lambda: {0.0: Pose()})
    through: Mapping[float, str] = field(default_factory=dict[float, str])
    travel: tuple[float, float, float] = (0.0, 0.0, 0.0)
    bounce: float = 0.02
    circle: float = 0.0

    @property
    def keyposes(self) -> tuple[float, ...]:
        """The beats of the figure's keyposes: those on which the hands stop."""
        return tuple(sorted(self.hands))
