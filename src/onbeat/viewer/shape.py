"""The shape of a drawn body: capsules between joints, with radii by role.

Everything that draws a dancer (the page, the software renderer) takes its body from here, so that a dancer looks
alike everywhere. A capsule lies on the line through two joints: its ends are ``a + start (b - a)`` and
``a + end (b - a)``, mostly the joints themselves (0 and 1); a value outside 0…1 reaches past a joint, as a skull
does past the last joint of the neck. All lengths grow with the body's legs. A skeleton without roles is drawn as
plain bones.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat.motion import Body, Skeleton
from onbeat.motion.body import chain_length

ADULT_LEG = 0.82
"""Metres from hip to ankle of the adult for whom the radii below hold."""
MIDDLE = 0.21
"""Metres from the height of that adult's shoulder joints up to the middle of the skull."""
GROUPS = (
    "head",
    "torso",
    "hips",
    *(f"{side}_{part}" for side in ("left", "right") for part in ("arm", "hand", "leg", "foot")),
)
"""The colour groups."""


class Capsule(NamedTuple):
    """A tapering capsule on the line from one joint to another; radii in metres at its two ends."""

    joint_a: int
    joint_b: int
    radius_a: float
    radius_b: float
    group: str
    start: float = 0.0
    end: float = 1.0


def capsules(skeleton: Skeleton, body: Body | None) -> list[Capsule]:
    """The capsules that make a body; plain bones where ``body`` is None.

    Examples
    --------
    >>> arm = Skeleton(("elbow", "wrist"), [-1, 0], [[0, 0, 0], [0.25, 0, 0]])
    >>> capsules(arm, None)
    [Capsule(joint_a=0, joint_b=1, radius_a=0.03, radius_b=0.025, group='torso', start=0.0, end=1.0)]
    """
    if body is None:
        return _bones(skeleton)
    size = min(max(body.leg_length / ADULT_LEG, 0.2), 3.0)
    made = [*_torso(body, size), *_head(body, size)]
    for side in ("left", "right"):
        made += [*_arm(body, side), *_hand(body, side, size), *_leg(body, side, size), *_foot(body, side, size)]
    return [c._replace(radius_a=c.radius_a * size, radius_b=c.radius_b * size) for c in made]


def _bones(skeleton: Skeleton) -> list[Capsule]:
    """A thin capsule for each bone that has a length."""
    made: list[Capsule] = []
    for joint, length in enumerate(skeleton.bone_lengths.tolist()):
        if joint and length > 1e-4:
            radius = min(0.03, 0.25 * length)
            made.append(Capsule(int(skeleton.parents[joint]), joint, radius, radius / 1.2, "torso"))
    return made


def _torso(body: Body, size: float) -> list[Capsule]:
    hips, chest = body["hips"], body["chest"]
    left_shoulder, right_shoulder = body["left_shoulder"], body["right_shoulder"]
    left_hip, right_hip = body["left_hip"], body["right_hip"]
    top = body.joints.get("neck", chest)
    # Files differ in how far their root lies above the hip joints; the shirt's hem does not follow it.
    rest = body.skeleton.rest_positions
    drop = float(np.linalg.norm((rest[left_hip] + rest[right_hip]) / 2 - rest[hips]))
    hem = (0.07 * size - drop) / max(_length(body, hips, chest), 0.1 * size)
    made = [
        Capsule(left_hip, right_hip, 0.094, 0.094, "hips"),
        Capsule(hips, chest, 0.098, 0.108, "torso", hem, 1.0),
        Capsule(left_shoulder, right_shoulder, 0.05, 0.05, "torso", 0.06, 0.94),
    ]
    if top != chest:
        made.append(Capsule(chest, top, 0.105, 0.06, "torso"))
    elif "head" in body and (rise := _shoulders_above(body, chest)) > 0.15 * size:
        made.append(Capsule(chest, body["head"], 0.1, 0.085, "torso", 0.0, rise / _length(body, chest, body["head"])))
    for shoulder, hip in ((left_shoulder, left_hip), (right_shoulder, right_hip)):
        # Out from the waist and the chest to the shoulder, and to the hip: a narrow waist, a broad chest.
        made.append(Capsule(hips, shoulder, 0.088, 0.07, "torso", 0.3, 0.9))
        made.append(Capsule(chest, shoulder, 0.095, 0.062, "torso", 0.1, 0.85))
        made.append(Capsule(chest, hip, 0.09, 0.088, "torso", 0.3, 0.66))
    return made


