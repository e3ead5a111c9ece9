"""What is wrong with a motion, as captured and exported motion often is: what, where, and what to do about it.

All thresholds are in metres, seconds and radians, so that any frame rate finds the same.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.errors import BodyError
from onbeat.motion import leaps
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.contacts import foot_contacts, point_speeds
from onbeat.motion.edit import stature
from onbeat.motion.floor import is_on_floor
from onbeat.motion.handedness import MIRRORED, is_mirrored
from onbeat.motion.held import held_poses
from onbeat.motion.leaps import body_leaps, leaping_joints
from onbeat.motion.motion import Motion
from onbeat.motion.retarget import feet_in_air, floor_height

FLIP = np.radians(60)
"""Radians from one frame to the next, and not on: at dancers' 15 rad/s a joint turns 30° in a frame of 1/30 s."""
FLIP_SPEED = 40.0
"""rad/s that no joint reaches."""
LEAP = 12.0
"""m/s faster than anybody moves."""
STILL = 0.5
"""Seconds without any change in the last bit: nobody stands so."""
SKATE = 0.15
"""m/s (mean) of feet that rest."""
FIXED, STEPS = 0.005, 0.1
"""Metres: hips that never leave the first while feet go over the second have lost their path."""
SIZES, LEGS = (0.3, 2.5), (0.48, 1.1)
"""Metres of bodies, and of their legs from hip to ankle, that need no explanation: of 1.0 to 2.3 m, lying ones too."""


def problems(motion: Motion) -> list[str]:
    """One line for each thing found, the gravest first; an empty list is a good sign, no proof.

    Examples
    --------
    >>> from onbeat.motion.skeleton import Skeleton
    >>> rod = Skeleton(("foot", "head"), [-1, 0], [[0, 0, 0], [0, 0, 1.7]])
    >>> q = np.tile([1.0, 0, 0, 0], (60, 2, 1))
    >>> problems(Motion(rod, q, np.zeros((60, 3)), fps=30))[0]
    'frames 0–59 are exactly alike (2.00 s): the capture stopped, or frames were filled in'
    """
    found = [*_leaps(motion), *_flips(motion), *_still(motion), *_held(motion), *_repeats(motion)]
    try:
        body = Body.of(motion.skeleton)
    except BodyError as error:
        return [*found, *_size(motion, None), *_stretching(motion), str(error).split(";")[0]]
    found = [*_joint_leaps(motion, body), *found, *_size(motion, body), *_stretching(motion)]
    found += [said for said in (in_place(motion, body),) if said]
    return [*found, *_floor(motion, body), *_feet(motion, body), *_sides(body), *_turned(motion, body)]


def _leaps(motion: Motion) -> Iterator[str]:
    speed = _without_held(motion, np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) * motion.fps)
    fast = np.flatnonzero(speed > LEAP)
    if len(fast):
        yield (
            f"the root leaps at {len(fast)} frame{'s' * (len(fast) > 1)}, first between {fast[0]} and {fast[0] + 1} "
            f"({speed[fast[0]]:.0f} m/s): a cut, or a wrong rate or unit"
        )


def _without_held(motion: Motion, values: Array) -> Array:
    """Values from frame to frame (F − 1, …) that are 0 where a pose of reference is left or entered."""
    held = held_poses(motion)
    values[: held.first] = 0.0
    values[len(values) - held.last :] = 0.0
    return values


def _joint_leaps(motion: Motion, body: Body) -> Iterator[str]:
    """Joints that leap where the root does not; what libraries leave out (see ``leaps``)."""
    speeds = body_leaps(motion, body)
    root = np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) * motion.fps > LEAP
    speeds[np.convolve(root, np.ones(5), "same") > 0] = 0.0  # a root that leaps was told already
    frames = np.flatnonzero((speeds > leaps.LEAP).any(axis=1))
    if len(frames):
        at = int(speeds.max(axis=1).argmax())
        joint = motion.skeleton.names[leaping_joints(body)[int(speeds[at].argmax())]]
        yield (
            f"{joint} leaps at {len(frames)} frame{'s' * (len(frames) > 1)}, furthest between {at} and {at + 1} "
            f"({speeds[at].max():.0f} m/s faster than just before and after): noise of the capture"
        )


