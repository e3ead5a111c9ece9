"""Who is above whom in a skeleton, without walking its chains again and again."""

from __future__ import annotations

from dataclasses import dataclass

from onbeat.motion.skeleton import Skeleton


def ancestors(skeleton: Skeleton, joint: int) -> list[int]:
    """The joint, its parent and so on up to the root."""
    line = [joint]
    while skeleton.parents[line[-1]] >= 0:
        line.append(int(skeleton.parents[line[-1]]))
    return line


def chain_length(skeleton: Skeleton, top: int, bottom: int) -> float:
    """Metres along the bones from ``top`` down to its descendant ``bottom``."""
    length, joint = 0.0, bottom
    while joint not in (top, -1):
        length += float(skeleton.bone_lengths[joint])
        joint = int(skeleton.parents[joint])
    return length


@dataclass(frozen=True)
class Tree:
    """A skeleton's joints numbered depth first, so that all below a joint is one stretch of numbers.

    Parameters
    ----------
    parents : of each joint, -1 for the root.
    children : of each joint.
    bones : length of each joint's bone from its parent.
    depths : length along the bones from the root.
    first, end : each joint's number and the one after the last below it.

    Examples
    --------
    >>> tree = Tree.of(Skeleton("abcd", [-1, 0, 1, 0], [[0, 0, 0], [0, 0, 1], [0, 0, 1], [1, 0, 0]]))
    >>> tree.above(1, 2), tree.above(1, 3), tree.fork(2, 3), tree.between(0, 2), tree.depths
    (True, False, 0, [1], [0.0, 1.0, 2.0, 1.0])
    """

    parents: list[int]
    children: list[list[int]]
    bones: list[float]
    depths: list[float]
    first: list[int]
    end: list[int]

    @classmethod
    def of(cls, skeleton: Skeleton) -> Tree:
        """Number the joints; parents come before their children."""
        parents: list[int] = skeleton.parents.tolist()
        bones: list[float] = skeleton.bone_lengths.tolist()
        count = len(parents)
        children: list[list[int]] = [[] for _ in parents]
        sizes, depths, first = [1] * count, [0.0] * count, [0] * count
        for joint in range(count - 1, 0, -1):
            sizes[parents[joint]] += sizes[joint]
        free = [1] * count
        for joint in range(1, count):
            parent = parents[joint]
            children[parent].append(joint)
            depths[joint] = depths[parent] + bones[joint]
            first[joint] = free[parent]
            free[parent] += sizes[joint]
            free[joint] = first[joint] + 1
        return cls(parents, children, bones, depths, first, [a + b for a, b in zip(first, sizes, strict=True)])

    def above(self, top: int, bottom: int) -> bool:
        """Whether ``bottom`` is below ``top`` and not the same joint."""
        return top != bottom and self.first[top] <= self.first[bottom] < self.end[top]

    def fork(self, a: int, b: int) -> int:
        """The lowest joint that is above both or one of them."""
        while not (a == b or self.above(a, b)):
            a = self.parents[a]
        return a

    def between(self, top: int, bottom: int) -> list[int]:
        """The joints on the way down from ``top`` to ``bottom``, without these two."""
        way: list[int] = []
        joint = self.parents[bottom]
        while joint not in (top, -1):
            way.append(joint)
            joint = self.parents[joint]
        return way[::-1]

    def length(self, top: int, bottom: int) -> float:
        """Length along the bones from ``top`` down to ``bottom``."""
        return self.depths[bottom] - self.depths[top]

    def tip(self, joint: int) -> int | None:
        """The joint at the other end of the longest bone that hangs on a joint; None where there is no bone.

        Bones that hang on a joint at the same place, as twins do, are looked at too.
        """
        longest, length, here = None, 1e-3, [joint]
        while here:
            for child in self.children[here.pop()]:
                if self.bones[child] > length:
                    longest, length = child, self.bones[child]
                if self.length(joint, child) < 1e-3:
                    here.append(child)
        return longest
