"""The flags with which a user says what was heard wrong; ``listen`` and ``dance`` have the same."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cyclopts

from onbeat.music.fixes import Corrections, TempoFix


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class CorrectionFlags:
    """What is to be put right in what was heard, in this order.

    Parameters
    ----------
    beats
        Take these beats: a .beats, .txt or .csv file with a time a line in seconds of the sound file, perhaps with the
        place in the bar (1 = downbeat) behind it; or a song.json.
    tap
        A file of times at which somebody tapped along, unevenly or for a while only: the beats heard are brought to
        the tempo and phase of the taps.
    tempo
        ``half`` or ``third`` keep every second or third beat, ``double`` and ``triple`` put others between.
    meter
        So many beats in a bar.
    downbeat_offset
        The downbeats come so many beats later; below 0, earlier.
    """

    beats: Path | None = None
    tap: Path | None = None
    tempo: TempoFix | None = None
    meter: int | None = None
    downbeat_offset: int = 0

    def corrections(self) -> Corrections:
        """What to put right."""
        return Corrections(self.beats, self.tap, self.tempo, self.meter, self.downbeat_offset)


NO_FLAGS = CorrectionFlags()
"""None was given."""
