"""The trunk from its markers: pelvis and hips by regressions, chest and head, how tall the body is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.capture.body import SIDES, Template
from onbeat.capture.pose import best_turns, bridge, bridge_places, is_seen
from onbeat.capture.sites import SITES
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot

TILT = np.radians(10.0)
"""How far the plane through the iliac spines leans forwards when standing."""
Seen = Mapping[str, Positions]
"""Positions (F, 3) by site, NaN where it is not seen."""
_SMALLEST, _LARGEST = 0.3, 2.0


def pelvis(seen: Seen, body: Template) -> tuple[Array, dict[str, Array]]:
    """The hips' offsets and the pelvis' sites by Harrington et al. (2007, J. Biomech. 40:595), from width and depth.

    With the width W between the front spines and the depth D to the middle of the hind ones the hip's centre is
    ``−0.24 D − 9.9 mm`` forwards, ``−0.30 W − 10.9 mm`` upwards and ``0.33 W + 7.3 mm`` sideways of the middle of the
    front spines, in the plane of the spines.
    """
    offsets = body.skeleton.offsets.copy()
    places = {name: SITES[name].place.copy() for name in seen}
    front = _middle(seen, "left_asis", "right_asis")
    back = _middle(seen, "left_psis", "right_psis")
    back = seen.get("sacrum") if back is None else back
    if front is None or back is None:
        return offsets, places
    width = float(np.clip(np.nan_to_num(median_length(seen["right_asis"] - seen["left_asis"]), nan=0.24), 0.12, 0.36))
    depth = float(np.clip(np.nan_to_num(median_length(front - back), nan=0.15), 0.08, 0.28))
    forwards = np.array([0, np.cos(TILT), -np.sin(TILT)])
    upwards = np.array([0, np.sin(TILT), np.cos(TILT)])
    hip = body.skeleton.offsets[body.skeleton.index("RightUpLeg")]
    ahead = [0, 0, hip[2]] + (0.24 * depth + 0.0099) * forwards + (0.30 * width + 0.0109) * upwards
    behind = ahead - depth * forwards
    for side, sign in SIDES.items():
        offsets[body.skeleton.index(f"{side}UpLeg")] = [sign * (0.33 * width + 0.0073), 0, hip[2]]
        places[f"{side.lower()}_asis"] = ahead + np.array([sign * width / 2, 0, 0])
        if f"{side.lower()}_psis" in seen:
            breadth = median_length(seen["right_psis"] - seen["left_psis"]) if _both(seen, "psis") else 0.09
            breadth = float(np.nan_to_num(breadth, nan=0.09))
            places[f"{side.lower()}_psis"] = behind + np.array([sign * breadth / 2, 0, 0])
    if "sacrum" in seen:
        places["sacrum"] = behind
    return offsets, places


def waist(seen: Seen, body: Template) -> tuple[Rotations, Positions]:
    """The pelvis' rotations (F, 4) and the hips' joint (F, 3), bridged where too little of the pelvis is seen."""
    offsets, places = pelvis(seen, body)
    return pelvis_pose(seen, offsets, places, body)


def pelvis_pose(seen: Seen, offsets: Array, places: Mapping[str, Array], body: Template) -> tuple[Rotations, Positions]:
    """The pelvis' rotations (F, 4) and the hips' joint (F, 3) by the sites on it, at these places."""
    names = [name for name in seen if SITES[name].segment == "Hips"]
    joints = body.skeleton
    at = [places[n] + (offsets[joints.index(SITES[n].anchor)] if SITES[n].anchor != "Hips" else 0) for n in names]
    world = [seen[name] for name in names]
    if len(names) == 2:
        # Two hips alone leave the lean open; the shoulders tell it.
        top = _shoulders(seen)
        at, world = [*at, np.array([0, 0, 0.45])], [*world, top]
        turns, origin, good = register(np.array(at), np.stack(world, axis=1), np.array([1.0, 1.0, 0.1]))
    else:
        turns, origin, good = register(np.array(at), np.stack(world, axis=1), np.ones(len(names)))
    return bridge(turns, good), bridge_places(origin, good)


def register(local: Array, world: Positions, weights: Array) -> tuple[Rotations, Positions, Bools]:
    """Rotations and origins that bring points ``local`` (K, 3) to ``world`` (F, K, 3), NaN where not seen."""
    known = is_seen(world)
    share = known * weights
    share = share / np.maximum(share.sum(axis=1, keepdims=True), 1e-12)
    centre = np.sum(np.where(known[..., None], world, 0.0) * share[..., None], axis=1)
    middle = share @ local
    turns, good = best_turns(local - middle[:, None], world - centre[:, None], np.broadcast_to(weights, known.shape))
    return turns, centre - rot.rotate(turns, middle), good & (known.sum(axis=1) >= 3)


def trunk_size(seen: Seen, origin: Positions, body: Template) -> float:
    """How many times as tall as the template a body is, from waist to shoulders.

    Raises
    ------
    BodyError
        If both are never seen together, or no human is so tall.
    """
    joints = body.skeleton
    tall = joints.rest_positions[joints.index("RightArm"), 2]
    tall += 0.0 if "left_shoulder" in seen else SITES["right_acromion"].place[2]
    size = median_length(_shoulders(seen) - origin) / tall
    if not np.isfinite(size):
        raise BodyError("the pelvis and the shoulders are never seen at the same time; no body can be measured")
    if not _SMALLEST < size < _LARGEST:
        raise BodyError(f"a body {1.75 * size:.3g} m tall is found in these markers; is the file's unit right?")
    return float(size)


def _shoulders(seen: Seen) -> Positions:
    """The middle of the shoulders."""
    middle = _middle(seen, "left_shoulder", "right_shoulder")
    middle = _middle(seen, "left_acromion", "right_acromion") if middle is None else middle
    if middle is None:
        both = [seen.get(f"{side}_shoulder", seen.get(f"{side}_acromion")) for side in ("left", "right")]
        return np.mean([each for each in both if each is not None], axis=0)
    return middle


def chest_turns(seen: Seen, places: Mapping[str, Array], at: Array, hips: Rotations, origin: Positions) -> Rotations:
    """The chest by its markers and the shoulders', which count less as they move on it."""
    local, world, weights = [], [], []
    for name in seen:
        site = SITES[name]
        if site.segment == "Chest" and site.anchor == "Chest":
            local, world, weights = [*local, places[name] + at], [*world, seen[name]], [*weights, 1.0]
        elif name.endswith(("_acromion", "_shoulder")):
            sign = -1.0 if name.startswith("left") else 1.0
            place = np.array([sign * 0.175, -0.01, 0.43]) + places[name]
            local, world, weights = [*local, place], [*world, seen[name]], [*weights, 0.3]
    # The waist far below steadies the lean where only shoulders are seen.
    local, world, weights = [*local, np.zeros(3)], [*world, origin], [*weights, 0.1]
    turns, _, good = register(np.array(local), np.stack(world, axis=1), np.array(weights))
    return bridge(turns, good) if good.any() else hips


def cluster_turns(seen: Seen, places: Mapping[str, Array], segment: str, otherwise: Rotations) -> Rotations:
    """The rotations (F, 4) of a segment with three sites or more; those given where it has fewer."""
    names = [name for name in seen if SITES[name].segment == segment]
    if len(names) < 3:
        return otherwise
    local, world = np.array([places[name] for name in names]), np.stack([seen[name] for name in names], axis=1)
    turns, _, good = register(local, world, np.ones(len(names)))
    return bridge(turns, good) if good.any() else otherwise


def _both(seen: Seen, place: str) -> bool:
    return {f"left_{place}", f"right_{place}"} <= set(seen)


def _middle(seen: Seen, *names: str) -> Positions | None:
    """The middle of several sites, or None unless all are there."""
    return np.mean([seen[name] for name in names], axis=0) if set(names) <= set(seen) else None


def median_length(vectors: Positions) -> float:
    """The median length of vectors (F, 3), NaN where none is known."""
    lengths = np.linalg.norm(vectors, axis=-1)
    lengths = lengths[np.isfinite(lengths)]
    return float(np.median(lengths)) if len(lengths) else float("nan")
