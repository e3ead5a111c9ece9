"""Arms and legs: joints whose names may fit are taken as the chain that fits best from the trunk out.

A name often stands for two roles: ``LeftLeg`` is a shin on one skeleton and a thigh on another, ``LeftShoulder`` a
collar bone or the shoulder. Of all ways to give a limb's roles to joints of which each is below the one before, the
one with the least doubt is taken: the sum of the names' doubts and of what is left out. The joints of one run (a
robot's pitch, roll and yaw of a shoulder) are one place of the body and never play two roles in a row.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from onbeat.motion.role_names import Candidate, Part
from onbeat.motion.tree import Tree

LIMBS: Mapping[str, tuple[str, ...]] = {
    "arm": ("collar", "shoulder", "elbow", "wrist", "hand"),
    "leg": ("hip", "knee", "ankle", "toe"),
}
_CORE: Mapping[str, tuple[str, str, str]] = {"arm": ("shoulder", "elbow", "wrist"), "leg": ("hip", "knee", "ankle")}
_MISSING = {"collar": 100.0, "hand": 100.0, "toe": 100.0}
_MISSING_CORE, _SAME_PLACE = 1000.0, 0.5


def limb_roles(limb: str, side: str) -> list[str]:
    """The roles of a limb from the trunk out.

    Examples
    --------
    >>> limb_roles("leg", "left")
    ['left_hip', 'left_knee', 'left_ankle', 'left_toe']
    """
    return [f"{side}_{role}" for role in LIMBS[limb]]


def core_roles(limb: str, side: str) -> tuple[str, str, str]:
    """The three roles of a limb without which a body cannot dance, from the trunk out."""
    top, middle, bottom = _CORE[limb]
    return f"{side}_{top}", f"{side}_{middle}", f"{side}_{bottom}"


def best_chain(
    tree: Tree, roles: Sequence[str], candidates: Mapping[str, Sequence[Candidate]], told: Mapping[str, int]
) -> dict[str, int]:
    """The joints that play a limb's roles by their names; roles that nobody can play are left out.

    Parameters
    ----------
    tree : of the skeleton.
    roles : of the limb, from the trunk out.
    candidates : for each role the joints that may play it.
    told : roles whose joints are known; the others are found around them.
    """
    # The best chain that ends at each joint, with its doubt and the joint's run; -1 stands for no joint so far.
    ends: dict[int, tuple[float, dict[str, int], int]] = {-1: (0.0, {}, -1)}
    for role in roles:
        missing = _MISSING.get(role.split("_")[-1], _MISSING_CORE)
        grown = (
            {} if role in told else {end: (doubt + missing, chain, run) for end, (doubt, chain, run) in ends.items()}
        )
        able = [Candidate(0.0, told[role])] if role in told else candidates.get(role, ())
        for new, joint, run in able:
            for end, (doubt, chain, above) in ends.items():
                forced = role in told and bool(chain) and list(chain)[-1] in told
                if not forced and end >= 0 and (not tree.above(end, joint) or above == run >= 0):
                    continue
                total = doubt + new + (_SAME_PLACE if _at_one_place(tree, end, joint) else 0.0)
                if joint not in grown or total < grown[joint][0]:
                    grown[joint] = total, {**chain, role: joint}, run
        ends = grown
    return min(ends.values(), key=lambda end: end[0])[1] if ends else {r: told[r] for r in roles if r in told}


def _at_one_place(tree: Tree, top: int, bottom: int) -> bool:
    """Whether two joints have no length between them on a skeleton that has lengths: a robot's axes of one joint."""
    return top >= 0 and tree.depths[bottom] > 0 and tree.depths[bottom] == tree.depths[top]


def completed(
    tree: Tree, limb: str, side: str, found: Mapping[str, int], parts: Sequence[Part | None]
) -> dict[str, int]:
    """What the tree tells of a limb of which two of three joints are known: the third, above, between or below them."""
    roles = core_roles(limb, side)
    missing = [role for role in roles if role not in found]
    if len(missing) != 1:
        return {}
    line = limb_roles(limb, side)
    place = line.index(missing[0])
    before = [found[role] for role in line[:place] if role in found]
    after = [found[role] for role in line[place:] if role in found]
    used = set(found.values())
    able = [j for j in _between(tree, before, after) if parts[j] is not None and j not in used]
    return {missing[0]: able[0]} if able else {}


def _between(tree: Tree, before: Sequence[int], after: Sequence[int]) -> list[int]:
    """The joints that may be next to the last of ``before`` and the first of ``after``, the likeliest first."""
    if before and after:
        top, bottom = before[-1], after[0]
        half = (tree.depths[top] + tree.depths[bottom]) / 2
        between = tree.between(top, bottom) if tree.above(top, bottom) else []
        return sorted(between, key=lambda joint: abs(tree.depths[joint] - half))
    if before:
        tip = tree.tip(before[-1])
        return [] if tip is None else [tip]
    above = tree.parents[after[0]]
    alone = above > 0 and len(tree.children[above]) == 1 and tree.bones[after[0]] > 0
    return [above] if alone else []
