"""A first guess from anatomy: body, poses, and the length of bones by the joints' centres."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.capture.body import SIDES, Template
from onbeat.capture.limbs import arm, leg
from onbeat.capture.model import Pose
from onbeat.capture.sites import SITES
from onbeat.capture.trunk import Seen, chest_turns, cluster_turns, median_length, pelvis, pelvis_pose, trunk_size
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import local_rotations


@dataclass(frozen=True)
class Guess:
    """A body and its poses before anything is fitted.

    Parameters
    ----------
    offsets : (J, 3) metres, the template's with this pelvis.
    scales : (groups,) by which the bones of each group are longer.
    places : offsets (3,) of the sites in their segments.
    pose : of F frames.
    centres : (F, 3) centres of the limbs' joints by joint, NaN where not known.
    """

    offsets: Array
    scales: Array
    places: Mapping[str, Array]
    pose: Pose
    centres: Mapping[str, Positions]


def guess(seen: Seen, body: Template) -> Guess:
    """A first guess of body and poses from sites alone."""
    offsets, places = pelvis(seen, body)
    chest_at = body.skeleton.rest_positions[body.skeleton.index("Chest")]
    hips, origin = pelvis_pose(seen, offsets, places, body)
    turns: dict[str, Rotations] = {"Hips": hips}
    size = trunk_size(seen, origin, body)
    turns["Chest"] = chest_turns(seen, places, chest_at, hips, origin)
    turns["Head"] = cluster_turns(seen, places, "Head", turns["Chest"])
    turns["Spine"] = rot.slerp(hips, turns["Chest"], 0.5)
    turns["Neck"] = rot.slerp(turns["Chest"], turns["Head"], 0.5)
    centres: dict[str, Positions] = {}
    for side, sign in SIDES.items():
        upleg = origin + rot.rotate(hips, offsets[body.skeleton.index(f"{side}UpLeg")])
        leg(seen, places, side, sign, upleg, turns, centres)
        arm(seen, places, side, sign, turns, centres)
    scales, size = _scales(centres, body, offsets, size, measured=_is_measured("hips", seen))
    places = {name: at if _is_measured(name, seen) else at * size for name, at in places.items()}
    world = np.stack([_turn_of(name, turns) for name in body.skeleton.names], axis=1)
    return Guess(offsets, scales, places, Pose(local_rotations(body.skeleton, world), origin), centres)


def _turn_of(name: str, turns: Mapping[str, Rotations]) -> Rotations:
    above = {"HeadEnd": "Head"}
    for side in SIDES:
        above |= {f"{side}Shoulder": "Chest", f"{side}HandEnd": f"{side}Hand"}
        above |= {f"{side}ToeBase": f"{side}Foot", f"{side}ToeEnd": f"{side}Foot"}
    return turns[above.get(name, name)]


def _is_measured(site: str, seen: Seen) -> bool:
    return SITES[site].segment == "Hips" and {"left_asis", "right_asis"} <= set(seen)


_LIMBS = (("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand"))


def _scales(
    centres: Mapping[str, Positions], body: Template, offsets: Array, trunk: float, measured: bool
) -> tuple[Array, float]:
    """The scale of each group from the median distances of its joints; one size for what cannot be measured."""
    found: dict[str, list[float]] = {}
    for side in SIDES:
        for top, end in _LIMBS:
            joint = body.skeleton.index(side + end)
            length = median_length(centres[side + end] - centres[side + top])
            if np.isfinite(length):
                scale = float(np.clip(length / np.linalg.norm(offsets[joint]), 0.3, 2.0))
                found.setdefault(body.groups[body.group[joint]], []).append(scale)
    limbs = {group: float(np.mean(scales)) for group, scales in found.items()}
    size = float(np.median([*limbs.values(), trunk]))
    pelvis = dict.fromkeys(("pelvis", "left_pelvis", "right_pelvis"), 1.0 if measured else size)
    scales = {"trunk": trunk} | pelvis | limbs
    return np.array([scales.get(group, size) for group in body.groups]), size
