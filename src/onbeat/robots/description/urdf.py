"""Robots of URDF files (ROS's robot descriptions).

Meshes are looked for beside the file; those that are not there are left out and counted in a warning: a link without
shapes gets capsules along it. Joints that follow another (``<mimic>``), that slide or that are held are still.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from xml.etree.ElementTree import Element

import numpy as np

from onbeat._shapes import Positions, Rotations
from onbeat.errors import BodyError
from onbeat.limits.plain_xml import as_number, number, read_xml
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import AssumedWarning, Description
from onbeat.robots.description.pieces import Piece, Turn, description_of_pieces
from onbeat.robots.description.shapes import Shape, box, cloud, cylinder, sphere
from onbeat.robots.description.stl import read_stl

_KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
_MOST = 2000


def read_urdf(path: Path) -> Description:
    """The description of a humanoid that a URDF holds; what is assumed is a warning.

    Raises
    ------
    BodyError
        If a joint's axis has no length, its limits are reversed or missing, links make a loop or more than one tree, a
        link that moves has no mass, or no feet are found; joint or link are named.
    LimitError
        If the file cannot be read or is no XML, or a number is none.
    """
    root = read_xml(path, "a URDF")
    label = str(path)
    if root.tag != "robot":
        raise BodyError(f"{label}: <{root.tag[:40]}> found; a URDF's <robot> is expected")
    if any(child.tag.startswith("xacro:") for child in root):
        raise BodyError(f"{label} is a xacro, from which a URDF is made; run xacro on it first")
    meshes = _Meshes(path.parent)
    links = {_name(link, label): link for link in root.findall("link")}
    joints = {_name(joint, label): joint for joint in root.findall("joint")}
    pieces = [_piece(link, joint, links, meshes, label) for link, joint in _in_order(links, joints, label)]
    name = root.get("name", "") or path.stem
    if meshes.missing:
        warnings.warn(
            f"{label}: {len(meshes.missing)} meshes are not beside it ({meshes.missing[0]}, …); links without a shape "
            "get capsules along them",
            AssumedWarning,
            stacklevel=2,
        )
    return description_of_pieces(name, pieces, label, f"{path.name}")


class _Meshes:
    """Meshes beside a file, and the names of those that are not."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.missing = folder, list[str]()

    def shape(self, name: str, scale: Positions) -> Shape | None:
        """The shape of a mesh; None where it is not found or is no STL."""
        parts = PurePosixPath(name.partition("://")[2] or name).parts
        for start in range(len(parts)):
            path = self.folder.joinpath(*parts[start:])
            if ".." not in parts and path.suffix.lower() == ".stl" and path.is_file():
                return cloud(read_stl(path) * scale)
        self.missing.append(name[:100])
        return None


def _name(element: Element, label: str) -> str:
    name = element.get("name", "")
    if not name:
        raise BodyError(f"{label}: a {element.tag} without a name found; a URDF's links and joints have names")
    return name


def _end(joint: Element, which: str, label: str) -> str:
    element = joint.find(which)
    link = element.get("link", "") if element is not None else ""
    if not link:
        raise BodyError(f'{label}: joint {joint.get("name")!r} has no <{which} link="…">')
    return link


def _in_order(
    links: Mapping[str, Element], joints: Mapping[str, Element], label: str
) -> list[tuple[str, Element | None]]:
    """Links with the joint above each, depth first from the root."""
    above, below = dict[str, str](), dict[str, list[str]]()
    for name, joint in joints.items():
        parent, child = _end(joint, "parent", label), _end(joint, "child", label)
        for link in (parent, child):
            if link not in links:
                raise BodyError(f"{label}: joint {name!r} joins link {link!r}, which is not there")
        if child in above:
            raise BodyError(
                f"{label}: link {child!r} hangs on two joints, {above[child]!r} and {name!r}; a tree is expected"
            )
        above[child] = name
        below.setdefault(parent, []).append(name)
    roots = [link for link in links if link not in above]
    if not roots:
        raise BodyError(f"{label}: its links make a loop through joint {next(iter(joints), '')!r}; a tree is expected")
    if len(roots) > 1:
        raise BodyError(f"{label}: {', '.join(roots[:5])} hang on nothing; one root is expected")
    order, waiting = list[tuple[str, Element | None]](), [roots[0]]
    while waiting:
        link = waiting.pop()
        order.append((link, joints[above[link]] if link in above else None))
        waiting += [_end(joints[name], "child", label) for name in reversed(below.get(link, []))]
    if len(order) < len(links):
        lost = next(link for link in links if link not in dict(order))
        raise BodyError(f"{label}: link {lost!r} is in a loop of joints ({above[lost]!r}); a tree is expected")
    if len(order) > _MOST:
        raise BodyError(f"{label}: {len(order)} links found; no robot has over {_MOST}")
    return order


