"""The motion file formats there are: a format is one file, and one row here."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from onbeat.errors import FormatError
from onbeat.formats.acclaim.read import read_amc
from onbeat.formats.angles_csv import write_angles_csv
from onbeat.formats.bvh.read import read_bvh
from onbeat.formats.bvh.write import write_bvh
from onbeat.formats.c3d.read import read_c3d
from onbeat.formats.c3d.write import write_c3d
from onbeat.formats.conventions import Convention, Up
from onbeat.formats.glb import write_glb
from onbeat.formats.keyed import is_pkl, read_pkl
from onbeat.formats.npz import is_npz, read_npz, write_npz
from onbeat.formats.robot_csv import is_robot_csv, read_robot_csv, write_robot_csv
from onbeat.formats.tracking import write_tracking
from onbeat.formats.trc.read import read_trc
from onbeat.formats.trc.write import write_trc
from onbeat.formats.usd.write import write_usd
from onbeat.motion import Markers, Motion


class Reader(Protocol):
    """Reads one format, in metres with Z up.

    ``fps``, ``up`` and ``unit`` are what the user says of the file; they replace what it stores or leaves open.
    """

    def __call__(
        self, path: Path, /, fps: float | None = None, up: Up | None = None, unit: str | None = None
    ) -> Motion | Markers:
        """Read the file at ``path``."""
        ...


class Format(NamedTuple):
    """A file format: its suffix in lower case, and what reads and writes it, if anything does."""

    suffix: str
    title: str
    read: Reader | None = None
    write: Callable[[Motion, Path, Convention | None], None] | None = None
    write_markers: Callable[[Markers, Path, Convention | None], None] | None = None
    convention: Convention | None = None
    """What is written where nothing else is asked for; None where the format allows only one."""
    is_one: Callable[[Path], bool] | None = None
    """Tells motion from the other files of a folder that have this suffix; without it all are motion."""


SOUNDS = (".wav", ".flac", ".ogg", ".oga", ".opus", ".mp3", ".m4a", ".aac", ".aif", ".aiff")
"""Suffixes of songs, so that who gives one for motion is told."""
_MM_UP, _USD = Convention("z", "mm"), Convention("z", "m")
FORMATS = (
    Format(".bvh", "Biovision Hierarchy", read_bvh, write_bvh, convention=Convention("y", "cm")),
    Format(".amc", "Acclaim motion (its .asf beside it)", read_amc),
    Format(".c3d", "C3D markers", read_c3d, write_markers=write_c3d, convention=_MM_UP),
    Format(".trc", "TRC markers", read_trc, write_markers=write_trc, convention=Convention("y", "mm")),
    Format(".tracking.npz", "whole-body tracking, G1", None, write_tracking),
    Format(".npz", "onbeat, AMASS, SMPL, AIST++, tracking", read_npz, write_npz, is_one=is_npz),
    Format(".pkl", "AIST++, AMASS, GMR pickles", read_pkl, is_one=is_pkl),
    Format(".pickle", "AIST++, AMASS, GMR pickles", read_pkl, is_one=is_pkl),
    Format(".angles.csv", "joint angles", None, write_angles_csv),
    Format(".csv", "Unitree G1", read_robot_csv, write_robot_csv, is_one=is_robot_csv),
    Format(".glb", "binary glTF", None, write_glb),
    *(Format(suffix, "USD", None, write_usd, convention=_USD) for suffix in (".usda", ".usdc", ".usd", ".usdz")),
)
"""All formats; of two suffixes that fit a name, the first here counts."""


def reading(path: Path) -> Format:
    """The format that reads a file of this name; a ``FormatError`` lists those there are."""
    return _format(path, "read", [f for f in FORMATS if f.read])


def writing(path: Path) -> Format:
    """The format in which a file of this name is written; a ``FormatError`` lists those there are."""
    return _format(path, "write", [f for f in FORMATS if f.write or f.write_markers])


def _format(path: Path, verb: str, able: list[Format]) -> Format:
    for known in able:
        if path.name.lower().endswith(known.suffix):
            return known
    names = ", ".join(f.suffix for f in able)
    if path.suffix.lower() in SOUNDS:
        raise FormatError(f"{path} is a song; a motion file is expected here ({names})")
    raise FormatError(f"cannot {verb} {path}: the suffix {path.suffix!r} is not one of {names}")
