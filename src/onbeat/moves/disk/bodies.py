"""A skeleton as text, for the index of a library."""

from __future__ import annotations

import msgspec

from onbeat.errors import FormatError, LibraryError
from onbeat.motion.skeleton import Skeleton


class Body(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """A skeleton.

    Parameters
    ----------
    names, parents, offsets, end_sites : as of ``Skeleton``.
    roles : what is told of its joints, role to joint name; left out where nothing is.
    """

    names: list[str]
    parents: list[int]
    offsets: list[tuple[float, float, float]]
    end_sites: list[bool]
    roles: dict[str, str] = {}  # msgspec copies it

    @classmethod
    def of(cls, skeleton: Skeleton) -> Body:
        """Lists of a skeleton's arrays."""
        s, offsets = skeleton, [tuple(row) for row in skeleton.offsets.tolist()]
        return cls(list(s.names), s.parents.tolist(), offsets, s.end_sites.tolist(), dict(s.roles))

    def skeleton(self) -> Skeleton:
        """The skeleton, exact to the last bit."""
        return Skeleton(self.names, self.parents, self.offsets, self.end_sites, roles=self.roles)


def skeleton_text(skeleton: Skeleton) -> str:
    """JSON of a skeleton."""
    return msgspec.json.encode(Body.of(skeleton)).decode()


def skeleton_of(text: str) -> Skeleton:
    """The skeleton of a text; a ``LibraryError`` says what is wrong with it."""
    try:
        return msgspec.json.decode(text, type=Body).skeleton()
    except (msgspec.DecodeError, FormatError) as error:
        raise LibraryError(f"the library's skeleton is damaged ({error}); build the library again") from None
