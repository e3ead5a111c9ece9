"""A body: which joint of a skeleton plays which role, and the body-centre frame.

Files name their joints as they like; algorithms ask for roles. How roles are found tells :mod:`onbeat.motion.roles`.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.limbs import LIMBS, core_roles, limb_roles
from onbeat.motion.motion import Motion
from onbeat.motion.role_names import NEEDED, ROLES
from onbeat.motion.roles import How, find_roles, nearest
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import ancestors, chain_length

__all__ = [
    "NEEDED",
    "ROLES",
    "Body",
    "ancestors",
    "body_frames",
    "chain_length",
    "facing",
    "frames_from",
]
_LISTED = 100
_BELOW = 0.4  # of a bone's length


@dataclass(frozen=True)
class Body:
    """Which joint of a skeleton plays which role.

    Parameters
    ----------
    skeleton : J joints.
    joints : the joint of each role.
    how : how each was found: "told", "name", "tree" or "guess"; see :func:`onbeat.motion.roles.role_report`.

    Examples
    --------
    >>> names = ["hips", "chest", *(s + n for s in "lr" for n in
    ...          ("humerus", "radius", "wrist", "femur", "tibia", "foot"))]
    >>> parents = [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12]
    >>> body = Body.of(Skeleton(names, parents, np.ones((14, 3))))
    >>> body.skeleton.names[body["left_elbow"]], body.how["left_elbow"]
    ('lradius', 'name')
    """

    skeleton: Skeleton
    joints: Mapping[str, int]
    how: Mapping[str, How] = field(default_factory=dict[str, How], compare=False)

    @classmethod
    def of(cls, skeleton: Skeleton) -> Body:
        """Find the roles: what the skeleton is told first, then names, the tree and, at last, a guess.

        Raises
        ------
        BodyError
            If a needed role is not found; it lists what comes near and how to tell the roles in a file. If roles
            that are told cannot be a body's: a knee that is not below its hip. If an arm or a leg has no length.
        """
        joints, how = find_roles(skeleton)
        if skeleton.roles:
            _check_told(skeleton, joints)
        missing = [role for role in NEEDED if role not in joints]
        if missing:
            raise BodyError(_missing(skeleton, missing))
        _check_lengths(skeleton, joints)
        return cls(skeleton, joints, how)

    def __getitem__(self, role: str) -> int:
        """The joint that plays ``role``; a ``BodyError`` where none does."""
        try:
            return self.joints[role]
        except KeyError:
            raise BodyError(f"the body has no {role}; it has {', '.join(self.joints)}") from None

    def __contains__(self, role: str) -> bool:
        return role in self.joints

    def indices(self, *roles: str) -> Ints:
        """The joints of several roles."""
        return np.array([self[role] for role in roles], np.int64)

    def turning(self, role: str) -> int:
        """The joint whose rotation turns the bone from a role's joint to the next one of its limb.

        It is the role's own joint but where a bone has several: a robot's hip turns about three axes in three places,
        and a skinned thigh twists half-way down. Then it is the lowest that has two fifths of the bone below it.
        """
        side, _, part = role.rpartition("_")
        limb = next((limb for limb, parts in LIMBS.items() if side and part in parts), None)
        if limb is None:
            return self[role]
        roles = limb_roles(limb, side)
        after = next((self.joints[r] for r in roles[roles.index(role) + 1 :] if r in self.joints), None)
        if after is None or self[role] not in (line := ancestors(self.skeleton, after)):
            return self[role]
        long = _BELOW * chain_length(self.skeleton, self[role], after)
        return next(j for j in line[1:] if j == self[role] or chain_length(self.skeleton, j, after) >= long > 0)

    @property
    def leg_length(self) -> float:
        """Metres from hip to ankle along the left leg in the rest pose."""
        knee, ankle = self["left_knee"], self["left_ankle"]
        return chain_length(self.skeleton, self["left_hip"], knee) + chain_length(self.skeleton, knee, ankle)


def _missing(skeleton: Skeleton, missing: list[str]) -> str:
    """What is not found, what comes near, which joints there are, and what to do."""
    near = [f"{role} may be {' or '.join(names)}" for role, names in nearest(skeleton, missing).items() if names]
    listed = ", ".join(skeleton.names[:_LISTED])
    more = f" and {len(skeleton) - _LISTED} more" if len(skeleton) > _LISTED else ""
    perhaps = f"; {', '.join(near)}" if near else ""
    return (
        f"no joint found for {', '.join(missing)}{perhaps}; the skeleton has {listed}{more}; "
        "rename its joints as CMU, Mixamo or LAFAN1 do, or tell them in a roles file beside the motion: "
        f'NAME.roles.toml with [joints] and lines like {missing[0]} = "joint"'
    )


def _check_told(skeleton: Skeleton, joints: Mapping[str, int]) -> None:
    """Raise a ``BodyError`` where a told limb does not hang together."""
    for limb in LIMBS:
        for side in ("left", "right"):
            roles = [role for role in core_roles(limb, side) if role in joints]
            for above, below in itertools.pairwise(roles):
                if joints[above] not in ancestors(skeleton, joints[below]):
                    names = [skeleton.names[joints[role]] for role in (below, above)]
                    raise BodyError(
                        f"{below} is {names[0]}, which is not below {above}, {names[1]}; tell other joints for them"
                    )


def _check_lengths(skeleton: Skeleton, joints: Mapping[str, int]) -> None:
    """Raise a ``BodyError`` where arms or legs have no length, as in files whose bones are all zero."""
    lines = {f"{side} {limb}": core_roles(limb, side) for limb in LIMBS for side in ("left", "right")}
    lengths = {limb: chain_length(skeleton, joints[top], joints[end]) for limb, (top, _, end) in lines.items()}
    without = [limb for limb, length in lengths.items() if not length > 0]
    if without:
        which = "arms and legs" if len(without) == len(lines) else " and the ".join(without)
        raise BodyError(
            f"the {which} {'have' if without[1:] else 'has'} no length, so a body cannot be told; "
            "export the motion again with the lengths of its bones"
        )


def body_frames(motion: Motion, body: Body | None = None) -> tuple[Rotations, Positions]:
    """The body-centre frame of each frame (Shiratori 2006, Sec. II-A).

    The origin is the waist (the hips' joint); z points from the waist to the trunk (the mid-point of the
    shoulders), y to the front, x across to the body's right.

    Returns
    -------
    (F, 4) rotations wxyz from the body-centre frame to the world and (F, 3) origins in metres.
    """
    body = Body.of(motion.skeleton) if body is None else body
    p = motion.positions
    waist = p[:, body["hips"]]
    up = (p[:, body["left_shoulder"]] + p[:, body["right_shoulder"]]) / 2 - waist
    across = (
        p[:, body["right_hip"]] - p[:, body["left_hip"]] + p[:, body["right_shoulder"]] - p[:, body["left_shoulder"]]
    )
    return frames_from(up, across), waist


def frames_from(up: Positions, across: Positions) -> Rotations:
    """Frames (..., 4) whose z is ``up`` and whose x is the part of ``across`` square to it.

    Raises
    ------
    BodyError
        If a frame has no such directions: the body has no trunk, or its left and right are in one place.
    """
    tall = np.linalg.norm(up, axis=-1, keepdims=True)
    z = up / np.maximum(tall, 1e-9)
    x = across - z * np.sum(z * across, axis=-1, keepdims=True)
    wide = np.linalg.norm(x, axis=-1, keepdims=True)
    # What is left of directions that are the same is rounding, of the size of the numbers.
    if not (np.minimum(tall, wide) > 1e-9 + 1e-12 * np.abs(across).max(initial=0.0)).all():
        raise BodyError(
            "the hips and shoulders are in one place or one line, so that left and right of the body cannot be told; "
            "export the motion again with the lengths of its bones"
        )
    x = x / wide
    return rot.from_matrix(np.stack((x, np.cross(z, x), z), axis=-1))


def facing(frames: Rotations) -> Array:
    """Yaw in radians (...) of body-centre frames: where their front (y) points on the ground, 0 along +Y.

    Taken from the frontal vector, never from Euler angles, so that leaning does not turn it.
    """
    front = rot.rotate(frames, np.array([0.0, 1.0, 0.0]))
    return np.arctan2(-front[..., 0], front[..., 1])
