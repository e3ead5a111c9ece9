"""Reading and writing motion files by their suffix: a format is one file and one row here."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from onbeat.errors import FormatError
from onbeat.formats.asfamc import read_amc
from onbeat.formats.bvh import read_bvh
from onbeat.formats.bvh_write import write_bvh
from onbeat.formats.conventions import Convention, Up
from onbeat.formats.glb import write_glb
from onbeat.formats.npz import read_npz, write_npz
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


Writer = Callable[[Motion, Path, Convention | None], None]
MarkersWriter = Callable[[Markers, Path, Convention | None], None]


class Format(NamedTuple):
    """A file format: its suffix in lower case, and what reads and writes it, if anything does."""

    suffix: str
    read: Reader | None = None
    write: Writer | None = None
    write_markers: MarkersWriter | None = None
    convention: Convention | None = None
    """What is written where nothing else is asked for; None where the format allows only one."""
    is_one: Callable[[Path], bool] | None = None
    """Tells motion from the other files of a folder that have this suffix; without it all are motion."""


FORMATS = (
    Format(".bvh", read_bvh, write_bvh, convention=Convention("y", "cm")),
    Format(".amc", read_amc),
    Format(".npz", read_npz, write_npz),
    Format(".glb", write=write_glb),
)


def _format(path: Path, verb: str, able: list[Format]) -> Format:
    for known in able:
        if path.suffix.lower() == known.suffix:
            return known
    names = ", ".join(f.suffix for f in able)
    raise FormatError(f"cannot {verb} {path}: the suffix {path.suffix!r} is not one of {names}")


def read_file(
    path: str | os.PathLike[str], fps: float | None = None, up: Up | None = None, unit: str | None = None
) -> Motion | Markers:
    """Read a file of any known format as what it holds: a body's motion or markers; see :func:`read_motion`."""
    path = Path(path)
    read = _format(path, "read", [f for f in FORMATS if f.read]).read
    assert read is not None
    if fps is not None and not 0.1 <= fps <= 10000:
        raise FormatError(f"{fps:g} frames a second cannot be; give a rate from 0.1 to 10000")
    if not path.is_file():
        raise FormatError(f"no file {path}" if not path.is_dir() else f"{path} is a folder; give a motion file")
    return read(path, fps, up, unit)


def read_motion(
    path: str | os.PathLike[str], fps: float | None = None, up: Up | None = None, unit: str | None = None
) -> Motion:
    """Read a motion file of any known format, in metres with Z up.

    Parameters
    ----------
    path : the file; an ``.amc`` needs its ``.asf`` beside it.
    fps : the rate of its frames, where the file stores none (AMC: 120 is assumed with a warning) or a wrong one.
    up, unit : the axis that points up and the unit of length, where the file leaves them open (BVH) or is wrong.

    Raises
    ------
    FormatError
        If the file is missing, of no known format, or damaged.
    """
    found = read_file(path, fps, up, unit)
    if isinstance(found, Markers):
        raise FormatError(f"{path} holds markers, not a body's motion")
    return found


def _asked(known: Format, up: Up | None, unit: str | None) -> Convention | None:
    """What to write: what is asked for, and the format's own where nothing is."""
    if up is None and unit is None:
        return known.convention
    usual = known.convention or Convention("z", "m")
    return Convention(up or usual.up, unit or usual.unit)


def write_motion(
    motion: Motion,
    path: str | os.PathLike[str],
    convention: Convention | None = None,
    *,
    up: Up | None = None,
    unit: str | None = None,
) -> None:
    """Write a motion in the format of the path's suffix (``.bvh``, ``.glb`` or ``.npz``).

    Parameters
    ----------
    convention : up axis and unit where the format leaves them free: BVH, by default Y up in centimetres.
    up, unit : one of them alone; the other is then the format's own.

    Raises
    ------
    FormatError
        If the format is not known or does not allow the convention.
    """
    known = _format(Path(path), "write", [f for f in FORMATS if f.write])
    assert known.write is not None
    known.write(motion, Path(path), convention or _asked(known, up, unit))


def write_markers(
    markers: Markers,
    path: str | os.PathLike[str],
    convention: Convention | None = None,
    *,
    up: Up | None = None,
    unit: str | None = None,
) -> None:
    """Write markers in the format of the path's suffix; see :func:`write_motion`."""
    known = _format(Path(path), "write markers to", [f for f in FORMATS if f.write_markers])
    assert known.write_markers is not None
    known.write_markers(markers, Path(path), convention or _asked(known, up, unit))


def motion_files(folder: str | os.PathLike[str]) -> list[Path]:
    """The readable motion files in a folder and all folders in it, sorted; hidden ones are left out."""
    readable = {f.suffix: f for f in FORMATS if f.read}
    root = Path(folder)
    if not root.is_dir():
        raise FormatError(f"no folder {root}; give a folder of motion files")
    found = (p for p in root.rglob("*") if p.suffix.lower() in readable and p.is_file())
    shown = (p for p in found if not any(part.startswith(".") for part in p.relative_to(root).parts))
    return sorted(p for p in shown if (is_one := readable[p.suffix.lower()].is_one) is None or is_one(p))
