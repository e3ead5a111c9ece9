"""A robot's tree of hinges for inverse kinematics: where its links are, and how each column of the unknowns moves them.

The unknowns of a frame are N = 6 + n numbers: by how much the root is moved (3) and turned (3, a rotation vector d)
from where it is wanted, ``p = p_wanted + x``, ``R = exp(d) R_wanted``, then the n angles. A column c of them turns all
that hangs on it about the axis w_c through o_c: a point P moves by ``w_c × (P − o_c)``; of d the axes are the columns
of the left Jacobian, ``1 + [d]/2 + [d]²/6`` to third order. All is exact and analytic: no model and no simulator is
asked.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from onbeat._shapes import Array, Ints, Positions
from onbeat.motion.hinges import HingeBody

ROOT = 6
"""Unknowns of the root in front of the angles."""


class Tree(NamedTuple):
    """A robot as arrays: J joints, n hinges, N = 6 + n unknowns.

    Parameters
    ----------
    parents : (J,) the joint above each, -1 for the root.
    offsets : (J, 3) metres, in the frame of the joint above.
    hinges : (J,) the hinge of each joint, -1 where there is none.
    axes : (n, 3) of the hinges.
    starts, columns : those of the unknowns from 3 on that turn joint j are ``columns[starts[j]:starts[j + 1]]``.
    """

    parents: Ints
    offsets: Array
    hinges: Ints
    axes: Array
    starts: Ints
    columns: Ints


def tree_of(body: HingeBody) -> Tree:
    """The robot as arrays.

    Examples
    --------
    >>> from onbeat.motion.unitree_g1 import G1
    >>> tree = tree_of(G1)
    >>> tree.axes.shape, tree.columns[: tree.starts[2]].tolist()
    ((29, 3), [3, 4, 5, 3, 4, 5, 6])
    """
    skeleton = body.skeleton
    hinges = np.full(len(skeleton), -1)
    hinges[body.joints] = np.arange(len(body.joints))
    chains: list[list[int]] = []
    for joint, parent in enumerate(skeleton.parents.tolist()):
        above = chains[parent] if joint else [3, 4, 5]
        chains.append([*above, ROOT + int(hinges[joint])] if hinges[joint] >= 0 else list(above))
    starts = np.concatenate(([0], np.cumsum([len(chain) for chain in chains])))
    columns = np.array([column for chain in chains for column in chain])
    return Tree(np.array(skeleton.parents), np.array(skeleton.offsets), hinges, np.array(body.axes), starts, columns)


class Posed(NamedTuple):
    """One frame of a robot in the world: its links, and the axes of the unknowns. Filled anew by :func:`pose`.

    Parameters
    ----------
    turns : (J, 3, 3) rotation matrices.
    places : (J, 3) metres.
    axes, points : (N, 3) the axis w_c of each unknown and a point o_c on it; of the first three nothing is used.
    """

    turns: Array
    places: Positions
    axes: Array
    points: Positions


@numba.njit(cache=True)
def unposed(joints: int, unknowns: int) -> Posed:
    """Room for one frame."""
    return Posed(np.zeros((joints, 3, 3)), np.zeros((joints, 3)), np.zeros((unknowns, 3)), np.zeros((unknowns, 3)))


@numba.njit(cache=True)
def about(axis: Array, angle: float, out: Array) -> None:
    """The rotation matrix by an angle about a unit axis (Rodrigues)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = axis[0], axis[1], axis[2]
    out[0, 0], out[0, 1], out[0, 2] = c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s
    out[1, 0], out[1, 1], out[1, 2] = y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s
    out[2, 0], out[2, 1], out[2, 2] = z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)


@numba.njit(cache=True)
def product(a: Array, b: Array, out: Array) -> None:
    """The product of two 3 × 3 matrices."""
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


@numba.njit(cache=True)
def carried(turn: Array, v: Array, out: Array) -> None:
    """A vector (3,) turned by a matrix."""
    for i in range(3):
        out[i] = turn[i, 0] * v[0] + turn[i, 1] * v[1] + turn[i, 2] * v[2]


@numba.njit(cache=True)
def _root(x: Array, place: Array, turn: Array, posed: Posed, local: Array) -> None:
    """Root and the axes of its three turns."""
    d = x[3:6]
    angle = np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    about(d / max(angle, 1e-12), angle, local)
    product(local, turn, posed.turns[0])
    posed.places[0] = place + x[:3]
    cross = np.array([[0.0, -d[2], d[1]], [d[2], 0.0, -d[0]], [-d[1], d[0], 0.0]])
    product(cross, cross, local)
    for c in range(3):
        for i in range(3):
            posed.axes[3 + c, i] = (1.0 if i == c else 0.0) + cross[i, c] / 2 + local[i, c] / 6
        posed.points[3 + c] = posed.places[0]


@numba.njit(cache=True)
def pose(tree: Tree, x: Array, place: Array, turn: Array, posed: Posed) -> None:
    """Fill in where the links are with unknowns x (N,) of a root wanted at ``place`` (3,), turned ``turn`` (3, 3)."""
    local, step = np.empty((3, 3)), np.empty(3)
    _root(x, place, turn, posed, local)
    for joint in range(1, len(tree.parents)):
        parent, hinge = tree.parents[joint], tree.hinges[joint]
        carried(posed.turns[parent], tree.offsets[joint], step)
        for i in range(3):
            posed.places[joint, i] = posed.places[parent, i] + step[i]
        if hinge < 0:
            posed.turns[joint] = posed.turns[parent]
            continue
        about(tree.axes[hinge], float(x[6 + hinge]), local)
        product(posed.turns[parent], local, posed.turns[joint])
        carried(posed.turns[parent], tree.axes[hinge], posed.axes[6 + hinge])
        posed.points[6 + hinge] = posed.places[joint]


@numba.njit(cache=True)
def add_point(tree: Tree, posed: Posed, joint: int, point: Array, sign: float, rows: Array) -> None:
    """Add to rows (3, N) how a point that a joint carries moves with each unknown, ``sign`` times."""
    for i in range(3):
        rows[i, i] += sign
    for k in range(tree.starts[joint], tree.starts[joint + 1]):
        c = tree.columns[k]
        w, o = posed.axes[c], posed.points[c]
        x, y, z = point[0] - o[0], point[1] - o[1], point[2] - o[2]
        rows[0, c] += sign * (w[1] * z - w[2] * y)
        rows[1, c] += sign * (w[2] * x - w[0] * z)
        rows[2, c] += sign * (w[0] * y - w[1] * x)
