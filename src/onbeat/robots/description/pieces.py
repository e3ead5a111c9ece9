"""Rigid pieces of a robot's file made into a description: what does not move against each other becomes one link."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import (
    AssumedWarning,
    Capsule,
    Description,
    Link,
    Point,
    Root,
    Sole,
    six,
    vector,
)
from onbeat.robots.description.shapes import Shape, as_capsule, bone
from onbeat.robots.description.soles import Member, feet_of, foot_capsules, side_of
from onbeat.robots.description.sound import check_description

SPEED, TORQUE = 10.0, 4.0
"""What is assumed where a file tells nothing: rad/s, and N·m per kilogram of the whole robot."""
_SEEN = 5
_SHORT = 0.02
_SMALL, _THIN = 0.1, 1e-4


class Turn(NamedTuple):
    """A hinge: its name, axis in its piece's frame, limits in radians, rad/s and N·m (0: not told), and armature."""

    name: str
    axis: Positions
    low: float
    high: float
    speed: float
    torque: float
    armature: float = 0.0


@dataclass
class Piece:
    """A rigid piece: where it is in the frame of the piece above it, the hinge that turns it if any, its mass."""

    name: str
    parent: str
    at: Positions
    turn: Rotations
    hinge: Turn | None = None
    mass: float = 0.0
    centre: Positions = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    shapes: list[Shape] = field(default_factory=list[Shape])
    frames: dict[str, Positions] = field(default_factory=dict[str, Positions])
    """The pieces that it is made of, and where they are in its frame."""


def description_of_pieces(name: str, pieces: Sequence[Piece], label: str, source: str) -> Description:
    """The robot that pieces make up; what is assumed is a warning.

    Parameters
    ----------
    name : of the robot.
    pieces : the root first, parents before children, all that hangs on one before the next.
    label : the file, for messages.
    source : where the figures are from.

    Raises
    ------
    BodyError
        If a link that moves has no mass, no feet are found, or the description is not sound; link or joint are named.
    """
    bodies = _merged(pieces)
    for body in bodies:
        if body.mass <= 0:
            raise BodyError(f"{label}: {_moved(body)} has no mass; give it an <inertial>")
    members = [Member(b.name, b.parent, b.at, b.turn, b.frames, _points(b)) for b in bodies]
    feet, notes = feet_of(members, label)
    off = [body.name for body in bodies if _balanced(body, label)]
    notes += [f"inertias that no body has are set right where they are a little off: {_listed(off)}"] if off else []
    weight = sum(body.mass for body in bodies)
    notes += _not_told(bodies)
    capsules = _capsules(bodies)
    for sole in feet.values():
        capsules[sole.link] = foot_capsules(sole)
    first, *others = bodies
    root = Root(first.name, first.mass, vector(first.centre), six(first.inertia), capsules[first.name])
    links = {body.name: _link(body, weight, capsules[body.name]) for body in others}
    ends = _ends(bodies, feet)
    found = Description(name=name, root=root, links=links, feet=feet, source=source, ends=ends)
    check_description(found, label)
    if notes:
        warnings.warn(f"{label}: {'; '.join(notes)}", AssumedWarning, stacklevel=3)
    return found


def _merged(pieces: Sequence[Piece]) -> list[Piece]:
    """One body for each piece that a hinge turns, and the root; the others are part of what they hang on."""
    bodies, places = list[Piece](), dict[str, tuple[Piece, Rotations, Positions]]()
    for piece in pieces:
        if not bodies:
            body, turn, at = _body(piece, "", piece.turn, piece.at), rot.IDENTITY, np.zeros(3)
            bodies.append(body)
        else:
            above, turned, placed = places[piece.parent]
            turn = rot.multiply(turned, piece.turn)
            at = placed + rot.rotate(turned, piece.at)
            if piece.hinge is not None:
                body = _body(piece, above.name, turn, at)
                bodies.append(body)
                turn, at = rot.IDENTITY, np.zeros(3)
            else:
                body = above
        _add(body, piece, turn, at)
        places[piece.name] = body, turn, at
    return bodies


def _body(piece: Piece, parent: str, turn: Rotations, at: Positions) -> Piece:
    return Piece(piece.name, parent, at, turn, piece.hinge)


def _add(body: Piece, piece: Piece, turn: Rotations, at: Positions) -> None:
    """Make a piece part of a body in whose frame it is turned and placed like this; Steiner's theorem."""
    body.frames[piece.name] = at
    body.shapes += [shape.moved(turn, at) for shape in piece.shapes]
    if piece.mass <= 0:
        return
    matrix = rot.to_matrix(turn[None])[0]
    centre, inertia = at + matrix @ piece.centre, matrix @ piece.inertia @ matrix.T
    mass = body.mass + piece.mass
    apart = centre - body.centre
    reduced = body.mass * piece.mass / mass * (apart @ apart * np.eye(3) - np.outer(apart, apart))
    body.inertia = body.inertia + inertia + reduced
    body.centre = (body.mass * body.centre + piece.mass * centre) / mass
    body.mass = mass


