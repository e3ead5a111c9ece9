"""The joints of the upper body, which 2007 looks at: from the hips up to the head and out to the wrists."""

from __future__ import annotations

from onbeat.motion.body import ROLES, Body
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import ancestors

ENDS = ("head", "left_wrist", "right_wrist")


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
