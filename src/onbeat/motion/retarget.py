"""A motion on another skeleton, and its floor at z = 0.

Two skeletons of the same joints and rest pose share local rotations. Otherwise motion goes over by roles. Both
bodies are looked at in a reference pose: the rest pose where that is a standing body, else the most upright frame.
A role's joint on the target then turns in the world as on the source, ``W_t = ΔW_s B_j W_t,ref`` with
``ΔW_s = W_s W_s,ref⁻¹``; B_j turns the target's reference pose to face as the source's does and lays the bone of a limb
along the source's. Feet keep their own pitch, for both stand flat in their reference poses.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, ancestors, facing, frames_from
from onbeat.motion.kinematics import forward_kinematics, local_rotations
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

_LIMBS = {"shoulder": "elbow", "elbow": "wrist", "wrist": "hand", "hip": "knee", "knee": "ankle", "ankle": "toe"}
_ABOVE = {"wrist": "elbow", "hand": "wrist", "toe": "ankle", "head": "neck", "neck": "chest", "spine": "hips"}
_TRUNK = ("hips", "spine", "chest", "neck", "head")
NEAR_FLOOR = 0.03
"""Metres of floor height that are left alone: joints of a foot are above its sole by as much."""
SLOW = 0.25  # m/s under which the lowest joint of a foot stands
AIR = 0.15
"""Metres by which feet are above another joint that are in the air."""
FEW = 0.05
"""Part of the frames in which feet have to stand."""


def retarget(motion: Motion, skeleton: Skeleton, reference: Motion | None = None) -> Motion:
    """The motion on another skeleton, its path scaled by the ratio of leg lengths and its floor at z = 0.

    Parameters
    ----------
    motion : what to move over; its own animated offsets are used and then dropped.
    skeleton : the target, J joints.
    reference : any motion on the target skeleton; needed only where the target's rest pose is no standing body.

    Raises
    ------
    BodyError
        If a needed role is missing on either side, or the target has no usable reference pose.
    """
    source, target = Body.of(motion.skeleton), Body.of(skeleton)
    if same_build(motion.skeleton, skeleton) and motion.translations is None:
        rotations = np.array(motion.rotations)
    else:
        rotations = _by_roles(motion, source, target, reference)
    rotations[:, skeleton.end_sites] = rot.IDENTITY
    path = _path(motion, source, target, rotations)
    moved = Motion(skeleton, rotations, path, motion.fps, motion.name)
    return grounded(moved, target, near=0.0)


def same_build(a: Skeleton, b: Skeleton) -> bool:
    """Whether two skeletons have the same joints in the same tree, with bones that point the same way (within 30°)."""
    if a.names != b.names or not np.array_equal(a.parents, b.parents):
        return False
    long = (a.bone_lengths > 0.02) & (b.bone_lengths > 0.02)
    return bool((_angles(a.offsets[long], b.offsets[long]) < np.radians(30)).all())


def grounded(motion: Motion, body: Body | None = None, near: float = NEAR_FLOOR) -> Motion:
    """The motion with its floor at z = 0; as it is where the floor is nearer to that than ``near`` metres."""
    height = floor_height(motion, body)
    if abs(height) <= near:
        return motion
    return motion.replace(root_positions=motion.root_positions - [0.0, 0.0, height])


def floor_height(motion: Motion, body: Body | None = None) -> float:
    """Metres, the height on which the feet stand, or on which the body lies whose feet never do.

    The median height of the feet's lowest joint over the frames in which that joint hardly moves (slower than
    ``SLOW`` m/s) and no joint is far below it; the 5th percentile over all frames where there is no such moment. A few
    dips under the floor, common in captured motion, and time spent in the air do not move it. Where the feet are in
    the air all along (:func:`feet_in_air`) it is the same of the lowest joint of the body.
    """
    body = Body.of(motion.skeleton) if body is None else body
    feet = _Lowest.of(motion, _feet(body))
    if len(motion) < 3:
        return float(feet.heights.min())
    low = _Lowest.of(motion, sorted(body.joints.values()))
    chosen, standing = feet, feet.slow & (feet.heights - low.heights < AIR)
    if _never_stand(feet, low):
        chosen, standing = low, low.slow
    heights = chosen.heights
    return float(np.median(heights[standing])) if standing.mean() > FEW else float(np.percentile(heights, 5))


def feet_in_air(motion: Motion, body: Body | None = None) -> bool:
    """Whether the body never stands on its feet, and other joints are far below them: it lies, or is on its hands."""
    body = Body.of(motion.skeleton) if body is None else body
    return _never_stand(_Lowest.of(motion, _feet(body)), _Lowest.of(motion, sorted(body.joints.values())))


class _Lowest(NamedTuple):
    """Of some joints the height of the lowest one in each frame (F,), and whether that one hardly moves (F,)."""

    heights: Array
    slow: Bools

    @classmethod
    def of(cls, motion: Motion, joints: list[int]) -> _Lowest:
        points = motion.positions[:, joints]
        lowest = points[..., 2].argmin(axis=1)
        frames = np.arange(len(motion))
        if len(motion) < 3:
            return cls(points[frames, lowest, 2], np.ones(len(motion), np.bool_))
        speeds = np.linalg.norm(np.gradient(points, axis=0), axis=-1)[frames, lowest] * motion.fps
        return cls(points[frames, lowest, 2], speeds < SLOW)


def _feet(body: Body) -> list[int]:
    """The ankles and all joints that they turn."""
    ankles = set(body.indices("left_ankle", "right_ankle").tolist())
    tree = Tree.of(body.skeleton)
    return [j for j in range(len(body.skeleton)) if any(j == ankle or tree.above(ankle, j) for ankle in ankles)]


def _never_stand(feet: _Lowest, low: _Lowest) -> bool:
    above = feet.heights - low.heights >= AIR
    return bool(above.mean() > 0.5 and (feet.slow & ~above).mean() <= FEW)


def stands_in_rest(body: Body) -> bool:
    """Whether the rest pose is a standing body: legs down and trunk up, each within 45°, and left not on the right."""
    rest = body.skeleton.rest_positions
    legs = [rest[body[f"{side}_ankle"]] - rest[body[f"{side}_hip"]] for side in ("left", "right")]
    trunk = rest[body.indices("left_shoulder", "right_shoulder")].mean(0) - rest[body["hips"]]
    upright = _angles(np.array([*legs, trunk]), np.array([[0, 0, -1], [0, 0, -1], [0, 0, 1.0]]))
    return bool((upright < np.pi / 4).all()) and float(np.linalg.norm(_across(rest, body)[:2])) > 1e-3


def most_upright_frame(motion: Motion, body: Body) -> int:
    """The frame most like standing: legs and trunk upright, elbows straight, both feet level."""
    p = motion.positions
    score = _unit(p[:, body.indices("left_shoulder", "right_shoulder")].mean(1) - p[:, body["hips"]])[:, 2] * 2
    for side in ("left", "right"):
        chain = body.indices(*(f"{side}_{role}" for role in ("hip", "knee", "ankle")))
        score -= _unit(np.diff(p[:, chain], axis=1))[..., 2].sum(1)
        arm = _unit(np.diff(p[:, body.indices(*(f"{side}_{r}" for r in ("shoulder", "elbow", "wrist")))], axis=1))
        score += np.sum(arm[:, 0] * arm[:, 1], axis=-1) - 0.5 * arm[:, 0, 2]
    ankles = p[:, body.indices("left_ankle", "right_ankle"), 2]
    return int(np.argmax(score - 10 * np.abs(ankles[:, 0] - ankles[:, 1])))


def _unit(v: Positions) -> Positions:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def _angles(a: Positions, b: Positions) -> Array:
    return np.arccos(np.clip(np.sum(_unit(a) * _unit(b), axis=-1), -1, 1))


def _across(positions: Positions, body: Body) -> Positions:
    """From left to right, of hips and shoulders together."""
    hips = positions[..., body["right_hip"], :] - positions[..., body["left_hip"], :]
    return hips + positions[..., body["right_shoulder"], :] - positions[..., body["left_shoulder"], :]


def _reference_pose(body: Body, motion: Motion | None) -> tuple[Rotations, Positions]:
    """World rotations (J, 4) and positions (J, 3) of a standing pose."""
    if stands_in_rest(body):
        return np.tile(rot.IDENTITY, (len(body.skeleton), 1)), body.skeleton.rest_positions
    if motion is None:
        raise BodyError("the rest pose of the target skeleton is not a standing body; give a motion of it as reference")
    frame = most_upright_frame(motion, body)
    return motion.world_rotations[frame], motion.positions[frame]


def _by_roles(motion: Motion, source: Body, target: Body, reference: Motion | None) -> Rotations:
    """(F, J, 4) local rotations of the target."""
    source_world, source_pose = _reference_pose(source, motion)
    target_world, target_pose = _reference_pose(target, reference)
    turns = _bone_turns(source, source_pose, target, target_pose)
    moved: dict[int, Rotations] = {}
    for role, turn in turns.items():
        joint = source.turning(role)
        change = rot.multiply(motion.world_rotations[:, joint], rot.inverse(source_world[joint]))
        moved[target[role]] = rot.multiply(change, turn)
    world = rot.multiply(_all_joints(target, moved), target_world)
    return local_rotations(target.skeleton, world)


def _bone_turns(source: Body, source_pose: Positions, target: Body, target_pose: Positions) -> dict[str, Rotations]:
    """B for each role that both bodies have, from the hips outwards."""
    yaw = rot.yaw(_yaw(source, source_pose) - _yaw(target, target_pose))
    turns: dict[str, Rotations] = {}
    for role in (role for role in source.joints if role in target):
        side, _, part = role.rpartition("_")
        end = f"{side}_{_LIMBS[part]}" if part in _LIMBS else ""
        above = f"{side}_{_ABOVE.get(part, '')}".lstrip("_")
        if end in source and end in target:
            a = rot.rotate(yaw, target_pose[target[end]] - target_pose[target[role]])
            b = source_pose[source[end]] - source_pose[source[role]]
            turn = _foot_turn(a, b) if part == "ankle" else rot.between(a, b)
            turns[role] = rot.multiply(turn, yaw)
        else:
            turns[role] = turns[above] if above in turns and part in ("wrist", "hand", "toe") else yaw
    trunk = rot.multiply(_trunk_frame(source, source_pose), rot.inverse(_trunk_frame(target, target_pose)))
    return turns | {role: trunk for role in ("hips", "spine", "chest") if role in turns}


def _foot_turn(a: Positions, b: Positions) -> Rotations:
    """The heading from foot ``a`` to foot ``b``; none where a file puts the toes rather below than before the ankle."""
    level = np.array([1.0, 1.0, 0.0])
    steep = any(np.linalg.norm(v * level) < 0.5 * np.linalg.norm(v) for v in (a, b))
    return rot.IDENTITY if steep else rot.between(a * level, b * level)


def _trunk_frame(body: Body, pose: Positions) -> Rotations:
    """Up from the hip sockets to the shoulders, across from left to right."""
    shoulders, hips = (body.indices(f"left_{part}", f"right_{part}") for part in ("shoulder", "hip"))
    return frames_from(pose[shoulders].mean(0) - pose[hips].mean(0), _across(pose, body))


def _yaw(body: Body, pose: Positions) -> float:
    return float(facing(_trunk_frame(body, pose)))


def _all_joints(target: Body, moved: dict[int, Rotations]) -> Rotations:
    """(F, J, 4) world turns from the reference pose: joints without a role go with the joint above them.

    Joints of the trunk between two roles share the way between them; those above the hips go with the hips.
    """
    skeleton = target.skeleton
    frames = len(moved[target["hips"]])
    turns = np.empty((frames, len(skeleton), 4))
    turns[:, ancestors(skeleton, target["hips"])] = moved[target["hips"]][:, None]
    shared = _shared(target, moved)
    done = set(ancestors(skeleton, target["hips"]))
    for joint in (j for j in range(len(skeleton)) if j not in done):
        turns[:, joint] = moved.get(joint, shared.get(joint, turns[:, max(int(skeleton.parents[joint]), 0)]))
    return turns


def _shared(target: Body, moved: dict[int, Rotations]) -> dict[int, Rotations]:
    line = [target[role] for role in _TRUNK if role in target and target[role] in moved]
    shared: dict[int, Rotations] = {}
    for top, bottom in itertools.pairwise(line):
        way = ancestors(target.skeleton, bottom)
        between = way[1 : way.index(top)][::-1] if top in way else []
        for n, joint in enumerate(between, 1):
            shared[joint] = rot.slerp(moved[top], moved[bottom], n / (len(between) + 1))
    return shared


def _path(motion: Motion, source: Body, target: Body, rotations: Rotations) -> Positions:
    """The target's root path: its hip sockets' mid-point goes where the source's does, scaled by the legs."""
    scale = target.leg_length / source.leg_length
    middle = motion.positions[:, source.indices("left_hip", "right_hip")].mean(1)
    middle = (middle - [0.0, 0.0, floor_height(motion, source)]) * scale
    _, posed = forward_kinematics(target.skeleton, rotations, np.zeros((len(motion), 3)))
    return middle - posed[:, target.indices("left_hip", "right_hip")].mean(1)
