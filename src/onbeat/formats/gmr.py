"""GMR's robot motions (General Motion Retargeting): arrays by name, usually pickled.

``fps``, ``root_pos`` (F, 3) in metres with Z up, ``root_rot`` (F, 4) **xyzw**, ``dof_pos`` (F, 29) radians in the
order of the Unitree G1's MJCF (or 23); ``local_body_pos`` and ``link_body_list`` are not needed. Only what the
dictionary holds is handled here; pickles are never executed.
"""

from __future__ import annotations

import io
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from onbeat.files import write_atomically
from onbeat.formats.tracking import numbers, stored_rate
from onbeat.motion import Motion
from onbeat.motion.unitree_g1 import g1_angles, g1_motion


def is_gmr(keys: Collection[str]) -> bool:
    """Whether a dictionary with these keys is a GMR motion."""
    return {"root_pos", "root_rot", "dof_pos"} <= set(keys)


def gmr_motion(arrays: Mapping[str, Any], label: str, fps: float | None = None) -> Motion:
    """The motion of a GMR dictionary.

    Parameters
    ----------
    arrays : by key.
    label : the file, for messages; its stem is the motion's name.
    fps : the rate of its frames, where the stored one is wrong.

    Raises
    ------
    FormatError
        If an array is missing, of a wrong shape or not finite, or the robot is not the Unitree G1.

    Examples
    --------
    >>> still = {"fps": 30, "root_pos": np.zeros((2, 3)), "root_rot": [[0, 0, 0, 1]] * 2, "dof_pos": np.zeros((2, 29))}
    >>> gmr_motion(still, "still.pkl").duration
    0.06666666666666667
    """
    path = numbers(arrays, "root_pos", (-1, 3), label)
    turns = numbers(arrays, "root_rot", (len(path), 4), label)
    angles = numbers(arrays, "dof_pos", (len(path), -1), label)
    rate = fps if fps is not None else stored_rate(arrays, label, otherwise=30)
    return g1_motion(path, turns[:, [3, 0, 1, 2]], angles, rate, Path(label).stem, label)


def gmr_arrays(motion: Motion) -> dict[str, Any]:
    """The GMR dictionary of a motion of the Unitree G1; a ``FormatError`` where it is of another body."""
    return {
        "fps": motion.fps,
        "root_pos": np.array(motion.root_positions),
        "root_rot": motion.rotations[:, 0, [1, 2, 3, 0]],
        "dof_pos": g1_angles(motion, "a GMR dictionary"),
    }


def write_gmr(motion: Motion, path: str | Path) -> None:
    """Write the GMR dictionary of a motion of the Unitree G1 as ``.npz``: the same keys, and nothing to unpickle.

    Raises
    ------
    FormatError
        If the motion is of another body, or the file cannot be written.
    """
    buffer = io.BytesIO()
    np.savez(buffer, **gmr_arrays(motion))
    write_atomically(path, buffer.getvalue())
