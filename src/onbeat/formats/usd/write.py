"""Universal Scene Description (USD): an animated UsdSkel skeleton with a simple body, by the extra ``usd``.

One prim ``/dancer``, a SkelRoot, holds the skeleton, its animation and the capsule body (see
:mod:`onbeat.formats.usd.body`). Frame f is the time code f, at fps time codes a second. The joints' local rotations
(quaternions) and translations are sampled at each frame; in the rest pose, which is also the bind pose, the body
stands on the ground. USD lets a stage say its up axis (Y or Z) and its unit; here Z up in metres by default. USD names
are letters, digits and underscores: the joints' own names are kept in ``jointNames``.
"""

from __future__ import annotations

import importlib
import io
import re
import struct
import tempfile
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from onbeat._shapes import Float32, Positions
from onbeat.errors import FormatError, MissingExtraError, OnbeatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, up_rotations, up_vectors
from onbeat.formats.usd.body import add_body, in_stage
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

SUFFIXES = (".usda", ".usdc", ".usd", ".usdz")
"""Text, binary, binary, and a package of binary; all hold the same."""
_MOST_LETTERS = 50_000_000


def write_usd(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a motion as a USD file: ``.usda`` as text, ``.usdc`` and ``.usd`` as binary, ``.usdz`` as a package.

    Parameters
    ----------
    convention : the stage's up axis and unit, by default Z up in metres.

    Raises
    ------
    MissingExtraError
        If usd-core is not installed.
    FormatError
        If X is to point up, which USD does not know, or the motion cannot be held.
    """
    path, convention = Path(path), convention or Convention("z", "m")
    if convention.up not in ("y", "z"):
        raise FormatError(
            f"cannot write {path}: USD knows Y up and Z up, not {convention.up.upper()} up; ask for one of them"
        )
    if path.suffix.lower() not in SUFFIXES:
        raise FormatError(f"cannot write {path}: a USD file ends in one of {', '.join(SUFFIXES)}")
    write_atomically(path, usd_bytes(motion, path.suffix.lower(), convention))


def usd_bytes(motion: Motion, suffix: str = ".usda", convention: Convention | None = None) -> bytes:
    """The bytes of a USD file of one of :data:`SUFFIXES`; the same motion gives the same bytes."""
    pxr = require_usd()
    stage = _stage(pxr, motion, convention or Convention("z", "m"))
    layer = stage.GetRootLayer()  # lives only as long as the stage
    if suffix == ".usda":
        return layer.ExportToString().encode()
    try:
        with tempfile.TemporaryDirectory() as folder:  # usd-core writes binary files by their path only
            made = Path(folder, "motion.usdc")
            layer.Export(str(made))
            binary = made.read_bytes()
    except (OSError, RuntimeError) as error:  # usd-core's own is a RuntimeError
        raise OnbeatError(f"cannot write to the temporary folder {tempfile.gettempdir()}: {error}") from None
    return _packed(binary) if suffix == ".usdz" else binary


def _packed(binary: bytes) -> bytes:
    """A package: a zip of one file, stored as it is and starting at a multiple of 64 bytes, without today's date."""
    info = zipfile.ZipInfo("motion.usdc")
    info.create_system = 3  # the same on every system
    start = 30 + len(info.filename)  # what a zip says before the file
    pad = -(start + 4) % 64
    info.extra = struct.pack("<HH", 0x1986, pad) + bytes(pad)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as package:
        package.writestr(info, binary)
    return buffer.getvalue()


def require_usd() -> Any:
    """The modules of usd-core, which is an extra; a ``MissingExtraError`` says how to get it."""
    try:
        names = ("Gf", "Sdf", "Usd", "UsdGeom", "UsdShade", "UsdSkel", "Vt")
        return SimpleNamespace(**{name: importlib.import_module(f"pxr.{name}") for name in names})
    except ImportError:
        raise MissingExtraError(
            "writing USD needs usd-core, which is not installed; run: pip install 'onbeat[usd]'"
        ) from None


def _stage(pxr: Any, motion: Motion, convention: Convention) -> Any:
    stage = pxr.Usd.Stage.CreateInMemory()
    pxr.UsdGeom.SetStageUpAxis(stage, convention.up.upper())
    pxr.UsdGeom.SetStageMetersPerUnit(stage, convention.metres)
    stage.SetTimeCodesPerSecond(motion.fps)
    stage.SetFramesPerSecond(motion.fps)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(motion) - 1)
    dancer = pxr.UsdSkel.Root.Define(stage, "/dancer")
    stage.SetDefaultPrim(dancer.GetPrim())
    pxr.Usd.ModelAPI(dancer.GetPrim()).SetKind("component")
    _add_skeleton(pxr, stage, motion.skeleton, convention)
    _add_animation(pxr, stage, motion, convention)
    add_body(pxr, stage, motion, standing(motion.skeleton), convention)
    return stage