def _head(body: Body, size: float) -> list[Capsule]:
    base = body.joints.get("neck", body["chest"])
    head = body.joints.get("head", base)
    if head == base:
        above = max(0.28 * size, _shoulders_above(body, base) + 0.24 * size)
        return [_skull(body["hips"], base, above, _length(body, body["hips"], base), size)]
    length = _length(body, base, head)
    tips = [child for child in body.skeleton.children[head] if body.skeleton.bone_lengths[child] > 0.04 * size]
    above = _skull_above(body, head, tips, size)
    # Robots have their chest at the waist: the neck begins where the shoulders are.
    collar = min(max(_shoulders_above(body, base) / max(length, 1e-3), 0.0), 0.7)
    nape = 1.0 if tips else max(1.0, 1.0 + (above - 0.08 * size) / max(length, 0.02 * size))
    neck = [
        Capsule(base, head, 0.084, 0.056, "torso", collar, collar + 0.4 * (1 - collar)),
        Capsule(base, head, 0.055, 0.05, "head", collar + 0.3 * (1 - collar), nape),
    ]
    if not tips:
        return [*neck, _skull(base, head, above, length, size)]
    reach = float(body.skeleton.bone_lengths[tips[0]])
    start, end = (above - 0.025 * size) / reach, (above + 0.02 * size) / reach
    return [*neck, Capsule(head, tips[0], 0.084, 0.095, "head", start, end)]


def _skull_above(body: Body, head: int, tips: list[int], size: float) -> float:
    """Metres of the skull's middle past the joint of the head.

    Files differ in where along neck and head that joint is, and few have the crown at the end of the head: what they
    tell counts where the skull then is as high above the shoulders as people's is, or higher.
    """
    usual = MIDDLE * size + _shoulders_above(body, head)
    if tips:
        told = min(float(body.skeleton.bone_lengths[tips[0]]) - 0.11 * size, 0.11 * size)
    else:
        told = 0.0 if body.skeleton.end_sites[head] else 0.085 * size  # an end of a bone is the middle of the head
    return max(told, usual - 0.02 * size, -0.02 * size)


def _shoulders_above(body: Body, joint: int) -> float:
    """Metres of the shoulders above a joint of the trunk in the rest pose, along the trunk."""
    rest = body.skeleton.rest_positions
    middle = (rest[body["left_shoulder"]] + rest[body["right_shoulder"]]) / 2
    along = middle - rest[body["hips"]]
    return float((middle - rest[joint]) @ along) / max(float(np.linalg.norm(along)), 1e-6)


def _skull(base: int, head: int, above: float, length: float, size: float) -> Capsule:
    """A skull whose centre is ``above`` metres past ``head`` on the line from ``base``, ``length`` metres away."""
    length = max(length, 0.02 * size)
    return Capsule(
        base, head, 0.084, 0.095, "head", 1 + (above - 0.025 * size) / length, 1 + (above + 0.02 * size) / length
    )


def _arm(body: Body, side: str) -> list[Capsule]:
    shoulder, elbow, wrist = (body[f"{side}_{role}"] for role in ("shoulder", "elbow", "wrist"))
    return [
        Capsule(shoulder, elbow, 0.053, 0.04, f"{side}_arm"),
        Capsule(elbow, wrist, 0.041, 0.028, f"{side}_arm"),
    ]


def _hand(body: Body, side: str, size: float) -> list[Capsule]:
    elbow, wrist = body[f"{side}_elbow"], body[f"{side}_wrist"]
    tip = body.joints.get(f"{side}_hand", wrist)
    while body.skeleton.children[tip] and tip != wrist:
        tip = body.skeleton.children[tip][0]
    length = _length(body, wrist, tip)
    group = f"{side}_hand"
    if length < 0.03 * size:
        forearm = max(_length(body, elbow, wrist), 0.05 * size)
        palm, end = 1 + 0.08 * size / forearm, 1 + 0.15 * size / forearm
        return [
            Capsule(elbow, wrist, 0.027, 0.035, group, 1.0, palm),
            Capsule(elbow, wrist, 0.035, 0.018, group, palm, end),
        ]
    end = min(max(1.0, 0.16 * size / length), 2.5)
    return [
        Capsule(wrist, tip, 0.027, 0.035, group, 0.0, 0.55 * end),
        Capsule(wrist, tip, 0.035, 0.018, group, 0.55 * end, end),
    ]


def _leg(body: Body, side: str, size: float) -> list[Capsule]:
    hip, knee, ankle = (body[f"{side}_{role}"] for role in ("hip", "knee", "ankle"))
    shin = max(_length(body, knee, ankle), 0.05 * size)
    return [
        Capsule(hip, knee, 0.09, 0.056, f"{side}_leg"),
        Capsule(knee, ankle, 0.055, 0.058, f"{side}_leg", 0.0, 0.25),
        Capsule(knee, ankle, 0.058, 0.038, f"{side}_leg", 0.25, 1.0),
        # The heel lies below the ankle, on the shin's line.
        Capsule(knee, ankle, 0.041, 0.04, f"{side}_foot", 1.0, 1.0 + 0.03 * size / shin),
    ]


def _foot(body: Body, side: str, size: float) -> list[Capsule]:
    toe = body.joints.get(f"{side}_toe")
    if toe is None:
        return []
    group, ankle = f"{side}_foot", body[f"{side}_ankle"]
    made = [Capsule(ankle, toe, 0.043, 0.036, group)]
    ends = [child for child in body.skeleton.children[toe] if body.skeleton.bone_lengths[child] > 0.01 * size]
    if ends:
        made.append(Capsule(toe, ends[0], 0.036, 0.027, group))
    return made


def _length(body: Body, top: int, bottom: int) -> float:
    """Metres along the bones from ``top`` down to ``bottom``."""
    return chain_length(body.skeleton, top, bottom) if top != bottom else 0.0
