"""Robots: what a dance, a planner and a simulator need of one, by its name or from a file."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import msgspec

from onbeat._shapes import Array, Positions, frozen
from onbeat.errors import BodyError, FormatError
from onbeat.motion.body import NEEDED, Body
from onbeat.motion.hinges import End, Hinge, HingeBody
from onbeat.motion.retarget import stands_in_rest
from onbeat.motion.role_file import SUFFIX, read_roles
from onbeat.motion.roles import find_roles
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.description.description import AssumedWarning, Description, Point, vector
from onbeat.robots.description.limbs import Limbs, limbs_of
from onbeat.robots.description.mjcf import FRICTION, mjcf_of
from onbeat.robots.description.mjcf_file import read_mjcf
from onbeat.robots.description.toml import described, described_robots, read_description
from onbeat.robots.description.urdf import read_urdf
from onbeat.robots.engine import engine


@dataclass(frozen=True, eq=False)
class Foot:
    """A foot: the link (body of the model) that it is, and the corners (4, 3) of its sole in metres in that frame."""

    link: str
    corners: Positions


@dataclass(frozen=True, eq=False)
class Robot:
    """A humanoid with n hinges on a floor.

    Parameters
    ----------
    name : short, as on the command line.
    body : its hinges in the order of the model, their limits, and the skeleton that rests in the zero configuration.
    torque : (n,) N·m, what each motor can do in either direction.
    mjcf : the whole model as MuJoCo reads it: floor, capsules, soles, one motor for each hinge in order. It stands on
        the floor in the zero configuration.
    feet : "left" and "right".
    roles : the hinge, the root or the end that plays each role.
    source : where the figures are from.
    unclear : why its structure does not tell which joints are arms and legs; empty where it does.

    Examples
    --------
    >>> g1 = robot_named("G1")
    >>> len(g1.body.names), round(g1.mass, 2), g1.feet["left"].link
    (29, 33.34, 'left_ankle_roll_link')
    """

    name: str
    body: HingeBody
    torque: Array
    mjcf: str
    feet: Mapping[str, Foot]
    roles: Mapping[str, str]
    source: str
    unclear: str = ""

    @cached_property
    def model(self) -> Any:
        """MuJoCo's compiled model (``mujoco.MjModel``), compiled once: copy it before you change it."""
        return engine().MjModel.from_xml_string(self.mjcf)

    @property
    def mass(self) -> float:
        """Kilograms of the whole robot."""
        return float(self.model.body_mass.sum())


def robot_named(name: str, friction: float = FRICTION) -> Robot:
    """A robot by its name.

    Parameters
    ----------
    name : "g1", "hrp4c" or "talos", however it is spelt.
    friction : of its soles on the floor.

    Raises
    ------
    BodyError
        If there is no such robot; those that there are are named.
    """
    plain = name.strip().lower().replace("-", "").replace("_", "")
    if plain not in described_robots():
        raise BodyError(
            f"no robot {name[:40]!r} is known; there are {', '.join(described_robots())}; "
            "of others give a file: .urdf or .xml"
        )
    return _packaged(plain, float(friction))


@lru_cache(maxsize=16)
def _packaged(name: str, friction: float) -> Robot:
    robot = robot_of(name, described(name), friction)
    return replace(robot, body=G1) if name == "g1" else robot


def robot_from(path: str | os.PathLike[str], friction: float = FRICTION) -> Robot:
    """The humanoid of a file: a URDF (``.urdf``), an MJCF (``.xml``), or a description as onbeat has it (``.toml``).

    What is assumed of it (soles, speeds, torques that are not told, meshes that are not there) is a warning. Which
    joint plays which role its structure tells, whatever they are called; where it does not, ``NAME.roles.toml`` beside
    it does.

    Raises
    ------
    BodyError
        If it cannot be a robot's that stands on two feet; the joint or the link is named. If its roles file is wrong.
    LimitError
        If the file cannot be read, is no XML, or a number is none.
    """
    path = Path(path)
    readers = {".urdf": read_urdf, ".xml": read_mjcf, ".mjcf": read_mjcf, ".toml": read_description}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise BodyError(f"{path} is no robot's description; .urdf, .xml (MJCF) or .toml is expected")
    description, beside = reader(path), path.with_suffix(SUFFIX)
    try:
        if beside.is_file():
            told = {**description.roles, **read_roles(beside).joints}
            description = msgspec.structs.replace(description, roles=told)
        return robot_of(path.stem, description, friction)
    except FormatError as error:
        raise BodyError(f"{path}: {error}") from None


