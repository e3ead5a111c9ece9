"""Where on the body a marker sits: anatomical sites, the bone that carries each, and how well its place is known."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array

_BONY = (0.012, 0.012, 0.012)
_TRUNK = (0.03, 0.03, 0.03)
_JOINT = (0.002, 0.002, 0.002)


class Site(NamedTuple):
    """A place on the body.

    Parameters
    ----------
    segment : the joint whose rotation carries it ("LeftUpLeg": the left thigh).
    anchor : the joint from which its place is told: the segment's own or the one at the segment's other end.
    place : (3,) metres from the anchor in the rest pose of the template.
    spread : (3,) metres, one standard deviation of where it really is.
    """

    segment: str
    anchor: str
    place: Array
    spread: Array


_CENTRE: Mapping[str, tuple[str, str, tuple[float, float, float], tuple[float, float, float]]] = {
    "sacrum": ("Hips", "Hips", (0, -0.095, 0.05), _BONY),
    "waist_front": ("Hips", "Hips", (0, 0.12, 0.04), _TRUNK),
    "waist_back": ("Hips", "Hips", (0, -0.11, 0.05), _TRUNK),
    "hips": ("Hips", "Hips", (0, 0, 0), (0.01, 0.01, 0.02)),
    "spine": ("Spine", "Spine", (0, 0, 0), _TRUNK),
    "chest": ("Chest", "Chest", (0, 0, 0), (0.01, 0.02, 0.06)),
    "neck": ("Chest", "Neck", (0, 0, 0), (0.01, 0.01, 0.02)),
    "head": ("Neck", "Head", (0, 0, 0), (0.01, 0.03, 0.05)),
    "c7": ("Chest", "Chest", (0, -0.085, 0.26), _TRUNK),
    "t10": ("Chest", "Chest", (0, -0.12, 0.0), _TRUNK),
    "back_top": ("Chest", "Chest", (0, -0.11, 0.18), (0.02, 0.03, 0.06)),
    "clavicle": ("Chest", "Chest", (0, 0.065, 0.20), _TRUNK),
    "sternum": ("Chest", "Chest", (0, 0.11, 0.07), _TRUNK),
    "head_top": ("Head", "Head", (0, 0, 0.19), _TRUNK),
    "head_front": ("Head", "Head", (0, 0.11, 0.11), _TRUNK),
    "head_back": ("Head", "Head", (0, -0.10, 0.10), _TRUNK),
}
_SIDE: Mapping[str, tuple[str, str, tuple[float, float, float], tuple[float, float, float]]] = {
    "head_front": ("Head", "Head", (0.075, 0.08, 0.10), _TRUNK),
    "head_back": ("Head", "Head", (0.065, -0.09, 0.09), _TRUNK),
    "head_side": ("Head", "Head", (0.085, 0.0, 0.10), _TRUNK),
    "asis": ("Hips", "Hips", (0.12, 0.06, 0.024), _BONY),
    "psis": ("Hips", "Hips", (0.045, -0.088, 0.05), _BONY),
    "waist_side": ("Hips", "Hips", (0.165, 0.0, 0.04), _TRUNK),
    "iliac": ("Hips", "Hips", (0.145, -0.01, 0.08), _TRUNK),
    "scapula": ("Chest", "Chest", (0.09, -0.12, 0.12), (0.05, 0.04, 0.06)),
    "acromion": ("Shoulder", "Arm", (0.005, -0.005, 0.05), (0.015, 0.015, 0.012)),
    "shoulder_back": ("Shoulder", "Arm", (-0.03, -0.08, 0.0), (0.04, 0.03, 0.05)),
    "shoulder": ("Shoulder", "Arm", (0, 0, 0), _JOINT),
    "upper_arm": ("Arm", "Arm", (0.15, -0.02, 0.045), (0.08, 0.05, 0.02)),
    "elbow_lateral": ("Arm", "ForeArm", (0, -0.005, 0.042), _BONY),
    "elbow_medial": ("Arm", "ForeArm", (0, -0.005, -0.042), _BONY),
    "elbow": ("Arm", "ForeArm", (0, 0, 0), _JOINT),
    "forearm": ("ForeArm", "ForeArm", (0.13, 0.0, 0.045), (0.07, 0.03, 0.02)),
    "wrist_thumb": ("ForeArm", "Hand", (0, 0.035, 0.016), (0.015, 0.012, 0.012)),
    "wrist_little": ("ForeArm", "Hand", (0, -0.035, 0.016), (0.015, 0.012, 0.012)),
    "wrist_back": ("ForeArm", "Hand", (0, 0, 0.025), (0.015, 0.02, 0.012)),
    "wrist": ("ForeArm", "Hand", (0, 0, 0), _JOINT),
    "finger": ("Hand", "Hand", (0.085, 0.01, 0.02), (0.02, 0.02, 0.01)),
    "hand_thumb": ("Hand", "Hand", (0.08, 0.035, 0.015), (0.02, 0.015, 0.015)),
    "hand_little": ("Hand", "Hand", (0.075, -0.035, 0.015), (0.02, 0.015, 0.015)),
    "thumb": ("Hand", "Hand", (0.06, 0.07, 0.0), (0.03, 0.03, 0.03)),
    "hand_end": ("Hand", "HandEnd", (0, 0, 0), (0.02, 0.01, 0.01)),
    "hip": ("Hips", "UpLeg", (0, 0, 0), _JOINT),
    "trochanter": ("UpLeg", "UpLeg", (0.085, 0, 0), (0.02, 0.02, 0.03)),
    "thigh": ("UpLeg", "UpLeg", (0.085, 0.02, -0.25), (0.03, 0.06, 0.10)),
    "knee_lateral": ("UpLeg", "Leg", (0.058, 0, 0), _BONY),
    "knee_medial": ("UpLeg", "Leg", (-0.058, 0, 0), _BONY),
    "knee": ("UpLeg", "Leg", (0, 0, 0), _JOINT),
    "shin": ("Leg", "Leg", (0.045, 0.02, -0.20), (0.04, 0.04, 0.10)),
    "ankle_lateral": ("Leg", "Foot", (0.043, -0.005, 0), _BONY),
    "ankle_medial": ("Leg", "Foot", (-0.043, 0.005, 0), _BONY),
    "ankle": ("Leg", "Foot", (0, 0, 0), _JOINT),
    "heel": ("Foot", "Foot", (0, -0.06, -0.04), (0.012, 0.015, 0.015)),
    "toe": ("Foot", "Foot", (0, 0.125, -0.04), (0.012, 0.02, 0.012)),
    "mt5": ("Foot", "Foot", (0.05, 0.09, -0.05), (0.015, 0.02, 0.012)),
    "mt1": ("Foot", "Foot", (-0.04, 0.11, -0.045), (0.015, 0.02, 0.012)),
    "toe_base": ("Foot", "ToeBase", (0, 0, 0), (0.01, 0.01, 0.01)),
    "toe_tip": ("ToeBase", "ToeBase", (0, 0.07, 0.01), (0.015, 0.02, 0.01)),
}


def _all_sites() -> dict[str, Site]:
    sites = {
        name: Site(seg, anchor, np.array(at, float), np.array(sd)) for name, (seg, anchor, at, sd) in _CENTRE.items()
    }
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        for name, (segment, anchor, at, spread) in _SIDE.items():
            joints = [joint if joint in ("Hips", "Chest", "Head") else side + joint for joint in (segment, anchor)]
            place = np.array(at, float) * [sign, 1, 1]
            sites[f"{side.lower()}_{name}"] = Site(joints[0], joints[1], place, np.array(spread))
    return sites


SITES: Mapping[str, Site] = _all_sites()
"""All sites by name; those of a side begin with ``left_`` or ``right_``."""
JOINT_SITES = frozenset(
    name
    for name in SITES
    if name.removeprefix("left_").removeprefix("right_")
    in (
        "hips",
        "spine",
        "chest",
        "neck",
        "head",
        "shoulder",
        "elbow",
        "wrist",
        "hand_end",
        "hip",
        "knee",
        "ankle",
        "toe_base",
    )
)
"""Sites that are joints' centres themselves."""