def standing(skeleton: Skeleton) -> Positions:
    """(3,) metres, where the root is when the rest pose stands on the ground."""
    return np.array([0.0, 0.0, -float(skeleton.rest_positions[:, 2].min())])


def _add_skeleton(pxr: Any, stage: Any, skeleton: Skeleton, convention: Convention) -> None:
    made = pxr.UsdSkel.Skeleton.Define(stage, "/dancer/skeleton")
    stand = standing(skeleton)
    local = np.array(skeleton.offsets)
    local[0] = stand
    made.CreateJointsAttr(joint_paths(skeleton))
    made.CreateJointNamesAttr(skeleton.names)
    for attribute, places in (
        (made.CreateBindTransformsAttr(), skeleton.rest_positions + stand),
        (made.CreateRestTransformsAttr(), local),
    ):
        matrices = np.tile(np.eye(4), (len(skeleton), 1, 1))
        matrices[:, 3, :3] = up_vectors(places, convention.up) / convention.metres  # row vectors: p M
        attribute.Set(pxr.Vt.Matrix4dArray.FromNumpy(matrices))
    binding = pxr.UsdSkel.BindingAPI.Apply(made.GetPrim())
    binding.CreateAnimationSourceRel().SetTargets([pxr.Sdf.Path("/dancer/skeleton/motion")])


def joint_paths(skeleton: Skeleton) -> list[str]:
    """Each joint as the path from the root down to it, of names that USD allows and of which no two are alike.

    Examples
    --------
    >>> joint_paths(Skeleton(("rig:hips", "1", "rig hips"), [-1, 0, 1], [[0, 0, 0], [0, 0, 1], [0, 0, 1]]))
    ['rig_hips', 'rig_hips/_1', 'rig_hips/_1/rig_hips_2']
    """
    names = _valid_names(skeleton.names)
    paths: list[str] = []
    letters = 0
    for joint, parent in enumerate(skeleton.parents.tolist()):
        paths.append(f"{paths[parent]}/{names[joint]}" if joint else names[joint])
        letters += len(paths[-1])
        if letters > _MOST_LETTERS:
            raise FormatError(f"{skeleton.names[joint]!r} is too deep for USD, which spells out each joint's path")
    return paths


def _valid_names(names: tuple[str, ...]) -> list[str]:
    """ASCII identifiers, numbered from 2 where they would clash."""
    made: dict[str, None] = {}
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        plain = first = plain if plain and not plain[0].isdigit() else f"_{plain}"
        number = 1
        while plain in made:
            number += 1
            plain = f"{first}_{number}"
        made[plain] = None
    return list(made)


def _add_animation(pxr: Any, stage: Any, motion: Motion, convention: Convention) -> None:
    made = pxr.UsdSkel.Animation.Define(stage, "/dancer/skeleton/motion")
    made.CreateJointsAttr(joint_paths(motion.skeleton))
    made.CreateScalesAttr(pxr.Vt.Vec3hArray(len(motion.skeleton), pxr.Gf.Vec3h(1)))
    turned = rot.normalise(rot.continuous(up_rotations(motion.rotations, convention.up)))[..., [1, 2, 3, 0]]
    moved = _translations(motion, convention)
    rotations, translations = made.CreateRotationsAttr(), made.CreateTranslationsAttr()
    turned = np.ascontiguousarray(turned, np.float32)  # as Gf keeps a quaternion in memory: xyz, then w
    for frame in range(len(motion)):
        rotations.Set(pxr.Vt.QuatfArray.FromNumpy(turned[frame]), frame)
        translations.Set(pxr.Vt.Vec3fArray.FromNumpy(moved[frame]), frame)


def _translations(motion: Motion, convention: Convention) -> Float32:
    """(F, J, 3) each joint's place in its parent's frame, in the file's axes and unit."""
    fixed = np.broadcast_to(motion.skeleton.offsets, (len(motion), len(motion.skeleton), 3))
    moved = np.array(fixed if motion.translations is None else motion.translations)
    moved[:, 0] = motion.root_positions
    return in_stage(moved, convention)
