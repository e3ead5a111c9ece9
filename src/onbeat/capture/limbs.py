"""Arms and legs from their markers: the joints' centres and how each bone is turned."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.capture.pose import best_turns, bridge
from onbeat.capture.sites import SITES
from onbeat.capture.trunk import Seen
from onbeat.motion import rotations as rot


def leg(
    seen: Seen, places: Mapping[str, Array], side: str, sign: float, hip: Positions,
    turns: dict[str, Rotations], centres: dict[str, Positions],
) -> None:  # fmt: skip
    """Add thigh, shin and foot of a side to ``turns`` and its joints to ``centres``.

    Hip to knee to ankle are laid along the bones; the knee's axis turns them about their length: across the plane of
    a bent leg, else as the foot points. Knee and ankle lie inside the limb by half its width from their markers.
    """
    s = side.lower()
    x, _, z = np.eye(3)
    raw = np.tile(rot.IDENTITY, (len(hip), 1))
    knee, ankle = (
        _joint(seen, {}.fromkeys(names, np.zeros(3)), names, raw)
        for names in ((f"{s}_knee_lateral", f"{s}_knee"), (f"{s}_ankle_lateral", f"{s}_ankle"))
    )
    across = rot.rotate(turns["Hips"], x)
    hint = _hinge(hip, knee, ankle, -1.0, _known(_toes_across(seen, s, knee, ankle), across), across)
    thigh, good = _bone(-z, knee - hip, x, hint)
    knee = _joint(seen, places, (f"{s}_knee_lateral", f"{s}_knee_medial", f"{s}_knee"), bridge(thigh, good))
    hint = _known(_across(seen, f"{s}_knee", sign), hint)
    turns[f"{side}UpLeg"] = bridge(*_bone(-z, knee - hip, x, hint))
    shin, good = _bone(-z, ankle - knee, x, hint)
    names = (f"{s}_ankle_lateral", f"{s}_ankle_medial", f"{s}_ankle")
    ankle = _joint(seen, places, names, bridge(shin, good))
    turns[f"{side}Leg"] = bridge(*_bone(-z, ankle - knee, x, hint))
    turns[f"{side}Foot"] = _foot(seen, places, side, ankle, turns[f"{side}Leg"])
    centres |= {f"{side}UpLeg": hip, f"{side}Leg": knee, f"{side}Foot": ankle}


def arm(
    seen: Seen, places: Mapping[str, Array], side: str, sign: float,
    turns: dict[str, Rotations], centres: dict[str, Positions],
) -> None:  # fmt: skip
    """Add upper arm, forearm and hand of a side to ``turns`` and its joints to ``centres``, as :func:`leg` does."""
    s = side.lower()
    x, y, z = np.eye(3)
    chest = turns["Chest"]
    shoulder = _joint(seen, places, (f"{s}_acromion", f"{s}_shoulder"), chest)
    raw = np.tile(rot.IDENTITY, (len(chest), 1))
    zero = dict.fromkeys(seen, np.zeros(3))
    elbow = _joint(seen, zero, (f"{s}_elbow_lateral", f"{s}_elbow"), raw)
    wrist = _joint(seen, zero, (f"{s}_wrist", f"{s}_wrist_thumb", f"{s}_wrist_little", f"{s}_wrist_back"), raw)
    up = _hinge(shoulder, elbow, wrist, sign, rot.rotate(chest, z), rot.rotate(chest, z))
    up = _known(_across(seen, f"{s}_elbow", 1.0), up)
    arm, good = _bone(x * sign, elbow - shoulder, z, up)
    names = (f"{s}_elbow_lateral", f"{s}_elbow_medial", f"{s}_elbow")
    elbow = _joint(seen, places, names, bridge(arm, good))
    turns[f"{side}Arm"] = bridge(*_bone(x * sign, elbow - shoulder, z, up))
    forearm = _forearm(seen, s, sign, wrist - elbow, up)
    names = (f"{s}_wrist", f"{s}_wrist_thumb", f"{s}_wrist_little", f"{s}_wrist_back")
    wrist = _joint(seen, places, names, forearm)
    turns[f"{side}ForeArm"] = _forearm(seen, s, sign, wrist - elbow, up)
    tips = [f"{s}_{n}" for n in ("hand_end", "finger", "hand_little", "hand_thumb") if f"{s}_{n}" in seen]
    hand = turns[f"{side}ForeArm"]
    if tips:
        level = rot.rotate(hand, y)
        hand = bridge(*_bone(x * sign, seen[tips[0]] - wrist, y, level))
    turns[f"{side}Hand"] = hand
    centres |= {f"{side}Arm": shoulder, f"{side}ForeArm": elbow, f"{side}Hand": wrist}


def _foot(seen: Seen, places: Mapping[str, Array], side: str, ankle: Positions, shin: Rotations) -> Rotations:
    s = side.lower()
    names = [name for name in seen if SITES[name].segment == f"{side}Foot" and name.startswith(s)]
    base = np.array([0, 0.12, -0.055])
    local = [places[name] + (base if SITES[name].anchor.endswith("ToeBase") else 0) for name in names]
    world = [seen[name] - ankle for name in names]
    if not names and f"{s}_toe_tip" in seen:
        local, world = [base + places[f"{s}_toe_tip"]], [seen[f"{s}_toe_tip"] - ankle]
    if not world:
        return shin
    across = rot.rotate(shin, np.array([1.0, 0, 0])) * 0.05
    turns, good = best_turns(
        np.array([*local, [0.05, 0, 0]]), np.stack([*world, across], axis=1), np.ones(len(local) + 1)
    )
    return bridge(turns, good)


def _forearm(seen: Seen, side: str, sign: float, along: Positions, up: Positions) -> Rotations:
    """The forearm, turned by the markers on both sides of the wrist, or as a thumb between up and forwards has it."""
    x, y, _ = np.eye(3)
    ahead = np.cross(up, _unit(along) * sign)
    thumb, little = seen.get(f"{side}_wrist_thumb"), seen.get(f"{side}_wrist_little")
    hint = ahead if thumb is None or little is None else _known(_unit(thumb - little), ahead)
    return bridge(*_bone(x * sign, along, y, hint))


def _joint(seen: Seen, places: Mapping[str, Array], names: tuple[str, ...], turns: Rotations) -> Positions:
    """A joint's centre: the middle of where each site, its offset turned with the bone, says it is."""
    found = [seen[name] - rot.rotate(turns, places[name]) for name in names if name in seen]
    if not found:
        return np.full((len(turns), 3), np.nan)
    known = np.isfinite(found).all(axis=-1, keepdims=True)
    total = np.sum(np.where(known, found, 0.0), axis=0)
    return np.where(known.any(axis=0), total / np.maximum(known.sum(axis=0), 1), np.nan)


