"""A simple visible body for formats that carry a mesh: one tapering capsule per bone, moved rigidly by its joint."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Ints, Positions
from onbeat.errors import BodyError
from onbeat.motion import Body, Skeleton
from onbeat.motion.body import ancestors

SIDES = 10
_ADULT_LEG = 0.82
_RADII = {
    "hips": (0.095, 0.088),
    "spine": (0.1, 0.11),
    "chest": (0.115, 0.075),
    "neck": (0.055, 0.05),
    "head": (0.09, 0.085),
    "collar": (0.07, 0.055),
    "shoulder": (0.055, 0.04),
    "elbow": (0.041, 0.028),
    "wrist": (0.03, 0.026),
    "hand": (0.026, 0.018),
    "hip": (0.086, 0.054),
    "knee": (0.056, 0.038),
    "ankle": (0.04, 0.03),
    "toe": (0.03, 0.022),
}
"""Metres at the start and the end of the bones that hang on a joint, for an adult, by the joint's role."""
_TIPS = {"head": (0.06, 0.115), "left_wrist": (0.0, 0.13), "right_wrist": (0.0, 0.13)}
"""Metres beyond a joint at which the ball-ended body part starts and ends, for an adult whose file ends there."""


class Bone(NamedTuple):
    """A capsule: its start and end (3,) and the radii there in metres, and the joint that moves it."""

    start: Positions
    end: Positions
    radius_a: float
    radius_b: float
    owner: int


class Mesh(NamedTuple):
    """Triangles of a body in the rest pose; each vertex belongs to one joint."""

    vertices: Positions
    """(V, 3) metres."""
    normals: Positions
    """(V, 3) unit vectors."""
    joints: Ints
    """(V,) the joint that moves each vertex."""
    triangles: Ints
    """(T, 3) vertices, counter-clockwise seen from outside."""


def body_mesh(skeleton: Skeleton) -> Mesh:
    """The mesh of a skeleton in its rest pose with the root at the origin."""
    body = _body(skeleton)
    bones = _bones(skeleton, body)
    if body is not None:
        bones += [*_ribs(body), *_tips(body, {bone.owner for bone in bones})]
    bones = bones or [Bone(np.zeros(3), np.array([0, 0, 1e-3]), 0.05, 0.05, 0)]
    parts = [_capsule(bone) for bone in bones]
    owners = [bone.owner for bone in bones]
    counts = [len(points) for points, _, _ in parts]
    starts = np.cumsum([0, *counts[:-1]])
    return Mesh(
        np.concatenate([points for points, _, _ in parts]),
        np.concatenate([normals for _, normals, _ in parts]),
        np.repeat(np.array(owners, np.int64), counts),
        np.concatenate([triangles + start for (_, _, triangles), start in zip(parts, starts, strict=True)]),
    )


def _body(skeleton: Skeleton) -> Body | None:
    try:
        return Body.of(skeleton)
    except BodyError:
        return None


def _bones(skeleton: Skeleton, body: Body | None) -> list[Bone]:
    """Start, end, radii and moving joint of each bone that has a length, twins once."""
    rest, radii = skeleton.rest_positions, _radii(skeleton, body)
    made: list[Bone] = []
    there: set[tuple[float, ...]] = set()
    for joint in range(1, len(skeleton)):
        parent, length = int(skeleton.parents[joint]), float(skeleton.bone_lengths[joint])
        twin = (parent, *np.round(skeleton.offsets[joint], 6).tolist())
        if length > 1e-4 and twin not in there:
            there.add(twin)
            start, end = radii[parent]
            start, end = min(start, 0.6 * length + 0.01), min(end, 0.6 * length + 0.01)
            # The ball at a tip ends there; at a joint it is centred there.
            short = min(end, 0.9 * length) / length if skeleton.end_sites[joint] else 0.0
            made.append(Bone(rest[parent], rest[joint] - short * skeleton.offsets[joint], start, end, parent))
    return made


