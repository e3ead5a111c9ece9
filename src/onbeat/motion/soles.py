"""Feet that do not sink into the floor.

Captured feet dip into it: toes point down where a shoe could not, markers slip, clips of several bodies are put on one.
A joint of a foot may lie a little under the floor, for it is not known how far its sole is below it; from there on its
depth is pressed together, ever more, towards a depth that is never reached. That looks at one pose alone and is smooth
in it, so that a motion stays as smooth as it was, and poses above the floor stay what they are to the bit.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.legs import place_foot
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

FREE, DEEPEST = 0.015, 0.025
"""Metres under the floor up to which joints stay where they are, and to which they never come."""
DOWN, SIDEWAYS = np.radians(3.0), np.radians(30.0)
"""Radians from straight down up to which toes are not turned, and from which on they are turned as far as they need."""
SHORTEST = 1e-6
"""Metres; what is shorter has no direction."""


def pressed(heights: Array) -> Array:
    """Heights in metres with those deeper than ``FREE`` pressed together above −``DEEPEST``, smoothly.

    h′ = −FREE − (DEEPEST − FREE) (1 − exp((h + FREE) / (DEEPEST − FREE))) for h < −FREE.

    Examples
    --------
    >>> pressed(np.array([0.1, 0.0, -0.02, -0.08])).round(4).tolist()
    [0.1, 0.0, -0.0189, -0.025]
    """
    room = DEEPEST - FREE
    under = np.minimum(heights + FREE, 0.0)
    return np.where(under < 0.0, -FREE + room * np.expm1(under / room), heights)


def on_soles(body: Body, rotations: Rotations, roots: Positions) -> Rotations:
    """Local rotations (F, J, 4) of the same poses with feet that do not sink into the floor at z = 0.

    A foot that is too deep as a whole is lifted, the leg bending; toes that are deeper than their ball are bent up, or
    lifted with it where they point straight down.

    Parameters
    ----------
    body : roles of the skeleton; legs that it does not know stay as they are.
    rotations : (F, J, 4) wxyz, local.
    roots : (F, 3) metres.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> body = Body.of(Build(1.7).skeleton)
    >>> rest = np.tile([1.0, 0.0, 0.0, 0.0], (1, len(body.skeleton), 1))
    >>> sunk = np.array([[0.0, 0.0, -0.1 - body.skeleton.rest_positions[:, 2].min()]])
    >>> turned = on_soles(body, rest, sunk)
    >>> forward_kinematics(body.skeleton, turned, sunk)[1][..., 2].min().round(3).item()
    -0.025
    """
    skeleton, out = body.skeleton, rotations
    world = forward_kinematics(skeleton, rotations, roots)
    for side in ("left", "right"):
        if not all(f"{side}_{role}" in body for role in ("hip", "knee", "ankle")):
            continue
        foot, ball = _below(skeleton, body[f"{side}_ankle"]), _ball(body, side)
        frames = np.flatnonzero((world[1][:, foot, 2] < -FREE).any(axis=1))
        if len(frames):
            out = out.copy() if out is rotations else out
            out[frames] = _lifted(body, side, out[frames], roots[frames])
            if ball != body[f"{side}_ankle"]:
                out[frames] = _bent_up(body, side, out[frames], roots[frames])
    return out


def _across(way: Positions) -> Positions:
    """(N, 3) level axes about which what points that way turns up; what points straight down has none, and gets one."""
    level = np.hypot(way[:, 0], way[:, 1])[:, None]
    ahead = np.where(level > SHORTEST, way, [0.0, 1.0, 0.0])
    across = np.stack([ahead[:, 1], -ahead[:, 0], np.zeros(len(ahead))], axis=1)
    return across / np.linalg.norm(across, axis=1, keepdims=True)


def _ball(body: Body, side: str) -> int:
    """The joint of the toes; the ankle of a body without."""
    return body[f"{side}_toe" if f"{side}_toe" in body else f"{side}_ankle"]


def _below(skeleton: Skeleton, joint: int) -> Ints:
    """The joint and all that hang on it."""
    tree = Tree.of(skeleton)
    return np.array([other for other in range(len(skeleton)) if other == joint or tree.above(joint, other)])


def _lifted(body: Body, side: str, rotations: Rotations, roots: Positions) -> Rotations:
    """The foot lifted so far as ankle and ball are too deep: what hangs on the ball can bend."""
    ankle, ball = body[f"{side}_ankle"], _ball(body, side)
    soft = _below(body.skeleton, ball)[1:] if ball != ankle else []
    firm = [joint for joint in _below(body.skeleton, ankle) if joint not in soft]
    world = forward_kinematics(body.skeleton, rotations, roots)
    lowest = world[1][:, firm, 2].min(axis=1)
    target = world[1][:, ankle].copy()
    target[:, 2] += pressed(lowest) - lowest
    return place_foot(body, side, rotations, world, target, world[0][:, ankle])


def _bent_up(body: Body, side: str, rotations: Rotations, roots: Positions) -> Rotations:
    """The toes turned up about their ball, to where their tips are no longer too deep.

    They are turned in the upright plane that they are in. Toes near straight down are in none, or in another the next
    moment: the nearer, the less they are turned, and the foot is lifted by what is left.
    """
    skeleton, ball = body.skeleton, _ball(body, side)
    tips = _below(skeleton, ball)[1:]
    if not len(tips):
        return rotations
    turns, places = forward_kinematics(skeleton, rotations, roots)
    rows = np.arange(len(rotations))
    deep = places[:, tips][rows, places[:, tips, 2].argmin(axis=1)]
    arm = deep - places[:, ball]
    length = np.maximum(np.linalg.norm(arm, axis=1), SHORTEST)
    now = np.arcsin(np.clip(arm[:, 2] / length, -1.0, 1.0))
    wanted = np.arcsin(np.clip((pressed(deep[:, 2]) - places[:, ball, 2]) / length, -1.0, 1.0))
    angle = _away(now + np.pi / 2) * np.maximum(wanted - now, 0.0)
    out, foot = rotations.copy(), skeleton.parents[ball]
    turned = rot.multiply(rot.about(_across(arm), angle), turns[:, ball])
    out[:, ball] = rot.multiply(rot.inverse(turns[:, foot]), turned)
    return _freed(body, side, out, roots, pressed(places[:, tips, 2].min(axis=1)))


def _away(angle: Array) -> Array:
    """From 0 straight down to 1 from ``SIDEWAYS`` on, smoothly."""
    part = np.clip((angle - DOWN) / (SIDEWAYS - DOWN), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)


def _freed(body: Body, side: str, rotations: Rotations, roots: Positions, lowest: Array) -> Rotations:
    """The foot lifted to where its toes' tips are as high as ``lowest`` (N,) metres; as it is where they are."""
    ankle, ball = body[f"{side}_ankle"], _ball(body, side)
    world = forward_kinematics(body.skeleton, rotations, roots)
    missing = lowest - world[1][:, _below(body.skeleton, ball)[1:], 2].min(axis=1)
    some = np.flatnonzero(missing > SHORTEST)
    if not len(some):
        return rotations
    turns, places = (values[some] for values in world)
    target = places[:, ankle].copy()
    target[:, 2] += missing[some]
    out = rotations.copy()
    out[some] = place_foot(body, side, rotations[some], (turns, places), target, turns[:, ankle])
    return out
