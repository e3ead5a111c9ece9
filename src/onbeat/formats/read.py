"""Reading any motion file: what it holds, as a body's motion, as markers."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from onbeat.capture.fit import Fit, fit_body
from onbeat.errors import BodyError, FormatError
from onbeat.formats.conventions import Up
from onbeat.formats.notes import tell
from onbeat.formats.registry import FORMATS, reading
from onbeat.motion import Body, Markers, Motion, Skeleton
from onbeat.motion.handedness import MIRRORED, is_mirrored
from onbeat.motion.role_file import FOLDER_FILE, Roles, read_roles, roles_beside
from onbeat.motion.roles import find_roles

FAR_OFF_MM = 25.0


class FitWarning(UserWarning):
    """A body was fitted to markers, and something of it was guessed or is far off."""


class MirroredWarning(UserWarning):
    """A body is its own mirror image, as in files of left-handed axes."""


def read_file(
    path: str | os.PathLike[str],
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
    roles: Roles | None = None,
) -> Motion | Markers:
    """Read a file of any known format as what it holds: a body's motion or markers; see :func:`read_motion`."""
    path = Path(path)
    read = reading(path).read
    assert read is not None
    if fps is not None and not 0.1 <= fps <= 10000:
        raise FormatError(f"{fps:g} frames a second cannot be; give a rate from 0.1 to 10000")
    if not path.is_file():
        what = "is a folder" if path.is_dir() else "is no file that can be read" if os.path.lexists(path) else ""
        raise FormatError(f"{path} {what}; give a motion file" if what else f"no file {path}")
    found = read(path, fps, up, unit)
    told = _roles(path, roles)
    if isinstance(found, Markers):
        return found
    if told is not None and told.joints:
        found = found.replace(skeleton=_told(found.skeleton, told, of_folder=roles is None))
    if "guess" in find_roles(found.skeleton).how.values():
        tell("roles", "guessed", "no names tell arms and legs; the rest pose does")
    _warn_if_mirrored(found, path)
    return found


def read_motion(
    path: str | os.PathLike[str],
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
    roles: Roles | None = None,
) -> Motion:
    """Read a motion file of any known format, in metres with Z up; to markers a body is fitted.

    Parameters
    ----------
    path : the file; an ``.amc`` needs its ``.asf`` beside it.
    fps : the rate of its frames, where the file stores none (AMC: 120 is assumed with a warning) or a wrong one.
    up, unit : the axis that points up and the unit of length, where the file leaves them open (BVH) or is wrong.
    roles : which joints or markers are what, where their names do not tell; without it the roles file beside
        ``path``, if there is one (see :mod:`onbeat.motion.role_file`).

    Raises
    ------
    FormatError
        If the file is missing, of no known format, or damaged.
    BodyError
        If it holds markers of which no body can be made.
    """
    found = read_file(path, fps, up, unit, roles)
    return found if isinstance(found, Motion) else fitted(found, path, roles).motion


def read_markers(
    path: str | os.PathLike[str], fps: float | None = None, up: Up | None = None, unit: str | None = None
) -> Markers:
    """Read the markers of a C3D or TRC file, in metres with Z up; NaN where one is not seen.

    Raises
    ------
    FormatError
        If the file is missing, damaged, or holds a body's motion instead.
    """
    found = read_file(path, fps, up, unit)
    if isinstance(found, Motion):
        raise FormatError(f"{path} holds a body's motion, no markers; `read_motion` reads it")
    return found


def fitted(markers: Markers, path: str | os.PathLike[str], roles: Roles | None = None) -> Fit:
    """The body fitted to the markers of a file, told as notes; a :class:`FitWarning` where they are far off it.

    Raises
    ------
    BodyError
        If the markers do not tell a whole body; the file is named.
    """
    told = _roles(Path(path), roles)
    if told is not None and told.joints and Path(told.source).name != FOLDER_FILE:
        raise FormatError(f"{told.source}: [joints] is of bodies, but {path} holds markers; say them in [markers]")
    try:
        fit = fit_body(markers, told.markers if told and told.markers else None)
    except BodyError as error:
        raise BodyError(f"{path}: {str(error).removeprefix(f'{markers.name}: ')}") from None
    name, (summary, *more) = Path(path).name, fit.report
    tell("body", "fitted to the markers", summary)
    for line in more:
        tell("markers", "", line)
    if fit.residual_mm > FAR_OFF_MM or fit.support.min() < 1:
        ask = f"; {len(more)} more to know: `onbeat info {name}`" if more else ""
        warnings.warn(f"{name}: a body was fitted: {summary}{ask}", FitWarning, stacklevel=3)
    # The clip is not cut: its time is that of sound and other cameras. But whoever dances it has to know.
    _warn_if_mirrored(fit.motion, Path(path), stacklevel=4)
    first, end = fit.trusted
    if (first, end) != (0, len(markers)):
        span = f"{first / markers.fps:.2f} s to {end / markers.fps:.2f} s"
        warnings.warn(f"{name}: only from {span} are half of its markers seen", FitWarning, stacklevel=3)
    return fit


def _warn_if_mirrored(motion: Motion, path: Path, stacklevel: int = 3) -> None:
    try:
        body = Body.of(motion.skeleton)
    except BodyError:
        return
    if is_mirrored(motion, body):
        warnings.warn(f"{path.name}: {MIRRORED}", MirroredWarning, stacklevel=stacklevel)


def _roles(path: Path, roles: Roles | None) -> Roles | None:
    if roles is not None:
        return roles
    beside = roles_beside(path)
    return None if beside is None else read_roles(beside)


def _told(skeleton: Skeleton, roles: Roles, of_folder: bool) -> Skeleton:
    """The skeleton with its roles; a file that is for a whole folder may be of other bodies in it."""
    if of_folder and Path(roles.source).name == FOLDER_FILE:
        strangers = [name for name in roles.joints.values() if name not in skeleton.names]
        if strangers:
            tell("roles", f"not those of {FOLDER_FILE}", f"it is of another body: there is no {strangers[0]!r}")
            return skeleton
    return roles.told(skeleton)


def motion_files(folder: str | os.PathLike[str]) -> list[Path]:
    """The readable motion files in a folder and all folders in it, sorted; hidden ones are left out."""
    readable = {f.suffix: f for f in FORMATS if f.read}
    root = Path(folder)
    if not root.is_dir():
        raise FormatError(f"no folder {root}; give a folder of motion files")
    found = (p for p in root.rglob("*") if p.suffix.lower() in readable and p.is_file())
    shown = (p for p in found if not any(part.startswith(".") for part in p.relative_to(root).parts))
    return sorted(p for p in shown if (is_one := readable[p.suffix.lower()].is_one) is None or is_one(p))
