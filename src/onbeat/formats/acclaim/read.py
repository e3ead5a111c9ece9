"""Acclaim ASF (skeleton) and AMC (motion), as CMU's files have them.

A bone's local rotation is ``L = C M C⁻¹``: M by the motion's angles, C the bone's ``axis`` in the skeleton file. An
Euler order "XYZ" turns about the fixed axes X, then Y, then Z. A joint carries the name of its bone and stands where
the bone starts, so ``lradius`` is at the elbow; the end of a leaf is ``<bone>_end``. Bone lengths never change.
Lengths are ``0.0254 / length`` metres with the skeleton's ``:units`` (0.056444 m for CMU's 0.45). Y is up.

AMC stores no frame rate. CMU's usual 120 is assumed with a warning, and 60 for their subjects 60 and 61 (files named
``60_01.amc`` and so on), which move at a human pace only so.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Rotations
from onbeat.errors import FormatError
from onbeat.formats.acclaim.amc import read_columns
from onbeat.formats.acclaim.asf import Acclaim, Bone, read_asf
from onbeat.formats.conventions import Convention, Up, z_up_motion
from onbeat.formats.notes import tell
from onbeat.formats.rates import assumed
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

ASSUMED_FPS = 120.0
_SLOWER_SUBJECTS = {"60": 60.0, "61": 60.0}


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
    acclaim = read_asf(Path(skeleton) if skeleton else skeleton_file(path))
    columns, radians = read_columns(path, acclaim)
    if fps is None:
        usual = _SLOWER_SUBJECTS.get(path.stem.partition("_")[0], ASSUMED_FPS)
        fps = assumed(usual, "AMC files store", "that of CMU's recordings")
    tell("up", up or "y", "it is given" if up else "Acclaim files have Y up")
    length = 0.0254 / acclaim.metres
    tell("unit", unit or f"{acclaim.metres:.6g} m", "it is given" if unit else f"an inch is {length:g} in its :units")
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


def _turn(order: str, angles: Array) -> Rotations:
    """About fixed axes in ``order``: moving axes in the reverse order."""
    return rot.from_euler(order[::-1], np.ascontiguousarray(angles[..., ::-1]))


def _local(bone: Bone, columns: Array, radians: float) -> Rotations:
    """``C M C⁻¹`` for each frame; the axis triple is given as x, y, z whatever its order."""
    angles = np.zeros((len(columns), 3))
    for dof, column in zip(bone.dofs, columns.T, strict=True):
        if dof[0] == "r":
            angles[:, bone.order.index(dof[1].upper())] = column * radians
    frame = _turn(bone.order, bone.axis[["XYZ".index(axis) for axis in bone.order]])
    return rot.multiply(rot.multiply(frame, _turn(bone.order, angles)), rot.inverse(frame))


def _motion(acclaim: Acclaim, columns: dict[str, Array], radians: float, fps: float, path: Path) -> Motion:
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


def _joints(acclaim: Acclaim) -> tuple[list[str], list[int], list[Array], list[bool]]:
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
