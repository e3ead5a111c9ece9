"""A skeleton: named joints in a tree, each at a fixed offset from its parent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Bools, Ints, frozen
from onbeat.errors import FormatError


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints; parents come before their children.

    In the rest pose all local rotations are the identity, so a joint's rest position is the sum of the offsets
    from the root down to it.

    Parameters
    ----------
    names : J joint names, no two alike.
    parents : (J,) index of each joint's parent, -1 for the root, which is joint 0.
    offsets : (J, 3) metres, each joint's position in its parent's frame, Z up; the root's is zero.
    end_sites : (J,) true where a joint is only the end of a bone: it has no rotation of its own.

    Raises
    ------
    FormatError
        If the tree is not a tree, a name occurs twice or an offset is not finite.

    Examples
    --------
    >>> arm = Skeleton(("shoulder", "elbow"), [-1, 0], [[0, 0, 0], [0.3, 0, 0]])
    >>> arm.index("elbow"), arm.bone_lengths.tolist()
    (1, [0.0, 0.3])
    """

    names: tuple[str, ...]
    parents: Ints
    offsets: Array
    end_sites: Bools = field(default_factory=lambda: np.zeros(0, bool))

    def __init__(
        self,
        names: Sequence[str],
        parents: Sequence[int] | Ints,
        offsets: object,
        end_sites: Sequence[bool] | Bools | None = None,
    ) -> None:
        set_ = object.__setattr__
        set_(self, "names", tuple(names))
        set_(self, "parents", frozen(parents, np.int64))
        set_(self, "offsets", frozen(offsets, np.float64))
        set_(self, "end_sites", frozen([False] * len(self.names) if end_sites is None else end_sites, np.bool_))
        self._check()

    def _check(self) -> None:
        count = len(self.names)
        if count == 0:
            raise FormatError("the skeleton has no joints; a root joint is needed")
        if self.parents.shape != (count,) or self.offsets.shape != (count, 3) or self.end_sites.shape != (count,):
            raise FormatError(
                f"a skeleton of {count} joints has parents of shape {self.parents.shape}, offsets of shape "
                f"{self.offsets.shape} and end sites of shape {self.end_sites.shape}; ({count},), ({count}, 3) and "
                f"({count},) are needed"
            )
        twice = {name for name in self.names if self.names.count(name) > 1}
        if twice:
            raise FormatError(f"joint names occur twice: {', '.join(sorted(twice))}; rename them")
        if self.parents[0] != -1 or np.any(self.parents[1:] < 0) or np.any(self.parents >= np.arange(count)):
            raise FormatError(
                "the joints are not one tree with parents before children; reorder them from the root down"
            )
        if not np.isfinite(self.offsets).all():
            joint = self.names[int(np.argmax(~np.isfinite(self.offsets).all(1)))]
            raise FormatError(f"the offset of joint {joint!r} is not a finite number")

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        """Two skeletons are equal when names, tree and end sites are and offsets agree to a micrometre."""
        return (
            isinstance(other, Skeleton)
            and self.names == other.names
            and np.array_equal(self.parents, other.parents)
            and np.array_equal(self.end_sites, other.end_sites)
            and np.allclose(self.offsets, other.offsets, rtol=0, atol=1e-6)
        )

    def __hash__(self) -> int:
        return hash((self.names, self.parents.tobytes()))

    def index(self, name: str) -> int:
        """Index of the joint called ``name``; a ``FormatError`` lists the names there are."""
        try:
            return self.names.index(name)
        except ValueError:
            raise FormatError(f"no joint {name!r}; the skeleton has {', '.join(self.names)}") from None

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """The children of each joint."""
        return tuple(tuple(np.flatnonzero(self.parents == j).tolist()) for j in range(len(self)))

    @cached_property
    def bone_lengths(self) -> Array:
        """(J,) metres, the length of each joint's offset."""
        return np.linalg.norm(self.offsets, axis=1)

    @cached_property
    def rest_positions(self) -> Array:
        """(J, 3) metres, joint positions with all rotations the identity and the root at the origin."""
        positions = np.zeros((len(self), 3))
        for joint in range(1, len(self)):
            positions[joint] = positions[self.parents[joint]] + self.offsets[joint]
        return positions