def _ribs(body: Body) -> list[Bone]:
    """From the chest most of the way to each shoulder, so that the trunk is broader than it is deep."""
    rest, chest, size = body.skeleton.rest_positions, body["chest"], _size(body)
    made: list[Bone] = []
    for shoulder in body.indices("left_shoulder", "right_shoulder").tolist():
        end = rest[chest] + 0.7 * (rest[shoulder] - rest[chest])
        if np.linalg.norm(end - rest[chest]) > 1e-4:
            made.append(Bone(rest[chest], end, 0.1 * size, 0.085 * size, chest))
    return made


def _tips(body: Body, owners: set[int]) -> list[Bone]:
    """A head and hands where a file ends with their joints, on along the bones that lead there."""
    skeleton, size, made = body.skeleton, _size(body), list[Bone]()
    for role, (low, high) in _TIPS.items():
        joint = body.joints.get(role, 0)
        length = float(skeleton.bone_lengths[joint])
        if length > 1e-4 and not any(joint in ancestors(skeleton, owner) for owner in owners):
            along = size / length * skeleton.offsets[joint]
            at, (start, end) = skeleton.rest_positions[joint], _RADII[role.split("_")[-1]]
            made.append(Bone(at + low * along, at + high * along, start * size, end * size, joint))
    return made


def _size(body: Body) -> float:
    """How much larger a body is than an adult, by its legs."""
    return min(max(body.leg_length / _ADULT_LEG, 0.2), 3.0)


def _radii(skeleton: Skeleton, body: Body | None) -> list[tuple[float, float]]:
    """Radii for the bones below each joint: those of its role, or of the nearest role above it."""
    if body is None:
        return [(0.03, 0.025)] * len(skeleton)
    size = _size(body)
    by_joint = {joint: _RADII[role.split("_")[-1]] for role, joint in body.joints.items()}
    radii: list[tuple[float, float]] = []
    for joint in range(len(skeleton)):
        parent = max(int(skeleton.parents[joint]), 0)
        start, end = by_joint.setdefault(joint, by_joint.get(parent, (0.05, 0.05)))
        radii.append((start * size, end * size))
    return radii


def _capsule(bone: Bone) -> tuple[Positions, Positions, Ints]:
    """Vertices, normals and triangles of a tapering capsule: half a ball, a cone, half a ball."""
    along = (bone.end - bone.start) / np.linalg.norm(bone.end - bone.start)
    helper = np.eye(3)[int(np.argmin(np.abs(along)))]
    u = np.cross(along, helper)
    u /= np.linalg.norm(u)
    v = np.cross(along, u)
    around = np.linspace(0, 2 * np.pi, SIDES, endpoint=False)
    ring = np.asarray(np.cos(around)[:, None] * u + np.sin(around)[:, None] * v, np.float64)
    slopes = np.asarray(np.deg2rad(np.array([-90.0, -60, -30, 0, 0, 30, 60, 90])), np.float64)
    normals = np.asarray(np.cos(slopes)[:, None, None] * ring + np.sin(slopes)[:, None, None] * along, np.float64)
    radius = np.repeat([bone.radius_a, bone.radius_b], 4)[:, None, None]
    centre = np.repeat(np.stack((bone.start, bone.end)), 4, axis=0)[:, None]
    vertices = (centre + radius * normals).reshape(-1, 3)
    return vertices, normals.reshape(-1, 3), _tube(len(slopes))


def _tube(rings: int) -> Ints:
    """Triangles between neighbouring rings of :data:`SIDES` vertices; those of no area at the poles are left out."""
    low, side = np.meshgrid(np.arange(rings - 1) * SIDES, np.arange(SIDES), indexing="ij")
    a, b = low + side, low + (side + 1) % SIDES
    first, second = np.stack((a, b, b + SIDES), -1), np.stack((a, b + SIDES, a + SIDES), -1)
    return np.concatenate((first[1:].reshape(-1, 3), second[:-1].reshape(-1, 3)))
