"""Feet found in a robot's file: by their links' names or as its lowest ends, and their soles' corners by their shapes.

The sole is the trapezium about what is lowest of the foot's shapes while the robot stands in the zero configuration;
of a foot without a shape it is estimated from the robot's height, and a warning says so.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.role_names import words_of
from onbeat.robots.description.description import Capsule, Sole, Vector, vector

THICK = 0.004
"""Metres above the lowest point of a foot in which a point belongs to its sole."""
LONG, BROAD, FRONT, HIGH = 0.24, 0.12, 0.62, 0.08
"""Of a sole that is estimated: its length and breadth for each metre of the ankle's depth below the root, the share of
the length before the ankle, and its depth below the ankle for each such metre."""
_FOOT = re.compile(r"foot|feet|sole|ankle")
_SIDES = {"left": ("left", "l"), "right": ("right", "r")}
_PART, _LEAST, _HINGES = 0.6, 0.02, 4
_LEG, _OFF, _MIRROR = 6, 0.1, np.array([1.0, -1.0, 1.0])
_RADIUS, _ABOVE = 0.03, 0.003
Corners = tuple[Vector, Vector, Vector, Vector]


class Member(NamedTuple):
    """A rigid link: its place and turn in the link above, the frames it is made of, and points on its surface."""

    name: str
    parent: str
    at: Positions
    turn: Rotations
    frames: Mapping[str, Positions]
    points: Positions


def feet_of(members: Sequence[Member], label: str) -> tuple[dict[str, Sole], list[str]]:
    """The left and the right foot of a robot of these links, the root first, and notes on what was estimated.

    Raises
    ------
    BodyError
        If no foot is found; the links there are are named.
    """
    places = _places(members)
    found = {side: _foot(members, side, places) for side in _SIDES}
    if not all(found.values()):
        found |= _mirrored_feet(members, places)
    feet, notes = dict[str, Sole](), list[str]()
    for side, foot in found.items():
        if foot is None:
            names = ", ".join(member.name for member in members[:40])
            raise BodyError(
                f"{label}: no {side} foot found: no link's name has {side!r} or {side[0]!r} and one of foot, sole, "
                "ankle, and of the lowest ends of its limbs no two mirror each other; name the foot's link "
                f"{side}_foot; there are {names}"
            )
        corners, note = _corners(foot, *places[foot.name])
        feet[side] = Sole(foot.name, corners)
        notes += [note] if note else []
    return feet, notes


def _foot(members: Sequence[Member], side: str, places: Mapping[str, tuple[Rotations, Positions]]) -> Member | None:
    """The last link, down the tree, whose name or whose part's name says that it is this foot.

    Where none does: the lowest of the ends of long limbs that are named after the side.
    """
    found = [member for member in members if any(_says(name, side) for name in member.frames)]
    if found:
        return found[-1]
    ends = [member for member in _ends(members) if side_of(member.name) == side]
    lowest = min(ends, key=lambda member: places[member.name][1][2], default=None)
    return lowest if lowest is not None and places[lowest.name][1][2] < 0 else None


def _ends(members: Sequence[Member]) -> list[Member]:
    """Links on which nothing hangs, with hinges enough between them and the root for a leg."""
    above = {member.name: member.parent for member in members}
    return [m for m in members if m.name not in above.values() and len(_line(m.name, above)) >= _HINGES]


def _mirrored_feet(
    members: Sequence[Member], places: Mapping[str, tuple[Rotations, Positions]]
) -> dict[str, Member | None]:
    """The two ends that mirror each other lowest, whatever they are called; of toes the foot above them.

    Nothing where something else is much lower: such a robot does not stand on these.
    """
    above = {member.name: member.parent for member in members}
    heights = [at[2] for _, at in places.values()]
    tall = max(heights) - min(heights)
    pairs = [
        (one, other)
        for one, other in itertools.permutations(_ends(members), 2)
        if places[one.name][1][1] > 1e-3
        and min(len(_alone(one, other, above)), len(_alone(other, one, above))) >= _HINGES
        and np.linalg.norm(places[one.name][1] - places[other.name][1] * _MIRROR) < _OFF * tall
        and max(places[end.name][1][2] for end in (one, other)) < min(min(heights) + _OFF * tall, 0.0)
    ]
    if not pairs:
        return dict.fromkeys(_SIDES)
    named = {member.name: member for member in members}
    lowest = min(pairs, key=lambda pair: sum(places[end.name][1][2] for end in pair))
    toes = [_is_toe(end, _alone(end, other, above)) for end, other in (lowest, lowest[::-1])]
    feet = [named[end.parent] for end in lowest] if all(toes) else lowest
    return dict(zip(_SIDES, feet, strict=True))


def _alone(end: Member, other: Member, above: Mapping[str, str]) -> list[str]:
    """The links from an end up to where the other one hangs as well."""
    lines = [_line(name, above) for name in (end.name, other.name)]
    return [name for name in lines[0] if name not in lines[1]]


def _is_toe(end: Member, leg: Sequence[str]) -> bool:
    """Whether a link hangs before a foot: behind a leg's six hinges, and more before than below them."""
    before = float(np.linalg.norm(end.at[:2]))
    return len(leg) > _LEG and before > max(_LEAST, abs(float(end.at[2])))


