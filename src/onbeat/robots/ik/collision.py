"""Self-collision: a robot's links as capsules, and how far those that may meet are from each other.

The distance of two capsules is that of the segments of their axes less both radii. The nearest points of two segments
``a + s u`` and ``b + t v``, 0 ≤ s, t ≤ 1, are those of the two lines, clamped one after the other (Ericson 2005,
*Real-Time Collision Detection*, Sec. 5.1.9).
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numba
import numpy as np

from onbeat._shapes import Array, Ints, Positions
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot

MARGIN = 0.02
"""Metres that capsules are kept apart."""


class Capsules(NamedTuple):
    """A robot's C capsules and the K pairs of them that must not meet.

    Parameters
    ----------
    joints : (C,) that carry them.
    ends : (C, 2, 3) metres in the joints' frames.
    radii, halves : (C,) metres; halves of the axes' lengths.
    pairs : (K, 2).
    margins : (K,) metres that each pair is to keep; less where they are nearer in the zero configuration.
    """

    joints: Ints
    ends: Array
    radii: Array
    halves: Array
    pairs: Ints
    margins: Array


@numba.njit(cache=True)
def nearest(one: Array, other: Array) -> tuple[float, float]:
    """Where two segments (2, 3) come nearest, as the parts s and t of each that lie before it.

    Examples
    --------
    >>> nearest(np.array([[-1.0, 0, 0], [1, 0, 0]]), np.array([[0.0, 0, 1], [0, 4, 1]]))
    (0.5, 0.0)
    """
    uu = vv = uv = ur = vr = 0.0
    for i in range(3):
        u, v, r = one[1, i] - one[0, i], other[1, i] - other[0, i], one[0, i] - other[0, i]
        uu, vv, uv, ur, vr = uu + u * u, vv + v * v, uv + u * v, ur + u * r, vr + v * r
    if uu < 1e-12:
        return 0.0, (min(max(vr / vv, 0.0), 1.0) if vv > 1e-12 else 0.0)
    if vv < 1e-12:
        return min(max(-ur / uu, 0.0), 1.0), 0.0
    det = uu * vv - uv * uv
    s = min(max((uv * vr - vv * ur) / det, 0.0), 1.0) if det > 1e-9 * uu * vv else 0.5
    t = (uv * s + vr) / vv
    if t < 0.0 or t > 1.0:
        t = min(max(t, 0.0), 1.0)
        s = min(max((uv * t - ur) / uu, 0.0), 1.0)
    return s, t


@numba.njit(cache=True)
def pairs_near(ends: Array, capsules: Capsules, found: Ints) -> int:
    """List the pairs that may be nearer than their margin by the spheres around them; how many."""
    pairs, radii, halves = capsules.pairs, capsules.radii, capsules.halves
    many = 0
    for pair in range(len(pairs)):
        a, b = pairs[pair, 0], pairs[pair, 1]
        x = ends[a, 0, 0] + ends[a, 1, 0] - ends[b, 0, 0] - ends[b, 1, 0]
        y = ends[a, 0, 1] + ends[a, 1, 1] - ends[b, 0, 1] - ends[b, 1, 1]
        z = ends[a, 0, 2] + ends[a, 1, 2] - ends[b, 0, 2] - ends[b, 1, 2]
        most = radii[a] + radii[b] + halves[a] + halves[b] + capsules.margins[pair]
        if x * x + y * y + z * z < 4 * most * most:
            found[many] = pair
            many += 1
    return many


@numba.njit(cache=True)
def place_ends(turns: Array, places: Positions, capsules: Capsules, ends: Array) -> None:
    """Fill in where in the world the ends (C, 2, 3) of the capsules' axes are, of one frame's joints."""
    for c in range(len(capsules.joints)):
        joint = capsules.joints[c]
        for e in range(2):
            for i in range(3):
                ends[c, e, i] = places[joint, i]
                for k in range(3):
                    ends[c, e, i] += turns[joint, i, k] * capsules.ends[c, e, k]


@numba.njit(cache=True)
def write_gaps(ends: Array, capsules: Capsules, out: Array) -> None:
    """Fill in the distances (K,) of the skins of each pair, of one frame's ends."""
    for pair in range(len(capsules.pairs)):
        a, b = capsules.pairs[pair, 0], capsules.pairs[pair, 1]
        s, t = nearest(ends[a], ends[b])
        square = 0.0
        for i in range(3):
            gap = ends[a, 0, i] + s * (ends[a, 1, i] - ends[a, 0, i])
            square += (gap - ends[b, 0, i] - t * (ends[b, 1, i] - ends[b, 0, i])) ** 2
        out[pair] = np.sqrt(square) - capsules.radii[a] - capsules.radii[b]