def _flips(motion: Motion) -> Iterator[str]:
    """Joints that turn in one frame further than anybody can, named with how often."""
    turn = _without_held(motion, rot.angle_between(motion.rotations[:-1], motion.rotations[1:]))
    flips = (turn > FLIP) & (turn * motion.fps > FLIP_SPEED)
    frames, joints = np.nonzero(flips)
    if len(frames):
        counts = sorted(((int(n), int(j)) for j, n in zip(*np.unique(joints, return_counts=True), strict=True)))[::-1]
        named = ", ".join(f"{motion.skeleton.names[j]} {n}×" for n, j in counts[:4])
        yield f"joints flip from one frame to the next ({named}), first after frame {frames[0]}: noise of the capture"


def _unchanged(motion: Motion) -> Bools:
    """(F − 1,) true where a frame is the one before, to the last bit."""
    same = (motion.rotations[1:] == motion.rotations[:-1]).all((1, 2))
    return np.asarray(same & (motion.root_positions[1:] == motion.root_positions[:-1]).all(1))


def _still(motion: Motion) -> Iterator[str]:
    at, longest, first = 0, 0, 0
    held = held_poses(motion)
    same = _unchanged(motion)[: len(motion) - 1 - held.last]
    same[: held.first] = False
    for equal, run in itertools.groupby(same.tolist()):
        length = sum(1 for _ in run)
        if equal and length > longest:
            longest, first = length, at
        at += length
    if longest >= STILL * motion.fps:
        seconds = (longest + 1) / motion.fps
        yield (
            f"frames {first}–{first + longest} are exactly alike ({seconds:.2f} s): the capture stopped, or frames "
            "were filled in"
        )


def _repeats(motion: Motion) -> Iterator[str]:
    same = _unchanged(motion)
    if len(same) < 12 or not 0.4 < same.mean() < 0.9:
        return
    changes = np.diff(np.flatnonzero(~same))
    if len(changes) > 3 and (changes == changes[0]).mean() > 0.9 and changes[0] > 1:
        yield (
            f"each frame is there {changes[0]} times: it was stored at {motion.fps:g} frames a second but made at "
            f"{motion.fps / changes[0]:g}"
        )


def _held(motion: Motion) -> Iterator[str]:
    held, fps = held_poses(motion), motion.fps
    if held.first:
        yield (
            f"{_frames(0, held.first)} a pose by itself (of reference, as a T-pose) and no part of the movement; leave "
            f"it out (`onbeat convert --start {held.first / fps:.4g}`)"
        )
    if held.last:
        end = len(motion) - held.last
        yield (
            f"{_frames(end, len(motion))} a pose by itself (of reference, as a T-pose) and no part of the movement; "
            f"leave it out (`onbeat convert --end {end / fps:.4g}`)"
        )


def _frames(first: int, end: int) -> str:
    return f"frame {first} is" if end - first == 1 else f"frames {first}–{end - 1} are"


def odd_size(motion: Motion, body: Body | None) -> str:
    """Words on a body of a size that needs an explanation; none ("") of one that does not.

    By the legs where they are known: who crouches all the time is not small.

    Parameters
    ----------
    motion : metres, Z up.
    body : its roles; None where they are not known.

    Examples
    --------
    >>> from onbeat.motion.skeleton import Skeleton
    >>> rod = Skeleton(("foot", "head"), [-1, 0], [[0, 0, 0], [0, 0, 0.17]])
    >>> odd_size(Motion(rod, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.zeros((2, 3)), fps=30), None)
    'the body is 0.17 m tall: is the unit right?'
    """
    height = stature(motion)
    legs = 0.82 if body is None else body.leg_length
    if SIZES[0] <= height <= SIZES[1] and LEGS[0] <= legs <= LEGS[1]:
        return ""
    of_legs = "" if body is None else f", its legs {legs:.2f} m long"
    return f"the body is {height:.2f} m tall{of_legs}: is the unit right?"


