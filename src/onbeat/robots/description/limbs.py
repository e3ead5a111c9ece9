"""Arms, legs and trunk of a robot by its structure: what its joints are called is not asked.

In the zero configuration a humanoid stands: its legs are the ways down to its feet, and its arms the longest pair of
other limbs that are each other's mirror image. Along a limb the knee or the elbow is the hinge that bends it where it
is long on both sides; a hinge that turns about the bone above or below it bends nothing. The hinges above it are hip
or shoulder (of three or more the middle one, of two the first, as :func:`onbeat.motion.role_names.named` has it), those
below it ankle or wrist. The chest is the hinge on which both arms hang; a robot without a waist has none.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from onbeat._shapes import Positions
from onbeat.motion.hinges import HingeBody
from onbeat.motion.tree import Tree

_MIRROR = np.array([1.0, -1.0, 1.0])
_OFF, _ALIKE = 0.15, 0.12
"""By which part of its length a limb may begin off its mirror image's place, and its bones differ."""
_RIVAL = 0.7
"""Another pair of limbs this part as long as the arms might as well be the arms."""
_TWIST = 0.7
"""Cosine between a hinge's axis and a bone from which on it turns the bone about itself."""
_SHORT, _NEAR = 0.15, 0.25
"""Parts of a limb, and of a bone: what is shorter is none, and which hinges are still at the bone's end."""
_RUN = 3
_RUNS = ("hip", "shoulder", "wrist")
"""Of the hinges at these the middle one plays the role; knees, elbows and ankles begin with theirs."""
_PLACE = 0.02
"""Metres within which two hinges are at one place."""


@dataclass(frozen=True)
class Limbs:
    """What a robot's structure says of its joints; joints are numbers in its skeleton.

    Parameters
    ----------
    roles : the joint of each role that is found.
    same : joints that a name may say instead, as the structure holds them to be at the same place of the body.
    rigid : whether the arms hang on the pelvis, without a waist: nothing plays the chest then.
    unclear : why not all is found.
    """

    roles: Mapping[str, int] = field(default_factory=dict[str, int])
    same: Mapping[str, frozenset[int]] = field(default_factory=dict[str, frozenset[int]])
    rigid: bool = False
    unclear: str = ""

    def agree(self, joints: Mapping[str, int]) -> bool:
        """Whether the joints that names give to these roles are at the places of the body where they should be."""
        return all(joints.get(role) in able for role, able in self.same.items()) and not self.rigid


def limbs_of(body: HingeBody, feet: Mapping[str, int]) -> Limbs:
    """The limbs of a humanoid in its zero configuration.

    Parameters
    ----------
    body : its hinges.
    feet : the joints that move its "left" and "right" foot.

    Examples
    --------
    >>> from onbeat.motion.unitree_g1 import G1
    >>> names = G1.skeleton.names
    >>> feet = {side: names.index(f"{side}_ankle_roll_joint") for side in ("left", "right")}
    >>> found = limbs_of(G1, feet)
    >>> [names[found.roles[role]] for role in ("left_knee", "right_elbow", "chest")]
    ['left_knee_joint', 'right_elbow_joint', 'waist_pitch_joint']
    """
    return _Structure(body).limbs(feet)