@numba.njit(cache=True)
def _clearances(turns: Array, places: Positions, capsules: Capsules, out: Array) -> None:
    ends = np.empty((len(capsules.joints), 2, 3))
    for frame in range(len(places)):
        place_ends(turns[frame], places[frame], capsules, ends)
        write_gaps(ends, capsules, out[frame])


def clearances(motion: Motion, capsules: Capsules) -> Array:
    """(F, K) metres between the skins of each pair in each frame of a robot's motion; negative where they meet."""
    out = np.empty((len(motion), len(capsules.pairs)))
    turns = np.ascontiguousarray(rot.to_matrix(motion.world_rotations))
    _clearances(turns, np.ascontiguousarray(motion.positions), capsules, out)
    return out


def capsules_of(robot: Robot) -> Capsules:
    """A robot's capsules and spheres, as its model has them, and the pairs of them that its model looks at."""
    model, body = robot.model, robot.body
    names = body.skeleton.names
    joint_of: dict[int, int] = {}
    for link in range(1, model.nbody):
        first = int(model.body_jntadr[link])
        name = model.joint(first).name if first >= 0 else ""
        joint_of[link] = names.index(name) if name in names else joint_of.get(int(model.body_parentid[link]), 0)
    found: list[tuple[int, int, Array, float]] = []
    for geom in range(model.ngeom):
        link, kind = int(model.geom_bodyid[geom]), int(model.geom_type[geom])
        if link == 0 or kind not in (2, 3) or not model.geom_conaffinity[geom] & 2:
            continue
        frame = rot.IDENTITY if joint_of[link] == 0 else body.links[joint_of[link] - 1]
        along = rot.rotate(model.geom_quat[geom], np.array([0.0, 0.0, model.geom_size[geom, 1] if kind == 3 else 0.0]))
        ends = model.geom_pos[geom] + np.array([-along, along])
        found.append((link, joint_of[link], rot.rotate(frame, ends), float(model.geom_size[geom, 0])))
    apart = {(int(s) >> 16, int(s) & 0xFFFF) for s in model.exclude_signature}
    apart |= {(b, a) for a, b in apart}
    links = [link for link, *_ in found]
    pairs = [
        (i, j)
        for i, j in itertools.combinations(range(len(found)), 2)
        if links[i] != links[j]
        and (links[i], links[j]) not in apart
        and links[j] != model.body_parentid[links[i]]
        and links[i] != model.body_parentid[links[j]]
    ]
    ends = np.array([ends for *_, ends, _ in found], np.float64).reshape(-1, 2, 3)
    joints = np.array([joint for _, joint, *_ in found], np.int64)
    radii = np.array([radius for *_, radius in found], np.float64)
    halves = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1) / 2
    table = np.array(pairs, np.int64).reshape(-1, 2)
    capsules = Capsules(joints, ends, radii, halves, table, np.full(len(table), MARGIN))
    rest = hinge_motion(body, np.zeros((1, 3)), rot.IDENTITY[None], np.zeros((1, len(body.names))), 1.0)
    return capsules._replace(margins=np.clip(0.8 * clearances(rest, capsules)[0], 0.0, MARGIN))
