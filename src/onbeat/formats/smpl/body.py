"""A mean body with the joints of SMPL, its proportions from published anthropometry.

SMPL's own skeleton is part of a licensed model; nothing of it is used here. The tree and the names of its joints are
public (Loper et al. 2015; hands as in Romero et al. 2017). The lengths are fractions of the stature:

- heights of ankle 0.039, knee 0.285, hip 0.530 and shoulder 0.818; foot 0.152 long: Drillis and Contini 1966, as in
  Winter, *Biomechanics and Motor Control of Human Movement*, figure 4.1;
- upper arm 0.162, forearm 0.154, hand 0.108 of which 0.050 to the knuckles: between joint centres, de Leva 1996 (those
  of Drillis and Contini add up to a span of 1.14);
- the pelvis at the whole body's centre of mass, 0.555 (Winter, chapter 4); spine joints at the iliac crest
  0.604, the tenth rib 0.660 and the chest 0.727, the neck at the seventh vertebra 0.863, the inner ends of the
  collar bones at the suprasternal notch 0.816; the ball at 0.73 of the foot from the heel, the ankle at 0.26: ratios to
  stature in the ANSUR survey (Gordon et al. 1989), rounded;
- hip joints 0.05 to each side (170 mm apart, Bell et al. 1990); shoulder joints 0.105, a little inside half the breadth
  across the shoulder blades, 0.113 (ANSUR); the head joint at the level of the ears, 0.925;
- bones of the fingers: Buryanov and Kotiuk 2010.

The rest pose is SMPL's: a T-pose, here with Z up, so that the body looks along −Y with its left along +X.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from onbeat._shapes import Array
from onbeat.motion import Skeleton

STATURE = 1.70
"""Metres from sole to crown."""
PELVIS = 0.555
"""Height of the pelvis over the sole, as a fraction of the stature."""
SOLE = 0.010
"""Height of the tips of the toes and the balls over the sole, as a fraction of the stature."""
_ROW = "pelvis {hip} spine1 {knee} spine2 {ankle} spine3 {foot} neck {collar} head {shoulder} {elbow} {wrist}"
_FINGERS = ("index", "middle", "pinky", "ring", "thumb")
_SIDES = ("left", "right")


def _both(name: str) -> list[str]:
    return [f"{side}_{name.strip('{}')}" for side in _SIDES] if name.startswith("{") else [name]


BODY_JOINTS = tuple(joint for name in _ROW.split() for joint in _both(name))
"""The 22 joints that all SMPL bodies begin with, in the order of their poses."""
HAND_JOINTS = ("left_hand", "right_hand")
FINGER_JOINTS = tuple(f"{side}_{finger}{n}" for side in _SIDES for finger in _FINGERS for n in (1, 2, 3))
FACE_JOINTS = ("jaw", "left_eye", "right_eye")
ORDERS: dict[int, tuple[str, ...]] = {
    22: BODY_JOINTS,
    24: BODY_JOINTS + HAND_JOINTS,
    52: BODY_JOINTS + FINGER_JOINTS,
    55: BODY_JOINTS + FACE_JOINTS + FINGER_JOINTS,
}
"""Joints by their count in a pose: the body alone, SMPL, SMPL-H and SMPL-X."""

# Joint, its parent and its place from there in fractions of the stature: x to the body's left, y back, z up.
_CENTRE = (
    ("pelvis", "", (0, 0, 0)),
    ("spine1", "pelvis", (0, 0, 0.049)),
    ("spine2", "spine1", (0, 0, 0.056)),
    ("spine3", "spine2", (0, 0, 0.067)),
    ("neck", "spine3", (0, 0, 0.136)),
    ("head", "neck", (0, -0.010, 0.062)),
    ("head_end", "head", (0, 0, 0.075)),
)
_LEG = (
    ("hip", "pelvis", (0.050, 0, -0.025)),
    ("knee", "hip", (0, 0, -0.245)),
    ("ankle", "knee", (0, 0, -0.246)),
    ("foot", "ankle", (0, -0.071, -0.039 + SOLE)),
    ("foot_end", "foot", (0, -0.041, 0)),
)
_ARM = (
    ("collar", "spine3", (0.015, 0, 0.089)),
    ("shoulder", "collar", (0.090, 0, 0.002)),
    ("elbow", "shoulder", (0.162, 0, 0)),
    ("wrist", "elbow", (0.154, 0, 0)),
)
_PALM = (("hand", "wrist", (0.050, 0, 0)), ("hand_end", "hand", (0.058, 0, 0)))
# Knuckle from the wrist and the three bones beyond it, in hundredths of the hand's length.
_KNUCKLES = {
    "index": (51, -12, (22, 12, 11)),
    "middle": (50, 0, (24, 14, 12)),
    "ring": (46, 10, (22, 14, 12)),
    "pinky": (41, 20, (18, 10, 11)),
    "thumb": (12, -13, (25, 17, 14)),
}


@cache
def smpl_skeleton(fingers: bool = False, size: float = 1.0) -> Skeleton:
    """The mean body, 24 joints and its ends depth first; with ``fingers`` 15 joints for each hand instead of one.

    Parameters
    ----------
    fingers : whether the hands have fingers.
    size : the stature in units of :data:`STATURE`.

    Examples
    --------
    >>> body = smpl_skeleton()
    >>> len(body), int(body.end_sites.sum()), body.names[:4]
    (29, 5, ('pelvis', 'left_hip', 'left_knee', 'left_ankle'))
    >>> round(float(np.ptp(body.rest_positions[:, 2])), 2)
    1.68
    """
    rows = _depth_first([*_sided("left", 1, fingers), *_sided("right", -1, fingers), *_CENTRE])
    names = [name for name, _, _ in rows]
    parents = [names.index(parent) if parent else -1 for _, parent, _ in rows]
    offsets: Array = np.array([offset for _, _, offset in rows]) * STATURE * size
    return Skeleton(names, parents, offsets, [name.endswith("_end") for name in names])


_Rows = list[tuple[str, str, tuple[float, float, float]]]


def _sided(side: str, sign: int, fingers: bool) -> _Rows:
    rows = [*_LEG, *_ARM, *(_finger_rows() if fingers else _PALM)]
    named = [(name, parent if parent in ("pelvis", "spine3") else f"{side}_{parent}", at) for name, parent, at in rows]
    return [(f"{side}_{name}", parent, (sign * x, y, z)) for name, parent, (x, y, z) in named]


def _finger_rows() -> _Rows:
    """Straight fingers; the thumb points half forward."""
    hand, rows = 0.00108, _Rows()
    for finger, (along, across, bones) in _KNUCKLES.items():
        x, y = (0.7, -0.7) if finger == "thumb" else (1.0, 0.0)
        chain = [f"{finger}1", f"{finger}2", f"{finger}3", f"{finger}3_end"]
        rows.append((chain[0], "wrist", (along * hand, across * hand, 0.0)))
        rows += [(chain[n + 1], chain[n], (bone * hand * x, bone * hand * y, 0.0)) for n, bone in enumerate(bones)]
    return rows


def _depth_first(rows: _Rows, parent: str = "") -> _Rows:
    return [found for row in rows if row[1] == parent for found in (row, *_depth_first(rows, row[0]))]
