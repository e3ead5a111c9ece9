"""Reading and writing motion files by their suffix: a format is one file and one row here."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from onbeat.errors import FormatError
from onbeat.formats.asfamc import read_amc
from onbeat.formats.bvh import read_bvh, write_bvh
from onbeat.formats.conventions import Convention
from onbeat.formats.glb import write_glb
from onbeat.formats.npz import read_npz, write_npz
from onbeat.motion import Motion

Reader = Callable[[Path, float | None], Motion]
Writer = Callable[[Motion, Path, Convention | None], None]


class Format(NamedTuple):
    """A motion format: its suffix in lower case, and what reads and writes it, if anything does."""

    suffix: str
    read: Reader | None
    write: Writer | None


FORMATS = (
    Format(".bvh", read_bvh, write_bvh),
    Format(".amc", read_amc, None),
    Format(".npz", read_npz, write_npz),
    Format(".glb", None, write_glb),
)


def _format(path: Path, verb: str) -> Format:
    able = [f for f in FORMATS if (f.read if verb == "read" else f.write)]
    for known in able:
        if path.suffix.lower() == known.suffix:
            return known
    names = ", ".join(f.suffix for f in able)
    raise FormatError(f"cannot {verb} {path}: the suffix {path.suffix!r} is not one of {names}")


def read_motion(path: str | os.PathLike[str], fps: float | None = None) -> Motion:
    """Read a motion file of any known format, in metres with Z up.

    Parameters
    ----------
    path : a ``.bvh``, ``.amc`` (with its ``.asf`` beside it) or ``.npz`` file.
    fps : the rate of its frames, where the file stores none (AMC: 120 is assumed with a warning) or a wrong one.

    Raises
    ------
    FormatError
        If the file is missing, of no known format, or damaged.
    """
    path = Path(path)
    read = _format(path, "read").read
    assert read is not None
    if not path.is_file():
        raise FormatError(f"no file {path}" if not path.is_dir() else f"{path} is a folder; give a motion file")
    return read(path, fps)


def write_motion(motion: Motion, path: str | os.PathLike[str], convention: Convention | None = None) -> None:
    """Write a motion in the format of the path's suffix (``.bvh``, ``.glb`` or ``.npz``).

    Parameters
    ----------
    convention : up axis and unit where the format leaves them free: BVH, by default Y up in centimetres.

    Raises
    ------
    FormatError
        If the format is not known or does not allow the convention.
    """
    write = _format(Path(path), "write").write
    assert write is not None
    write(motion, Path(path), convention)


def motion_files(folder: str | os.PathLike[str]) -> list[Path]:
    """The readable motion files in a folder and all folders in it, sorted; hidden ones are left out."""
    suffixes = {f.suffix for f in FORMATS if f.read}
    root = Path(folder)
    if not root.is_dir():
        raise FormatError(f"no folder {root}; give a folder of motion files")
    found = (p for p in root.rglob("*") if p.suffix.lower() in suffixes and p.is_file())
    return sorted(p for p in found if not any(part.startswith(".") for part in p.relative_to(root).parts))