def _size(motion: Motion, body: Body | None) -> Iterator[str]:
    if said := odd_size(motion, body):
        yield f"{said} (`--source-unit`; in are inches)"


def _stretching(motion: Motion) -> Iterator[str]:
    if motion.translations is None:
        return
    lengths: Array = np.linalg.norm(motion.translations[:, 1:], axis=-1)
    spread = np.ptp(lengths, axis=0)
    if spread.max(initial=0) > 1e-3:
        joint = int(np.argmax(spread)) + 1
        yield (
            f"bones change their length, that to {motion.skeleton.names[joint]} by up to {1000 * spread.max():.0f} mm "
            f"({int((spread > 1e-3).sum())} bones do)"
        )


def in_place(motion: Motion, body: Body) -> str:
    """Words on a motion whose path is missing, so that the feet move and the hips never do; none ("") of another.

    Parameters
    ----------
    motion : metres, Z up.
    body : its roles.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> dance = embedded_motions()[0]
    >>> in_place(dance, Body.of(dance.skeleton))
    ''
    """
    hips, feet = (motion.positions[:, body.indices(*r)] for r in (("hips",), ("left_ankle", "right_ankle")))
    if np.ptp(hips, axis=0).max() > FIXED or np.ptp(feet, axis=0).max() < STEPS:
        return ""
    return "the hips never move, though the feet do: the motion was exported in place, without its path; export it anew"


def _floor(motion: Motion, body: Body) -> Iterator[str]:
    if feet_in_air(motion, body):
        yield (
            "the feet are in the air all along (who lies, or stands on the hands?) and tell of no floor; the lowest "
            f"joint rests at {floor_height(motion, body):+.2f} m"
        )
        return
    if not is_on_floor(motion, body):
        yield f"feet stand at {floor_height(motion, body):+.2f} m (`onbeat convert --ground` puts them on 0)"


def _feet(motion: Motion, body: Body) -> Iterator[str]:
    contacts = foot_contacts(motion, body).feet
    feet = motion.positions[:, body.indices("left_ankle", "right_ankle")]
    if (
        contacts.any()
        and not feet_in_air(motion, body)
        and (speed := float(point_speeds(feet, motion.fps)[contacts].mean())) > SKATE
    ):
        yield f"feet slide while they stand ({speed:.2f} m/s on average)"


def _turned(motion: Motion, body: Body) -> Iterator[str]:
    """A body that is mirrored, or upside down nearly throughout: the axes of its file are others than was thought."""
    if is_mirrored(motion, body):
        yield MIRRORED
    top = motion.positions[:, body["head"] if "head" in body else body["chest"], 2]
    feet = motion.positions[:, body.indices("left_ankle", "right_ankle"), 2]
    if (top < feet.min(1) - body.leg_length / 2).mean() > 0.9:
        yield "the head is under the feet nearly throughout: is the up axis right? (`--source-up`)"


def _sides(body: Body) -> Iterator[str]:
    lengths = body.skeleton.bone_lengths
    for role, joint in body.joints.items():
        other = body.joints.get("right_" + role.removeprefix("left_"))
        if role.startswith("left_") and other is not None and max(lengths[joint], lengths[other]) > 0.1:
            ratio = float(lengths[joint] / max(lengths[other], 1e-9))
            if not 0.9 < ratio < 1.11:
                yield (
                    f"left and right differ: the bone to the {role.removeprefix('left_')} is {lengths[joint]:.3f} m on "
                    f"the left, {lengths[other]:.3f} m on the right"
                )
