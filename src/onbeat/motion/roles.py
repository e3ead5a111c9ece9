"""Which joint plays which role: what is told, what names say, what the tree says, and at last a guess.

1. What is told (``Skeleton.roles``) holds.
2. Names: the limbs are the chains that fit best (:mod:`onbeat.motion.limbs`); joints that only twist or control others
   are never taken.
3. The tree: legs fork at the hips, arms at the chest; the neck is between chest and head; where two joints of a limb
   are known, so is the third; hand and toe are at the end of the bone that hangs on wrist and ankle.
4. Where an arm or a leg is still not found, a guess from the rest pose (:mod:`onbeat.motion.role_guess`).
"""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from onbeat.motion.limbs import LIMBS, best_chain, completed, core_roles, limb_roles
from onbeat.motion.role_guess import guessed_limbs
from onbeat.motion.role_names import NEEDED, ROLES, Candidate, Part, named, parts_of, usual_names
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree
from onbeat.motion.trunk import Trunk

How = Literal["told", "name", "tree", "guess"]
"""How a role was found."""
_SIDES = ("left", "right")


class RoleFound(NamedTuple):
    """A role, its joint and how that was found; of a role that was not found, what comes near.

    Parameters
    ----------
    role : one of ``ROLES``.
    joint : its name, None where none was found.
    how : "told", "name", "tree" or "guess"; None where none was found.
    needed : whether no body can dance without it.
    near : names of joints that might play a role that was not found, the likeliest first.
    """

    role: str
    joint: str | None
    how: How | None
    needed: bool
    near: tuple[str, ...] = ()


class Found(NamedTuple):
    """The joint of each role that was found, in the order of the roles, and how."""

    joints: Mapping[str, int]
    how: Mapping[str, How]


def find_roles(skeleton: Skeleton) -> Found:
    """The roles of a skeleton's joints; those that nobody plays are left out.

    Skeletons that are the same in every bit share the answer.

    Examples
    --------
    >>> arm = Skeleton(("UpperArm_L", "Ellbogen", "Hand_L"), [-1, 0, 1], [[0, 0, 0], [0.3, 0, 0], [0.3, 0, 0]])
    >>> dict(find_roles(arm).how)
    {'left_shoulder': 'name', 'left_elbow': 'tree', 'left_wrist': 'name'}
    """
    s = skeleton
    told = tuple(s.roles.items())
    return _found(s.names, s.parents.tobytes(), s.offsets.tobytes(), s.end_sites.tobytes(), told)


@lru_cache(maxsize=64)
def _found(
    names: tuple[str, ...], parents: bytes, offsets: bytes, end_sites: bytes, told: tuple[tuple[str, str], ...]
) -> Found:
    skeleton = Skeleton(
        names,
        np.frombuffer(parents, np.int64),
        np.frombuffer(offsets, np.float64).reshape(-1, 3),
        np.frombuffer(end_sites, np.bool_),
        roles=dict(told),
    )
    tree, parts = Tree.of(skeleton), parts_of(names)
    known = {role: names.index(name) for role, name in told}
    candidates = {role: [c for c in able if c.joint not in known.values()] for role, able in named(parts).items()}
    how: dict[str, How] = dict.fromkeys(known, "told")
    _limbs(tree, parts, candidates, known, how)
    guessed = _guess(skeleton, tree, parts, known, how)
    _tips(tree, known, how)
    trunk = Trunk(skeleton, tree, parts, candidates, known)
    for role, joint in trunk.find().items():
        how.setdefault(role, "name" if trunk.says(joint, role) else "guess" if guessed else "tree")
    kept = {role: known[role] for role in ROLES if role in known}
    return Found(MappingProxyType(kept), MappingProxyType({role: how[role] for role in kept}))


def _take(found: Mapping[str, int], way: How, known: dict[str, int], how: dict[str, How]) -> None:
    """Keep what is new of what was found in a way."""
    for role, joint in found.items():
        if role not in known:
            known[role], how[role] = joint, way


def _limbs(
    tree: Tree,
    parts: Sequence[Part | None],
    candidates: Mapping[str, Sequence[Candidate]],
    known: dict[str, int],
    how: dict[str, How],
) -> None:
    """Arms and legs by names, and what the tree tells of those of which two joints are known."""
    told, limbs = dict(known), list(itertools.product(LIMBS, _SIDES))
    for limb, side in limbs:
        _take(best_chain(tree, limb_roles(limb, side), candidates, told), "name", known, how)
    for limb, side in limbs:
        _take(completed(tree, limb, side, known, parts), "tree", known, how)


def _guess(
    skeleton: Skeleton, tree: Tree, parts: Sequence[Part | None], known: dict[str, int], how: dict[str, How]
) -> bool:
    """Fill limbs of which something needed is missing, where the guess agrees with what is known; whether it did."""
    limbs = [limb for limb in LIMBS if any(role not in known for side in _SIDES for role in core_roles(limb, side))]
    found = guessed_limbs(skeleton, tree, parts) if limbs else {}
    guessed = False
    for limb in limbs if found else []:
        roles = [role for side in _SIDES for role in limb_roles(limb, side)]
        new = {role: found[role] for role in roles if role in found and role not in known}
        agrees = all(known[role] == found.get(role) for role in roles if role in known)
        if agrees and not set(new.values()) & set(known.values()):
            _take(new, "guess", known, how)
            guessed = True
    return guessed


def _tips(tree: Tree, known: dict[str, int], how: dict[str, How]) -> None:
    """Hands and toes that no name tells: the ends of the bones that hang on wrists and ankles."""
    for side in _SIDES:
        for role, above in ((f"{side}_hand", f"{side}_wrist"), (f"{side}_toe", f"{side}_ankle")):
            tip = tree.tip(known[above]) if above in known and role not in known else None
            _take({} if tip is None or tip in known.values() else {role: tip}, "tree", known, how)


def role_report(skeleton: Skeleton) -> list[RoleFound]:
    """Every role with its joint and how it was found, in the order of ``ROLES``.

    Examples
    --------
    >>> arm = Skeleton(("UpperArm_L", "Ellbogen", "Hnd_L"), [-1, 0, 1], [[0, 0, 0], [0.3, 0, 0], [0.3, 0, 0]])
    >>> next(found for found in role_report(arm) if found.role == "left_wrist")
    RoleFound(role='left_wrist', joint=None, how=None, needed=True, near=('Hnd_L',))
    """
    joints, how = find_roles(skeleton)
    near = nearest(skeleton, [role for role in ROLES if role not in joints])
    return [
        RoleFound(
            role,
            skeleton.names[joints[role]] if role in joints else None,
            how.get(role),
            role in NEEDED,
            near.get(role, ()),
        )
        for role in ROLES
    ]


def nearest(skeleton: Skeleton, roles: Sequence[str], most: int = 120) -> dict[str, tuple[str, ...]]:
    """For each of some roles up to three joints of no role whose names come near to the usual ones.

    Of very large skeletons only the first ``most`` joints are looked at.
    """
    taken = set(find_roles(skeleton).joints.values())
    free = [(skeleton.names[j], part) for j, part in enumerate(parts_of(skeleton.names[:most])) if j not in taken]
    found: dict[str, tuple[str, ...]] = {}
    for role in roles:
        side = role.split("_")[0] if "_" in role else ""
        words = {part.word[:40]: name for name, part in reversed(free) if part is not None and part.side == side}
        close = [word for usual in usual_names(role) for word in difflib.get_close_matches(usual, words, 2, 0.65)]
        found[role] = tuple(words[word] for word in list(dict.fromkeys(close))[:3])
    return found
