"""Motion of the SMPL family (AMASS, AIST++, EDGE, PHC and what regressors of video write), without the model.

Poses are rotation vectors of 22, 24, 52 or 55 joints, the first turning the whole body; a path comes with them. The
body is the mean skeleton of :mod:`onbeat.formats.smpl.body`: shapes (``betas``) mean nothing without SMPL's own model.

SMPL's rest pose has Y up and looks along +Z. With Q the turn of that to Z up, a body joint turns by ``Q q Q⁻¹``. In a
world that T turns to Z up, the root turns by ``T R Q⁻¹``: the turn Q has to go out of it, for the offsets have it.

The path is not quite the pelvis: SMPL adds the pelvis of its rest pose, some 0.2 m down its own Y, without turning it.
With Z up that is a shift on the ground and heights are good, so they tell the size of the body: that with which its
standing feet reach the floor. With Y up the height is open, and the body of mean size is put on the floor.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.errors import FormatError
from onbeat.formats.conventions import UNITS, Convention, Up, z_up_rotations, z_up_vectors
from onbeat.formats.named.arrays import floats
from onbeat.formats.notes import tell
from onbeat.formats.rates import assumed
from onbeat.formats.smpl.body import FINGER_JOINTS, ORDERS, PELVIS, SOLE, STATURE, smpl_skeleton
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.retarget import floor_height

POSES = ("poses", "smpl_poses", "pose_aa", "fullpose")
ROOTS, BODIES = ("root_orient", "global_orient"), ("pose_body", "body_pose")
HANDS = (("pose_hand",), ("left_hand_pose", "right_hand_pose"))
PATHS = ("trans", "smpl_trans", "transl", "root_trans_offset")
RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "frame_rate", "framerate")
_LARGEST_TURN, _LARGEST_PATH = 1e4, 1e7
_SAMPLES = 20_000
"""So many frames of a motion tell its floor."""
_SIZES = (0.82, 1.2)
_LYING = 0.5
"""Metres (of metric files) below which the pelvis of a body is that lies or sits."""
"""Bodies from 1.40 to 2.04 m."""


def is_smpl(keys: Collection[str]) -> bool:
    """Whether arrays of these names are poses and a path of the SMPL family.

    Examples
    --------
    >>> is_smpl({"poses", "trans", "betas", "mocap_framerate"}), is_smpl({"smpl_poses"})
    (True, False)
    """
    whole = _first(keys, POSES) or (_first(keys, ROOTS) and _first(keys, BODIES))
    return bool(whole and _first(keys, PATHS))


def smpl_motion(
    arrays: Mapping[str, NDArray[Any]],
    label: str,
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
) -> Motion:
    """The motion of a file's arrays on the mean body, in metres with Z up.

    Parameters
    ----------
    arrays : by name; only those needed are asked for.
    label : the file, for messages; its stem is the motion's name.
    fps : the rate of its frames, where the file stores none (60 for AIST++, else 30 is assumed with a warning).
    up : the axis that points up; without it that which files with these keys have, else along which the body stands.
    unit : of the path; without it metres, or what makes the body's height one.

    Raises
    ------
    FormatError
        If an array is missing, of a wrong shape, or not finite.
    """
    poses, path = _poses(arrays, label), _path(arrays, label)
    if len(poses) != len(path):
        raise FormatError(f"{label}: poses of {len(poses)} frames, but a path of {len(path)}; cut both alike")
    rate = _rate(arrays, label) if fps is None else fps
    turn = rot.exp(poses[:, 0])
    axis, turn, path = _upright(turn, path, up, _usual_up(arrays))
    metres = UNITS[_unit(path, axis, label)] if unit is None else Convention("z", unit).metres
    rotations, fingers = _local(poses, turn, axis)
    path = z_up_vectors(path, axis) * metres
    tell("body", "a mean body", "the shape that a file stores needs SMPL's licensed model")
    return _standing(Motion(smpl_skeleton(fingers), rotations, path, rate, Path(label).stem), fingers, axis)


def _first(keys: Collection[str], names: tuple[str, ...]) -> str | None:
    return next((name for name in names if name in keys), None)


def _vectors(arrays: Mapping[str, NDArray[Any]], key: str, label: str, largest: float, single: bool = False) -> Array:
    """An array of (frames, …) as (frames, N, 3), with ``single`` N = 1 expected; a batch of one is opened."""
    shape: tuple[int, ...] = arrays[key].shape
    batch = len(shape) >= 3 and shape[0] == 1 and (single or shape[-1] != 3)
    inner = list(shape[1:] if batch else shape)
    joints, odd = divmod(int(np.prod(inner[1:])), 3)
    if len(inner) not in (2, 3) or (len(inner) == 3 and inner[2] != 3) or odd or not joints or not inner[0]:
        raise FormatError(f"{label}: {key!r} has the shape {shape}; (frames, 3 × joints) is expected, axis times angle")
    values = floats(arrays, key, label).reshape(inner[0], joints, 3)
    if np.abs(values).max() > largest:
        frame = int(np.argmax(np.abs(values).max((1, 2)) > largest))
        raise FormatError(f"{label}: {key!r} has {np.abs(values[frame]).max():g} at frame {frame}; that cannot be")
    return values


def _poses(arrays: Mapping[str, NDArray[Any]], label: str) -> Array:
    """Rotation vectors (F, J, 3) of all joints, from one array or from its parts."""
    key = _first(arrays, POSES)
    if key is not None:
        poses = _vectors(arrays, key, label, _LARGEST_TURN)
    else:
        keys = [str(_first(arrays, ROOTS)), str(_first(arrays, BODIES))]
        parts = [_vectors(arrays, part, label, _LARGEST_TURN, single=part in ROOTS) for part in keys]
        hands = next((names for names in HANDS if all(name in arrays for name in names)), ())
        whole = parts[1].shape[1] == 21
        parts += [_vectors(arrays, name, label, _LARGEST_TURN) for name in hands if whole]
        if len({len(part) for part in parts}) > 1:
            raise FormatError(f"{label}: {', '.join([*keys, *hands])} have different numbers of frames")
        poses = np.concatenate(parts, axis=1)
    if poses.shape[1] not in ORDERS:
        widths = ", ".join(f"{3 * count}" for count in ORDERS)
        raise FormatError(f"{label}: poses of {3 * poses.shape[1]} numbers a frame found; {widths} are known")
    return poses


def _path(arrays: Mapping[str, NDArray[Any]], label: str) -> Positions:
    """The path (F, 3), by AIST++'s scaling where there is one."""
    key = str(_first(arrays, PATHS))
    path = _vectors(arrays, key, label, _LARGEST_PATH, single=True)
    if path.shape[1] != 1:
        raise FormatError(f"{label}: {key!r} has the shape {arrays[key].shape}; (frames, 3) is expected")
    if "smpl_scaling" not in arrays:
        return path[:, 0]
    scaling = floats(arrays, "smpl_scaling", label)
    if scaling.size != 1 or not 1e-3 < scaling.reshape(-1)[0] < 1e4:
        raise FormatError(f"{label}: 'smpl_scaling' is {str(scaling)[:40]}; one positive number is expected")
    return path[:, 0] / scaling.reshape(-1)[0]


