"""Which kind of motion a file of named arrays holds, told by the names: SMPL's family, tracking files, GMR."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from onbeat.errors import FormatError
from onbeat.formats.conventions import Up
from onbeat.formats.gmr import gmr_motion, is_gmr
from onbeat.formats.named.pickled import load_pickled_arrays
from onbeat.formats.smpl.read import is_smpl, smpl_motion
from onbeat.formats.tracking import is_tracking, tracking_motion
from onbeat.motion import Motion

KINDS = (
    "SMPL, AMASS, AIST++ (poses or smpl_poses with trans or smpl_trans)",
    "tracking files (joint_pos, body_pos_w, body_quat_w)",
    "GMR (root_pos, root_rot, dof_pos)",
)


def read_pkl(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read a pickled dictionary of arrays (AIST++, GMR, …) as a motion; nothing in it is ever executed.

    Parameters
    ----------
    path : the ``.pkl`` file.
    fps : the rate of its frames, where it stores none or a wrong one.
    up, unit : the axis that points up and the unit of length, where they are not what the data look like.

    Raises
    ------
    FormatError
        If the file needs anything but plain arrays, is damaged, or of no known kind.
    """
    return keyed_motion(load_pickled_arrays(path), str(path), fps, up, unit)


def is_keyed(keys: Collection[str]) -> bool:
    """Whether arrays of these names are a motion of one of the kinds."""
    return is_smpl(keys) or is_tracking(keys) or is_gmr(keys)


def is_pkl(path: Path) -> bool:
    """Whether a pickle is a motion: anything may be pickled, and what is refused is taken for something else."""
    try:
        return is_keyed(load_pickled_arrays(path))
    except FormatError:
        return False


def keyed_motion(
    arrays: Mapping[str, NDArray[Any]],
    label: str,
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
    others: Collection[str] = (),
) -> Motion:
    """The motion of named arrays, by the names; ``others`` are kinds to name where none is known.

    Raises
    ------
    FormatError
        If no kind has these names (they are listed), or its reader refuses.
    """
    if is_smpl(arrays):
        return smpl_motion(arrays, label, fps, up, unit)
    robots = tracking_motion if is_tracking(arrays) else gmr_motion if is_gmr(arrays) else None
    if robots is not None:
        if up not in (None, "z") or unit not in (None, "m"):
            raise FormatError(f"{label}: a robot's motion is in metres with Z up; leave the axis and the unit out")
        return robots(arrays, label, fps)
    raise FormatError(f"{label}: arrays called {named(arrays)} found; known are {'; '.join([*others, *KINDS])}")


def named(keys: Collection[str]) -> str:
    """Names for a message: the first few, shortened.

    Examples
    --------
    >>> named(["a", "b"]), named([])
    ("'a', 'b'", 'nothing')
    """
    shown = [ascii(key[:30]) for key in list(keys)[:12]]
    return ", ".join(shown + ["…"] * (len(keys) > 12)) or "nothing"
