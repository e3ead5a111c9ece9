"""onbeat puts motion on the beat: motion capture and a song in, a dance on the music out."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from onbeat.errors import OnbeatError

if TYPE_CHECKING:
    from onbeat.dance.make import Dance, make_dance
    from onbeat.formats import read_markers, read_motion, write_markers, write_motion
    from onbeat.motion import Body, Markers, Motion, Skeleton
    from onbeat.moves.library import MoveLibrary
    from onbeat.music import Song, listen

__all__ = [
    "Body",
    "Dance",
    "Markers",
    "Motion",
    "MoveLibrary",
    "OnbeatError",
    "Skeleton",
    "Song",
    "__version__",
    "listen",
    "make_dance",
    "read_markers",
    "read_motion",
    "write_markers",
    "write_motion",
]
__version__ = "0.1.0"

_ON_DEMAND = {
    **dict.fromkeys(("Body", "Markers", "Motion", "Skeleton"), "onbeat.motion"),
    **dict.fromkeys(("read_markers", "read_motion", "write_markers", "write_motion"), "onbeat.formats"),
    **dict.fromkeys(("Song", "listen"), "onbeat.music"),
    **dict.fromkeys(("Dance", "make_dance"), "onbeat.dance.make"),
    "MoveLibrary": "onbeat.moves.library",
}
"""Imported when first asked for, so that ``import onbeat`` stays quick."""


def __getattr__(name: str) -> Any:
    if name not in _ON_DEMAND:
        raise AttributeError(f"module 'onbeat' has no attribute {name!r}")
    return getattr(import_module(_ON_DEMAND[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
