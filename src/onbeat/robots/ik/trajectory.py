"""Inverse kinematics of a whole dance at once: nonlinear least squares over all frames' unknowns.

With r_f(x_f) what is wrong in frame f, weighted (:mod:`onbeat.robots.ik.residuals`), and h the seconds between frames
the cost is

    h Σ_f (|r_f|² + |w (x_f − x_rest)|² + |τ² (x_{f−1} − 2 x_f + x_{f+1}) / h²|² + |τ_v (x_{f+1} − x_f) / h|²)

and a steep price of steps beyond the limits of speed. The last two terms keep angles continuous where the first
leaves them open (a straight elbow, the shoulder's singularity): what r tells with weight σ is followed up to a
frequency of √σ / (2π τ). Angles keep their limits by projected steps (Bertsekas 1982, doi:10.1137/0320018): a column
at its limit that wants to go on is held. A step solves a band of 2 N beside the diagonal; it is taken if the cost
falls, else damped more (Levenberg–Marquardt).
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from scipy.linalg import solveh_banded

from onbeat._shapes import Array
from onbeat.robots.ik.collision import Capsules
from onbeat.robots.ik.directions import Aims
from onbeat.robots.ik.residuals import Normal, roomy, touches, turns, vectors
from onbeat.robots.ik.tree import Tree, pose, unposed

STEEP = 1000.0
"""The price of a step beyond the limit of speed: this times its square over the time it takes."""
STEPS, ENOUGH = 30, 1e-3
"""Steps at most, and the part by which a step has to lower the cost for there to be another."""
STIFFEST = 1e4
"""Damping beyond which no step is sought any more."""


class Rules(NamedTuple):
    """What holds for every frame.

    Parameters
    ----------
    low, high : (N,) bounds of the unknowns.
    rest : (N,) where they go when nothing is asked.
    ease : (N,) weights w of that.
    bend, drag : (N,) seconds, τ and τ_v.
    speed : (N,) most by which an unknown may change in a second.
    apart : what a metre under a pair's margin weighs.
    """

    low: Array
    high: Array
    rest: Array
    ease: Array
    bend: Array
    drag: Array
    speed: Array
    apart: float


class Problem(NamedTuple):
    """All but the unknowns: a robot, what is asked of it, and what holds.

    Parameters
    ----------
    tree, capsules : of the robot.
    aims : of F frames.
    rules : that hold for each.
    push : (F, K) how much more than usual each pair of capsules is pushed apart.
    h : seconds between frames.
    """

    tree: Tree
    aims: Aims
    capsules: Capsules
    rules: Rules
    push: Array
    h: float

    def cut(self, part: slice) -> Problem:
        """The problem of some of the frames."""
        push = np.ascontiguousarray(self.push[part])
        return self._replace(aims=self.aims.cut(part), push=push, h=self.h * (part.step or 1))


class Solution(NamedTuple):
    """Unknowns x (F, N), their cost, and what is wrong (F,) in each frame: ``|r_f|²``."""

    x: Array
    cost: float
    wrong: Array


class _State(NamedTuple):
    cost: float
    normal: Normal
    wrong: Array


def solve(problem: Problem, x: Array, pinned: tuple[int, int] = (0, 0), steps: int = STEPS) -> Solution:
    """The unknowns of the least cost that is downhill from x (F, N).

    Parameters
    ----------
    problem : of F frames.
    x : within bounds.
    pinned : how many of the first and of the last frames stay as they are.
    steps : at most.
    """
    state, damping = _state(problem, x), 1e-3
    for _ in range(steps):
        trial = _step(problem.rules, x, state.normal, pinned, damping, problem.h)
        new = _state(problem, trial)
        if new.cost < state.cost:
            gained = 1 - new.cost / state.cost
            x, state, damping = trial, new, max(damping / 5, 1e-6)
            if gained < ENOUGH:
                break
        elif damping > STIFFEST:
            break
        else:
            damping *= 10
    return Solution(x, state.cost, state.wrong / problem.h)


def _step(rules: Rules, x: Array, normal: Normal, pinned: tuple[int, int], damping: float, h: float) -> Array:
    """The unknowns after one projected Gauss–Newton step."""
    slope = normal.slope.reshape(x.shape)
    held = ((x <= rules.low + 1e-9) & (slope > 0)) | ((x >= rules.high - 1e-9) & (slope < 0))
    held[: pinned[0]] = True
    held[len(x) - pinned[1] :] = True
    band = normal.band.copy()
    band[:, 0] = band[:, 0] * (1 + damping) + h * 1e-6 + 1e9 * held.ravel()
    downhill = np.where(held, 0.0, -slope).ravel()
    step = solveh_banded(band.T, downhill, overwrite_ab=True, lower=True, check_finite=False)
    return np.clip(x + step.reshape(x.shape), rules.low, rules.high)


def _state(problem: Problem, x: Array) -> _State:
    normal = Normal(np.zeros((x.size, 2 * x.shape[1] + 1)), np.zeros(x.size))
    wrong = np.zeros(len(x))
    _frames(problem, x, normal, wrong)
    rules = problem.rules
    cost = _smooth(rules, problem.h, x, normal) + _too_fast(rules.speed * problem.h, STEEP / problem.h, x, normal)
    return _State(float(wrong.sum() + cost), normal, wrong)


@numba.njit(cache=True)
def _frames(problem: Problem, x: Array, normal: Normal, wrong: Array) -> None:
    """Gather what is wrong in each frame."""
    tree, aims, capsules, rules = problem.tree, problem.aims, problem.capsules, problem.rules
    frames, unknowns = x.shape
    posed = unposed(len(tree.parents), unknowns)
    room = roomy(unknowns, len(capsules.joints), len(capsules.pairs))
    root = np.sqrt(problem.h)
    for f in range(frames):
        at, scale = f * unknowns, root * aims.importance[f]
        pose(tree, x[f], aims.place[f], aims.turn[f], posed)
        wrong[f] = vectors(tree, posed, aims, f, scale, room, normal, at)
        wrong[f] += turns(tree, posed, aims, f, scale, room, normal, at)
        weights = problem.push[f] * (rules.apart * root)
        wrong[f] += touches(tree, posed, capsules, weights, room, normal, at)


@numba.njit(cache=True)
def _smooth(rules: Rules, h: float, x: Array, normal: Normal) -> float:
    """Gather the terms of rest, speed and acceleration; their cost."""
    frames, unknowns = x.shape
    cost = 0.0
    for c in range(unknowns):
        ease, drag, bend = h * rules.ease[c] ** 2, rules.drag[c] ** 2 / h, rules.bend[c] ** 4 / h**3
        for f in range(frames):
            at = f * unknowns + c
            cost += _difference(normal, at, unknowns, (1.0, 0.0, 0.0), ease, x[f, c] - rules.rest[c])
            if f + 1 < frames:
                cost += _difference(normal, at, unknowns, (-1.0, 1.0, 0.0), drag, x[f + 1, c] - x[f, c])
            if f + 2 < frames:
                curve = x[f, c] - 2 * x[f + 1, c] + x[f + 2, c]
                cost += _difference(normal, at, unknowns, (1.0, -2.0, 1.0), bend, curve)
    return cost


@numba.njit(cache=True)
def _too_fast(most: Array, stiff: float, x: Array, normal: Normal) -> float:
    """Gather the price of steps beyond ``most`` (N,); their cost."""
    frames, unknowns = x.shape
    cost = 0.0
    for f in range(frames - 1):
        for c in range(unknowns):
            step = x[f + 1, c] - x[f, c]
            over = abs(step) - most[c]
            if over > 0:
                over = over if step > 0 else -over
                cost += _difference(normal, f * unknowns + c, unknowns, (-1.0, 1.0, 0.0), stiff, over)
    return cost


@numba.njit(cache=True)
def _difference(
    normal: Normal, at: int, unknowns: int, parts: tuple[float, float, float], weight: float, value: float
) -> float:
    """Gather ``weight value²`` of a value that is these parts of one unknown in three frames in a row; its cost."""
    for i in range(3):
        if parts[i] != 0.0:
            normal.slope[at + i * unknowns] += weight * parts[i] * value
            for j in range(i, 3):
                if parts[j] != 0.0:
                    normal.band[at + i * unknowns, (j - i) * unknowns] += weight * parts[i] * parts[j]
    return weight * value * value
