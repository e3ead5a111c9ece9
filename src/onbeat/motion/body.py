"""Joint roles (which joint is the left wrist?) and the body-centre frame.

Files name their joints as they like; algorithms ask for roles. A :class:`Body` maps each role to a joint of one
skeleton. Names are compared without case, separators and common prefixes (``mixamorig:``, ``Bip01``).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

CENTRE_ROLES = ("hips", "spine", "chest", "neck", "head")
SIDE_ROLES = ("collar", "shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "toe")
ROLES = (*CENTRE_ROLES, *(f"{side}_{role}" for side in ("left", "right") for role in SIDE_ROLES))
NEEDED = (
    "hips",
    "chest",
    *(
        f"{side}_{role}"
        for side in ("left", "right")
        for role in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    ),
)
"""Roles without which a body cannot dance."""

_CENTRE_NAMES: Mapping[str, tuple[str, ...]] = {
    "hips": ("hips", "pelvis", "root", "hip", "waist"),
    "spine": ("lowerback", "spine", "spine0", "spine1", "abdomen", "torso", "lowback"),
    "chest": ("thorax", "upperchest", "chest2", "chest", "spine3", "spine2", "spine1", "upperback", "spine"),
    "neck": ("lowerneck", "neck", "neck1", "upperneck"),
    "head": ("head",),
}
_SIDE_NAMES: Mapping[str, tuple[str, ...]] = {
    "collar": ("clavicle", "collar", "shoulder", "inshoulder", "collarbone"),
    "shoulder": ("humerus", "arm", "upperarm", "uparm", "uarm", "shldr", "shoulder"),
    "elbow": ("radius", "forearm", "lowerarm", "elbow", "lowarm", "farm"),
    "wrist": ("wrist", "hand"),
    "hand": ("fingers", "middle1", "handmiddle1", "finger2", "handend", "handsite", "fingerbase", "hand"),
    "hip": ("femur", "upleg", "upperleg", "thigh", "hip", "leg"),
    "knee": ("tibia", "leg", "lowerleg", "shin", "calf", "knee", "lowleg"),
    "ankle": ("ankle", "foot"),
    "toe": ("toes", "toebase", "toe", "toe0", "ball", "footend", "footsite", "foot"),
}
# Tried in this order, so that "shoulder" is the collar where there is an "arm", else the shoulder itself.
_SIDE_ORDER = ("ankle", "knee", "hip", "toe", "shoulder", "collar", "elbow", "wrist", "hand")


def _plain(name: str) -> str:
    name = re.sub(r"^(mixamorig\d*[:_]?|bip0?1[ _]?|character\d*[_:]|joint[_:])", "", name, flags=re.IGNORECASE)
    name = name.split(":")[-1]
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _sides(plain: str) -> tuple[str, str] | None:
    """Side and the rest of a plain name, as ("left", "arm"); None for the centre line."""
    for side, initial in (("left", "l"), ("right", "r")):
        if plain.startswith(side):
            return side, plain[len(side) :]
        if plain.endswith(side):
            return side, plain[: -len(side)]
        known = {n for names in _SIDE_NAMES.values() for n in names}
        if plain.startswith(initial) and plain[1:] in known:
            return side, plain[1:]
        if plain.endswith(initial) and plain[:-1] in known:
            return side, plain[:-1]
    return None


@dataclass(frozen=True)
class Body:
    """Which joint of a skeleton plays which role.

    Examples
    --------
    >>> names = ["hips", "chest", *(s + n for s in "lr" for n in
    ...          ("humerus", "radius", "wrist", "femur", "tibia", "foot"))]
    >>> parents = [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12]
    >>> body = Body.of(Skeleton(names, parents, np.zeros((14, 3))))
    >>> body.skeleton.names[body["left_elbow"]]
    'lradius'
    """

    skeleton: Skeleton
    joints: Mapping[str, int]

    @classmethod
    def of(cls, skeleton: Skeleton) -> Body:
        """Find the roles by the joints' names; a ``BodyError`` lists what is missing."""
        joints = _roles(skeleton)
        missing = [role for role in NEEDED if role not in joints]
        if missing:
            raise BodyError(
                f"no joint found for {', '.join(missing)}; the skeleton has {', '.join(skeleton.names)}; "
                "rename its joints as CMU, Mixamo or LAFAN1 do"
            )
        return cls(skeleton, joints)

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

    @property
    def leg_length(self) -> float:
        """Metres from hip to ankle along the left leg in the rest pose."""
        knee, ankle = self["left_knee"], self["left_ankle"]
        return chain_length(self.skeleton, self["left_hip"], knee) + chain_length(self.skeleton, knee, ankle)


