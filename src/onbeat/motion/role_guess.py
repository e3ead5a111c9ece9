"""Arms and legs of a skeleton whose names tell nothing: a guess from the rest pose.

A body has two pairs of long limbs. The two chains of a pair hang on one joint and their bones are of equal lengths. The
legs lie along each other, away from where the arms hang; their two longest bones in a row are thigh and shin, those of
an arm upper arm and forearm. The toes point to the front, and the left is ``up × front``: for no axis is it assumed
that it points up. Words for left and right in the names are believed before the toes; where there are such the rest
pose need not stand, as bones that lie along their local axes do not: then the arms are the pair farther from the root.
Where this does not hold nothing is guessed.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Positions
from onbeat.motion.limbs import limb_roles
from onbeat.motion.role_names import Part
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

_ALIKE = 0.12  # by which part the bones of two sides may differ
_LONG = 0.12  # what part of the way from root to farthest joint a limb has at least
_BENT = 0.02  # bones shorter than this part of a limb end where they begin


class Chain(NamedTuple):
    """A limb: the joints of its bones' ends from the trunk out, and its place among them of upper bone and tip."""

    joints: tuple[int, ...]
    top: int

    @property
    def core(self) -> tuple[int, int, int]:
        """Hip, knee and ankle, or shoulder, elbow and wrist."""
        a, b, c = self.joints[self.top : self.top + 3]
        return a, b, c

    @property
    def before(self) -> int | None:
        """The joint of the collar bone."""
        return self.joints[self.top - 1] if self.top else None

    @property
    def beyond(self) -> int | None:
        """The joint of the toes or the fingers."""
        return self.joints[self.top + 3] if len(self.joints) > self.top + 3 else None


Pair = tuple[Chain, Chain]


def guessed_limbs(skeleton: Skeleton, tree: Tree, parts: Sequence[Part | None]) -> dict[str, int]:
    """The roles of arms and legs; empty where the skeleton does not stand as a body does.

    Examples
    --------
    >>> up, side = [0.0, 0.0, 0.5], lambda x: [[x, 0, 0], [3 * x, 0, 0], [3 * x, 0, 0]]
    >>> leg = lambda x: [[x, 0, 0], [0, 0, -0.4], [0, 0, -0.4], [0, 0.15, 0]]
    >>> body = Skeleton([f"j{n}" for n in range(16)], [-1, 0, 1, 2, 3, 1, 5, 6, 0, 8, 9, 10, 0, 12, 13, 14],
    ...                 [[0, 0, 0], up, *side(-0.1), *side(0.1), *leg(-0.1), *leg(0.1)])
    >>> found = guessed_limbs(body, Tree.of(body), [None] * 16)
    >>> found["left_shoulder"], found["left_wrist"], found["right_knee"], found["right_toe"]
    (2, 4, 13, 15)
    """
    if not 1e-6 < max(tree.depths) < 1e12:
        return {}
    rest = skeleton.rest_positions
    pairs = _pairs(tree, rest)
    if not 2 <= len(pairs) <= 4:
        return {}
    for legs, arms in itertools.permutations(pairs, 2):
        down = _down(rest, legs, arms)
        if set(legs[0].joints) & set(arms[0].joints) or (down is None and not _below_the_trunk(tree, legs, arms)):
            continue
        sided = _by_names(legs, arms, parts) or (None if down is None else _by_toes(rest, legs, arms, down))
        if sided is not None:
            return _roles(*sided)
    return {}


def _pairs(tree: Tree, rest: Positions) -> list[Pair]:
    """Pairs of long chains alike that hang on one joint, from the root out."""
    reach, along = [0.0] * len(tree.parents), [-1] * len(tree.parents)
    for joint in range(len(tree.parents) - 1, 0, -1):
        parent = tree.parents[joint]
        if along[parent] < 0 or reach[joint] + tree.bones[joint] > reach[parent]:
            reach[parent], along[parent] = reach[joint] + tree.bones[joint], joint
    found: list[Pair] = []
    for children in tree.children:
        long = [child for child in children if reach[child] > _LONG * reach[0] > 0]
        if 2 <= len(long) <= 8:
            lines = [_line(tree, along, child, reach[child]) for child in long]
            pairs = [_pair(tree, rest, a, b) for a, b in itertools.combinations(lines, 2)]
            found += [pair for pair in pairs if pair is not None]
    return found


def _line(tree: Tree, along: Sequence[int], joint: int, reach: float) -> list[int]:
    """The joints from one on along the longest way down, of those at one place the first."""
    line = [joint]
    while (joint := along[joint]) >= 0:
        if tree.length(line[-1], joint) > _BENT * reach:
            line.append(joint)
    return line


