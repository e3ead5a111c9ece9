"""Another try where a solution is caught on the wrong side: an arm behind the trunk, a shoulder turned the other way.

Least squares finds the nearest valley, not the deepest. Where a stretch of the dance is in trouble its worst moment is
solved anew from many poses spread over the hinges' limits, each on its own; the best are followed through the stretch,
frame by frame, as are the poses at its ends; the stretch is then solved from the path that goes between these ways at
the least cost, its ends held, and kept if it costs less.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.motion.contacts import runs
from onbeat.robots.ik.trajectory import Problem, Rules, Solution, solve
from onbeat.robots.ik.tree import ROOT

SEEDS, KEPT = 16, 5
"""Poses from which a moment is solved, and how many of the solutions are followed through the stretch."""
FOLLOWING = 6
"""Steps of a frame's solution from its neighbour's."""
TURNING = 0.02
"""Seconds: what turning a hinge by a radian costs on the way is this, squared, over the time it takes."""
TROUBLE = 0.1
"""What is wrong in a frame that is in trouble: one link by 18 degrees, or capsules 3 cm under their margin."""
AROUND = 0.4
"""Seconds before and after the trouble that are solved anew."""
LONGEST = 2.0
"""Seconds of trouble that are solved anew at most at once."""
UNLIKE = 0.5
"""Radians of some hinge by which two poses are unlike each other."""


class Stretch(NamedTuple):
    """A stretch in trouble.

    Parameters
    ----------
    part : frames of the dance, with some before and after.
    pinned : how many of the first and the last of them are held.
    first, last : of its frames, those in trouble.
    """

    part: slice
    pinned: tuple[int, int]
    first: int
    last: int


def stretches_of(trouble: Bools, h: float) -> list[Stretch]:
    """Stretches of frames, ``h`` seconds apart, that are in trouble; what is near to each other is one.

    Examples
    --------
    >>> trouble = np.zeros(300, bool)
    >>> trouble[[100, 110, 290]] = True
    >>> [(s.part.start, s.part.stop, s.pinned) for s in stretches_of(trouble, 1 / 60)]
    [(76, 135, (2, 2)), (266, 300, (2, 0))]
    """
    around, frames = max(round(AROUND / h), 1), len(trouble)
    ends = np.array(runs(trouble)).reshape(-1, 2)
    apart = np.flatnonzero(ends[1:, 0] - ends[:-1, 1] > around)
    firsts, lasts = np.append(ends[:1, 0], ends[apart + 1, 0]), np.append(ends[apart, 1], ends[-1:, 1])
    found: list[Stretch] = []
    for first, last in zip(firsts.tolist(), lasts.tolist(), strict=True):
        part = slice(max(first - around, 0), min(last + around, frames))
        pinned = 2 * (part.start > 0), 2 * (part.stop < frames)
        found.append(Stretch(part, pinned, first - part.start, last - part.start))
    return found


def mended(problem: Problem, found: Solution) -> Array:
    """(F, N) the unknowns with each stretch in trouble solved anew, where that costs less."""
    x = found.x.copy()
    for stretch in stretches_of(found.wrong > TROUBLE, problem.h):
        stretch = _worst_of(stretch, found.wrong, problem.h)
        x[stretch.part] = tried_again(problem.cut(stretch.part), x[stretch.part], stretch).x
    return x


def _worst_of(stretch: Stretch, wrong: Array, h: float) -> Stretch:
    """Of a long stretch what is around its worst frame; where all is wrong (a slow robot), trying more is in vain."""
    first, last = stretch.part.start + stretch.first, stretch.part.start + stretch.last
    if (last - first) * h <= LONGEST:
        return stretch
    trouble, worst, half = np.zeros(len(wrong), np.bool_), first + int(wrong[first:last].argmax()), LONGEST / 2 / h
    trouble[max(worst - round(half), first) : min(worst + round(half) + 1, last)] = True
    return stretches_of(trouble, h)[0]


def tried_again(problem: Problem, x: Array, stretch: Stretch) -> Solution:
    """The better solution of a stretch: from x (F, N) as it is, or from the best path along other ways through it."""
    best = solve(problem, x, stretch.pinned)
    worst = stretch.first + int(best.wrong[stretch.first : stretch.last].argmax())
    ways = [best]
    for frame, pose in ((0, x[0]), (len(x) - 1, x[-1]), *((worst, pose) for pose in _poses(problem, worst, x[worst]))):
        ways.append(_followed(problem, pose, frame, len(x)))
    path = _best_path(ways, problem)
    path[: stretch.pinned[0]] = x[: stretch.pinned[0]]
    path[len(x) - stretch.pinned[1] :] = x[len(x) - stretch.pinned[1] :]
    trial = solve(problem, path, stretch.pinned)
    return trial if trial.cost < best.cost else best


def _poses(problem: Problem, frame: int, now: Array) -> list[Array]:
    """The best poses (N,) for one frame, unlike each other."""
    moment, seeds = problem.cut(slice(frame, frame + 1)), spread(problem.rules)
    seeds[:, :ROOT] = now[:ROOT]
    found = sorted((solve(moment, seed[None]) for seed in seeds), key=lambda solution: solution.cost)
    kept: list[Array] = []
    for solution in found[: len(found) // 2]:
        if len(kept) < KEPT and all(np.abs(solution.x[0] - pose)[ROOT:].max() > UNLIKE for pose in kept):
            kept.append(solution.x[0])
    return kept


def _followed(problem: Problem, pose: Array, frame: int, frames: int) -> Solution:
    """A pose of one frame followed through all frames, forwards and back, each solved from its neighbour's."""
    x, wrong = np.tile(pose, (frames, 1)), np.zeros(frames)
    for f in [*range(frame, frames), *range(frame - 1, -1, -1)]:
        before = frame if f == frame else f - 1 if f > frame else f + 1
        one = solve(problem.cut(slice(f, f + 1)), x[before : before + 1], steps=FOLLOWING)
        x[f], wrong[f] = one.x[0], one.wrong[0]
    return Solution(x, float(wrong.sum()) * problem.h, wrong)


