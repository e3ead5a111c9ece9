"""Two-bone inverse kinematics of legs, in closed form and on batches of frames.

The leg is swung so that it points at the target and bent at the knee until it reaches it. The knee stays in its plane,
and the shin and thigh keep their lengths; nothing is searched for, so nothing can fail to converge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body

STRAIGHT = 0.999
"""Part of the leg's length to which it is stretched at most, unless it is straighter already."""
FOLDED = 1.02
"""A folded leg stays longer than this times the difference of its bones."""
BACKWARD = 0.35
"""Radians; a knee that is bent further than this against its hinge bends so: the hinge, read at rest, is misjudged."""


@dataclass(frozen=True)
class LegTurns:
    """By what the bones of N legs must be turned.

    Parameters
    ----------
    thigh, shin : (N, 4) wxyz, world rotations to apply from the left to everything from the hip, from the knee down.
    """

    thigh: Rotations
    shin: Rotations


def bend_leg(hip: Positions, knee: Positions, ankle: Positions, target: Positions, hinge: Positions) -> LegTurns:
    """Turns of thigh and shin that bring the ankle to ``target``, all (N, 3) metres in the world.

    Law of cosines for the angles at hip and knee. ``hinge`` (N, 3) is the axis about which the knee bends (to the
    body's left where the body faces forward); it decides only for a straight leg, and which way a knee bends. A target
    beyond reach is approached along the line from the hip.

    Examples
    --------
    >>> hip, knee, ankle = np.array([[0, 0, 1.0]]), np.array([[0, 0.01, 0.5]]), np.array([[0, 0, 0.0]])
    >>> target = np.array([[0.1, 0, 0.2]])
    >>> turns = bend_leg(hip, knee, ankle, target, np.array([[-1.0, 0, 0]]))
    >>> new_knee = hip + rot.rotate(turns.thigh, knee - hip)
    >>> ((new_knee + rot.rotate(turns.shin, ankle - knee)).round(9) + 0.0).tolist()
    [[0.1, 0.0, 0.2]]
    """
    thigh, shin = knee - hip, ankle - knee
    a, b = np.linalg.norm(thigh, axis=-1), np.linalg.norm(shin, axis=-1)
    normal, sign = _plane(thigh, shin, hinge)
    reach = np.linalg.norm(target - hip, axis=-1)
    now = np.linalg.norm(ankle - hip, axis=-1)
    # A leg that is straighter than we stretch one may stay so, or it would snap where the target leaves the ankle.
    longest = np.maximum(STRAIGHT * (a + b), now)
    wanted = np.clip(reach, np.minimum(FOLDED * np.abs(a - b) + 1e-6, now), longest)
    swing = rot.between(ankle - hip, target - hip)
    # The knee bends about its hinge; one that is overstretched stays so only while the leg gets no shorter.
    misjudged = np.pi - _corner(a, b, now) > BACKWARD
    bends = np.where((sign < 0) & ((wanted >= now - 1e-9) | misjudged), -1.0, 1.0)
    at_hip = bends * _corner(a, wanted, b) - sign * _corner(a, now, b)
    at_knee = bends * (np.pi - _corner(a, b, wanted)) - sign * (np.pi - _corner(a, b, now))
    axis = rot.rotate(swing, normal)
    return LegTurns(
        rot.multiply(rot.about(axis, -at_hip), swing),
        rot.multiply(rot.about(axis, at_knee - at_hip), swing),
    )


def _plane(thigh: Positions, shin: Positions, hinge: Positions) -> tuple[Positions, Array]:
    """The normal of the knee's plane on the hinge's side, and +1 where the knee bends about it, -1 against it."""
    along = thigh / np.maximum(np.linalg.norm(thigh, axis=-1, keepdims=True), 1e-12)
    across = np.cross(thigh, shin)
    size = np.linalg.norm(across, axis=-1, keepdims=True)
    side = hinge - along * np.sum(hinge * along, axis=-1, keepdims=True)
    side = side / np.maximum(np.linalg.norm(side, axis=-1, keepdims=True), 1e-12)
    bent = size > 1e-7
    normal = np.where(bent, across / np.where(bent, size, 1.0), side)
    sign = np.where(np.sum(normal * hinge, axis=-1) < 0, -1.0, 1.0)
    return normal * sign[..., None], sign


def _corner(side: Array, other: Array, opposite: Array) -> Array:
    """The angle between two sides of a triangle, facing the third."""
    cosine = (side**2 + other**2 - opposite**2) / np.maximum(2 * side * other, 1e-12)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def hinge_axes(body: Body, side: str, world_rotations: Rotations) -> Positions:
    """(N, 3) the axis about which the knee of ``side`` bends, carried by the thigh: to the left in the rest pose."""
    rest = body.skeleton.rest_positions
    to_left = rest[body["left_hip"]] - rest[body["right_hip"]]
    return rot.rotate(world_rotations[:, body[f"{side}_hip"]], to_left / max(float(np.linalg.norm(to_left)), 1e-9))


def place_foot(
    body: Body,
    side: str,
    rotations: Rotations,
    world: tuple[Rotations, Positions],
    ankle: Positions,
    foot: Rotations,
) -> Rotations:
    """Local rotations (N, J, 4) that bring the ankle of ``side`` to ``ankle`` (N, 3) with the foot turned as ``foot``.

    ``world`` are the world rotations and positions of ``rotations``; the pelvis stays where it is and the foot's world
    rotation becomes ``foot`` (N, 4), so that the sole lies as wanted.
    """
    turned, placed = world
    parents = body.skeleton.parents
    hip, knee, tip = (body[f"{side}_{role}"] for role in ("hip", "knee", "ankle"))
    turns = bend_leg(placed[:, hip], placed[:, knee], placed[:, tip], ankle, hinge_axes(body, side, turned))
    out = rotations.copy()
    new_hip = rot.multiply(turns.thigh, turned[:, hip])
    out[:, hip] = rot.multiply(rot.inverse(turned[:, parents[hip]]), new_hip)
    above_knee = rot.multiply(turns.thigh, turned[:, parents[knee]])
    out[:, knee] = rot.multiply(rot.inverse(above_knee), rot.multiply(turns.shin, turned[:, knee]))
    above_tip = rot.multiply(turns.shin, turned[:, parents[tip]])
    out[:, tip] = rot.multiply(rot.inverse(above_tip), foot)
    return out
