"""Acclaim ASF (skeleton) and AMC (motion), as CMU's files have them.

A bone's local rotation is ``L = C M C⁻¹``: M by the motion's angles, C the bone's ``axis`` in the skeleton file. An
Euler order "XYZ" turns about the fixed axes X, then Y, then Z. A joint carries the name of its bone and stands where
the bone starts, so ``lradius`` is at the elbow; the end of a leaf is ``<bone>_end``. Bone lengths never change.
Lengths are ``0.0254 / length`` metres with the skeleton's ``:units`` (0.056444 m for CMU's 0.45). Y is up.

AMC stores no frame rate. CMU's usual 120 is assumed with a warning, and 60 for their subjects 60 and 61 (files named
``60_01.amc`` and so on), which move at a human pace only so.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Rotations
from onbeat.errors import FormatError
from onbeat.formats.conventions import Convention, Up, z_up_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

ASSUMED_FPS = 120.0
_SLOWER_SUBJECTS = {"60": 60.0, "61": 60.0}


class RateWarning(UserWarning):
    """The rate of a file is not stored and was assumed."""


@dataclass
class _Bone:
    name: str
    line: int
    direction: Array = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Array = field(default_factory=lambda: np.zeros(3))
    order: str = "XYZ"
    dofs: list[str] = field(default_factory=list[str])


@dataclass
class _Acclaim:
    """What an ASF file says; angles in radians, lengths in its unit."""

    bones: dict[str, _Bone]
    children: dict[str, list[str]]
    metres: float
    radians: float
    position: Array


def read_amc(
    path: str | Path,
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
    skeleton: str | Path | None = None,
) -> Motion:
    """Read an AMC file with its ASF in metres with Z up.

    Parameters
    ----------
    path : the ``.amc`` file.
    fps : the rate of its frames; without it one is assumed, with a warning.
    up, unit : the axis that points up and the unit of length, where they are not Y and the skeleton file's.
    skeleton : the ``.asf`` file; without it the one that belongs to ``path`` (see :func:`skeleton_file`).

    Raises
    ------
    FormatError
        If either file is not valid or they do not belong together; file, line or frame are named.
    """
    path = Path(path)
    acclaim = _read_asf(Path(skeleton) if skeleton else skeleton_file(path))
    columns, radians = _read_columns(path, acclaim)
    if fps is None:
        fps = _SLOWER_SUBJECTS.get(path.stem.partition("_")[0], ASSUMED_FPS)
        warnings.warn(
            f"AMC files store no frame rate: {fps:g} frames a second are assumed; give another with --fps of "
            "`onbeat moves build`, or --source-fps of `onbeat convert`",
            RateWarning,
            stacklevel=3,
        )
    metres = acclaim.metres if unit is None else Convention("y", unit).metres
    return z_up_motion(_motion(acclaim, columns, radians, fps, path), metres, up or "y")


def skeleton_file(path: Path) -> Path:
    """The ASF file of an AMC file: of the same stem, of the part before the last ``_``, or the only one there."""
    beside = sorted(p for p in path.parent.glob("*") if p.suffix.lower() == ".asf")
    for stem in (path.stem, path.stem.rpartition("_")[0]):
        for asf in beside:
            if asf.stem == stem:
                return asf
    if len(beside) == 1:
        return beside[0]
    raise FormatError(
        f"no skeleton for {path}: {path.stem}.asf is expected beside it ({len(beside)} .asf files are there)"
    )


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig", errors="replace").replace("\r\n", "\n").replace("\r", "\n")
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None


def _numbers(words: list[str], count: int, where: str) -> Array:
    try:
        values = np.array([float(word) for word in words[:count]])
    except ValueError:
        values = np.full(count, np.nan)
    if len(values) < count or not np.isfinite(values).all():
        raise FormatError(f"{where}: {count} numbers are expected, {' '.join(words)[:60]!r} found")
    return values


def _read_asf(path: Path) -> _Acclaim:
    """Read the skeleton file line by line, section by section."""
    root = _Bone("root", 0, dofs=["tx", "ty", "tz", "rx", "ry", "rz"])
    found = _Acclaim({"root": root}, {}, 0.0254, np.pi / 180, np.zeros(3))
    section, bone = "", root
    for number, line in enumerate(_text(path).split("\n"), 1):
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
            bone = _Bone("", number) if key == "begin" else bone
            _bone_line(found, bone, key, words[1:], where)
        elif section == "hierarchy" and key not in ("begin", "end"):
            _attach(found, words, where)
    for each in found.bones.values():
        each.axis = each.axis * found.radians
    if len(found.bones) < 2 or "root" not in found.children:
        raise FormatError(f"{path}: no :bonedata and :hierarchy with a root found; an ASF skeleton is expected")
    return found


def _units(found: _Acclaim, key: str, words: list[str], where: str) -> None:
    if key == "length":
        length = float(_numbers(words, 1, where)[0])
        if not 1e-6 < length < 1e6:
            raise FormatError(f"{where}: a positive unit of length is expected, {length} found")
        found.metres = 0.0254 / length
    elif key == "angle":
        found.radians = 1.0 if words and words[0].lower().startswith("rad") else np.pi / 180


def _root_line(found: _Acclaim, key: str, words: list[str], where: str) -> None:
    root = found.bones["root"]
    if key == "order":
        root.dofs = _dofs(words, where)
    elif key == "axis":
        root.order = _order(words, where)
    elif key == "position":
        found.position = _numbers(words, 3, where)
    elif key == "orientation":
        root.axis = _numbers(words, 3, where)


def _bone_line(found: _Acclaim, bone: _Bone, key: str, words: list[str], where: str) -> None:
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


def _attach(found: _Acclaim, words: list[str], where: str) -> None:
    attached = {child for children in found.children.values() for child in children}
    for word in words:
        if word not in found.bones:
            raise FormatError(f"{where}: the bone {word[:40]!r} is not in :bonedata")
    for child in words[1:]:
        if child in attached or child == "root":
            raise FormatError(f"{where}: the bone {child!r} has two parents")
        attached.add(child)
        found.children.setdefault(words[0], []).append(child)


def _read_columns(path: Path, acclaim: _Acclaim) -> tuple[dict[str, Array], float]:
    """Each bone's (F, dofs) values, and the radians of one unit of angle.

    All frames list the same bones in the same order, so the words of the file are a table.
    """
    text, radians = _text(path), acclaim.radians
    body = text.split("\n")
    start = 0
    while start < len(body) and not body[start].strip()[:1].isdigit():
        word = body[start].strip().upper()
        radians = {":DEGREES": np.pi / 180, ":RADIANS": 1.0}.get(word, radians)
        if word and word[0] not in ":#":
            raise FormatError(f"{path}:{start + 1}: a frame number is expected, {word[:40]!r} found")
        start += 1
    words = "\n".join(body[start:]).split()
    spans, width = _frame_layout(words, acclaim, path)
    count, rest = divmod(len(words), width)
    if count == 0 or rest:
        raise FormatError(f"{path}: the file ends inside frame {count + 1}; {width} words a frame are expected")
    _check_numbering(words[::width], path)
    columns: dict[str, Array] = {}
    for name, (low, high) in spans.items():
        _check_names(words[low - 1 :: width], name, path)
        columns[name] = np.stack([_column(words[k::width], path) for k in range(low, high)], axis=1)
    return columns, radians


def _frame_layout(words: list[str], acclaim: _Acclaim, path: Path) -> tuple[dict[str, tuple[int, int]], int]:
    """Where in a frame's words each bone's values are, and how many words a frame has; from the first frame."""
    spans: dict[str, tuple[int, int]] = {}
    at = 1
    while at < len(words) and not words[at][:1].isdigit():
        bone = acclaim.bones.get(words[at])
        if bone is None or not bone.dofs or bone.name in spans:
            raise FormatError(f"{path}: frame {words[0]} has {words[at][:40]!r}, which its skeleton does not move so")
        spans[bone.name] = (at + 1, at + 1 + len(bone.dofs))
        at += 1 + len(bone.dofs)
    return spans, at


def _check_numbering(words: list[str], path: Path) -> None:
    for n, word in enumerate(words):
        if word != str(int(words[0]) + n) if words[0].isdecimal() else True:
            raise FormatError(
                f"{path}: {word[:40]!r} found where frame {n + 1} of the file should start; is one missing?"
            )


def _check_names(words: list[str], name: str, path: Path) -> None:
    if words.count(name) != len(words):
        bad = next(n for n, word in enumerate(words) if word != name)
        raise FormatError(f"{path}: frame {bad + 1} has {words[bad][:40]!r} where {name!r} is expected")


def _column(words: list[str], path: Path) -> Array:
    try:
        values = np.array(words, np.float64)
    except ValueError:
        values = np.array([np.nan])
    if not np.isfinite(values).all():
        bad = next(n for n, word in enumerate(words) if not _is_number(word))
        raise FormatError(f"{path}: frame {bad + 1} has {words[bad][:40]!r} where a number is expected")
    return values


def _is_number(word: str) -> bool:
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return False


def _turn(order: str, angles: Array) -> Rotations:
    """About fixed axes in ``order``: moving axes in the reverse order."""
    return rot.from_euler(order[::-1], np.ascontiguousarray(angles[..., ::-1]))


def _local(bone: _Bone, columns: Array, radians: float) -> Rotations:
    """``C M C⁻¹`` for each frame; the axis triple is given as x, y, z whatever its order."""
    angles = np.zeros((len(columns), 3))
    for dof, column in zip(bone.dofs, columns.T, strict=True):
        if dof[0] == "r":
            angles[:, bone.order.index(dof[1].upper())] = column * radians
    frame = _turn(bone.order, bone.axis[["XYZ".index(axis) for axis in bone.order]])
    return rot.multiply(rot.multiply(frame, _turn(bone.order, angles)), rot.inverse(frame))


def _motion(acclaim: _Acclaim, columns: dict[str, Array], radians: float, fps: float, path: Path) -> Motion:
    """The motion in the file's own unit and axes."""
    frames = len(next(iter(columns.values()), np.zeros((0, 1))))
    names, parents, offsets, ends = _joints(acclaim)
    rotations = np.tile(rot.IDENTITY, (frames, len(names), 1))
    for name, values in columns.items():
        if name in names:
            rotations[:, names.index(name)] = _local(acclaim.bones[name], values, radians)
    root = np.tile(acclaim.position, (frames, 1))
    for dof, column in zip(acclaim.bones["root"].dofs, columns.get("root", np.zeros((frames, 0))).T, strict=False):
        if dof[0] == "t":
            root[:, "xyz".index(dof[1])] += column
    return Motion(Skeleton(names, parents, offsets, ends), rotations, root, fps, path.stem)


def _joints(acclaim: _Acclaim) -> tuple[list[str], list[int], list[Array], list[bool]]:
    """Joints depth first: a bone's joint stands at its parent bone's end; a leaf has an end of its own."""
    names: list[str] = []
    parents: list[int] = []
    offsets: list[Array] = []
    ends: list[bool] = []
    stack: list[tuple[str, int, Array]] = [("root", -1, np.zeros(3))]
    while stack:
        name, parent, offset = stack.pop()
        here = len(names)
        names, parents, offsets = [*names, name], [*parents, parent], [*offsets, offset]
        ends.append(name not in acclaim.bones)
        if ends[-1]:
            continue
        bone = acclaim.bones[name]
        along = bone.direction / max(float(np.linalg.norm(bone.direction)), 1e-12) * bone.length
        below = acclaim.children.get(name, [])
        stack += [(child, here, along) for child in reversed(below)] or [(f"{name}_end", here, along)]
    return names, parents, offsets, ends
