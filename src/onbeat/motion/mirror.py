"""The mirror image of a motion on the same skeleton: left becomes right.

The world is reflected across a vertical plane, ``S = I − 2 n nᵀ`` with n across the body. Each joint takes the world
rotation of its partner on the other side, ``W'_j = S W_p M_j``, where the reflection M_j takes the joint's own frame
to its partner's: ``M_j o_c = o_p(c)`` for the bones that hang on it. On a skeleton whose rest pose is symmetric all
M_j are S; where a file lays its bones along local axes they are found bone by bone. With ``M = −P``, P a half turn or
none, and joint a above j, the local rotations are ``R'_j = P_a⁻¹ R_p P_j``: mirroring twice gives the motion back. On
a symmetric skeleton the joints land exactly where the reflected ones are; otherwise each side keeps its own bones.
"""

from __future__ import annotations

import re

import numpy as np

from onbeat._shapes import Array, Ints, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.motion import Motion

_PAIRS = (("left", "right"), ("l", "r"))


def mirrored(motion: Motion, body: Body | None = None) -> Motion:
    """The mirror image of a motion on its own skeleton; mirroring twice gives the motion back.

    Raises
    ------
    BodyError
        If the skeleton has no left and right that are known.
    """
    body = Body.of(motion.skeleton) if body is None else body
    skeleton, partner = motion.skeleton, partners(body)
    turns, world = _half_turns(body, partner), half_turn(world_normal(body))
    above = turns[skeleton.parents]
    above[0] = world
    rotations = rot.multiply(rot.multiply(rot.inverse(above), motion.rotations[:, partner]), turns)
    translations = motion.translations
    if translations is not None:
        translations = -rot.rotate(rot.inverse(above), translations[:, partner])
    path = -rot.rotate(world, motion.root_positions)
    return Motion(skeleton, rotations, path, motion.fps, motion.name, translations)


def half_turn(normal: Array) -> Rotations:
    """The half turn P about a unit vector (3,): ``−P`` is the reflection across the plane square to it."""
    return np.array([0.0, *normal])


def _half_turns(body: Body, partner: Ints) -> Rotations:
    """(J, 4) P_j: of the body's reflection, the parent's, none and those of the axes the first that suits its bones.

    A choice suits when it takes the joint's bones to its partner's almost (a tenth of their length) as well as any.
    """
    skeleton = body.skeleton
    turns = np.tile(half_turn(sagittal_normal(body)), (len(skeleton), 1))
    axes = [half_turn(axis) for axis in np.eye(3)]
    for joint in range(len(skeleton)):
        other = int(partner[joint])
        choices = np.array([turns[0], turns[skeleton.parents[joint]], rot.IDENTITY, *axes])
        bones = [c for j in {joint, other} for c in skeleton.children[j]]
        images = -rot.rotate(choices[:, None], skeleton.offsets[bones])
        errors = np.linalg.norm(images - skeleton.offsets[partner[bones]], axis=-1).sum(1)
        suits = errors <= errors.min() + 0.1 * skeleton.bone_lengths[bones].sum()
        turns[joint] = choices[int(np.argmax(suits))] if joint <= other else turns[other]
    return turns


def partners(body: Body) -> Ints:
    """(J,) the joint on the other side of each joint, itself on the centre line; by roles, then by names.

    Swapping is its own inverse: a joint without a clear partner is its own.
    """
    skeleton = body.skeleton
    partner = np.arange(len(skeleton))
    lower = {name.lower(): joint for joint, name in enumerate(skeleton.names)}
    for joint, name in enumerate(skeleton.names):
        for other in _other_names(name):
            if (found := lower.get(other, joint)) != joint and partner[joint] == joint and partner[found] == found:
                partner[joint], partner[found] = found, joint
    for role, joint in body.joints.items():
        if role.startswith("left_") and (other := body.joints.get("right_" + role.removeprefix("left_"))) is not None:
            for alone in (partner[joint], partner[other]):
                partner[alone] = alone
            partner[joint], partner[other] = other, joint
    return partner


def _other_names(name: str) -> list[str]:
    """The names, in lower case, that a joint's partner may have: each left or right in it turned over."""
    made: list[str] = []
    for pair in _PAIRS:
        for here, there in (pair, pair[::-1]):
            places = [m for m in re.finditer(here, name, re.IGNORECASE) if len(here) > 1 or _is_mark(name, m.start())]
            made += [name[: m.start()].lower() + there + name[m.end() :].lower() for m in places]
    return made


def _is_mark(name: str, at: int) -> bool:
    """Whether the single letter at a place stands for a side: at the start, the end, or set off by a separator."""
    before, after = name[at - 1] if at else "_", name[at + 1] if at + 1 < len(name) else "_"
    return at == 0 or not before.isalnum() or not after.isalnum()


def sagittal_normal(body: Body) -> Array:
    """(3,) the unit vector across the hips' frame, from the right to the left hip; X where that is no line.

    A direction within 5° of a coordinate axis is taken to be that axis: bodies are built along axes, and the few
    millimetres by which hips are off must not turn the path.
    """
    rest = body.skeleton.rest_positions
    across: Array = rest[body["left_hip"]] - rest[body["right_hip"]]
    length = float(np.linalg.norm(across))
    if length < 1e-6:
        return np.array([1.0, 0.0, 0.0])
    across = across / length
    axis = int(np.argmax(np.abs(across)))
    return np.eye(3)[axis] if abs(across[axis]) > np.cos(np.radians(5)) else across


def world_normal(body: Body) -> Array:
    """(3,) the horizontal unit vector across which the world is reflected: the body's own where it is level, else X."""
    normal = sagittal_normal(body) * [1, 1, 0]
    length = float(np.linalg.norm(normal))
    return normal / length if length > 0.5 else np.array([1.0, 0.0, 0.0])
