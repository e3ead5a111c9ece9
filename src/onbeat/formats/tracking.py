"""Tracking files: what policies that follow a motion are trained on (BeyondMimic's whole_body_tracking, mjlab).

An ``.npz`` with ``fps`` (1,), ``joint_pos`` and ``joint_vel`` (F, 29), and in the world, for each of the 30 links of
the Unitree G1, ``body_pos_w`` (F, 30, 3), ``body_quat_w`` (F, 30, 4) wxyz, ``body_lin_vel_w`` and ``body_ang_vel_w``
(F, 30, 3); metres, radians, Z up. Their makers' loaders go by place, not by name, and the places differ:

- ``mujoco``: depth first, limb after limb, as mjlab has it;
- ``isaac``: breadth first, left and right and waist in turn, as Isaac Lab, and so BeyondMimic, has it.

A file says nothing of its order (ours does: ``joint_names``, ``body_names``, which loaders ignore). It is the one in
which the robot's own kinematics puts the links where ``body_pos_w`` has them. Policies run at 50 Hz: resample first.
"""

from __future__ import annotations

import io
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention
from onbeat.formats.notes import tell
from onbeat.formats.rates import assumed
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_speeds
from onbeat.motion.unitree_g1 import G1, G1_23, LARGEST, LINKS, g1_angles, g1_motion

JointOrder = Literal["mujoco", "isaac"]
"""Whose order of joints and bodies."""
ASSUMED_FPS = 50.0
_NEEDED = ("joint_pos", "body_pos_w", "body_quat_w")
_TRIED = 64
_NEAR = 0.05
_MOST_BODIES = 500


def _depths() -> Ints:
    depths = np.zeros(len(LINKS), np.int64)
    for joint in G1.joints:
        depths[joint] = depths[G1.skeleton.parents[joint]] + 1
    return depths


_BREADTH_FIRST = np.argsort(_depths(), kind="stable")
ORDERS: Mapping[JointOrder, Ints] = {"mujoco": np.arange(len(LINKS)), "isaac": _BREADTH_FIRST}
"""(30,) which of our links stands at each place of a file's bodies; its joints are those less the pelvis."""


def is_tracking(keys: Collection[str]) -> bool:
    """Whether arrays of these names are a tracking file's."""
    return set(_NEEDED) <= set(keys)


def tracking_motion(arrays: Mapping[str, Any], label: str, fps: float | None = None) -> Motion:
    """The motion of a tracking file's arrays: the pelvis' path and the joints' angles.

    Parameters
    ----------
    arrays : by name, as :func:`numpy.load` gives them.
    label : the file, for messages; its stem is the motion's name.
    fps : the rate of its frames, where the stored one is wrong.

    Raises
    ------
    FormatError
        If an array is missing, of a wrong shape or not finite, or the joints are not the Unitree G1's.
    """
    positions = numbers(arrays, "body_pos_w", (-1, -1, 3), label)
    turns = numbers(arrays, "body_quat_w", (len(positions), positions.shape[1], 4), label)
    given = numbers(arrays, "joint_pos", (len(positions), -1), label)
    if not 0 < positions.shape[1] <= _MOST_BODIES:
        raise FormatError(
            f"{label}: body_pos_w holds {positions.shape[1]} bodies; the pelvis and other links are expected"
        )
    names = _names(arrays, "body_names", positions.shape[1], label)
    root = names.index("pelvis") if "pelvis" in names else 0
    path, root_turns = positions[:, root], turns[:, root]
    rate = fps if fps is not None else stored_rate(arrays, label)
    hinges = _names(arrays, "joint_names", given.shape[1], label)
    if hinges:
        angles = _named(given, hinges, label)
    elif given.shape[1] == len(G1.names):
        angles = _ordered(given, positions, path, root_turns, label)
    else:
        raise FormatError(f"{label}: {given.shape[1]} joints found; the Unitree G1 has 29 (or give joint_names)")
    return g1_motion(path, root_turns, angles, rate, Path(label).stem.removesuffix(".tracking"), label)


