"""Hips, spine, chest, neck and head: where the limbs meet, and what the names of the joints between say.

Legs meet at the hips and arms at the chest, whatever these joints are called. The others are looked for by name, but
only where they can be: the neck below the chest, the head below the neck, the spine between hips and chest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from onbeat.motion.role_names import Candidate, Part
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.tree import Tree

_SIDES = ("left", "right")


@dataclass
class Trunk:
    """The search for the roles of the trunk on one skeleton.

    Parameters
    ----------
    skeleton, tree : whose joints they are.
    parts : what their names say.
    candidates : for each role the joints that may play it by their names.
    joints : of roles that are known, those of the limbs and what is told; :meth:`find` adds to them.
    """

    skeleton: Skeleton
    tree: Tree
    parts: Sequence[Part | None]
    candidates: Mapping[str, Sequence[Candidate]]
    joints: dict[str, int]

    def find(self) -> dict[str, int]:
        """All roles that are known then; each is looked for among what the ones before leave."""
        arms = self._meeting("shoulder")
        self._take("hips", self._hips(self._meeting("hip")))
        self._take("chest", self._chest(arms))
        top = self.joints.get("chest", self.joints.get("hips", 0))
        self._take("neck", self._named("neck", lambda j: self.tree.above(top, j) and not self._bears_limb(j)))
        if arms is not None and self.tree.above(top, arms) and self.says(arms, "neck"):
            self._take("neck", arms)
        self._take("head", self._head(top))
        self._take("neck", self._neck_below(top))
        self._take("spine", self._spine())
        return self.joints

    def says(self, joint: int, role: str) -> bool:
        """Whether a joint's name may mean a role."""
        return any(c.joint == joint for c in self.candidates.get(role, ()))

    def _take(self, role: str, joint: int | None) -> None:
        if joint is not None and role not in self.joints and joint not in self.joints.values():
            self.joints[role] = joint

    def _named(self, role: str, fits: Callable[[int], bool]) -> int | None:
        """The likeliest joint by its name that fits and plays no other role."""
        free = (c.joint for c in self.candidates.get(role, ()) if c.joint not in self.joints.values())
        return next((joint for joint in free if fits(joint)), None)

    def _meeting(self, limb: str) -> int | None:
        """Where the left and the right limb meet."""
        left, right = (self.joints.get(f"{side}_{limb}") for side in _SIDES)
        return None if left is None or right is None else self.tree.fork(left, right)

    def _bears_limb(self, joint: int) -> bool:
        """Whether a limb hangs on a joint or below, or it is one."""
        roles = [f"{side}_{limb}" for side in _SIDES for limb in ("shoulder", "hip")]
        ends = [self.joints[role] for role in roles if role in self.joints]
        return any(joint == end or self.tree.above(joint, end) for end in ends)

    def _hips(self, legs: int | None) -> int:
        """Where the legs meet; the pelvis above where they hang on what is called a spine, as Biped's may."""
        if legs is None:
            named = self._named("hips", lambda j: True)
            return 0 if named is None else named
        pelvis = self._named("hips", lambda j: j != 0 and self.tree.above(j, legs))
        spine = self.says(legs, "spine") and not self.says(legs, "hips")
        return pelvis if pelvis is not None and spine else legs

    def _chest(self, arms: int | None) -> int | None:
        """Where the arms meet; by name where that is at the hips, the neck or the root, else the joint above a neck."""
        hips = self.joints.get("hips", 0)
        if arms is not None and arms not in (0, hips) and not self.says(arms, "neck"):
            return arms
        bears = [self.joints[f"{side}_shoulder"] for side in _SIDES if f"{side}_shoulder" in self.joints]
        named = self._named("chest", lambda j: j != hips and all(self.tree.above(j, arm) for arm in bears))
        if named is None and arms not in (None, 0, hips) and self.tree.parents[arms] not in (0, hips):
            return self.tree.parents[arms]
        return named if named is not None else self._named("chest", lambda j: not self.tree.above(j, hips))

    def _head(self, top: int) -> int | None:
        """By name, else the end of the only line of joints that goes up from the chest.

        It is at least half as far from the chest as a shoulder: robots have shapes of heads that hang on the waist.
        """
        arm = self.joints.get("left_shoulder", top)
        far = 0.5 * self.tree.length(top, arm) if self.tree.above(top, arm) else 0.0
        named = self._named("head", lambda j: self.tree.above(top, j) and self.tree.length(top, j) >= far)
        if named is not None or "chest" not in self.joints:
            return named
        line = [self.joints.get("neck", top)]
        while len(bare := [j for j in self.tree.children[line[-1]] if self._is_bare(j)]) == 1:
            line += bare
        line += self._tip(line[0]) if len(line) == 1 else []
        return line[-1] if len(line) > 1 and self.tree.length(top, line[-1]) >= far > 0 else None

    def _tip(self, joint: int) -> list[int]:
        """The only end of a bone on a joint that has no side: all that files without names leave of a head."""
        ends = [j for j in self.tree.children[joint] if self.skeleton.end_sites[j]]
        free = [j for j in ends if (part := self.parts[j]) is None or not part.side]
        return free if len(free) == 1 else []

    def _is_bare(self, joint: int) -> bool:
        """Whether a joint may be of the neck or the head: it turns, has no side, and no limb hangs on it."""
        part = self.parts[joint]
        return not (self.skeleton.end_sites[joint] or part is None or part.side or self._bears_limb(joint))

    def _neck_below(self, top: int) -> int | None:
        """The first joint on the way from the chest to the head that bears no arm."""
        head = self.joints.get("head")
        way = self.tree.between(top, head) if head is not None and self.tree.above(top, head) else []
        return next((j for j in way if not self._bears_limb(j)), None)

    def _spine(self) -> int | None:
        """By name between hips and chest, else the lowest joint there."""
        if "chest" not in self.joints or "hips" not in self.joints:
            return self._named("spine", lambda j: True)
        hips, chest = self.joints["hips"], self.joints["chest"]
        way = self.tree.between(self.tree.fork(hips, chest), chest)
        named = self._named("spine", lambda j: j in way)
        return named if named is not None else next((j for j in way if j not in self.joints.values()), None)