def _best_path(ways: list[Solution], problem: Problem) -> Array:
    """(F, N) the path that goes from way to way at the least cost (Viterbi): what is wrong, and how far hinges turn."""
    x = np.array([way.x for way in ways])
    wrong = np.array([way.wrong for way in ways]) * problem.h
    total, came = wrong[:, 0], np.zeros(wrong.shape, np.int64)
    for f in range(1, x.shape[1]):
        turned = x[:, None, f - 1, ROOT:] - x[None, :, f, ROOT:]
        over = np.maximum(np.abs(turned) / (problem.rules.speed[ROOT:] * problem.h) - 1, 0)
        costs = total[:, None] + np.sum(TURNING**2 / problem.h * turned**2 + over, axis=-1)
        came[:, f] = costs.argmin(axis=0)
        total = costs.min(axis=0) + wrong[:, f]
    way = int(total.argmin())
    path = np.empty(x.shape[1:])
    for f in range(len(path) - 1, -1, -1):
        path[f] = x[way, f]
        way = came[way, f]
    return path


def spread(rules: Rules, count: int = SEEDS) -> Array:
    """(count, N) poses spread evenly over the hinges' limits (Kronecker's sequence: multiples of roots of primes)."""
    low, high = rules.low[ROOT:], rules.high[ROOT:]
    numbers = range(2, 20 * len(low) + 20)
    primes = [p for p in numbers if all(p % d for d in range(2, int(p**0.5) + 1))][: len(low)]
    parts = np.arange(1, count + 1)[:, None] * np.sqrt(primes) % 1.0
    seeds = np.zeros((count, ROOT + len(low)))
    seeds[:, ROOT:] = low + (0.1 + 0.8 * parts) * (high - low)
    return seeds