def _pair(tree: Tree, rest: Positions, a: list[int], b: list[int]) -> Pair | None:
    """Two lines as the two sides of a body, if their bones are alike; each core is where two bones are longest.

    It begins where the sides are apart: collar bones often begin at one place.
    """
    shorter = min(len(a), len(b))
    bones = np.array([[tree.length(*two) for two in itertools.pairwise(line[:shorter])] for line in (a, b)])
    apart = np.linalg.norm(rest[a[:shorter]] - rest[b[:shorter]], axis=-1) > 0.05 * bones.sum() / 2
    first = int(np.argmax(apart))
    if not apart.any() or not 3 <= shorter - first <= 40:
        return None
    two = np.round((bones[:, first:-1] + bones[:, first + 1 :]).sum(0), 9)
    top = first + int(np.argmax(two))
    same = np.isclose(bones[0], bones[1], rtol=_ALIKE, atol=0.02 * bones.sum() / 2)
    return (Chain(tuple(a), top), Chain(tuple(b), top)) if same[: top + 2].all() else None


def _down(rest: Positions, legs: Pair, arms: Pair) -> Positions | None:
    """(3,) where the legs point to, if they lie along each other and away from the arms."""
    ways = [rest[leg.core[2]] - rest[leg.core[0]] for leg in legs]
    ways = [way / max(float(np.linalg.norm(way)), 1e-12) for way in ways]
    if ways[0] @ ways[1] < 0.7:
        return None
    down = (ways[0] + ways[1]) / np.linalg.norm(ways[0] + ways[1])
    trunk = np.mean([rest[arm.core[0]] for arm in arms], 0) - np.mean([rest[leg.core[0]] for leg in legs], 0)
    return down if trunk @ down < -0.7 * np.linalg.norm(trunk) else None


def _below_the_trunk(tree: Tree, legs: Pair, arms: Pair) -> bool:
    """Whether the arms hang on a joint below that of the legs, which bears a head as well."""
    low, high = (tree.fork(pair[0].core[0], pair[1].core[0]) for pair in (legs, arms))
    others = [c for c in tree.children[high] if not any(c == j or tree.above(c, j) for j in (a.core[0] for a in arms))]
    return tree.above(low, high) and bool(others)


def _by_names(legs: Pair, arms: Pair, parts: Sequence[Part | None]) -> tuple[Pair, Pair] | None:
    """Legs and arms, the left one of each first; None where no names tell."""
    marked = [_marked(pair, parts) for pair in (legs, arms)]
    return (_turned(legs, marked[0]), _turned(arms, marked[1])) if all(marked) else None


def _by_toes(rest: Positions, legs: Pair, arms: Pair, down: Positions) -> tuple[Pair, Pair] | None:
    """Legs and arms, the left one of each first; None where the feet do not tell."""
    front = np.zeros(3)
    for leg in legs:
        foot = rest[leg.beyond] - rest[leg.core[2]] if leg.beyond is not None else np.zeros(3)
        foot = foot - (foot @ down) * down
        if np.linalg.norm(foot) < 0.05 * np.linalg.norm(rest[leg.core[2]] - rest[leg.core[0]]) or foot @ front < 0:
            return None
        front = front + foot
    left = np.cross(-down, front / np.linalg.norm(front))
    across = [float((rest[pair[0].core[0]] - rest[pair[1].core[0]]) @ left) for pair in (legs, arms)]
    if min(abs(part) for part in across) < 1e-3 * np.linalg.norm(rest[legs[0].core[2]] - rest[legs[0].core[0]]):
        return None
    return _turned(legs, across[0]), _turned(arms, across[1])


def _turned(pair: Pair, side: float) -> Pair:
    """The pair as it is where ``side`` is positive, else the other way round."""
    return pair if side > 0 else (pair[1], pair[0])


def _marked(pair: Pair, parts: Sequence[Part | None]) -> int:
    """1 where the names call the first of a pair left and the second right, -1 the other way round, else 0."""
    sides = [{part.side for j in chain.joints if (part := parts[j]) is not None and part.side} for chain in pair]
    return (sides == [{"left"}, {"right"}]) - (sides == [{"right"}, {"left"}])


def _roles(legs: Pair, arms: Pair) -> dict[str, int]:
    roles: dict[str, int] = {}
    for n, side in enumerate(("left", "right")):
        arm, leg = arms[n], legs[n]
        found = ((arm.before, *arm.core, arm.beyond), (*leg.core, leg.beyond))
        for limb, joints in zip(("arm", "leg"), found, strict=True):
            named = zip(limb_roles(limb, side), joints, strict=True)
            roles |= {role: joint for role, joint in named if joint is not None}
    return roles