def numbers(arrays: Mapping[str, Any], key: str, shape: tuple[int, ...], label: str) -> Array:
    """One of a file's arrays as float64, checked; −1 in ``shape`` is any number.

    Raises
    ------
    FormatError
        If it is missing, of another shape, without a frame, or holds what is not a number or beyond all measure.
    """
    if key not in arrays:
        raise FormatError(f"{label}: no {key} found; an array of shape {_shown(shape)} is expected")
    raw = _array(arrays[key])
    if raw.dtype.kind not in "fiu":
        raise FormatError(f"{label}: {key} holds no numbers; shape {_shown(shape)} is expected")
    with np.errstate(all="ignore"):
        values: Array = raw.astype(np.float64)
    if values.ndim != len(shape) or any(n not in (-1, m) for n, m in zip(shape, values.shape, strict=True)):
        raise FormatError(f"{label}: {key} has the shape {values.shape}; {_shown(shape)} is expected")
    if not len(values):
        raise FormatError(f"{label}: {key} has no frames")
    good = (np.abs(values.reshape(len(values), -1)) < LARGEST).all(axis=1)
    if not good.all():
        raise FormatError(f"{label}: frame {int(np.argmin(good))} of {key} is not a number, or too large for one")
    return values


def _array(value: Any) -> NDArray[Any]:
    """A value as an array: of an object where it cannot be one of numbers or words."""
    try:
        return np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        return np.array(None)


def _shown(shape: tuple[int, ...]) -> str:
    return f"({', '.join(str(m) if m >= 0 else '…' if n else 'frames' for n, m in enumerate(shape))})"


def stored_rate(arrays: Mapping[str, Any], label: str, otherwise: float = ASSUMED_FPS) -> float:
    """The rate in ``fps``, a number or an array of one; where there is none, ``otherwise`` with a warning."""
    if arrays.get("fps") is None:
        return assumed(otherwise, f"{label} stores")
    rate = _array(arrays["fps"])
    if rate.size != 1 or rate.dtype.kind not in "fiu" or not 0.1 <= rate.reshape(-1)[0] <= 10000:
        raise FormatError(f"{label}: fps is {str(arrays['fps'])[:40]}; a number from 0.1 to 10000 is expected")
    return float(rate.reshape(-1)[0])


def _names(arrays: Mapping[str, Any], key: str, count: int, label: str) -> list[str]:
    """The names a file gives its joints or bodies; none where it gives none."""
    if key not in arrays:
        return []
    names = _array(arrays[key])
    if names.shape != (count,) or names.dtype.kind not in "US":
        raise FormatError(f"{label}: {key} has the shape {names.shape}; {count} names are expected")
    return [name.decode("latin-1") if isinstance(name, bytes) else str(name) for name in names.tolist()]


def _named(given: Array, names: list[str], label: str) -> Array:
    """Angles in our order by their names; those that only the larger G1 has may be missing."""
    angles, missing = np.zeros((len(given), len(G1.names))), [name for name in G1_23 if name not in names]
    if missing:
        raise FormatError(f"{label}: joint_names lacks {', '.join(missing[:4])}; the Unitree G1's joints are expected")
    for place, name in enumerate(G1.names):
        if name in names:
            angles[:, place] = given[:, names.index(name)]
    tell("joints", "by name", "the file stores joint_names")
    return angles


def _ordered(given: Array, positions: Positions, path: Positions, turns: Rotations, label: str) -> Array:
    """Angles in our order: of the two, that in which the links are where the file has its bodies."""
    some = np.unique(np.linspace(0, len(given) - 1, _TRIED).astype(np.int64))
    tried: dict[JointOrder, tuple[float, Array]] = {}
    for name, order in ORDERS.items():
        angles = given[:, np.argsort(order[1:])]
        tried[name] = _distance(angles[some], positions[some], path[some], turns[some], label), angles
    best = min(tried, key=lambda name: tried[name][0])
    apart = ", ".join(f"{away * 1000:.1f} mm in the order of {name}" for name, (away, _) in tried.items())
    if tried[best][0] > _NEAR:
        raise FormatError(
            f"{label}: the joints' angles do not put the links where body_pos_w has them ({apart} on average); "
            "is it another robot than the Unitree G1 with 29 joints?"
        )
    tell("joints", best, f"the links are {apart} from body_pos_w on average")
    return tried[best][1]


