"""A robot's description: its links, how they hang together, what they weigh, and what its motors can do.

As TOML, for people to read and to correct; all in metres, radians, kilograms and N·m::

    version = 1
    name = "my robot"
    source = "…"                                # where the figures are from
    licence = "…"
    [root]                                      # the link that hangs on nothing
    link = "pelvis"
    mass = 3.8
    centre = [0, 0, -0.08]                      # of mass, in the link's frame
    inertia = [0.01, 0.009, 0.008, 0, 0, 0]     # xx yy zz xy xz yz about that centre, in the axes of the link
    capsules = [[0, 0, 0, 0, 0, 0.1, 0.05]]     # from, to, radius
    [links.left_thigh]                          # parents first, and all that hangs on a link before the next one
    parent = "pelvis"
    joint = "left_hip"                          # the hinge that turns it
    origin = [0, 0.06, -0.1]                    # in the frame of the link above
    rpy = [0, 0, 0]                             # roll, pitch, yaw of this link's frame in that
    axis = [0, 1, 0]                            # in this link's frame
    position = [-2.5, 2.9]
    speed = 32
    torque = 88
    armature = 0.01                             # kg·m², what the motor's rotor adds at the hinge
    mass = …                                    # and so on as of the root
    [feet.left]
    link = "left_foot"
    corners = [[0.12, 0.03, -0.035], …]         # four of the sole, in the link's frame
    [ends.left_toe]                             # points on a link that a dance may tell of
    link = "left_foot"
    at = [0.13, 0, -0.035]
    [pads.left_toe_tip]                         # points that touch the floor besides the soles, if any; not counted on
    link = "left_toe"
    at = [0.05, 0, -0.01]
    [roles]                                     # only those that names do not tell
    left_hip = "left_hip"
"""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onbeat._shapes import Array

VERSION = 1
Vector = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]
Capsule = tuple[float, float, float, float, float, float, float]
"""Both ends in the link's frame, and the radius: metres."""
_Positive = Annotated[float, msgspec.Meta(gt=0)]
_NotNegative = Annotated[float, msgspec.Meta(ge=0)]


class AssumedWarning(UserWarning):
    """What a robot's file does not tell, or not well, is assumed, set right or left out."""


class Link(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A link and the hinge that turns it against the link above it.

    Parameters
    ----------
    parent : the link above.
    joint : the hinge's name.
    origin, rpy : metres, and roll, pitch and yaw in radians, of this link's frame in that of the link above.
    axis : of the hinge, in this link's frame; it goes through the origin.
    position : low and high, radians.
    speed, torque : limits in rad/s and N·m.
    mass, centre, inertia : kg; metres; kg·m² as xx yy zz xy xz yz about the centre in the link's axes.
    armature : kg·m², what the motor's rotor adds at the hinge.
    capsules : what it takes up of space.
    """

    parent: str
    joint: str
    origin: Vector
    axis: Vector
    position: tuple[float, float]
    speed: _Positive
    torque: _Positive
    mass: _Positive
    centre: Vector
    inertia: Six
    rpy: Vector = (0.0, 0.0, 0.0)
    armature: _NotNegative = 0.0
    capsules: tuple[Capsule, ...] = ()


class Root(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The link that hangs on nothing: its name, and what else a :class:`Link` has but for the hinge."""

    link: str
    mass: _Positive
    centre: Vector
    inertia: Six
    capsules: tuple[Capsule, ...] = ()


class Sole(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A foot: its link, and the four corners of its sole in metres in that link's frame."""

    link: str
    corners: tuple[Vector, Vector, Vector, Vector]


class Point(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A point on a link, in metres in its frame."""

    link: str
    at: Vector


class Description(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """All of a robot. ``links`` are in the order of their hinges: depth first, as an engine has them.

    ``apart`` are pairs of links that are not looked at for collisions, besides neighbours.
    """

    name: str
    root: Root
    links: dict[str, Link]
    feet: dict[str, Sole]
    source: str = ""
    licence: str = ""
    note: str = ""
    version: int = VERSION
    ends: dict[str, Point] = {}
    pads: dict[str, Point] = {}
    roles: dict[str, str] = {}
    apart: tuple[tuple[str, str], ...] = ()

    @property
    def mass(self) -> float:
        """Kilograms of the whole robot."""
        return self.root.mass + sum(link.mass for link in self.links.values())


def vector(values: Array) -> Vector:
    """Three numbers of an array (3,)."""
    x, y, z = np.asarray(values, np.float64).tolist()
    return x, y, z


def six(inertia: Array) -> Six:
    """The six numbers of an inertia (3, 3), as descriptions have them."""
    xx, yy, zz, xy, xz, yz = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    return xx, yy, zz, xy, xz, yz


def moments(inertia: Six) -> Array:
    """The principal moments (3,) of an inertia, the least first."""
    xx, yy, zz, xy, xz, yz = inertia
    return np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