def chain_length(skeleton: Skeleton, top: int, bottom: int) -> float:
    """Metres along the bones from ``top`` down to its descendant ``bottom``."""
    length, joint = 0.0, bottom
    while joint not in (top, -1):
        length += float(skeleton.bone_lengths[joint])
        joint = int(skeleton.parents[joint])
    return length


def ancestors(skeleton: Skeleton, joint: int) -> list[int]:
    """The joint, its parent and so on up to the root."""
    line = [joint]
    while skeleton.parents[line[-1]] >= 0:
        line.append(int(skeleton.parents[line[-1]]))
    return line


def _fork(skeleton: Skeleton, a: int, b: int) -> int:
    """The lowest joint above both ``a`` and ``b``."""
    above = ancestors(skeleton, a)
    return next(joint for joint in ancestors(skeleton, b) if joint in above)


def _roles(skeleton: Skeleton) -> dict[str, int]:
    """All roles found; names tell the limbs, the tree tells hips and chest: where the legs and the arms fork."""
    sides = _side_joints(skeleton)
    found = {role: joint for role, joint in _centre_joints(skeleton).items() if joint not in sides.values()}
    for role, limb in (("hips", "hip"), ("chest", "shoulder")):
        if f"left_{limb}" in sides and f"right_{limb}" in sides:
            fork = _fork(skeleton, sides[f"left_{limb}"], sides[f"right_{limb}"])
            if role == "hips" or fork not in (0, found.get("hips"), found.get("neck")):
                found = {other: joint for other, joint in found.items() if joint != fork} | {role: fork}
    if "spine" not in found and "chest" in found and "hips" in found:
        between = [j for j in ancestors(skeleton, found["chest"]) if found["hips"] < j < found["chest"]]
        found |= {"spine": between[-1]} if between else {}
    return {role: joint for role in ROLES if (joint := (found | sides).get(role)) is not None}


def _centre_joints(skeleton: Skeleton) -> dict[str, int]:
    plain = [_plain(name) for name in skeleton.names]
    found: dict[str, int] = {}
    for role, names in _CENTRE_NAMES.items():
        for name in names:
            if name in plain and plain.index(name) not in found.values():
                found[role] = plain.index(name)
                break
    found.setdefault("hips", 0)
    return found


def _side_joints(skeleton: Skeleton) -> dict[str, int]:
    sided = [_sides(_plain(name)) for name in skeleton.names]
    found: dict[str, int] = {}
    for side in ("left", "right"):
        for role in _SIDE_ORDER:
            for name in _SIDE_NAMES[role]:
                if (side, name) in sided and sided.index((side, name)) not in found.values():
                    found[f"{side}_{role}"] = sided.index((side, name))
                    break
        for role, above in (("hand", "wrist"), ("toe", "ankle")):
            top = found.get(f"{side}_{above}")
            if f"{side}_{role}" not in found and top is not None and (tip := _beyond(skeleton, top)) is not None:
                found[f"{side}_{role}"] = tip
    return found


def _beyond(skeleton: Skeleton, joint: int) -> int | None:
    """The joint at the other end of the longest bone below a wrist or an ankle; None where there is no bone."""
    below = [j for j in range(joint + 1, len(skeleton)) if joint in ancestors(skeleton, j)]
    near = [j for j in below if chain_length(skeleton, joint, int(skeleton.parents[j])) < 1e-3]
    longest = max(near, key=lambda j: float(skeleton.bone_lengths[j]), default=None)
    return longest if longest is not None and skeleton.bone_lengths[longest] > 1e-3 else None


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
    """Frames (..., 4) whose z is ``up`` and whose x is the part of ``across`` square to it."""
    z = up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9)
    x = across - z * np.sum(z * across, axis=-1, keepdims=True)
    x = x / np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-9)
    return rot.from_matrix(np.stack((x, np.cross(z, x), z), axis=-1))


def facing(frames: Rotations) -> Array:
    """Yaw in radians (...) of body-centre frames: where their front (y) points on the ground, 0 along +Y.

    Taken from the frontal vector, never from Euler angles, so that leaning does not turn it.
    """
    front = rot.rotate(frames, np.array([0.0, 1.0, 0.0]))
    return np.arctan2(-front[..., 0], front[..., 1])
