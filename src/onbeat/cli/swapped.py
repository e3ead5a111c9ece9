"""Files given in each other's place: a song where motion is expected, motion where a song is, and what is meant."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from onbeat.cli.fetching import SONG
from onbeat.errors import OnbeatError
from onbeat.formats.registry import FORMATS, SOUNDS
from onbeat.moves.store import is_library

MODEL = ".npz"
"""Of recognisers; motion has it, too."""
_MOTION = tuple(known.suffix for known in FORMATS if known.read)


def looks_like_sound(path: Path) -> bool:
    """Whether a path is named as songs are, and is no folder."""
    return str(path).startswith(SONG) or (path.suffix.lower() in SOUNDS and not path.is_dir())


def looks_like_motion(path: Path) -> bool:
    """Whether a path is named as motion files are, or is a folder of them, or a library."""
    if not path.is_dir():
        return path.suffix.lower() in _MOTION
    try:
        return is_library(path) or any(child.suffix.lower() in _MOTION for child in path.iterdir())
    except OSError:
        return False  # whoever reads it says why it cannot be read


def refuse_swapped(song: Path | None, motion: Path | None, meant: str) -> None:
    """Refuse motion that is given as the song, or a song as the motion.

    Parameters
    ----------
    song, motion : what is given as each; None where nothing is.
    meant : how the command is given, with ``{song}`` and ``{motion}`` in their places.

    Raises
    ------
    OnbeatError
        If one looks like the other; it says the command that is meant.
    """
    no_motion = motion is not None and looks_like_sound(motion)
    no_song = song is not None and looks_like_motion(song)
    if not (no_motion or no_song):
        return
    found = [f"{song} is motion, no song"] * no_song + [f"{motion} is a song, no motion"] * no_motion
    swapped = no_song and no_motion
    right = {
        "song": motion if swapped or song is None else "SONG" if no_song else song,
        "motion": song if swapped or motion is None else "MOTION" if no_motion else motion,
    }
    told = meant.format(**{name: shlex.quote(str(path)) for name, path in right.items()})
    raise OnbeatError(f"{' and '.join(found)}{': they look swapped' if swapped else ''}; give `{told}`")


def refuse_swapped_model(model: Path, probes: Sequence[Path]) -> None:
    """Refuse motion that is given as the recogniser; an ``OnbeatError`` says the command that is meant."""
    if model.suffix.lower() == MODEL or not (model.suffix.lower() in _MOTION or looks_like_sound(model)):
        return
    found = next((path for path in probes if path.suffix.lower() == MODEL), Path("MODEL.npz"))
    others = [str(path) for path in (model, *probes) if path != found]
    raise OnbeatError(
        f"{model} is no recogniser: it is given first; give `onbeat recognise {shlex.join([str(found), *others])}`"
    )