def _line(name: str, above: Mapping[str, str]) -> list[str]:
    """A link and those above it, without the root."""
    line = list[str]()
    while above[name]:
        line.append(name)
        name = above[name]
    return line


def side_of(name: str) -> str:
    """The side that a name says first, empty where it says none.

    Examples
    --------
    >>> side_of("r_foot_left_sensor"), side_of("pelvis")
    ('right', '')
    """
    words = words_of(name)
    said = (side for word in words for side, spelt in _SIDES.items() if word in spelt)
    return next(said, "")


def _says(name: str, side: str) -> bool:
    return bool(_FOOT.search("".join(words_of(name)))) and side_of(name) == side


def _places(members: Sequence[Member]) -> dict[str, tuple[Rotations, Positions]]:
    """How each link is turned and where it is in the root's frame, in the zero configuration."""
    places = {members[0].name: (rot.IDENTITY, np.zeros(3))}
    for member in members[1:]:
        turn, at = places[member.parent]
        places[member.name] = rot.multiply(turn, member.turn), at + rot.rotate(turn, member.at)
    return places


def _corners(foot: Member, turn: Rotations, at: Positions) -> tuple[Corners, str]:
    """The corners in the link's frame, front left, front right, back right, back left, and a note."""
    note, sole = "", _lowest(rot.rotate(turn, foot.points))
    if len(foot.points) and not _broad(sole):  # it is not level: one of its own axes is up
        turn = _nearest_axes(turn)
        sole = _lowest(rot.rotate(turn, foot.points))
    if _broad(sole):
        lowest = sole[:, 2].min()
        back, front = sole[:, 0].min(), sole[:, 0].max()
        (toe_right, toe_left), (heel_right, heel_left) = _breadths(sole, back, front)
    else:
        deep = -at[2]
        tips = [rot.rotate(turn, frame)[2] for name, frame in foot.frames.items() if "sole" in name.lower()]
        lowest = min(tips) if tips else -HIGH * deep
        front, back = FRONT * LONG * deep, (FRONT - 1) * LONG * deep
        toe_left = heel_left = BROAD * deep / 2
        toe_right = heel_right = -toe_left
        note = (
            f"{foot.name} has no shape: a sole of {front - back:.2f} × {2 * toe_left:.2f} m, {-lowest:.2f} m below it, "
            "is assumed"
        )
    toes = (front, toe_left, lowest), (front, toe_right, lowest)
    flat = np.array([*toes, (back, heel_right, lowest), (back, heel_left, lowest)])
    one, two, three, four = rot.rotate(rot.inverse(turn), flat).round(5)
    return (vector(one), vector(two), vector(three), vector(four)), note


def _lowest(points: Positions) -> Positions:
    return points[points[:, 2] < points[:, 2].min() + THICK] if len(points) else points


def _broad(sole: Positions) -> bool:
    """Whether points are enough of a sole to stand on."""
    return len(sole) >= 3 and bool((np.ptp(sole[:, :2], axis=0) > _LEAST).all())


def _nearest_axes(turn: Rotations) -> Rotations:
    """The turn by right angles that is nearest to a turn: up and front become axes of the link."""
    matrix = rot.to_matrix(turn[None])[0]
    rows = np.zeros((3, 3))
    up = int(np.argmax(np.abs(matrix[2])))
    front = int(np.argmax(np.where(np.arange(3) == up, 0, np.abs(matrix[0]))))
    rows[2, up], rows[0, front] = np.sign(matrix[2, up]), np.sign(matrix[0, front]) or 1.0
    rows[1] = np.cross(rows[2], rows[0])
    return rot.from_matrix(rows)


def _breadths(sole: Positions, back: float, front: float) -> list[tuple[float, float]]:
    """From the right to the left of the front and of the back of a sole's points; of all where a part has none."""
    found = list[tuple[float, float]]()
    for part in (sole[:, 0] > back + _PART * (front - back), sole[:, 0] < front - _PART * (front - back)):
        across = sole[part, 1] if len(sole[part]) > 1 and np.ptp(sole[part, 1]) > _LEAST else sole[:, 1]
        found.append((float(across.min()), float(across.max())))
    return found


def foot_capsules(sole: Sole) -> tuple[Capsule, ...]:
    """Two capsules along a sole, a little above it, so that the floor meets the corners first."""
    front_left, front_right, back_right, back_left = np.array(sole.corners)
    along, across = front_left - back_left, front_left - front_right
    up = np.cross(along, across)
    up /= max(float(np.linalg.norm(up)), 1e-9)
    radius = min(_RADIUS, float(np.linalg.norm(across)) / 4)
    inset = along / max(float(np.linalg.norm(along)), 1e-9) * radius
    aside = across / max(float(np.linalg.norm(across)), 1e-9) * radius
    raised = up * (radius + _ABOVE)
    pairs = ((back_left - aside, front_left - aside), (back_right + aside, front_right + aside))
    return tuple(_capsule(back + inset + raised, front - inset + raised, radius) for back, front in pairs)


def _capsule(start: Array, end: Array, radius: float) -> Capsule:
    x, y, z, a, b, c = np.concatenate((start, end)).round(4).tolist()
    return x, y, z, a, b, c, round(radius, 4)
