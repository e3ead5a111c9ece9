"""NumPy's ``.npz``: onbeat's own container, exact to the last bit, and the motions that others keep in one.

Keys of onbeat's own (version 1): ``onbeat_motion`` the version, ``names`` (J,), ``parents`` (J,), ``offsets`` (J, 3),
``end_sites`` (J,), ``rotations`` (F, J, 4) wxyz, ``root_positions`` (F, 3), ``fps``, ``name`` and, where offsets are
animated, ``translations`` (F, J, 3), where roles are told, ``roles``, a JSON object of joint names by role. Metres and
Z up.

Others are told by their keys: see :mod:`onbeat.formats.keyed`.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Ints, Rotations
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, Up
from onbeat.formats.keyed import is_keyed, keyed_motion
from onbeat.formats.named.arrays import NpzArrays, floats
from onbeat.motion import Motion, Skeleton

VERSION = 1
UNIT_WITHIN, EXACT_WITHIN = 1e-3, 1e-9
"""How far the length of a quaternion may be from 1, and up to where it is left as it is."""


def write_npz(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a motion whole; the file is always in metres with Z up."""
    if convention is not None and convention != Convention("z", "m"):
        raise FormatError("an .npz motion is always in metres with Z up; leave the unit and the axis out")
    s, buffer = motion.skeleton, io.BytesIO()
    _of_unit_length(motion.rotations, f"motion {motion.name!r}")
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
    if s.roles:
        kept["roles"] = np.array(msgspec.json.encode(dict(s.roles)).decode())
    np.savez(buffer, **kept)
    write_atomically(path, buffer.getvalue())


def read_npz(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read what :func:`write_npz` wrote, or another motion of named arrays; nothing in it is ever executed.

    Parameters
    ----------
    path : the ``.npz`` file.
    fps : the rate of its frames, where it stores none or a wrong one.
    up, unit : the axis that points up and the unit of length, for files of others that leave them open.

    Raises
    ------
    FormatError
        If it is damaged, a bomb, or of no known kind or version.
    """
    with NpzArrays(path) as arrays:
        if "onbeat_motion" in arrays:
            return _own(arrays, str(path), fps)
        return keyed_motion(arrays, str(path), fps, up, unit, others=["onbeat's own"])


def is_npz(path: Path) -> bool:
    """Whether an ``.npz`` is a motion, by its keys; a damaged one is taken for one, so that its reader tells."""
    try:
        with NpzArrays(path) as arrays:
            return "onbeat_motion" in arrays or is_keyed(arrays)
    except FormatError:
        return True


def _own(arrays: NpzArrays, label: str, fps: float | None) -> Motion:
    version = arrays["onbeat_motion"]
    if version.shape != () or version.dtype.kind not in "iu" or int(version) != VERSION:
        raise FormatError(
            f"{label}: version {VERSION} of an onbeat motion is expected, {str(version)[:40]} found; convert it again"
        )
    try:
        rotations = _of_unit_length(floats(arrays, "rotations", label), label)
        translations = floats(arrays, "translations", label) if "translations" in arrays else None
        rate = float(floats(arrays, "fps", label)) if fps is None else fps
        path, name = floats(arrays, "root_positions", label), _texts(arrays, "name", label, 0)[0]
        return Motion(_skeleton(arrays, label), rotations, path, rate, name, translations)
    except KeyError as error:
        raise FormatError(f"{label}: not a whole motion: {error} is missing") from None
    except (ValueError, TypeError, FormatError) as error:
        raise FormatError(f"{label}: not a whole motion: {str(error).removeprefix(f'{label}: ')}") from None


def _skeleton(arrays: Mapping[str, NDArray[Any]], label: str) -> Skeleton:
    names, ends = _texts(arrays, "names", label, 1), arrays["end_sites"]
    if ends.dtype.kind != "b":
        raise FormatError(f"{label}: 'end_sites' of type {ends.dtype}; booleans are expected")
    roles = _roles(_texts(arrays, "roles", label, 0)[0], label) if "roles" in arrays else {}
    return Skeleton(names, _whole(arrays, "parents", label), floats(arrays, "offsets", label), ends, roles=roles)


def _whole(arrays: Mapping[str, NDArray[Any]], key: str, label: str) -> Ints:
    found = arrays[key]
    if found.dtype.kind not in "iu":
        raise FormatError(f"{label}: {key!r} of type {found.dtype}; whole numbers are expected")
    return found.astype(np.int64)


def _texts(arrays: Mapping[str, NDArray[Any]], key: str, label: str, axes: int) -> list[str]:
    found = arrays[key]
    if found.dtype.kind != "U" or found.ndim != axes:
        raise FormatError(f"{label}: {key!r} of type {found.dtype} and shape {found.shape}; text is expected")
    return [str(text) for text in found.reshape(-1).tolist()]


def _roles(text: str, label: str) -> dict[str, str]:
    try:
        return msgspec.json.decode(text, type=dict[str, str])
    except (msgspec.MsgspecError, RecursionError):
        raise FormatError(f"{label}: 'roles' are {text[:40]!a}; a JSON object of texts is expected") from None


def _of_unit_length(rotations: Rotations, label: str) -> Rotations:
    """The same quaternions, rounding in them put right; a ``FormatError`` where they are no rotations."""
    if rotations.ndim != 3 or rotations.shape[2] != 4 or not rotations.size:
        return rotations  # the motion itself tells what is wrong
    with np.errstate(all="ignore"):
        off = np.abs(np.sqrt(np.einsum("fjk,fjk->fj", rotations, rotations)) - 1)
    if not off.max() <= UNIT_WITHIN:
        frame, joint = np.unravel_index(int(np.argmax(off)), off.shape)
        raise FormatError(
            f"{label}: the rotation of joint {joint} at frame {frame} is {rotations[frame, joint].tolist()}; "
            "unit quaternions wxyz are expected"
        )
    rounded = off > EXACT_WITHIN
    if rounded.any():
        rotations = rotations.copy()
        rotations[rounded] /= np.linalg.norm(rotations[rounded], axis=-1, keepdims=True)
    return rotations
