"""What a dancer asks of a robot at each moment: directions of its links, how its parts are turned, where its feet are.

Directions need no common rest pose: a link of the robot is to point as the dancer's bone does. Pelvis, feet, hands and
head are to be turned as the dancer's are against a standing pose (:mod:`onbeat.motion.retarget`). A hand's standing
pose is found along the arm, so that a palm that faces the thigh does so on both whatever their rest poses: with a the
rest bones of the robot and b those of the dancer, ``B_elbow = between(B_shoulder a, b) B_shoulder`` and so on.

A foot is wanted where the dancer's is seen from the hip, scaled by the legs; its height is such that the lowest
corner of its sole is as far above the floor as the dancer's foot is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations, Times
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, facing, frames_from
from onbeat.motion.contacts import SIDES, foot_contacts
from onbeat.motion.motion import Motion
from onbeat.motion.retarget import most_upright_frame, stands_in_rest
from onbeat.motion.retarget import retarget as onto_skeleton
from onbeat.robots.model import Robot, body_of

KEYPOSE_WEIGHT = 3.0
"""How much more a frame at a keypose weighs."""
KEYPOSE_WIDTH = 0.06
"""Seconds, the standard deviation of that around a keypose."""
_LINKS = {"shoulder": ("elbow", 1.0), "elbow": ("wrist", 1.0), "wrist": ("hand", 0.4), "hip": ("knee", 0.15)}
"""Bones whose direction is wanted: where they begin and end, and what a radian weighs."""
_PELVIS, _TRUNK, _HEAD, _FOOT, _ARM, _PALM = 0.8, 1.0, 0.3, 0.6, 0.1, 0.15
"""What a radian weighs by which a part is turned wrongly."""
_PATH, _ANKLE, _HEIGHT, _WRIST, _BOTH = 2.0, 4.0, 15.0, 0.7, 4.0
"""What a metre weighs of root, ankles, ankles' height, wrists, and of one wrist from the other where they are near."""

APART = 0.55
"""Least distance between the ankles, across, as a part of the width of the hips."""
TOGETHER = 0.1
"""Metres, of a robot's wrists: how near to each other they are for that to matter (a standard deviation)."""
TILT = 0.4
"""Radians by which a foot is tilted at most."""
_SOFT, _STEP_HEIGHT = 0.015, 0.02
"""Metres over which that begins to hold, and by which a foot is higher that gives way."""


class Aims(NamedTuple):
    """What is wanted in each of F frames: T vectors, R turns, and the root.

    Parameters
    ----------
    starts, ends : (T,) joints between which a vector is; of a start of -1 it is a place in the world.
    unit : (T,) true for directions, false for metres.
    vectors : (F, T, 3).
    weights : (T, 3).
    strengths : (F, T) parts of the weights, by time.
    joints : (R,) that are to be turned.
    turns : (F, R, 3, 3) rotation matrices in the world.
    turn_weights : (R,).
    place, turn : (F, 3) metres and (F, 3, 3), of the root.
    importance : (F,) what a frame weighs, 1 but near keyposes.
    """

    starts: Ints
    ends: Ints
    unit: Array
    vectors: Array
    weights: Array
    strengths: Array
    joints: Ints
    turns: Array
    turn_weights: Array
    place: Positions
    turn: Array
    importance: Array

    def cut(self, part: slice) -> Aims:
        """What is wanted in some of the frames."""
        names = ("vectors", "strengths", "turns", "place", "turn", "importance")
        return self._replace(**{name: np.ascontiguousarray(getattr(self, name)[part]) for name in names})


class _Vector(NamedTuple):
    start: int
    end: int
    unit: bool
    wanted: Positions
    weight: tuple[float, float, float]
    strength: Array | float = 1.0


def _evenly(weight: float) -> tuple[float, float, float]:
    return weight, weight, weight


class _Turn(NamedTuple):
    joint: int
    wanted: Rotations
    weight: float


def aims_of(motion: Motion, robot: Robot, keyposes: Times | None = None) -> Aims:
    """What a dancer's motion asks of a robot, frame by frame.

    Raises
    ------
    BodyError
        If a role that is needed is missing on either side, or the robot does not stand where its angles are zero.
    """
    source, target = Body.of(motion.skeleton), body_of(robot)
    ideal = onto_skeleton(motion, robot.body.skeleton)
    vectors = [*_bones(motion, source, target), *_hands(motion, source, target)]
    vectors += [*_feet(motion, source, ideal, target, robot)]
    turns = [*_trunk(motion, source, ideal, target), *_arms(motion, source, target)]
    return Aims(
        np.array([v.start for v in vectors]),
        np.array([v.end for v in vectors]),
        np.array([float(v.unit) for v in vectors]),
        np.stack([v.wanted for v in vectors], axis=1),
        np.array([v.weight for v in vectors]),
        np.stack([np.broadcast_to(v.strength, len(motion)) for v in vectors], axis=1),
        np.array([turn.joint for turn in turns]),
        rot.to_matrix(np.stack([turn.wanted for turn in turns], axis=1)),
        np.array([turn.weight for turn in turns]),
        np.array(ideal.root_positions),
        rot.to_matrix(ideal.rotations[:, 0]),
        _importance(motion, keyposes),
    )


