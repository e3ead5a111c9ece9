"""A skeleton: named joints in a tree, each at a fixed offset from its parent."""

from __future__ import annotations

import difflib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from onbeat._shapes import Array, Bools, Ints, frozen
from onbeat.errors import FormatError
from onbeat.motion.role_names import ROLES


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
    roles : what is told of the joints, role to joint name, where names do not tell it (``Body.of`` takes these first).
        Usually none. It is said of a skeleton, not part of it: skeletons that differ in nothing else are equal.

    Raises
    ------
    FormatError
        If the tree is not a tree, a name occurs twice, an offset is not finite, or a role or its joint is not known.

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
    _roles: tuple[tuple[str, str], ...] = field(default=(), repr=False)

    def __init__(
        self,
        names: Sequence[str],
        parents: Sequence[int] | Ints,
        offsets: object,
        end_sites: Sequence[bool] | Bools | None = None,
        *,
        roles: Mapping[str, str] | None = None,
    ) -> None:
        set_ = object.__setattr__
        set_(self, "names", tuple(names))
        set_(self, "parents", frozen(parents, np.int64))
        set_(self, "offsets", frozen(offsets, np.float64))
        set_(self, "end_sites", frozen([False] * len(self.names) if end_sites is None else end_sites, np.bool_))
        self._check()
        told = dict(roles or {})
        self._check_roles(told)
        set_(self, "_roles", tuple((role, told[role]) for role in ROLES if role in told))

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
        twice = {name for name, times in Counter(self.names).items() if times > 1}
        if twice:
            raise FormatError(f"joint names occur twice: {', '.join(sorted(twice))}; rename them")
        if self.parents[0] != -1 or np.any(self.parents[1:] < 0) or np.any(self.parents >= np.arange(count)):
            raise FormatError(
                "the joints are not one tree with parents before children; reorder them from the root down"
            )
        if not np.isfinite(self.offsets).all():
            joint = self.names[int(np.argmax(~np.isfinite(self.offsets).all(1)))]
            raise FormatError(f"the offset of joint {joint!r} is not a finite number")

    def _check_roles(self, roles: Mapping[str, str]) -> None:
        for role, name in roles.items():
            if role not in ROLES:
                raise FormatError(f"no role {role!r}{_near(role, ROLES)}; there are {', '.join(ROLES)}")
            if name not in self.names:
                near = _near(name, self.names[:1000])
                raise FormatError(f"{role} is to be {name!r}, which is no joint{near}; {_listed(self.names)}")

    @property
    def roles(self) -> Mapping[str, str]:
        """What is told of the joints: role to joint name, in the order of the roles; empty where nothing is."""
        return MappingProxyType(dict(self._roles))

    def replace(
        self,
        *,
        names: Sequence[str] | None = None,
        parents: Sequence[int] | Ints | None = None,
        offsets: object = None,
        end_sites: Sequence[bool] | Bools | None = None,
        roles: Mapping[str, str] | None = None,
    ) -> Skeleton:
        """A copy with some fields changed.

        Roles that are told stay with their joints: where as many joints have new names they follow, where there are
        fewer or more those of joints that are no longer there are dropped.

        Examples
        --------
        >>> arm = Skeleton(("a", "b"), [-1, 0], [[0, 0, 0], [0.3, 0, 0]], roles={"left_elbow": "b"})
        >>> dict(arm.replace(names=("upper", "lower")).roles)
        {'left_elbow': 'lower'}
        """
        new = self.names if names is None else tuple(names)
        if roles is None:
            now = dict(zip(self.names, new, strict=True)) if len(new) == len(self) else {name: name for name in new}
            roles = {role: now[name] for role, name in self._roles if name in now}
        return Skeleton(
            new,
            self.parents if parents is None else parents,
            self.offsets if offsets is None else offsets,
            self.end_sites if end_sites is None else end_sites,
            roles=roles,
        )

    def with_roles(self, roles: Mapping[str, str]) -> Skeleton:
        """A copy of which these roles are told, besides those that are; a ``FormatError`` lists what there is."""
        return self.replace(roles={**self.roles, **roles}) if roles else self

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        """Two skeletons are equal when names, tree and end sites are and offsets agree to a micrometre.

        Roles that are told do not count.
        """
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
            raise FormatError(f"no joint {name!r}; {_listed(self.names)}") from None

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """The children of each joint."""
        return tuple(tuple(np.flatnonzero(self.parents == j).tolist()) for j in range(len(self)))

    @cached_property
    def bone_lengths(self) -> Array:
        """(J,) metres, the length of each joint's offset."""
        with np.errstate(over="ignore"):  # damaged files have offsets whose squares are beyond all numbers
            return np.linalg.norm(self.offsets, axis=1)

    @cached_property
    def rest_positions(self) -> Array:
        """(J, 3) metres, joint positions with all rotations the identity and the root at the origin."""
        positions = np.zeros((len(self), 3))
        for joint in range(1, len(self)):
            positions[joint] = positions[self.parents[joint]] + self.offsets[joint]
        return positions


def _near(name: str, known: Sequence[str]) -> str:
    close = difflib.get_close_matches(name[:100], known, n=3)
    return f" (is {' or '.join(repr(word) for word in close)} meant?)" if close else ""


def _listed(names: Sequence[str], most: int = 200) -> str:
    """The joints there are, for messages; of very many only the first."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"the skeleton has {', '.join(names[:most])}{more}"