def _distance(angles: Array, positions: Positions, path: Positions, turns: Rotations, label: str) -> float:
    """Metres from the bodies to the nearest links, on average; whatever the order of the bodies."""
    links = g1_motion(path, turns, angles, 1.0, label=label).positions[:, : len(LINKS)]
    nearest = [np.linalg.norm(links - body[:, None], axis=-1).min(axis=1) for body in np.moveaxis(positions, 1, 0)]
    return float(np.mean(nearest))


def write_tracking(
    motion: Motion, path: str | Path, convention: Convention | None = None, joint_order: JointOrder = "mujoco"
) -> None:
    """Write a tracking file of a motion of the Unitree G1; velocities by central differences.

    Parameters
    ----------
    motion : at the rate at which it is to be played; BeyondMimic's and mjlab's policies take 50 a second.
    path : the ``.npz`` file.
    convention : always metres with Z up.
    joint_order : "mujoco" for mjlab, "isaac" for BeyondMimic's whole_body_tracking and Isaac Lab.

    Raises
    ------
    FormatError
        If the motion is of another body, or the order is not known.
    """
    if convention is not None and convention != Convention("z", "m"):
        raise FormatError("a tracking file is always in metres with Z up; leave the unit and the axis out")
    if joint_order not in ORDERS:
        raise FormatError(f"the joint order {joint_order!r} is not known; mujoco or isaac is expected")
    buffer = io.BytesIO()
    np.savez(buffer, **_arrays(motion, ORDERS[joint_order]))
    write_atomically(path, buffer.getvalue())


def _arrays(motion: Motion, order: Ints) -> dict[str, Any]:
    angles = g1_angles(motion, "a tracking file")
    joints = G1.found_in(motion.skeleton)[order]
    places = motion.positions[:, joints]
    tilts = np.concatenate((rot.IDENTITY[None], G1.links))[order]
    turns = rot.continuous(rot.normalise(rot.multiply(motion.world_rotations[:, joints], tilts)))
    kept: dict[str, Array] = {
        "joint_pos": angles[:, order[1:] - 1],
        "joint_vel": hinge_speeds(angles, motion.fps)[:, order[1:] - 1],
        "body_pos_w": places,
        "body_quat_w": turns,
        "body_lin_vel_w": hinge_speeds(places, motion.fps),
        "body_ang_vel_w": angular_velocities(turns, motion.fps),
    }
    rate = int(motion.fps) if motion.fps == int(motion.fps) else motion.fps
    names = {"joint_names": [G1.names[k - 1] for k in order[1:]], "body_names": [LINKS[k] for k in order]}
    return {"fps": [rate]} | {key: value.astype(np.float32) for key, value in kept.items()} | names


def angular_velocities(turns: Rotations, fps: float) -> Array:
    """Angular velocities (F, N, 3) in rad/s in the world of rotations (F, N, 4).

    ``ω_f = log(R_{f+1} R_{f−1}⁻¹) / 2Δt``, one-sided at the ends; zero for a single frame.

    Examples
    --------
    >>> turns = rot.about(np.array([0.0, 0.0, 1.0]), np.array([[0.0], [0.1], [0.2]]))
    >>> angular_velocities(turns, 30).round(9)[:, 0, 2].tolist()
    [3.0, 3.0, 3.0]
    """
    frames = np.arange(len(turns))
    after, before = np.minimum(frames + 1, len(turns) - 1), np.maximum(frames - 1, 0)
    moved = rot.log(rot.multiply(turns[after], rot.inverse(turns[before])))
    return moved * fps / np.maximum(after - before, 1)[:, None, None]
