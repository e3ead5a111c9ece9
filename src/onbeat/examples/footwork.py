"""From planned steps to feet that stand still or swing, and a pelvis over the foot that bears the weight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import minimum_filter1d

from onbeat._shapes import Array, Bools, Positions, Rotations, Times
from onbeat.examples.body import Build
from onbeat.examples.paths import bump, minimum_jerk, soften
from onbeat.motion import rotations as rot

LIFT_OFF = 0.88
"""Beats before its beat at which a stepping foot begins to leave the floor."""
LANDED = 0.22
"""Beats before its beat at which it stands."""
EDGE = 0.004
"""Metres over which a foot that would sink is eased onto the floor, so that nothing jerks."""


@dataclass(frozen=True)
class FootPlan:
    """Where one foot is to be: E events, the first its place at the start.

    Parameters
    ----------
    begins, ends : (E,) seconds of each swing; between swings the foot is still.
    places : (E, 3) metres, the ball of the foot after each swing, z above the floor.
    yaws, pitches : (E,) radians after each swing, pitch with the toes up.
    clearance : (E,) metres by which the foot is raised in mid-swing.
    detours : (E, 2) metres by which the foot goes aside of the straight way in mid-swing.
    stands : (E,) true where the foot stands on the floor after the swing, if only on its heel.
    """

    begins: Times
    ends: Times
    places: Positions
    yaws: Array
    pitches: Array
    clearance: Array
    detours: Array
    stands: Bools


@dataclass(frozen=True)
class FootPath:
    """What one foot does: ankle (F, 3), rotation (F, 4), bend of the toes (F,) and whether it stands (F,)."""

    ankle: Positions
    rotation: Rotations
    toes: Array
    yaw: Array
    contact: Bools


def foot_path(plan: FootPlan, times: Times, build: Build) -> FootPath:
    """The path of a foot: still between swings, the heel first off the floor, the ball over it in an arc."""
    index = np.clip(np.searchsorted(plan.begins, times, side="right") - 1, 0, len(plan.begins) - 1)
    before = np.maximum(index - 1, 0)
    share = np.clip((times - plan.begins[index]) / (plan.ends[index] - plan.begins[index]), 0.0, 1.0)
    swing = minimum_jerk(np.clip((share - 0.16) / 0.84, 0.0, 1.0))
    arc = bump(np.clip((share - 0.10) / 0.90, 0.0, 1.0))
    ball = plan.places[before] + (plan.places[index] - plan.places[before]) * swing[:, None]
    ball[:, 2] += plan.clearance[index] * arc
    ball[:, :2] += plan.detours[index] * arc[:, None]
    yaw = plan.yaws[before] + (plan.yaws[index] - plan.yaws[before]) * swing
    pitch = plan.pitches[before] + (plan.pitches[index] - plan.pitches[before]) * swing
    flat = plan.stands[before] & (plan.pitches[before] == 0.0)
    heel_off = bump(np.clip(share / 0.75, 0.0, 1.0)) * np.clip(plan.clearance[index] / 0.05, 0.0, 1.4)
    pitch = pitch - 0.42 * heel_off * flat
    moving = (share > 0.0) & (share < 1.0) & (index > 0)
    contact = ~moving & plan.stands[index]
    ankle, rotation, raised = _ankle(ball, yaw, pitch, build)
    toes = np.maximum(-pitch, 0.0) * np.exp(-np.maximum(ball[:, 2] + raised, 0.0) / 0.04)
    return FootPath(ankle, rotation, toes, yaw, contact)


def _ankle(ball: Positions, yaw: Array, pitch: Array, build: Build) -> tuple[Positions, Rotations, Array]:
    """Ankle and rotation of a foot with its ball at ``ball``, raised where its heel would be under the floor."""
    sine, cosine = np.sin(pitch), np.cos(pitch)
    back, up = build.ball_forward, build.ankle_height - build.ball_height
    # The heel under the pitched foot, from the ball: (−back − heel_back, −ball_height) turned by the pitch.
    heel = build.ball_height - (back + build.heel_back) * sine - build.ball_height * cosine
    under = -(ball[:, 2] + heel)
    raised = 0.5 * (under + np.sqrt(under**2 + EDGE**2) - EDGE)
    forward = -back * cosine - up * sine
    ankle = np.stack(
        (
            ball[:, 0] - np.sin(yaw) * forward,
            ball[:, 1] + np.cos(yaw) * forward,
            ball[:, 2] + raised + build.ball_height - back * sine + up * cosine,
        ),
        axis=-1,
    )
    zero = np.zeros_like(pitch)
    tilt = np.stack((np.cos(pitch / 2), np.sin(pitch / 2), zero, zero), axis=-1)
    return ankle, rot.multiply(rot.yaw(yaw), tilt), raised


def highest_pelvis(hips: Positions, ankles: Positions, leg: float, stretch: float = 0.994) -> Array:
    """Metres (F,) the hip joint (relative height ``hips`` z) can be raised until the leg is ``stretch`` straight.

    Returns the height of the pelvis above the floor at which ``|hip − ankle| = stretch · leg``.
    """
    level = np.sum((hips[:, :2] - ankles[:, :2]) ** 2, axis=-1)
    return ankles[:, 2] + np.sqrt(np.maximum((stretch * leg) ** 2 - level, 1e-4)) - hips[:, 2]


def softest_minimum(heights: Array, softness: float = 0.005) -> Array:
    """A smooth minimum over the last axis, never above the true one: ``−s log Σ exp(−h/s)``, ``softness`` metres."""
    low = heights.min(axis=-1, keepdims=True)
    return low[..., 0] - softness * np.log(np.exp(-(heights - low) / softness).sum(axis=-1))


def settle(height: Array, fps: float, seconds: float = 0.08) -> Array:
    """The height smoothed from below: the lowest within ``seconds`` on both sides, then a Gaussian half as wide."""
    low = minimum_filter1d(height, 2 * round(seconds * fps) + 1, mode="nearest")
    return soften(low, fps, seconds / 2)
