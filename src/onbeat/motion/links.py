"""The 17 link directions of a body, in its body-centre frame (Shiratori 2006, Sec. II-B, Fig. 4).

Link directions compare poses of bodies of any size. Each is a unit vector from one joint role to another, seen from
the body's own frame, so that neither place nor facing matters. Three lie on the centre line (trunk, head, pelvis) and
seven on each side (collar, upper arm, forearm, hand, thigh, shin, foot). The trunk is the frame's own z axis, the
same in every pose: it is kept so that the links are those of the paper. Lean and height are not seen here.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames
from onbeat.motion.motion import Motion

_SIDE_LINKS = ("collar", "upper_arm", "forearm", "hand", "thigh", "shin", "foot")
LINKS = ("trunk", "head", "pelvis", *(f"{side}_{link}" for side in ("left", "right") for link in _SIDE_LINKS))
"""Names of the links, in the order of the second axis of :func:`link_directions`."""
NEIGHBOURS = {"head": "trunk", "collar": "upper_arm", "hand": "forearm", "foot": "shin"}
"""Whose direction a link takes where the body lacks one of its joints, or the two joints are at one place."""
_SHORT = 1e-6  # metres; a link this short has no direction


def link_directions(motion: Motion, body: Body | None = None) -> Array:
    """(F, 17, 3) unit vectors, the links' directions in the body-centre frame, in the order of ``LINKS``.

    A link whose joint is missing (head, collar, hand, toe) or which has no length takes the direction of its
    neighbour (``NEIGHBOURS``), so that it counts neither more nor less.
    """
    body = Body.of(motion.skeleton) if body is None else body
    vectors = _world_vectors(motion, body)
    frames, _ = body_frames(motion, body)
    return rot.rotate(rot.inverse(frames)[:, None], np.stack([_units(vectors, name) for name in LINKS], axis=1))


def _world_vectors(motion: Motion, body: Body) -> dict[str, Positions]:
    """The links as (F, 3) vectors in the world; those whose joints are missing are left out."""
    p = motion.positions
    trunk_top = (p[:, body["left_shoulder"]] + p[:, body["right_shoulder"]]) / 2
    vectors = {
        "trunk": trunk_top - p[:, body["hips"]],
        "pelvis": p[:, body["right_hip"]] - p[:, body["left_hip"]],
    }
    if "head" in body:
        head = body["head"]
        top = motion.skeleton.children[head][0] if motion.skeleton.children[head] else head
        vectors["head"] = p[:, top] - (p[:, body["neck"]] if "neck" in body else trunk_top)
    chains = (
        ("collar", "collar", "shoulder"),
        ("upper_arm", "shoulder", "elbow"),
        ("forearm", "elbow", "wrist"),
        ("hand", "wrist", "hand"),
        ("thigh", "hip", "knee"),
        ("shin", "knee", "ankle"),
        ("foot", "ankle", "toe"),
    )
    for side in ("left", "right"):
        for link, top, bottom in chains:
            if f"{side}_{top}" in body and f"{side}_{bottom}" in body:
                vectors[f"{side}_{link}"] = p[:, body[f"{side}_{bottom}"]] - p[:, body[f"{side}_{top}"]]
    return vectors


def _units(vectors: dict[str, Positions], name: str) -> Positions:
    """Unit vectors (F, 3) of one link, its neighbour's where it has none."""
    side, _, link = name.partition("_") if name.startswith(("left_", "right_")) else ("", "", name)
    neighbour = NEIGHBOURS.get(link)
    if name not in vectors:
        return _units(vectors, f"{side}_{neighbour}".lstrip("_"))
    length = np.linalg.norm(vectors[name], axis=-1, keepdims=True)
    unit = vectors[name] / np.maximum(length, _SHORT)
    if neighbour is None or (length > _SHORT).all():
        return unit
    return np.where(length > _SHORT, unit, _units(vectors, f"{side}_{neighbour}".lstrip("_")))


def link_error(a: Array, b: Array) -> Array:
    """Mean angle in degrees (...) between the link directions (..., 17, 3) of two poses.

    Examples
    --------
    >>> up = np.tile([0.0, 0.0, 1.0], (17, 1))
    >>> float(link_error(up, up)), round(float(link_error(up, up[:, ::-1])), 6)
    (0.0, 90.0)
    """
    across = np.linalg.norm(np.cross(a, b), axis=-1)  # atan2 keeps its precision at small angles, arccos does not
    return np.degrees(np.arctan2(across, np.sum(a * b, axis=-1))).mean(axis=-1)
