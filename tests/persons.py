"""Small bodies and motions that the tests of motion and formats share."""

from __future__ import annotations

import numpy as np

from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import local_rotations

_CENTRE = (
    ("Hips", "", (0, 0, 0)),
    ("Spine", "Hips", (0, 0, 0.12)),
    ("Chest", "Spine", (0, 0, 0.2)),
    ("Neck", "Chest", (0, 0.01, 0.24)),
    ("Head", "Neck", (0, 0.01, 0.1)),
    ("Head_end", "Head", (0, 0, 0.16)),
)
_SIDE = (
    ("Collar", "Chest", (0.04, 0, 0.2)),
    ("Shoulder", "Collar", (0.14, 0, 0.01)),
    ("Elbow", "Shoulder", (0.29, 0, 0)),
    ("Wrist", "Elbow", (0.25, 0, 0)),
    ("Wrist_end", "Wrist", (0.16, 0, 0)),
    ("Hip", "Hips", (0.1, 0, -0.05)),
    ("Knee", "Hip", (0, 0, -0.42)),
    ("Ankle", "Knee", (0, -0.01, -0.42)),
    ("Toe", "Ankle", (0, 0.14, -0.07)),
    ("Toe_end", "Toe", (0, 0.06, 0)),
)


def person(size: float = 1.0, arms_down: bool = False) -> Skeleton:
    """A symmetric adult who looks along +Y in a T-pose, or with hanging arms."""
    rows = [(name, parent, np.array(offset, float)) for name, parent, offset in _CENTRE]
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        for name, parent, offset in _SIDE:
            x, y, z = offset
            arm = name in ("Elbow", "Wrist", "Wrist_end")
            moved = np.array([0, y, -x]) if arms_down and arm else np.array([sign * x, y, z])
            above = parent if parent in ("Hips", "Chest") else side + parent
            rows.append((side + name, above, moved))
    rows = depth_first(rows)
    names = [name for name, _, _ in rows]
    parents = [names.index(parent) if parent else -1 for _, parent, _ in rows]
    offsets = np.array([offset for _, _, offset in rows]) * size
    return Skeleton(names, parents, offsets, [name.endswith("_end") for name in names])


def depth_first(rows: list[tuple[str, str, np.ndarray]]) -> list[tuple[str, str, np.ndarray]]:
    """Rows of (name, parent, offset) in the order in which a hierarchy lists them."""

    def below(parent: str) -> list[tuple[str, str, np.ndarray]]:
        return [found for row in rows if row[1] == parent for found in (row, *below(row[0]))]

    return below("")


def swinging(skeleton: Skeleton, frames: int = 60, fps: float = 60.0, seed: int = 0, angle: float = 0.6) -> Motion:
    """All joints swing smoothly, each about an axis and with a phase of its own, while the root walks."""
    rng = np.random.default_rng(seed)
    t = np.arange(frames) / fps
    axes = rng.normal(size=(len(skeleton), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    angles = angle * np.sin(2 * np.pi * (0.7 * t[:, None] + rng.random(len(skeleton))))
    rotations = rot.exp(axes * angles[..., None])
    rotations[:, skeleton.end_sites] = rot.IDENTITY
    path = np.stack((0.4 * t, np.sin(t), 0.92 + 0.05 * np.sin(3 * t)), axis=1)
    return Motion(skeleton, rotations, path, fps, "swinging")


def along_local_axes(motion: Motion) -> Motion:
    """The same movement on a skeleton whose bones lie along local X, the right side's along −X."""
    s = motion.skeleton
    sign = np.where(np.char.startswith(np.array(s.names), "Right"), -1.0, 1.0)
    frames = np.tile(rot.IDENTITY, (len(s), 1))
    for joint in range(1, len(s)):
        parent, bones = int(s.parents[joint]), s.children[joint]
        del parent
        if len(bones) == 1:
            frames[joint] = rot.between(np.array([sign[joint], 0, 0]), s.offsets[bones[0]])
    world = rot.multiply(motion.world_rotations, frames)
    offsets = rot.rotate(rot.inverse(frames[s.parents]), s.offsets)
    offsets[0] = 0
    laid = Skeleton(s.names, s.parents, offsets, s.end_sites)
    rotations = local_rotations(laid, world)
    return Motion(laid, rotations, motion.root_positions, motion.fps, motion.name)


BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0.0 0.0 0.0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Spine
  {
    OFFSET 0.0 60.0 0.0
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0.0 40.0 0.0
    }
  }
  JOINT Leg
  {
    OFFSET 10.0 0.0 0.0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0.0 -80.0 0.0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
1.0 90.0 3.0 10.0 20.0 30.0 40.0 50.0 60.0 70.0
2.0 91.0 4.0 11.0 21.0 31.0 41.0 51.0 61.0 71.0
"""
"""Ten channels, two frames: a body of 180 cm whose leg has one channel."""

ASF = """# a skeleton
:version 1.10
:name TEST
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name thigh
     direction 0 -1 0
     length 8.0
     axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
     id 2
     name shin
     direction 0 -1 0
     length 7.0
     axis 0 0 0 XYZ
    dof rx
  end
  begin
     id 3
     name back
     direction 0 1 0
     length 10.0
     axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh back
    thigh shin
  end
"""

AMC = """#!OML:ASF TEST
:FULLY-SPECIFIED
:DEGREES
1
root 1.0 16.0 2.0 0 0 0
thigh 0 0 0
shin 0
2
root 1.0 16.0 2.0 10 20 30
thigh 40 50 60
shin 9e1
"""
