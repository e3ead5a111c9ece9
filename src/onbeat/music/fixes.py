"""What a listener may be told that somebody knows better: beats, taps, tempo, meter, downbeats."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Literal

from onbeat.errors import AudioError

TempoFix = Literal["half", "double", "third", "triple"]
TEMPO_FIXES: tuple[TempoFix, ...] = ("half", "double", "third", "triple")
METERS = range(1, 17)


@dataclass(frozen=True)
class Corrections:
    """What to put right, in this order; the default is nothing.

    Parameters
    ----------
    beats : file of the beats, which replace those heard; times count from the start of the sound file.
    taps : file of taps along; the beats heard are brought to their tempo and phase.
    tempo : ``half`` or ``third`` keep every second or third beat, ``double`` and ``triple`` put others between.
    meter : beats in a bar.
    downbeat_offset : beats by which the downbeats come later; below 0, earlier.
    """

    beats: str | os.PathLike[str] | None = None
    taps: str | os.PathLike[str] | None = None
    tempo: TempoFix | None = None
    meter: int | None = None
    downbeat_offset: int = 0

    def __post_init__(self) -> None:
        if self.beats is not None and self.taps is not None:
            raise AudioError("beats and taps are both given; give one of the two files")
        if self.tempo not in (None, *TEMPO_FIXES):
            raise AudioError(f"tempo {self.tempo!r}: expected one of {', '.join(TEMPO_FIXES)}")
        if self.meter is not None and self.meter not in METERS:
            raise AudioError(f"meter {self.meter}: expected {METERS.start} to {METERS.stop - 1} beats in a bar")

    @property
    def tells_tempo(self) -> bool:
        """Whether they say how fast the beats are, rather than only where the bars begin."""
        return self.beats is not None or self.taps is not None or self.tempo is not None

    def __bool__(self) -> bool:
        """Whether there is anything to put right."""
        return self != Corrections()


NOTHING = Corrections()
"""No corrections."""