def _importance(motion: Motion, keyposes: Times | None) -> Array:
    weights = np.ones(len(motion))
    for second in [] if keyposes is None else np.asarray(keyposes, np.float64).tolist():
        near = np.exp(-0.5 * ((motion.times - second) / KEYPOSE_WIDTH) ** 2)
        weights = np.maximum(weights, 1 + (KEYPOSE_WEIGHT - 1) * near)
    return weights


def _bones(motion: Motion, source: Body, target: Body) -> list[_Vector]:
    """Directions of the bones that both have, where they have a length."""
    found: list[_Vector] = []
    for side in SIDES:
        for part, (end, weight) in _LINKS.items():
            roles = f"{side}_{part}", f"{side}_{end}"
            if not all(role in body for role in roles for body in (source, target)):
                continue
            start, tip = target.indices(*roles).tolist()
            bone = np.diff(motion.positions[:, source.indices(*roles)], axis=1)[:, 0]
            long = np.linalg.norm(bone, axis=-1, keepdims=True)
            if float(long.min()) > 1e-3:
                found.append(_Vector(start, tip, True, bone / long, _evenly(weight)))
    return found


def _trunk(motion: Motion, source: Body, ideal: Motion, target: Body) -> list[_Turn]:
    """Pelvis, chest, head and feet."""
    chest = rot.multiply(
        _trunk_frames(motion.positions, source), rot.inverse(_trunk_frames(target.skeleton.rest_positions, target))
    )
    turns = [_Turn(target.turning("hips"), ideal.world_rotations[:, target["hips"]], _PELVIS)]
    turns.append(_Turn(target["chest"], chest, _TRUNK))
    if "head" in source and "head" in target:
        turns.append(_Turn(target["head"], ideal.world_rotations[:, target["head"]], _HEAD))
    for side in SIDES:
        foot = target.turning(f"{side}_ankle")
        turns.append(_Turn(foot, flatter(ideal.world_rotations[:, foot]), _FOOT))
    return turns


def _trunk_frames(positions: Positions, body: Body) -> Rotations:
    """From the hips up to the shoulders, and across the shoulders from left to right."""
    left, right = positions[..., body["left_shoulder"], :], positions[..., body["right_shoulder"], :]
    hips = positions[..., body.indices("left_hip", "right_hip"), :].mean(axis=-2)
    return frames_from((left + right) / 2 - hips, right - left)


def _hands(motion: Motion, source: Body, target: Body) -> list[_Vector]:
    """Wrists from their shoulders and, where they are near each other, one from the other, scaled by the arms."""
    p, scale = motion.positions, _arm_length(target) / _arm_length(source)
    found: list[_Vector] = []
    for side in SIDES:
        roles = f"{side}_shoulder", f"{side}_wrist"
        start, end = target.indices(*roles).tolist()
        way = np.diff(p[:, source.indices(*roles)], axis=1)[:, 0] * scale
        found.append(_Vector(start, end, False, way, _evenly(_WRIST)))
    left, right = target.indices("left_wrist", "right_wrist").tolist()
    way = (p[:, source["right_wrist"]] - p[:, source["left_wrist"]]) * scale
    near = np.exp(-0.5 * np.sum(way * way, axis=-1) / TOGETHER**2)
    found.append(_Vector(left, right, False, way, _evenly(_BOTH), np.where(near > 0.01, near, 0.0)))
    return found


def _arm_length(body: Body) -> float:
    line = body.skeleton.rest_positions[body.indices("left_shoulder", "left_elbow", "left_wrist")]
    return float(np.linalg.norm(np.diff(line, axis=0), axis=-1).sum())