def _rate(arrays: Mapping[str, NDArray[Any]], label: str) -> float:
    key = _first(arrays, RATES)
    if key is not None:
        found = floats(arrays, key, label).reshape(-1)
        if len(found) != 1 or not 0.1 <= found[0] <= 10000:
            raise FormatError(f"{label}: {key!r} is {str(found)[:40]}; one rate from 0.1 to 10000 is expected")
        return float(found[0])
    # AIST++ records 60 frames a second; what EDGE and others make from it has 30 and no scaling.
    aist = "smpl_poses" in arrays and "full_pose" not in arrays
    return assumed(60.0 if aist else 30.0, f"{label} stores")


def _usual_up(keys: Collection[str]) -> Up | None:
    """The up axis that files with these keys have: AMASS's Z, AIST++'s Y; None where the keys do not tell."""
    if "smpl_scaling" in keys:
        return "y"
    return "z" if "trans" in keys and any(key in keys for key in ("mocap_framerate", "mocap_frame_rate")) else None


def _upright(turn: Rotations, path: Positions, up: Up | None, usual: Up | None) -> tuple[Up, Rotations, Positions]:
    """Which axis of the world is up, and the roots turned over where it points down (as cameras have it).

    Where the keys tell the axis, a body that lies or stands on its hands does so. They are not believed only where the
    body is upright along another axis all the time and too high to lie.
    """
    if up is not None:
        return up, turn, path
    crowns = rot.rotate(turn, np.array([0.0, 1.0, 0.0]))
    crown = crowns.mean(0)
    axis: Up = "y" if abs(crown[1]) > abs(crown[2]) + 1e-6 else "z"
    along = float(crown["xyz".index(axis)])
    height = float(np.median(z_up_vectors(path, usual or axis)[:, 2]))
    if usual is not None and (axis == usual or abs(along) < 0.8 or abs(height) < _LYING):
        tell("up", usual, "as files with these keys have it")
        return usual, turn, path
    if abs(along) < 0.3:
        tell("up", axis, f"no axis is clearly upright; the body is along it most ({along:.2f})")
        return axis, turn, path
    if along < 0:
        over = np.array([0.0, 1.0, 0.0, 0.0])
        turn, path = rot.multiply(over, turn), rot.rotate(over, path)
    tell("up", axis if along > 0 else f"-{axis}", f"the body is upright along it (cosine {abs(along):.2f} on average)")
    return axis, turn, path


