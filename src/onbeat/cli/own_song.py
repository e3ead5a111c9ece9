"""The song of a dance that ``onbeat dance`` made: its beats lie beside it and need not be guessed from the motion."""

from __future__ import annotations

import sys
from pathlib import Path

DANCE, SONG = "dance", "song.json"


def own_song(motion: Path, *told: object) -> Path | None:
    """The ``song.json`` that was written with a dance, and a line that it is taken; None where anything is ``told``."""
    song = motion.with_name(SONG)
    if any(told) or motion.stem != DANCE or not (motion.with_name(f"{DANCE}.json").is_file() and song.is_file()):
        return None
    print(f"no beats given: those of {song}, to which {motion.name} was made", file=sys.stderr)  # noqa: T201
    return song