def _bone(bone: Array, along: Positions, second: Array, hint: Positions) -> tuple[Rotations, Bools]:
    """Rotations that lay ``bone`` along a direction and turn ``second`` about it towards a hint."""
    world = np.stack(
        (_unit(along), _unit(hint - _unit(along) * np.sum(_unit(along) * hint, -1, keepdims=True))), axis=1
    )
    return best_turns(np.stack((bone, second)), world, np.array([1.0, 0.2]))


def _hinge(
    top: Positions, middle: Positions, end: Positions, sign: float, hint: Positions, otherwise: Positions
) -> Positions:
    """The axis about which a limb is bent, ``sign`` times upper × lower; a hint decides where it is nearly straight."""
    bent = sign * np.cross(_unit(middle - top), _unit(end - middle))
    hint = np.where(np.isfinite(hint), hint, otherwise)
    # Past half a radian of bending the limb itself tells its axis.
    share = np.clip(np.linalg.norm(bent, axis=-1, keepdims=True) / 0.5, 0.0, 1.0) ** 2
    return _known(share * _unit(bent) + (1 - share) * _unit(hint), _unit(hint))


def _across(seen: Seen, joint: str, sign: float) -> Positions:
    """The direction across a joint with a marker on either side, to the body's right."""
    lateral, medial = seen.get(f"{joint}_lateral"), seen.get(f"{joint}_medial")
    if lateral is None or medial is None:
        return np.full((len(next(iter(seen.values()))), 3), np.nan)
    return _unit(lateral - medial) * sign


def _toes_across(seen: Seen, side: str, knee: Positions, ankle: Positions) -> Positions:
    """The direction across the leg, to the right, by where the foot points."""
    tips = [seen[f"{side}_{name}"] for name in ("toe", "mt1", "mt5", "toe_base", "toe_tip") if f"{side}_{name}" in seen]
    if not tips:
        return np.full_like(ankle, np.nan)
    forwards = np.mean(tips, axis=0) - seen.get(f"{side}_heel", ankle)
    return np.cross(_unit(forwards), _unit(knee - ankle))


def _unit(vectors: Positions) -> Positions:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)


def _known(first: Positions, otherwise: Positions) -> Positions:
    return np.where(np.isfinite(first).all(axis=-1, keepdims=True), first, otherwise)
