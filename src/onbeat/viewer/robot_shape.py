"""The shape of a drawn robot: its own model's capsules, so that it looks like the machine and not like a person."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from onbeat._shapes import Ints
from onbeat.errors import OnbeatError
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.robots.ik.collision import Capsules, capsules_of
from onbeat.robots.model import Robot
from onbeat.viewer.figure import Colour
from onbeat.viewer.shape import Capsule

SHELL, DARK, JOINT = (196, 204, 216), (48, 54, 64), (122, 132, 148)
ROBOT: Mapping[str, Colour] = MappingProxyType(
    {
        "head": DARK,
        "torso": SHELL,
        "hips": JOINT,
        **{f"{side}_{part}": SHELL for side in ("left", "right") for part in ("arm", "leg")},
        **{f"{side}_{part}": DARK for side in ("left", "right") for part in ("hand", "foot")},
    }
)
"""sRGB colour of each group: light shells, dark head, hands and feet."""
HEAD = 0.08
"""Metres above the shoulders from which a part of the trunk is the head: some robots' heads have no joint."""
SPHERE = 1e-5
"""Metres between the ends of what is round: a line between joints needs a direction."""


def robot_shape(motion: Motion, robot: Robot) -> tuple[Motion, list[Capsule]]:
    """A robot's motion with the ends of its capsules as further joints, and the capsules between these.

    Parameters
    ----------
    motion : of this robot.
    robot : its model.

    Raises
    ------
    OnbeatError
        If the motion is another body's.

    Examples
    --------
    >>> from onbeat.motion.hinges import hinge_motion
    >>> from onbeat.robots.model import robot_named
    >>> g1 = robot_named("g1")
    >>> still = hinge_motion(g1.body, np.zeros((1, 3)), rot.IDENTITY[None], np.zeros((1, 29)), 60.0)
    >>> dressed, shape = robot_shape(still, g1)
    >>> len(dressed.skeleton) - len(still.skeleton) == 2 * len(shape)
    True
    """
    skeleton, given = robot.body.skeleton, motion.skeleton
    if given.names != skeleton.names:
        other = next((name for name in given.names if name not in skeleton.names), f"{len(given)} joints")
        raise OnbeatError(
            f"{motion.name or 'the motion'} is not of the robot {robot.name}, which has {len(skeleton)} joints and not "
            f"{other}; give a motion of this robot"
        )
    found = capsules_of(robot)
    ends = np.asarray(found.ends).copy()
    ends[np.asarray(found.halves) < SPHERE, 1, 2] += SPHERE
    first = len(skeleton) + 2 * np.arange(len(found.joints))
    groups = _groups(given, found)
    shape = [
        Capsule(a, a + 1, radius, radius, group)
        for a, radius, group in zip(first.tolist(), found.radii.tolist(), groups, strict=True)
    ]
    return _with_ends(motion, found.joints, ends.reshape(-1, 3)), shape


def _with_ends(motion: Motion, joints: Ints, ends: np.ndarray) -> Motion:
    """With two joints more for each of the joints (C,): its capsule's ends (2 C, 3) in its frame."""
    skeleton, count = motion.skeleton, len(ends)
    names = [f"capsule {i // 2} {'ab'[i % 2]}" for i in range(count)]
    longer = Skeleton(
        (*skeleton.names, *names),
        np.concatenate((skeleton.parents, np.repeat(joints, 2))),
        np.concatenate((skeleton.offsets, ends)),
        np.concatenate((skeleton.end_sites, np.ones(count, np.bool_))),
        roles=skeleton.roles,
    )
    rotations = np.concatenate((motion.rotations, np.broadcast_to(rot.IDENTITY, (len(motion), count, 4))), axis=1)
    moved = motion.translations
    if moved is not None:
        moved = np.concatenate((moved, np.broadcast_to(ends, (len(motion), count, 3))), axis=1)
    return Motion(longer, rotations, motion.root_positions, motion.fps, motion.name, moved)


def _groups(skeleton: Skeleton, found: Capsules) -> list[str]:
    """The colour group of each capsule."""
    body = Body.of(skeleton)
    rest, began = skeleton.rest_positions, _began(body)
    collar = max(float(rest[body[f"{side}_shoulder"], 2]) for side in ("left", "right")) + HEAD
    groups = list[str]()
    for joint, ends in zip(found.joints.tolist(), found.ends, strict=True):
        at = joint
        while at not in began:
            at = int(skeleton.parents[at])
        high = float(rest[joint, 2] + ends[:, 2].mean()) > collar
        groups.append("head" if high and began[at] == "torso" else began[at])
    return groups


def _began(body: Body) -> dict[int, str]:
    """The joints at which a group begins; an arm does where it leaves the trunk, a leg at the root."""
    parents = body.skeleton.parents.tolist()
    trunk = _line(parents, body.joints.get("neck", body["chest"]))
    began = {0: "hips", **{joint: "torso" for joint in trunk if joint}}
    for side in ("left", "right"):
        for role, group in (("shoulder", "arm"), ("hip", "leg")):
            began[next(joint for joint in reversed(_line(parents, body[f"{side}_{role}"])) if joint not in trunk)] = (
                f"{side}_{group}"
            )
        began |= {body[f"{side}_wrist"]: f"{side}_hand", body[f"{side}_ankle"]: f"{side}_foot"}
    return began


def _line(parents: Sequence[int], joint: int) -> list[int]:
    """A joint and those above it, up to the root."""
    line = [joint]
    while parents[line[-1]] >= 0:
        line.append(parents[line[-1]])
    return line