def _points(body: Piece) -> Positions:
    return np.vstack([np.zeros((0, 3)), *(shape.points for shape in body.shapes)])


def _moved(body: Piece) -> str:
    by = f", which joint {body.hinge.name!r} turns," if body.hinge else ""
    return f"link {body.name!r}{by}"


def _balanced(body: Piece, label: str) -> bool:
    """Make an inertia that is a little off one that a body can have; whether it was."""
    values, axes = np.linalg.eigh(body.inertia)
    least, middle, most = values
    if least > 0 and least + middle >= most:
        return False
    slack = max(_SMALL * most, _THIN * body.mass)
    if least < -slack or least + middle < most - slack:
        raise BodyError(
            f"{label}: {_moved(body)} has an inertia that no body has: principal moments of {least:.3g}, {middle:.3g} "
            f"and {most:.3g} kg·m²; each is above zero, and at most the sum of the others"
        )
    low = np.maximum(values, 1e-2 * slack)
    low[:2] += max(low[2] - low[0] - low[1], 0.0) / 2 * (1 + 1e-6)
    body.inertia = axes @ np.diag(low) @ axes.T
    return True


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SEEN} more" if len(names) > _SEEN else ""
    return ", ".join(names[:_SEEN]) + more


def _not_told(bodies: Sequence[Piece]) -> list[str]:
    """What is assumed of hinges, for the warning."""
    notes = list[str]()
    hinges = [body.hinge for body in bodies if body.hinge]
    silent_ones = (
        ("speed", f"{SPEED:g} rad/s", [hinge.name for hinge in hinges if not hinge.speed > 0]),
        ("torque", f"{TORQUE:g} N·m for each kilogram", [hinge.name for hinge in hinges if not hinge.torque > 0]),
    )
    for what, unit, silent in silent_ones:
        if silent:
            notes.append(f"no {what} is told for {_listed(silent)}: {unit} is assumed")
    bare = [body.name for body in bodies if not body.shapes]
    if bare:
        notes.append(f"{len(bare)} links have no shape: capsules along them are as thick as their inertia says")
    return notes


def _capsules(bodies: Sequence[Piece]) -> dict[str, tuple[Capsule, ...]]:
    """Those of the shapes a body has; where there are none, along it to the bodies that hang on it."""
    found = dict[str, tuple[Capsule, ...]]()
    for body in bodies:
        tips = [other.at for other in bodies if other.parent == body.name and np.linalg.norm(other.at) > _SHORT]
        bones = bone(np.array(tips).reshape(-1, 3), body.mass, body.centre, body.inertia)
        solid = [shape.capsule for shape in body.shapes] or bones
        found[body.name] = tuple(as_capsule(capsule) for capsule in solid)
    return found


def _link(body: Piece, weight: float, capsules: tuple[Capsule, ...]) -> Link:
    hinge = body.hinge
    assert hinge is not None
    return Link(
        parent=body.parent,
        joint=hinge.name,
        origin=vector(body.at),
        rpy=vector(rot.to_euler("ZYX", body.turn)[::-1]),
        axis=vector(hinge.axis),
        position=(hinge.low, hinge.high),
        speed=hinge.speed if hinge.speed > 0 else SPEED,
        torque=hinge.torque if hinge.torque > 0 else round(TORQUE * weight, 1),
        armature=hinge.armature,
        mass=body.mass,
        centre=vector(body.centre),
        inertia=six(body.inertia),
        capsules=capsules,
    )


def _ends(bodies: Sequence[Piece], feet: Mapping[str, Sole]) -> dict[str, Point]:
    """Toes and heels, and of every other link on which nothing hangs its far end: hands, heads."""
    found = dict[str, Point]()
    for side, sole in feet.items():
        corners = np.array(sole.corners)
        for end, pair in (("toe", corners[:2]), ("heel", corners[2:])):
            found[f"{side}_{end}"] = Point(sole.link, vector(pair.mean(axis=0)))
    taken = {name for body in bodies for name in (body.name, body.hinge.name if body.hinge else "")}
    parents, soles = {body.parent for body in bodies}, {sole.link for sole in feet.values()}
    for body in bodies:
        if body.name not in parents | soles:
            hand = f"{side_of(body.name)}_hand"
            name = hand if hand[0] != "_" and hand not in taken else f"{body.name}_end"
            found[name] = Point(body.name, vector(2 * body.centre))
            taken.add(name)
    return found
