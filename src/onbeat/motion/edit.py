"""Cutting, joining and scaling whole motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import BodyError, FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames, facing
from onbeat.motion.markers import Markers
from onbeat.motion.motion import Motion
from onbeat.motion.roles import find_roles
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

Recorded = TypeVar("Recorded", Motion, Markers)


def cropped(motion: Recorded, start: float = 0.0, end: float | None = None) -> Recorded:
    """The frames of a motion, or of markers, shown from ``start`` until before ``end`` seconds; the clock begins anew.

    Raises
    ------
    FormatError
        If no frame is left.

    Examples
    --------
    >>> from onbeat.motion.skeleton import Skeleton
    >>> body = Skeleton(("hips",), [-1], [[0, 0, 0]])
    >>> still = Motion(body, np.tile([1.0, 0, 0, 0], (60, 1, 1)), np.zeros((60, 3)), fps=30)
    >>> cropped(still, 0.5, 1.5).duration
    1.0
    """
    span = len(motion) + 1  # what lies beyond, up to infinity, is beyond
    first = -1 if np.isnan(start) else int(np.ceil(np.clip(start * motion.fps - 1e-6, -1, span)))
    end_frame = span if end is None else -1 if np.isnan(end) else np.clip(end * motion.fps - 1e-6, -1, span)
    last = int(np.ceil(end_frame))
    if not 0 <= first < min(last, len(motion)):
        until = "its end" if end is None else f"{end:g} s"
        raise FormatError(f"no frame from {start:g} s to {until}: the motion lasts {motion.duration:.2f} s")
    return motion[first:last]


def concatenated(motions: Sequence[Motion], blend: float = 0.0) -> Motion:
    """One motion after the other on one skeleton, each placed where the one before has come to.

    Where a motion begins it stands on the ground point, and faces the way, where the one before ends; heights are its
    own. The rate is the first one's.

    Parameters
    ----------
    motions : at least one, all on the same skeleton.
    blend : seconds in which one fades into the next (both are shown then: the whole is so much shorter each time);
        without it the last frame of one is followed by the first of the next.

    Raises
    ------
    FormatError
        If there is none, the skeletons differ, or a motion is shorter than the blends at its ends.
    """
    if not motions:
        raise FormatError("no motions to put together; give at least one")
    first = motions[0]
    joined, over = first, round(blend * first.fps)
    for number, motion in enumerate(motions[1:], 2):
        if motion.skeleton != first.skeleton:
            raise FormatError(
                f"motion {number} ({motion.name!r}) has another skeleton than the first ({first.name!r}); move it over "
                "with `retarget`, or --like of `onbeat convert`"
            )
        following = motion.resampled(first.fps)
        if min(len(joined), len(following)) <= 2 * over:
            raise FormatError(f"motion {number} or the one before is too short for a blend of {blend:g} s")
        joined = _after(joined, following, over)
    return joined


def _after(a: Motion, b: Motion, over: int) -> Motion:
    """``b`` placed at the end of ``a``, the last ``over`` frames of which fade into it."""
    b = _placed(b, a[len(a) - 1 - over :], 0)
    weight = _ease((np.arange(over) + 1) / (over + 1))
    cut = len(a) - over
    fade = slice(0, over)
    rotations = rot.slerp(a.rotations[cut:], b.rotations[fade], weight[:, None])
    path = a.root_positions[cut:] + weight[:, None] * (b.root_positions[fade] - a.root_positions[cut:])
    translations = None
    if a.translations is not None or b.translations is not None:
        ta, tb = _offsets(a), _offsets(b)
        mixed = ta[cut:] + weight[:, None, None] * (tb[fade] - ta[cut:])
        translations = np.concatenate((ta[:cut], mixed, tb[over:]))
    return Motion(
        a.skeleton,
        np.concatenate((a.rotations[:cut], rotations, b.rotations[over:])),
        np.concatenate((a.root_positions[:cut], path, b.root_positions[over:])),
        a.fps,
        a.name,
        translations,
    )


def _placed(motion: Motion, at: Motion, frame: int) -> Motion:
    """The motion turned and moved on the ground so that it begins where ``at`` is in a frame."""
    turn = rot.yaw(heading(at)[frame] - heading(motion)[0])
    path = rot.rotate(turn, motion.root_positions - motion.root_positions[0] * [1, 1, 0])
    rotations = np.array(motion.rotations)
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    return motion.replace(rotations=rotations, root_positions=path + at.root_positions[frame] * [1, 1, 0])


def heading(motion: Motion) -> Array:
    """(F,) radians, the way the body faces, or where its root's +Y points if it is no body with legs and arms."""
    try:
        return facing(body_frames(motion)[0])
    except BodyError:
        return facing(motion.rotations[:, 0])


def _ease(t: Array) -> Array:
    return t * t * (3 - 2 * t)


def _offsets(motion: Motion) -> Array:
    if motion.translations is not None:
        return motion.translations
    return np.tile(motion.skeleton.offsets, (len(motion), 1, 1))


def scaled(motion: Motion, factor: float) -> Motion:
    """All lengths, bones and paths alike, times a factor.

    Raises
    ------
    FormatError
        If the factor is not positive.
    """
    if not (np.isfinite(factor) and factor > 0):
        raise FormatError(f"a scale of {factor} is not possible; a positive number is needed")
    s, t = motion.skeleton, motion.translations
    skeleton = s.replace(offsets=s.offsets * factor)
    moved = None if t is None else t * factor
    return Motion(skeleton, motion.rotations, motion.root_positions * factor, motion.fps, motion.name, moved)


def stature(motion: Motion) -> float:
    """Metres from the lowest to the highest joint when the body stands tallest (90th percentile over the frames).

    Arms do not count where they are known: a raised hand makes nobody taller.
    """
    heights = motion.positions[:, _but_arms(motion.skeleton), 2]
    return float(np.percentile(np.ptp(heights, axis=1), 90))


def _but_arms(skeleton: Skeleton) -> list[int]:
    """The joints that hang on no shoulder; all of a body whose arms are not known."""
    joints, _ = find_roles(skeleton)
    arms = [joints[role] for role in ("left_shoulder", "right_shoulder") if role in joints]
    tree = Tree.of(skeleton)
    return [joint for joint in range(len(skeleton)) if not any(tree.above(arm, joint) for arm in arms)]
