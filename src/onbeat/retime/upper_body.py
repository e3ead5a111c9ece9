"""Which joints are the upper body: what 2007 looks at, and all that may be retimed while feet stay planted."""

from __future__ import annotations

from onbeat.motion.body import ROLES, Body
from onbeat.motion.roles import find_roles
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import ancestors

ENDS = ("head", "left_wrist", "right_wrist")
LEGS = ("left_hip", "right_hip")


def upper_body(skeleton: Skeleton) -> list[str]:
    """Names of the joints between the hips and the head and wrists, these with them.

    Raises
    ------
    BodyError
        If the skeleton's hips and arms are not found.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> upper_body(Build(1.7).skeleton)[:6]
    ['Spine', 'Chest', 'Neck', 'Head', 'LeftShoulder', 'LeftArm']
    """
    body = Body.of(skeleton)
    below = set(ancestors(skeleton, body["hips"]))
    found = {joint for role in ENDS if role in body for joint in ancestors(skeleton, body[role])} - below
    return [skeleton.names[joint] for joint in sorted(found)]


def named_joints(skeleton: Skeleton, names: list[str]) -> list[str]:
    """Joints by their own names or by their roles (``left_shoulder``), as names of the skeleton.

    A role is the joint whose rotation turns the bone below it. Names that are neither are kept as they are.
    """
    out = list[str]()
    body = None
    for name in names:
        if name not in skeleton.names and name in ROLES:
            body = Body.of(skeleton) if body is None else body
            name = skeleton.names[body.turning(name)] if name in body else name
        out.append(name)
    return list(dict.fromkeys(out))


def above_the_legs(skeleton: Skeleton) -> tuple[int, ...]:
    """Every joint that turns but the root, the legs and what carries them; all but the root where no hip is known.

    Examples
    --------
    >>> import numpy as np
    >>> names = ["hips", "chest", "neck", "lfemur", "ltibia", "lfoot", "rfemur", "rtibia", "rfoot"]
    >>> body = Skeleton(names, [-1, 0, 1, 0, 3, 4, 0, 6, 7], np.eye(9, 3))
    >>> [names[joint] for joint in above_the_legs(body)]
    ['chest', 'neck']
    """
    roles = find_roles(skeleton).joints
    hips = [roles[role] for role in LEGS if role in roles]
    carrying = {0}.union(*(ancestors(skeleton, hip) for hip in hips))
    return tuple(
        joint
        for joint in range(len(skeleton))
        if joint not in carrying and not skeleton.end_sites[joint] and not {*ancestors(skeleton, joint)} & {*hips}
    )
