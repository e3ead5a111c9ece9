"""Writing a motion or markers in the format of the file's name."""

from __future__ import annotations

import os
from pathlib import Path

from onbeat.errors import FormatError
from onbeat.formats.conventions import Convention, Up
from onbeat.formats.registry import Format, writing
from onbeat.motion import Markers, Motion
from onbeat.motion.joint_markers import joint_markers


def write_motion(
    motion: Motion,
    path: str | os.PathLike[str],
    convention: Convention | None = None,
    *,
    up: Up | None = None,
    unit: str | None = None,
) -> None:
    """Write a motion in the format of the path's suffix; in a format of markers, its joints are the markers.

    Parameters
    ----------
    convention : up axis and unit where the format leaves them free: BVH, by default Y up in centimetres.
    up, unit : one of them alone; the other is then the format's own.

    Raises
    ------
    FormatError
        If the format is not known, does not allow the convention or cannot hold this body.
    """
    known, asked = _asked(Path(path), convention, up, unit)
    if known.write is None:
        write_markers(joint_markers(motion), path, asked)
    else:
        known.write(motion, Path(path), asked)


def write_markers(
    markers: Markers,
    path: str | os.PathLike[str],
    convention: Convention | None = None,
    *,
    up: Up | None = None,
    unit: str | None = None,
) -> None:
    """Write markers as C3D or TRC; see :func:`write_motion`."""
    known, asked = _asked(Path(path), convention, up, unit)
    if known.write_markers is None:
        raise FormatError(f"cannot write markers to {path}: {known.suffix} holds a body's motion; use .c3d or .trc")
    known.write_markers(markers, Path(path), asked)


def _asked(
    path: Path, convention: Convention | None, up: Up | None, unit: str | None
) -> tuple[Format, Convention | None]:
    """The format, and the convention to write: what is asked for, and the format's own where nothing is."""
    known = writing(path)
    if convention is not None or (up is None and unit is None):
        return known, convention or known.convention
    usual = known.convention or Convention("z", "m")
    return known, Convention(up or usual.up, unit or usual.unit)
