"""A description in its zero configuration: where its links are, how high it stands, what overlaps by design."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import Description

CLOSE = 0.002
"""Metres; capsules nearer than this in the zero configuration overlap by design."""


class Frame(NamedTuple):
    """A link's frame in that of the root: wxyz and metres."""

    turn: Rotations
    at: Positions


def rest_frames(description: Description) -> dict[str, Frame]:
    """The frame of each link in the zero configuration, the root's first."""
    frames = {description.root.link: Frame(rot.IDENTITY, np.zeros(3))}
    for name, link in description.links.items():
        above = frames[link.parent]
        tilt = rot.from_euler("ZYX", np.array(link.rpy[::-1]))
        at = above.at + rot.rotate(above.turn, np.array(link.origin))
        frames[name] = Frame(rot.multiply(above.turn, tilt), at)
    return frames


def standing_height(description: Description) -> float:
    """Metres from the lowest corner of the soles up to the root in the zero configuration."""
    frames = rest_frames(description)
    corners = [
        (frames[sole.link].at + rot.rotate(frames[sole.link].turn, np.array(sole.corners)))[:, 2]
        for sole in description.feet.values()
    ]
    return -float(np.min(corners))


def excluded(description: Description) -> list[tuple[str, str]]:
    """Pairs of links that are not looked at for collisions.

    Those the description keeps apart; those with one link between them, as of a hip that turns about three axes in one
    place; those whose capsules overlap in the zero configuration. A link and the one above it an engine leaves out
    by itself.
    """
    root = description.root
    solid = {root.link: root.capsules, **{name: link.capsules for name, link in description.links.items()}}
    solid = {name: capsules for name, capsules in solid.items() if capsules}
    above = {name: link.parent for name, link in description.links.items()}
    frames = rest_frames(description)
    ends = {name: _placed(np.array(capsules), frames[name]) for name, capsules in solid.items()}
    told = {frozenset(pair) for pair in description.apart}
    return [
        (one, other)
        for one, other in itertools.combinations(solid, 2)
        if frozenset((one, other)) in told or _near_in_tree(one, other, above) or _gap(ends[one], ends[other]) < CLOSE
    ]


def _near_in_tree(one: str, other: str, above: Mapping[str, str]) -> bool:
    """Whether a link is above the other, or one link is between them."""
    lines = [(name, above.get(name), above.get(above.get(name, ""))) for name in (one, other)]
    (a, up_a, top_a), (b, up_b, top_b) = lines
    return a in (up_b, top_b) or b in (up_a, top_a) or (up_a is not None and up_a == up_b)


def _placed(capsules: Array, frame: Frame) -> Array:
    """Capsules (C, 7) in the frame of the root."""
    return np.hstack(
        (
            frame.at + rot.rotate(frame.turn, capsules[:, :3]),
            frame.at + rot.rotate(frame.turn, capsules[:, 3:6]),
            capsules[:, 6:],
        )
    )


def _gap(some: Array, others: Array) -> float:
    """The least distance in metres between the surfaces of capsules (A, 7) and (B, 7)."""
    a, b = np.broadcast_arrays(some[:, None], others[None])
    axes = segment_distances(a[..., :3], a[..., 3:6], b[..., :3], b[..., 3:6])
    return float((axes - a[..., 6] - b[..., 6]).min())


def segment_distances(a: Positions, b: Positions, c: Positions, d: Positions) -> Array:
    """The distances (...) between segments from a to b and from c to d, (..., 3) each.

    With ``u = b − a, v = d − c, w = a − c`` the squared distance of ``a + s u`` and ``c + t v`` is convex in s and t:
    its least value in the unit square is inside, or on one of the four edges.

    Examples
    --------
    >>> points = np.array([[0, 0, 0], [1, 0, 0], [2, 1, 0], [2, 3, 0]], float)
    >>> float(segment_distances(*points).round(6))
    1.414214
    """
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = (u * u).sum(-1), (v * v).sum(-1), (u * v).sum(-1)
    uw, vw = (u * w).sum(-1), (v * w).sum(-1)
    area = uu * vv - uv * uv
    s = np.where(area > 1e-15, (uv * vw - vv * uw) / np.maximum(area, 1e-15), 0.0)
    t = np.where(area > 1e-15, (uu * vw - uv * uw) / np.maximum(area, 1e-15), 0.0)
    inside = (area > 1e-15) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    zero, one = np.zeros_like(s), np.ones_like(s)
    along_v = [np.clip((vw + edge * uv) / np.maximum(vv, 1e-15), 0, 1) for edge in (0.0, 1.0)]
    along_u = [np.clip((edge * uv - uw) / np.maximum(uu, 1e-15), 0, 1) for edge in (0.0, 1.0)]
    pairs = [(zero, along_v[0]), (one, along_v[1]), (along_u[0], zero), (along_u[1], one)]
    pairs.append((np.where(inside, s, 0.0), np.where(inside, t, along_v[0])))
    gaps = [np.linalg.norm(w + s[..., None] * u - t[..., None] * v, axis=-1) for s, t in pairs]
    return np.minimum.reduce(gaps)
