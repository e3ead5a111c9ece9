"""Acclaim ASF: the skeleton that AMC files move."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.formats.text import small_text

_LARGEST = 1 << 24


@dataclass
class Bone:
    """A bone: its direction and length in the file's unit, its axis in radians, and what of it moves."""

    name: str
    line: int
    direction: Array = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Array = field(default_factory=lambda: np.zeros(3))
    order: str = "XYZ"
    dofs: list[str] = field(default_factory=list[str])


@dataclass
class Acclaim:
    """What an ASF file says; angles in radians, lengths in its unit."""

    bones: dict[str, Bone]
    children: dict[str, list[str]]
    metres: float
    radians: float
    position: Array


def read_asf(path: Path) -> Acclaim:
    """Read a skeleton file line by line, section by section.

    Raises
    ------
    FormatError
        If it is no whole skeleton; file, line and what was expected are named.
    """
    root = Bone("root", 0, dofs=["tx", "ty", "tz", "rx", "ry", "rz"])
    found = Acclaim({"root": root}, {}, 0.0254, np.pi / 180, np.zeros(3))
    section, bone = "", root
    for number, line in enumerate(small_text(path, _LARGEST, "an ASF skeleton").split("\n"), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        where, key = f"{path}:{number}", words[0].lower()
        if key.startswith(":"):
            section = key[1:]
        elif section == "units":
            _units(found, key, words[1:], where)
        elif section == "root":
            _root_line(found, key, words[1:], where)
        elif section == "bonedata":
            bone = Bone("", number) if key == "begin" else bone
            _bone_line(found, bone, key, words[1:], where)
        elif section == "hierarchy" and key not in ("begin", "end"):
            _attach(found, words, where)
    for each in found.bones.values():
        each.axis = each.axis * found.radians
    if len(found.bones) < 2 or "root" not in found.children:
        raise FormatError(f"{path}: no :bonedata and :hierarchy with a root found; an ASF skeleton is expected")
    return found


def _numbers(words: list[str], count: int, where: str) -> Array:
    try:
        values = np.array([float(word) for word in words[:count]])
    except ValueError:
        values = np.full(count, np.nan)
    if len(values) < count or not np.isfinite(values).all():
        raise FormatError(f"{where}: {count} numbers are expected, {' '.join(words)[:60]!r} found")
    return values


def _units(found: Acclaim, key: str, words: list[str], where: str) -> None:
    if key == "length":
        length = float(_numbers(words, 1, where)[0])
        if not 1e-6 < length < 1e6:
            raise FormatError(f"{where}: a positive unit of length is expected, {length} found")
        found.metres = 0.0254 / length
    elif key == "angle":
        found.radians = 1.0 if words and words[0].lower().startswith("rad") else np.pi / 180


def _root_line(found: Acclaim, key: str, words: list[str], where: str) -> None:
    root = found.bones["root"]
    if key == "order":
        root.dofs = _dofs(words, where)
    elif key == "axis":
        root.order = _order(words, where)
    elif key == "position":
        found.position = _numbers(words, 3, where)
    elif key == "orientation":
        root.axis = _numbers(words, 3, where)


def _bone_line(found: Acclaim, bone: Bone, key: str, words: list[str], where: str) -> None:
    if key == "name":
        bone.name = words[0] if words else ""
        if not bone.name or bone.name in found.bones:
            raise FormatError(f"{where}: the bone name {bone.name!r} is empty or occurs twice")
        found.bones[bone.name] = bone
    elif key == "direction":
        bone.direction = _numbers(words, 3, where)
    elif key == "length":
        bone.length = float(_numbers(words, 1, where)[0])
    elif key == "axis":
        bone.axis, bone.order = _numbers(words, 3, where), _order(words[3:], where)
    elif key == "dof":
        bone.dofs = _dofs(words, where)
        if any(dof[0] == "t" for dof in bone.dofs):
            raise FormatError(f"{where}: only the root may have translations, {bone.name!r} has {' '.join(words)}")


def _dofs(words: list[str], where: str) -> list[str]:
    dofs = [word.lower() for word in words]
    if not set(dofs) <= {"rx", "ry", "rz", "tx", "ty", "tz"} or len(set(dofs)) < len(dofs):
        raise FormatError(f"{where}: degrees of freedom out of rx ry rz tx ty tz are expected, {words} found")
    return dofs


def _order(words: list[str], where: str) -> str:
    order = words[0].upper() if words else "XYZ"
    if sorted(order) != ["X", "Y", "Z"]:
        raise FormatError(f"{where}: an axis order such as XYZ is expected, {order[:40]!r} found")
    return order


def _attach(found: Acclaim, words: list[str], where: str) -> None:
    attached = {child for children in found.children.values() for child in children}
    for word in words:
        if word not in found.bones:
            raise FormatError(f"{where}: the bone {word[:40]!r} is not in :bonedata")
    for child in words[1:]:
        if child in attached or child == "root":
            raise FormatError(f"{where}: the bone {child!r} has two parents")
        attached.add(child)
        found.children.setdefault(words[0], []).append(child)
