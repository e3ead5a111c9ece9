"""onbeat's own container: one NumPy ``.npz`` with everything a motion has, exact to the last bit.

Keys (version 1): ``onbeat_motion`` the version, ``names`` (J,), ``parents`` (J,), ``offsets`` (J, 3), ``end_sites``
(J,), ``rotations`` (F, J, 4) wxyz, ``root_positions`` (F, 3), ``fps``, ``name`` and, where offsets are animated,
``translations`` (F, J, 3). Metres, Z up.
"""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, Up
from onbeat.motion import Motion, Skeleton

VERSION = 1


def write_npz(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a motion whole; the file is always in metres with Z up."""
    if convention is not None and convention != Convention("z", "m"):
        raise FormatError("an .npz motion is always in metres with Z up; leave the unit and the axis out")
    s, buffer = motion.skeleton, io.BytesIO()
    kept: dict[str, Any] = {
        "onbeat_motion": VERSION,
        "names": np.array(s.names),
        "parents": s.parents,
        "offsets": s.offsets,
        "end_sites": s.end_sites,
        "rotations": motion.rotations,
        "root_positions": motion.root_positions,
        "fps": motion.fps,
        "name": np.array(motion.name),
    }
    if motion.translations is not None:
        kept["translations"] = motion.translations
    np.savez(buffer, **kept)
    write_atomically(path, buffer.getvalue())


def read_npz(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read what :func:`write_npz` wrote; nothing in it is ever executed.

    Raises
    ------
    FormatError
        If it is not such a file, or of a version that is not known.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            kept = {key: file[key] for key in file.files}
    except (OSError, ValueError, EOFError, KeyError, NotImplementedError, zipfile.BadZipFile) as error:
        raise FormatError(f"cannot read {path} as a motion: {error}") from None
    version = kept.get("onbeat_motion")
    if version is None or version.shape != () or int(version) != VERSION:
        raise FormatError(
            f"{path}: version {VERSION} of an onbeat motion is expected, {version} found; convert it again"
        )
    try:
        skeleton = Skeleton([str(n) for n in kept["names"]], kept["parents"], kept["offsets"], kept["end_sites"])
        rate = float(kept["fps"]) if fps is None else fps
        translations = kept.get("translations")
        return Motion(skeleton, kept["rotations"], kept["root_positions"], rate, str(kept["name"]), translations)
    except (KeyError, ValueError, TypeError, FormatError) as error:
        raise FormatError(f"{path}: not a whole motion: {error}") from None