def _piece(name: str, joint: Element | None, links: Mapping[str, Element], meshes: _Meshes, label: str) -> Piece:
    link = links[name]
    turn, at = (rot.IDENTITY, np.zeros(3)) if joint is None else _origin(joint, f"{label}: joint {joint.get('name')!r}")
    parent = "" if joint is None else _end(joint, "parent", label)
    piece = Piece(name, parent, at, turn, None if joint is None else _hinge(joint, label))
    _weigh(piece, link.find("inertial"), f"{label}: link {name!r}")
    for kind in ("collision", "visual"):
        piece.shapes = piece.shapes or list(_shapes(link, kind, meshes, f"{label}: link {name!r}"))
    return piece


def _hinge(joint: Element, label: str) -> Turn | None:
    """The hinge; None where the joint is still."""
    name, kind = joint.get("name", ""), joint.get("type", "")
    where = f"{label}: joint {name!r}"
    if kind not in _KINDS:
        raise BodyError(f"{where}: type {kind[:40]!r} found; one of {', '.join(_KINDS)} is expected")
    if kind not in ("revolute", "continuous") or joint.find("mimic") is not None:
        return None
    limit = joint.find("limit")
    if limit is None and kind == "revolute":
        raise BodyError(f"{where}: a revolute joint needs a <limit lower= upper= velocity= effort=>, none found")
    low, high, speed, torque = -math.pi, math.pi, 0.0, 0.0
    if limit is not None:
        speed, torque = (number(limit, key, where, 0.0) for key in ("velocity", "effort"))
        if kind == "revolute":
            low, high = (number(limit, key, where, 0.0) for key in ("lower", "upper"))
    if low == high:
        return None
    element = joint.find("axis")
    axis = np.array([1.0, 0, 0]) if element is None else _numbers(element.get("xyz", "1 0 0"), f"{where}: axis")
    return Turn(name, axis, low, high, speed, torque)


def _origin(element: Element, where: str) -> tuple[Rotations, Positions]:
    origin = element.find("origin")
    if origin is None:
        return rot.IDENTITY, np.zeros(3)
    angles = _numbers(origin.get("rpy", "0 0 0"), f"{where}: rpy")
    return rot.from_euler("ZYX", angles[::-1]), _numbers(origin.get("xyz", "0 0 0"), f"{where}: xyz")


def _numbers(text: str, where: str) -> Positions:
    words = text.split()
    if len(words) != 3:
        raise BodyError(f"{where}: three numbers are expected, {text[:40]!r} found")
    values = np.array([as_number(word, where) for word in words])
    if not (np.abs(values) < 1e6).all():
        raise BodyError(f"{where}: {text[:40]!r} found, which no robot has")
    return values


def _weigh(piece: Piece, inertial: Element | None, where: str) -> None:
    if inertial is None:
        return
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    if mass is None or inertia is None:
        raise BodyError(f"{where}: an <inertial> has a <mass> and an <inertia>; one is missing")
    piece.mass = number(mass, "value", f"{where}: mass", 0.0)
    keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    xx, xy, xz, yy, yz, zz = (number(inertia, key, f"{where}: inertia", 0.0) for key in keys)
    if not all(abs(value) < 1e6 for value in (piece.mass, xx, xy, xz, yy, yz, zz)):
        raise BodyError(f"{where}: a mass or an inertia found that no robot has")
    turn, piece.centre = _origin(inertial, f"{where}: inertial")
    matrix = rot.to_matrix(turn[None])[0]
    piece.inertia = matrix @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ matrix.T


def _shapes(link: Element, kind: str, meshes: _Meshes, where: str) -> Iterator[Shape]:
    for element in link.findall(kind):
        turn, at = _origin(element, f"{where}: {kind}")
        for geometry in element.findall("geometry"):
            for solid in geometry:
                shape = _shape(solid, meshes, f"{where}: {solid.tag}")
                if shape is not None:
                    yield shape.moved(turn, at)


def _shape(solid: Element, meshes: _Meshes, where: str) -> Shape | None:
    if solid.tag == "box":
        return box(np.abs(_numbers(solid.get("size", ""), f"{where}: size")) / 2)
    if solid.tag == "sphere":
        return sphere(_length(solid, "radius", where))
    if solid.tag in ("cylinder", "capsule"):
        return cylinder(_length(solid, "radius", where), _length(solid, "length", where))
    if solid.tag == "mesh":
        return meshes.shape(solid.get("filename", ""), _numbers(solid.get("scale", "1 1 1"), f"{where}: scale"))
    return None


def _length(solid: Element, key: str, where: str) -> float:
    value = number(solid, key, where, 0.0)
    if not 0 < value < 1e3:
        raise BodyError(f"{where}: a {key} of {value:g} m found; one above zero is expected")
    return value