def _unit(path: Positions, axis: Up, label: str) -> str:
    """The unit in which the middle height of the path is that of a body."""
    height = float(np.median(np.abs(z_up_vectors(path, axis)[:, 2])))
    unit = "m" if height < 20 else "cm" if height < 300 else "mm"
    tell("unit", unit, f"the path is {height:.3g} high")
    return unit


def _local(poses: Array, turn: Rotations, axis: Up) -> tuple[Rotations, bool]:
    """Local rotations (F, J, 4) in the skeleton's order, and whether it has fingers: only those that move are kept."""
    order = ORDERS[poses.shape[1]]
    hands = [order.index(name) for name in FINGER_JOINTS if name in order]
    fingers = bool(hands) and float(np.ptp(poses[:, hands], axis=0).max()) > 1e-3
    skeleton = smpl_skeleton(fingers)
    rotations = np.zeros((len(poses), len(skeleton), 4))
    rotations[..., 0] = 1
    for place, name in enumerate(skeleton.names):
        if name in order[1:]:
            rotations[:, place] = z_up_rotations(rot.exp(poses[:, order.index(name)]))
    rest = rot.from_matrix(z_up_vectors(np.eye(3)).T)
    world = rot.from_matrix(z_up_vectors(np.eye(3), axis).T)
    rotations[:, 0] = rot.multiply(rot.multiply(world, turn), rot.inverse(rest))
    rotations.setflags(write=False)
    return rotations, fingers


def _standing(motion: Motion, fingers: bool, axis: Up) -> Motion:
    """The motion on a body of its size, standing on the floor."""
    size = _size(motion) if axis == "z" else None
    if size is not None:
        tell("size", f"{size:.2f}", "with it the standing feet reach the floor")
        motion = _on(smpl_skeleton(fingers, size), motion, motion.root_positions)
    floor = _floor(motion[:_SAMPLES]) - SOLE * STATURE * (size or 1.0)
    if size is None:
        tell("floor", f"{floor:.3f} m", "where the feet stand, put at 0, as the height over the floor is open")
    return _on(motion.skeleton, motion, motion.root_positions - np.array([0.0, 0.0, floor]))


def _floor(some: Motion) -> float:
    """Metres: where the feet stand; where the body is not on its feet, the lowest of it."""
    upright = rot.rotate(some.rotations[:, 0], np.array([0.0, 0.0, 1.0]))[:, 2] > 0.5
    if upright.mean() > 0.1:
        return floor_height(_chosen(some, upright))
    return float(np.percentile(some.positions[..., 2].min(axis=1), 5))


def _chosen(motion: Motion, frames: Bools) -> Motion:
    return Motion(motion.skeleton, motion.rotations[frames], motion.root_positions[frames], motion.fps)


def _on(skeleton: Skeleton, motion: Motion, path: Positions) -> Motion:
    return Motion(skeleton, motion.rotations, path, motion.fps, motion.name)


def _size(motion: Motion) -> float | None:
    """The size, in hundredths, with which the standing feet are on the floor; None where no body's is."""
    some = motion[:_SAMPLES]
    reach = some.root_positions[:, 2] - some.positions[..., 2].min(1) + SOLE * STATURE
    upright = reach > 0.85 * STATURE * PELVIS
    if upright.mean() < 0.1:
        return None
    size = round(1 + (floor_height(_chosen(some, upright)) - SOLE * STATURE) / float(np.median(reach[upright])), 2)
    return size if _SIZES[0] <= size <= _SIZES[1] else None