class _Structure:
    """The tree of a robot's hinges where they are in the zero configuration."""

    def __init__(self, body: HingeBody) -> None:
        self.tree, self.places = Tree.of(body.skeleton), body.skeleton.rest_positions
        self.axes = dict(zip(body.joints.tolist(), body.axes, strict=True))
        self.children = [[c for c in below if c in self.axes] for below in self.tree.children]
        self.reach = [0.0] * len(self.places)
        for joint in range(len(self.places) - 1, 0, -1):
            above = self.tree.parents[joint]
            self.reach[above] = max(self.reach[above], self.tree.bones[joint] + self.reach[joint])

    def limbs(self, feet: Mapping[str, int]) -> Limbs:
        """What is found: the legs, and where the arms are clear those and the trunk."""
        left, right = feet["left"], feet["right"]
        if left == right or self.tree.above(left, right) or self.tree.above(right, left):
            return Limbs(unclear="both its feet are on one leg")
        hips = self.tree.fork(left, right)
        legs = {side: [*self.tree.between(hips, foot), foot] for side, foot in feet.items()}
        found = self._with(Limbs({"hips": hips}, {"hips": frozenset((hips,))}), "leg", ("hip", "knee", "ankle"), legs)
        pairs = self._pairs([*legs["left"], *legs["right"]])
        reaches = [self.reach[pair[0]] + self.tree.bones[pair[0]] for pair in pairs]
        if not pairs:
            why = "no two limbs of three hinges or more, besides its legs, mirror each other"
            return replace(found, unclear=found.unclear or why)
        if len(pairs) > 1 and reaches[1] > _RIVAL * reaches[0]:
            return replace(found, unclear=found.unclear or "more than one pair of limbs may be its arms")
        tops = sorted(pairs[0], key=lambda joint: self.places[joint, 1], reverse=self._is_left(legs))
        arms = {side: self._line(top) for side, top in zip(("left", "right"), tops, strict=True)}
        found = self._with(found, "arm", ("shoulder", "elbow", "wrist"), arms)
        if found.unclear:
            return found
        roles, chest = dict(found.roles), self.tree.fork(*tops)
        for side, line in arms.items():
            tip = self._tip(line[-1])
            roles |= {f"{side}_hand": tip} if tip is not None and tip != roles[f"{side}_wrist"] else {}
        roles |= self._around(hips, chest, tops, legs)
        if chest == hips:
            return Limbs(roles, found.same, rigid=True)
        return Limbs(roles | {"chest": chest}, {**found.same, "chest": frozenset((chest,))})

    def _with(self, found: Limbs, name: str, parts: Sequence[str], lines: Mapping[str, list[int]]) -> Limbs:
        """What is found and the roles of two limbs more, or why they have none."""
        roles, same = dict(found.roles), dict(found.same)
        for side, line in lines.items():
            limb = self._limb(line)
            if limb is None or (name == "leg" and limb[2][0] not in self.axes):  # an ankle is a hinge
                return replace(
                    found, unclear=found.unclear or f"no hinge of its {side} {name} bends it as a {parts[1]}"
                )
            for part, able in zip(parts, limb, strict=True):
                roles[f"{side}_{part}"] = able[(len(able) - 1) // 2 if part in _RUNS else 0]
                same[f"{side}_{part}"] = frozenset(able)
        return Limbs(roles, same, unclear=found.unclear)

    def _is_left(self, legs: Mapping[str, Sequence[int]]) -> bool:
        """Whether the left foot is on the side of +Y, as robots' models have it."""
        return bool(self.places[legs["left"][-1], 1] > self.places[legs["right"][-1], 1])

    def _pairs(self, legs: Sequence[int]) -> list[tuple[int, int]]:
        """The first joints of limbs that mirror each other and bear no foot, the longest first."""
        found = list[tuple[int, int]]()
        for above, below in enumerate(self.children):
            if above in legs:
                continue
            free = [child for child in below if child not in legs and not any(self.tree.above(child, j) for j in legs)]
            found += [pair for pair in itertools.combinations(free, 2) if self._mirrored(*pair)]
        return sorted(found, key=lambda pair: -self.reach[pair[0]] - self.tree.bones[pair[0]])

    def _mirrored(self, a: int, b: int) -> bool:
        one, other = self._line(a), self._line(b)
        count = min(len(one), len(other))
        if count < _RUN or abs(len(one) - len(other)) > 1:
            return False
        long = max(self.reach[a], self.reach[b], 1e-9)
        off = float(np.linalg.norm(self.places[a] - self.places[b] * _MIRROR))
        bones = [np.array([self.tree.bones[joint] for joint in line[1:count]]) for line in (one, other)]
        alike = bool((np.abs(bones[0] - bones[1]) <= _ALIKE * long).all())
        return alike and off < _OFF * long and abs(self.places[a, 1] - self.places[b, 1]) > 1e-3

    def _line(self, top: int) -> list[int]:
        """The hinges of a limb from its first one down to where it forks into fingers."""
        line = [top]
        while below := sorted(self.children[line[-1]], key=lambda c: -self.reach[c] - self.tree.bones[c]):
            lengths = [self.reach[c] + self.tree.bones[c] for c in below]
            if len(below) > 1 and lengths[1] > lengths[0] / 2:
                break
            line.append(below[0])
        return line

    def _limb(self, line: list[int]) -> tuple[list[int], list[int], list[int]] | None:
        """The hinges at a limb's upper end, at its knee or elbow, and at its lower end; None where nothing bends it."""
        along = [0.0, *np.cumsum([self.tree.bones[joint] for joint in line[1:]]).tolist()]
        whole = along[-1] + self.reach[line[-1]]
        ends = [along[-1], whole]
        for end in ends:  # where the last hinge is the elbow the limb's end is beyond it
            scores = [min(at, end - at) if n and self._bends(line, n) else 0.0 for n, at in enumerate(along)]
            bend = int(np.argmax(scores))
            if scores[bend] > _SHORT * whole:
                break
        else:
            return None
        upper = [n for n in range(bend) if along[bend] - along[n] > _NEAR * along[bend]][-_RUN:]
        beyond = end - along[bend]
        lower = [n for n in range(bend + 1, len(line)) if along[n] - along[bend] > _NEAR * beyond][:_RUN]
        here = [n for n in range(len(line)) if n == bend or (n < bend and along[bend] - along[n] < _PLACE)]
        tip = self._tip(line[-1])
        low = [line[n] for n in lower] or ([tip] if tip is not None else [])
        middle = [line[bend], *(line[n] for n in here if n != bend)]
        return ([line[n] for n in upper], middle, low) if upper and low else None

    def _tip(self, joint: int) -> int | None:
        """The farthest end of the link that a hinge moves."""
        ends = [c for c in self.tree.children[joint] if c not in self.axes]
        return max(ends, key=lambda c: self.tree.bones[c], default=None)

    def _bends(self, line: Sequence[int], n: int) -> bool:
        """Whether a hinge of a limb bends it, and does not turn the bone above or below about itself."""
        axis = self.axes[line[n]]
        return all(abs(axis @ bone) < _TWIST for bone in (self._bone(line, n, -1), self._bone(line, n, 1)))

    def _bone(self, line: Sequence[int], n: int, way: int) -> Positions:
        """The direction (3,) from a hinge to the next one up or down the limb that is at another place."""
        tip = self._tip(line[-1])
        joints = [*line, tip] if tip is not None else [*line]
        for other in joints[n + way :: way] if n + way >= 0 else []:
            bone = self.places[other] - self.places[line[n]]
            if (length := float(np.linalg.norm(bone))) > _PLACE:
                return bone / length
        return np.zeros(3)

    def _around(self, hips: int, chest: int, arms: Sequence[int], legs: Mapping[str, Sequence[int]]) -> dict[str, int]:
        """Spine, neck and head, where there are hinges for them."""
        between = self.tree.between(hips, chest)
        found = {"spine": between[0]} if between else dict[str, int]()
        limbs = {*arms, *(leg[0] for leg in legs.values())}
        shoulders = float(self.places[list(arms), 2].mean())
        up = [
            child
            for child in self.children[chest]
            if child not in limbs and self.places[child, 2] > shoulders - _OFF * self.reach[arms[0]]
        ]
        if len(up) == 1 and abs(self.places[up[0], 1]) < _OFF * self.reach[arms[0]]:
            line = self._line(up[0])
            found |= {"neck": line[0], "head": line[-1]} if len(line) > 1 else {"head": line[0]}
        return found
