"""What still touches after a dance is solved: such capsules are pushed harder until nothing does, or nothing helps."""

from __future__ import annotations

import numba
import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Bools
from onbeat.motion import rotations as rot
from onbeat.robots.ik.collision import place_ends, write_gaps
from onbeat.robots.ik.mend import LONGEST, stretches_of, tried_again
from onbeat.robots.ik.trajectory import Problem, solve
from onbeat.robots.ik.tree import pose, unposed

LEAST = 0.5
"""Part of their margin that capsules have to be apart in the end."""
ROUNDS, HARDER = 4, 3.0
"""How often what touches is pushed harder, and how much."""
WIDER = 0.008
"""Metres by which the margin of what touches grows each time."""
NEAR = 0.08
"""Seconds before and after, pushed too."""


def gaps(problem: Problem, x: Array) -> Array:
    """(F, K) metres between the capsules of each pair."""
    out = np.empty(problem.push.shape)
    _all_gaps(problem, x, out)
    return out


@numba.njit(cache=True)
def _all_gaps(problem: Problem, x: Array, out: Array) -> None:
    tree, aims, capsules = problem.tree, problem.aims, problem.capsules
    posed = unposed(len(tree.parents), x.shape[1])
    ends = np.empty((len(capsules.joints), 2, 3))
    for frame in range(len(x)):
        pose(tree, x[frame], aims.place[frame], aims.turn[frame], posed)
        place_ends(posed.turns, posed.places, capsules, ends)
        write_gaps(ends, capsules, out[frame])


def between(problem: Problem, x: Array) -> tuple[Problem, Array]:
    """The moments half-way between frames, where quick hands may meet that did not in the frames."""
    aims = problem.aims
    q = rot.from_matrix(aims.turn)
    turn = rot.to_matrix(rot.slerp(q[:-1], q[1:], 0.5))
    middle = aims._replace(place=(aims.place[1:] + aims.place[:-1]) / 2, turn=turn)
    return problem._replace(aims=middle, push=problem.push[1:]), (x[1:] + x[:-1]) / 2


def touching(problem: Problem, x: Array) -> Bools:
    """(F, K) true where capsules are too near, in a frame or half-way to the next or from the last."""
    least = LEAST * problem.capsules.margins
    found = gaps(problem, x) < least
    if len(x) > 1:
        half = gaps(*between(problem, x)) < least / 2
        found[1:] |= half
        found[:-1] |= half
    return found


def cleared(problem: Problem, x: Array) -> Array:
    """The unknowns (F, N) with what touches pushed apart, stretch by stretch; the rest of the dance stays."""
    push, x, capsules = problem.push, x.copy(), problem.capsules
    for round_ in range(ROUNDS):
        found = touching(problem, x)
        if not found.any():
            break
        push = np.where(maximum_filter1d(found, 2 * round(NEAR / problem.h) + 1, axis=0), HARDER * push, push)
        for stretch in stretches_of(np.any(found, axis=1), problem.h):
            wider = capsules.margins + WIDER * (round_ + 1) * np.any(found[stretch.part], axis=0)
            part = problem._replace(push=push, capsules=capsules._replace(margins=wider)).cut(stretch.part)
            way = x[stretch.part]
            another = round_ % 2 == 1 and len(way) * part.h < LONGEST
            x[stretch.part] = (tried_again(part, way, stretch) if another else solve(part, way, stretch.pinned)).x
    return x
