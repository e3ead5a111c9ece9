"""Standing at ease: what a dancer does while there is nothing to dance to.

The body stands as it does in the calmest moment of its clips and breathes. Weight goes slowly from foot to foot; the
feet stay where they are. The end goes on into the beginning.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.dance.pelvis import sunk
from onbeat.live.bodies.stance import calmest_stance
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames
from onbeat.motion.contacts import SIDES
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.legs import place_foot
from onbeat.motion.motion import Motion

SECONDS = 12.0
"""How long it lasts."""
BREATHS = 3
"""In these seconds: 0.25 Hz, as adults breathe at rest."""
RATE = 60.0
"""Frames a second."""
CHEST, SHOULDERS = 0.045, 0.07
"""Radians by which the chest leans back, and the shoulders are lifted, with a breath."""
SWAY = (0.014, 0.005)
"""Parts of the leg's length by which the hips go to the side, and forward."""
NAME = "resting"


def resting(clips: Sequence[Motion]) -> Motion:
    """A clip of ``SECONDS`` in which the body of some clips stands at ease and breathes.

    Parameters
    ----------
    clips : of one skeleton; the stance is the calmest there is in them.

    Raises
    ------
    PlanError
        If there are no clips.
    BodyError
        If a needed role is not found.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> rest = resting(embedded_motions()[:1])
    >>> rest.duration, bool(np.ptp(rest.root_positions[:, 2]) < 0.01)
    (12.0, True)
    """
    stance = calmest_stance(clips)
    body = Body.of(stance.skeleton)
    frames = round(SECONDS * RATE)
    phase = 2 * np.pi * np.arange(frames) / frames
    rotations = np.tile(stance.rotations, (frames, 1, 1))
    axes = rot.rotate(body_frames(stance, body)[0], np.eye(3))  # to the right, to the front, up
    _breathe(body, rotations, stance, axes, _breath(BREATHS * phase))
    aside = np.sin(phase) + 0.3 * np.sin(2 * phase + 1.0)
    ahead = np.sin(2 * phase + 0.7)
    way = body.leg_length * (SWAY[0] * aside[:, None] * axes[0] + SWAY[1] * ahead[:, None] * axes[1])
    roots = stance.root_positions + way * np.array([1.0, 1.0, 0.0])
    return Motion(stance.skeleton, *_standing(body, stance, rotations, roots), RATE, NAME)


def _breath(phase: Array) -> Array:
    """0…1: in faster than out."""
    return (1 - np.cos(phase + 0.4 * np.sin(phase))) / 2


def _breathe(body: Body, rotations: Rotations, stance: Motion, axes: Array, breath: Array) -> None:
    """Chest, head and shoulders as one breathes, in place; arms and face keep their direction."""
    chest, head = CHEST * breath, [role for role in ("neck", "head") if role in body][:1]
    _turn(body, rotations, stance, "chest", axes[0], chest)
    for role in head:
        _turn(body, rotations, stance, role, axes[0], -chest)
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        lift = sign * SHOULDERS * breath if f"{side}_collar" in body else np.zeros(len(breath))
        if f"{side}_collar" in body:
            _turn(body, rotations, stance, f"{side}_collar", axes[1], lift)
        _turn(body, rotations, stance, f"{side}_shoulder", axes[1], -0.8 * lift)
        _turn(body, rotations, stance, f"{side}_shoulder", axes[0], -chest)


def _turn(body: Body, rotations: Rotations, stance: Motion, role: str, axis: Array, angles: Array) -> None:
    """Turn a joint about an axis of the world, as the stance has it, by angles (F,), in place."""
    joint = body[role]
    parent = stance.world_rotations[0, max(int(body.skeleton.parents[joint]), 0)]
    local = rot.rotate(rot.inverse(parent), axis)
    rotations[:, joint] = rot.multiply(rot.about(np.tile(local, (len(angles), 1)), angles), rotations[:, joint])


def _standing(body: Body, stance: Motion, rotations: Rotations, roots: Positions) -> tuple[Rotations, Positions]:
    """The poses with both feet where the stance has them, lowered as far as the legs need it."""
    world = forward_kinematics(body.skeleton, rotations, roots)
    ankles = {side: np.tile(stance.positions[:, body[f"{side}_ankle"]], (len(roots), 1)) for side in SIDES}
    down = sunk(body, world, ankles, np.ones(len(roots), bool), np.arange(len(roots)) / RATE).max(axis=0)
    for side in SIDES:
        world = forward_kinematics(body.skeleton, rotations, roots - down)
        turned = np.tile(stance.world_rotations[:, body[f"{side}_ankle"]], (len(roots), 1))
        rotations = place_foot(body, side, rotations, world, ankles[side], turned)
    return rotations, roots - down