def robot_of(name: str, description: Description, friction: float = FRICTION) -> Robot:
    """The robot that a sound description tells of.

    Raises
    ------
    BodyError
        If the friction is not above zero.
    """
    if not (math.isfinite(friction) and friction > 0):
        raise BodyError(f"soles with a friction of {friction:g} stand nowhere; a number above zero is expected")
    body, limbs = _understood(name, description)
    names = body.skeleton.names
    roles = {role: names[joint] for role, joint in find_roles(body.skeleton).joints.items()}
    feet = {side: Foot(sole.link, frozen(sole.corners)) for side, sole in description.feet.items()}
    source = "; ".join(text for text in (description.source, description.licence, description.note) if text)
    return Robot(
        name,
        body,
        frozen([link.torque for link in description.links.values()]),
        mjcf_of(description, friction),
        MappingProxyType(feet),
        MappingProxyType(roles),
        source,
        limbs.unclear,
    )


def body_of(robot: Robot) -> Body:
    """The roles of a robot's joints; a ``BodyError`` that tells what is missing where it cannot dance with them."""
    skeleton, file = robot.body.skeleton, f"{robot.name}{SUFFIX}"
    missing = [role for role in NEEDED if role not in robot.roles]
    how = f'{file} beside its file can tell them: [joints] and lines like {(missing or NEEDED)[0]} = "joint"'
    if missing:
        why = f" ({robot.unclear})" if robot.unclear else ""
        joints = ", ".join((skeleton.names[0], *robot.body.names))
        raise BodyError(
            f"{robot.name}: neither its structure{why} nor names tell its {', '.join(missing)}; {how}; "
            f"its joints are {joints}"
        )
    body = Body.of(skeleton)
    if not stands_in_rest(body):
        told = ", ".join(f"{role} {robot.roles[role]}" for role in NEEDED)
        raise BodyError(f"{robot.name} does not stand where all its angles are zero, taken as {told}; {how}")
    return body


def _understood(name: str, description: Description) -> tuple[HingeBody, Limbs]:
    """The body with its roles: those that are told, and those of the structure where names say otherwise or nothing."""
    body, joint = _body(description)
    limbs = limbs_of(body, {side: joint[sole.link] for side, sole in description.feet.items()})
    named, how = find_roles(body.skeleton.with_roles(description.roles))
    if not limbs.roles or ("guess" not in how.values() and limbs.agree(named)):
        return replace(body, skeleton=body.skeleton.with_roles(description.roles)), limbs
    names, told = body.skeleton.names, description.roles
    roles = {role: names[number] for role, number in limbs.roles.items() if names[number] not in told.values()}
    if limbs.rigid and "chest" not in told:
        # Without a waist a point between the shoulders plays the chest: it goes with the pelvis.
        shoulders = [limbs.roles[f"{side}_shoulder"] for side in ("left", "right")]
        middle = vector(body.skeleton.rest_positions[shoulders].mean(axis=0))
        roles["chest"] = "chest"
        while roles["chest"] in names:
            roles["chest"] += "_point"
        ends = {**description.ends, roles["chest"]: Point(description.root.link, middle)}
        body, _ = _body(msgspec.structs.replace(description, ends=ends))
    new = [r for r in NEEDED if r in roles and (how.get(r) == "guess" or named.get(r) != limbs.roles.get(r))]
    shown = ", ".join(f"{role} {roles[role]}" for role in new if not role.startswith("right"))
    if shown:
        warnings.warn(
            f"{name}: its structure tells which joint is what where names do not, or tell otherwise: {shown}; "
            f"{name}{SUFFIX} beside its file can say otherwise",
            AssumedWarning,
            stacklevel=4,
        )
    return replace(body, skeleton=body.skeleton.with_roles({**roles, **told})), limbs


def _body(description: Description) -> tuple[HingeBody, dict[str, int]]:
    """The body, and the joint in its skeleton that moves each link."""
    root, links = description.root.link, description.links
    joint = {root: root, **{name: link.joint for name, link in links.items()}}
    hinges = [
        Hinge(link.joint, joint[link.parent], link.origin, link.rpy, link.axis, *link.position, link.speed)
        for link in links.values()
    ]
    ends = [End(name, joint[end.link], end.at) for name, end in description.ends.items()]
    body = HingeBody.of(description.name, root, hinges, ends)
    return body, {link: number for number, link in enumerate(joint)}