def _arms(motion: Motion, source: Body, target: Body) -> list[_Turn]:
    """How the upper arms and the hands are turned about themselves."""
    frame = None if stands_in_rest(source) else most_upright_frame(motion, source)
    pose = source.skeleton.rest_positions if frame is None else motion.positions[frame]
    turns: list[_Turn] = []
    for side in SIDES:
        aligned = _facing_turn(source, pose, target)
        for part, end, weight in (("shoulder", "elbow", _ARM), ("elbow", "wrist", 0.0), ("wrist", "hand", _PALM)):
            roles = f"{side}_{part}", f"{side}_{end}"
            if all(role in body for role in roles for body in (source, target)):
                a = np.diff(target.skeleton.rest_positions[target.indices(*roles)], axis=0)[0]
                b = np.diff(pose[source.indices(*roles)], axis=0)[0]
                aligned = rot.multiply(rot.between(rot.rotate(aligned, a), b), aligned)
            joint = source.turning(roles[0])
            change = motion.world_rotations[:, joint]
            if frame is not None:
                change = rot.multiply(change, rot.inverse(motion.world_rotations[frame, joint]))
            if weight:
                turns.append(_Turn(target.turning(roles[0]), rot.multiply(change, aligned), weight))
    return turns


def _facing_turn(source: Body, pose: Positions, target: Body) -> Rotations:
    """The turn about the vertical by which the robot's resting pose faces where the dancer's does."""
    frames = _trunk_frames(pose, source), _trunk_frames(target.skeleton.rest_positions, target)
    return rot.yaw(float(facing(frames[0]) - facing(frames[1])))


def _feet(motion: Motion, source: Body, ideal: Motion, target: Body, robot: Robot) -> list[_Vector]:
    """Where the ankles are wanted."""
    heights = _clearance(motion, source) * target.leg_length / source.leg_length
    ankles = _uncrossed(np.array(ideal.positions[:, target.indices("left_ankle", "right_ankle")]), ideal, target)
    found: list[_Vector] = []
    for number, side in enumerate(SIDES):
        ankle, foot = target[f"{side}_ankle"], target.turning(f"{side}_ankle")
        rest = target.skeleton.rest_positions
        corners = _corners(robot, side, foot) + rest[foot] - rest[ankle]
        lowest = rot.rotate(flatter(ideal.world_rotations[:, foot])[:, None], corners)[..., 2].min(axis=1)
        wanted = ankles[:, number]
        wanted[:, 2] = heights[:, number] - lowest
        found.append(_Vector(-1, ankle, False, wanted, (_ANKLE, _ANKLE, _HEIGHT)))
    return found


def _uncrossed(ankles: Positions, ideal: Motion, target: Body) -> Positions:
    """Ankles (F, 2, 3) of which the left stays on the left of the right one, by a part of the hips' width.

    A robot's legs are too thick to cross. The higher foot gives way to the lower.
    """
    hips = ideal.positions[:, target["left_hip"]] - ideal.positions[:, target["right_hip"]]
    across = hips * [1.0, 1.0, 0.0]
    across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)
    least = APART * float(
        np.linalg.norm(np.diff(target.skeleton.rest_positions[target.indices("left_hip", "right_hip")], axis=0))
    )
    now = np.sum((ankles[:, 0] - ankles[:, 1]) * across, axis=-1)
    # A soft maximum: without a corner where the least begins to hold.
    lacking = _SOFT * np.logaddexp(0.0, (least - now) / _SOFT)
    left = 1 / (1 + np.exp(-np.clip((ankles[:, 0, 2] - ankles[:, 1, 2]) / _STEP_HEIGHT, -30, 30)))
    moved = ankles.copy()
    moved[:, 0] += (left * lacking)[:, None] * across
    moved[:, 1] -= ((1 - left) * lacking)[:, None] * across
    return moved


def flatter(feet: Rotations) -> Rotations:
    """Feet (F, 4) tilted less than :data:`TILT` against the floor: a robot does not dance on its toes."""
    up = rot.rotate(feet, np.array([0.0, 0.0, 1.0]))
    upright = rot.multiply(rot.between(up, np.array([0.0, 0.0, 1.0])), feet)
    tilt = rot.log(rot.multiply(feet, rot.inverse(upright)))
    angle = np.linalg.norm(tilt, axis=-1, keepdims=True)
    return rot.multiply(rot.exp(tilt * TILT * np.tanh(angle / TILT) / np.maximum(angle, 1e-9)), upright)


def _corners(robot: Robot, side: str, foot: int) -> Positions:
    """The sole's corners (4, 3) from the foot's joint, in its frame of the zero configuration."""
    hinge = robot.body.joints.tolist().index(foot)
    return rot.rotate(robot.body.links[hinge], robot.feet[side].corners)


def _clearance(motion: Motion, source: Body) -> Array:
    """(F, 2) metres by which the lowest joint of the dancer's left and right foot is above where it rests."""
    contacts = foot_contacts(motion, source)
    high = motion.positions[:, source.indices("left_ankle", "right_ankle"), 2] - contacts.heel_floor
    if "left_toe" in source and "right_toe" in source:
        toes = motion.positions[:, source.indices("left_toe", "right_toe"), 2] - contacts.toe_floor
        high = np.minimum(high, toes)
    return np.maximum(high, 0.0)
