"""What is wrong in one frame of a robot's dance: links that point or turn otherwise, feet elsewhere, capsules too near.

Each wrong is three numbers r with rows J (3, N) of how they change with the unknowns. What is gathered of all of them
are the cost ``Σ |W r|²``, the slope ``Jᵀ W² r`` and Gauss–Newton's matrix ``Jᵀ W² J``, as a band: ``band[a, k]`` is
its element (a, a + k).
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.robots.ik.collision import Capsules, nearest, pairs_near, place_ends
from onbeat.robots.ik.directions import Aims
from onbeat.robots.ik.tree import Posed, Tree, add_point


class Normal(NamedTuple):
    """The band (F N, 2 N + 1) and the slope (F N,) of all frames' unknowns."""

    band: Array
    slope: Array


class Room(NamedTuple):
    """Room to work in.

    Rows (3, N), which of their columns are used (N,) and their list (N,); ends of capsules (C, 2, 3), a list of pairs.
    """

    rows: Array
    used: Bools
    columns: Ints
    ends: Array
    pairs: Ints


@numba.njit(cache=True)
def roomy(unknowns: int, capsules: int, pairs: int) -> Room:
    """Room for so many unknowns, capsules and pairs."""
    whole, used = np.zeros(unknowns, np.int64), np.zeros(unknowns, np.bool_)
    return Room(np.zeros((3, unknowns)), used, whole, np.zeros((capsules, 2, 3)), np.zeros(pairs, np.int64))


@numba.njit(cache=True)
def gather(room: Room, many: int, weights: Array, wrong: Array, normal: Normal, at: int) -> float:
    """Add three rows, of which the first ``many`` listed columns are used, from unknown ``at`` on; their cost."""
    cost = 0.0
    for i in range(3):
        square = weights[i] * weights[i]
        if square == 0.0:
            continue
        cost += square * wrong[i] * wrong[i]
        for k in range(many):
            c = room.columns[k]
            value = square * room.rows[i, c]
            normal.slope[at + c] += value * wrong[i]
            for m in range(k + 1):
                d = room.columns[m]
                normal.band[at + d, c - d] += value * room.rows[i, d]
    return cost


@numba.njit(cache=True)
def _begin(tree: Tree, one: int, other: int, room: Room) -> int:
    """Clear the rows and list the columns, in order, that move one joint or the other; how many."""
    room.rows[:] = 0.0
    room.used[:] = False
    room.used[:3] = True
    for joint in (one, other):
        if joint >= 0:
            for k in range(tree.starts[joint], tree.starts[joint + 1]):
                room.used[tree.columns[k]] = True
    many = 0
    for c in range(len(room.used)):
        if room.used[c]:
            room.columns[many] = c
            many += 1
    return many


@numba.njit(cache=True)
def _across(room: Room, many: int, direction: Array, long: float) -> None:
    """Of rows that move a vector leave what turns it: ``(1 − u uᵀ) J / |v|``."""
    for k in range(many):
        c = room.columns[k]
        along = 0.0
        for i in range(3):
            along += direction[i] * room.rows[i, c]
        for i in range(3):
            room.rows[i, c] = (room.rows[i, c] - along * direction[i]) / long


@numba.njit(cache=True)
def vectors(tree: Tree, posed: Posed, aims: Aims, f: int, scale: float, room: Room, normal: Normal, at: int) -> float:
    """Gather the directions and places of frame ``f``, weighted by ``scale``; their cost."""
    cost = 0.0
    for t in range(len(aims.starts)):
        if aims.strengths[f, t] == 0.0:
            continue
        start, end = aims.starts[t], aims.ends[t]
        many = _begin(tree, start, end, room)
        v = posed.places[end].copy()
        add_point(tree, posed, end, posed.places[end], 1.0, room.rows)
        if start >= 0:
            v -= posed.places[start]
            add_point(tree, posed, start, posed.places[start], -1.0, room.rows)
        if aims.unit[t] > 0:
            long = max(np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), 1e-9)
            v /= long
            _across(room, many, v, long)
        weights = aims.weights[t] * (scale * aims.strengths[f, t])
        cost += gather(room, many, weights, v - aims.vectors[f, t], normal, at)
    return cost


@numba.njit(cache=True)
def turned(turn: Array, wanted: Array, wrong: Array) -> None:
    """Fill in the rotation vector, in the world, from a wanted rotation matrix to one that is."""
    x = y = z = trace = 0.0
    for k in range(3):
        x += turn[2, k] * wanted[1, k] - turn[1, k] * wanted[2, k]
        y += turn[0, k] * wanted[2, k] - turn[2, k] * wanted[0, k]
        z += turn[1, k] * wanted[0, k] - turn[0, k] * wanted[1, k]
        trace += turn[0, k] * wanted[0, k] + turn[1, k] * wanted[1, k] + turn[2, k] * wanted[2, k]
    sine = np.sqrt(x * x + y * y + z * z) / 2
    angle = np.arctan2(sine, (trace - 1) / 2)
    scale = 0.5 if sine < 1e-9 else angle / (2 * sine)
    wrong[0], wrong[1], wrong[2] = x * scale, y * scale, z * scale


@numba.njit(cache=True)
def turns(tree: Tree, posed: Posed, aims: Aims, f: int, scale: float, room: Room, normal: Normal, at: int) -> float:
    """Gather how the parts of frame ``f`` are turned, weighted by ``scale``; their cost."""
    cost, wrong = 0.0, np.empty(3)
    for t in range(len(aims.joints)):
        joint = aims.joints[t]
        first, last = int(tree.starts[joint]), int(tree.starts[joint + 1])
        for k in range(first, last):
            c = tree.columns[k]
            room.columns[k - first] = c
            for i in range(3):
                room.rows[i, c] = posed.axes[c, i]
        turned(posed.turns[joint], aims.turns[f, t], wrong)
        weights = np.full(3, aims.turn_weights[t] * scale)
        cost += gather(room, last - first, weights, wrong, normal, at)
    return cost


@numba.njit(cache=True)
def touches(tree: Tree, posed: Posed, capsules: Capsules, weights: Array, room: Room, normal: Normal, at: int) -> float:
    """Gather by how much each pair of capsules is nearer than its margin, weighted (K,); their cost."""
    cost, wrong, only = 0.0, np.zeros(3), np.zeros(3)
    place_ends(posed.turns, posed.places, capsules, room.ends)
    for k in range(pairs_near(room.ends, capsules, room.pairs)):
        pair = room.pairs[k]
        if weights[pair] == 0.0:
            continue
        a, b = int(capsules.pairs[pair, 0]), int(capsules.pairs[pair, 1])
        near = capsules.radii[a] + capsules.radii[b] + capsules.margins[pair]
        one, other = room.ends[a], room.ends[b]
        s, t = nearest(one, other)
        p, q = one[0] + s * (one[1] - one[0]), other[0] + t * (other[1] - other[0])
        gap = p - q
        far = np.sqrt(gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2])
        if far >= near or far < 1e-9:
            continue
        first, second = int(capsules.joints[a]), int(capsules.joints[b])
        many = _begin(tree, first, second, room)
        add_point(tree, posed, first, p, 1.0, room.rows)
        add_point(tree, posed, second, q, -1.0, room.rows)
        for n in range(many):
            c = room.columns[n]
            room.rows[0, c] = (gap[0] * room.rows[0, c] + gap[1] * room.rows[1, c] + gap[2] * room.rows[2, c]) / far
        wrong[0], only[0] = far - near, weights[pair]
        cost += gather(room, many, only, wrong, normal, at)
    return cost
