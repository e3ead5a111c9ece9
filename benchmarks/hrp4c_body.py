"""The humanoid HRP-4C read from its Choreonoid model, and its legs bent so that its feet are where they should be.

``HRP4C.body`` (YAML; the model is not part of onbeat) has the links as a tree: each one's place in the frame of the
link above it, a fixed tilt, and the axis, the range and the highest speed of its joint, in degrees. The legs turn at
one point of the hip about z, x and y, at the knee about y and at one point of the ankle about y and x, so that the six
angles that put a foot somewhere have a closed form.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from onbeat.motion import rotations as rot
from onbeat.motion.hinges import End, Hinge, HingeBody

ROOT = "WAIST"
FEET = {"left": "L_ANKLE_R", "right": "R_ANKLE_R"}
LEG = ("HIP_Y", "HIP_R", "HIP_P", "KNEE_P", "ANKLE_P", "ANKLE_R")
SOLE = 0.093  # [m] below the ankle
FINGERS = 0.12  # [m] from the wrist to the finger tips, about
_AXES = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}
# Told, as the names mislead: the wrist's first axis is in the elbow.
_PARTS = {"shoulder": "SHOULDER_P", "elbow": "ELBOW_P", "wrist": "WRIST_R"}
_PARTS |= {"hip": "HIP_Y", "knee": "KNEE_P", "ankle": "ANKLE_P", "toe": "TOE_P"}
_ROLES = {"hips": ROOT, "chest": "CHEST_Y", "neck": "NECK_Y", "head": "HEAD"}
_ROLES |= {f"{side}_{part}": f"{side[0].upper()}_{name}" for side in FEET for part, name in _PARTS.items()}
_ROLES |= {f"{side}_hand": f"{side[0].upper()}_HAND" for side in FEET}
# Ends of links, estimated from the extents of the shapes in the model.
_ENDS = [
    *(End(f"{s}_TOE", f"{s}_TOE_P", (0.06, 0, -0.016)) for s in "LR"),
    *(End(f"{s}_HEEL", f"{s}_ANKLE_R", (-0.065, 0, -SOLE)) for s in "LR"),
    *(End(f"{s}_HAND", f"{s}_WRIST_R", (0, 0, -FINGERS)) for s in "LR"),
    End("HEAD", "NECK_P", (0.02, 0, 0.1)),
]


@dataclass(frozen=True)
class Leg:
    """What the closed form needs of a leg, in metres: the hip's place, how far the knee is aside, thigh and shank."""

    hip: np.ndarray
    side: float
    thigh: float
    shank: float


def read_body(path: Path) -> tuple[HingeBody, list[int]]:
    """The robot, and the number (Choreonoid's ``joint_id``) of each of its hinges."""
    links = yaml.safe_load(path.read_text(encoding="utf-8"))["links"]
    moving = [link for link in links if link.get("joint_type") == "revolute"]
    body = HingeBody.of("HRP-4C", ROOT, [_hinge(link) for link in moving], _ENDS)
    return replace(body, skeleton=body.skeleton.replace(roles=_ROLES)), [link["joint_id"] for link in moving]


def _hinge(link: Mapping[str, Any]) -> Hinge:
    x, y, z, degrees = link.get("rotation", (1, 0, 0, 0))
    if (x, y, z) != (1, 0, 0):
        raise ValueError(f"{link['name']}: tilted about {x, y, z}; only tilts about x are known")
    axis = link["joint_axis"]  # three numbers, or a letter
    low, high = np.radians(link["joint_range"]).tolist()
    speed = float(np.radians(np.abs(link["joint_velocity_range"]).max()))
    offset = tuple(link.get("translation", (0, 0, 0)))
    tilt = (float(np.radians(degrees)), 0.0, 0.0)
    return Hinge(
        link["name"],
        link["parent"],
        offset,
        tilt,
        _AXES[axis] if isinstance(axis, str) else tuple(axis),
        low,
        high,
        speed,
    )


def leg_of(body: HingeBody, side: str) -> Leg:
    """The lengths of one leg."""
    hip, _, _, knee, ankle, _ = (
        body.skeleton.offsets[body.skeleton.index(f"{side[0].upper()}_{part}")] for part in LEG
    )
    return Leg(hip, float(knee[1]), float(-knee[2]), float(-ankle[2]))


def bend_leg(
    leg: Leg, waist: tuple[np.ndarray, np.ndarray], foot: tuple[np.ndarray, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Angles (F, 6) by ``LEG`` that bring a foot to its place, and by how many metres (F,) it is out of reach.

    Places are (F, 3) metres and (F, 4) wxyz. The hip as the foot sees it is ``p = R_foot⁻¹ (hip − ankle)``. Rolling
    the ankle must bring the hip into the plane in which hip and knee bend, which lies ``d`` beside the ankle:
    ``p_y cos r − p_z sin r = d``. In that plane thigh a and shank b end at the distance c: cosine rule. What is left
    over of the foot's rotation the three axes of the hip do.
    """
    hip = waist[0] + rot.rotate(waist[1], leg.hip)
    p = rot.rotate(rot.inverse(foot[1]), hip - foot[0])
    d, a, b = -leg.side, leg.thigh, leg.shank
    across = np.hypot(p[:, 1], p[:, 2])
    roll = np.arccos(np.clip(d / across, -1, 1)) - np.arctan2(p[:, 2], p[:, 1])
    along = np.sqrt(np.maximum(across**2 - d * d, 0.0))
    c = np.hypot(p[:, 0], along)
    knee = np.pi - np.arccos(np.clip((a * a + b * b - c * c) / (2 * a * b), -1, 1))
    pitch = np.arctan2(-a * np.sin(knee), b + a * np.cos(knee)) - np.arctan2(p[:, 0], along)
    x, y = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    thigh = rot.multiply(rot.multiply(foot[1], rot.about(x, -roll)), rot.about(y, -pitch - knee))
    hips = rot.to_euler("ZXY", rot.multiply(rot.inverse(waist[1]), thigh))
    return np.column_stack((hips, knee, pitch, roll)), np.maximum(c - a - b, 0.0)
