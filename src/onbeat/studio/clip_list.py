"""``clips.json``: which clips a library of the project has, so that they can be shown without opening it."""

from __future__ import annotations

from pathlib import Path

import msgspec

from onbeat.files import write_atomically

CLIPS = "clips.json"


class ClipList(msgspec.Struct, frozen=True):
    """Names and seconds of a library's clips, mirror images left out, and of what is not in it a line each."""

    clips: list[tuple[str, float]]
    problems: list[str]

    def write(self, folder: Path) -> None:
        """Write it into a folder."""
        write_atomically(folder / CLIPS, msgspec.json.encode(self))

    @classmethod
    def read(cls, folder: Path) -> ClipList:
        """The list in a folder."""
        return msgspec.json.decode((folder / CLIPS).read_bytes(), type=cls)
