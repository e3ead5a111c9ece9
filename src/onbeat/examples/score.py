"""The score of the embedded song: what every player reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat.examples.arrangement import Grid, Part
from onbeat.examples.harmony import Chord, Progressions
from onbeat.examples.tune import Composer, Note, choose_rhythm

SWING = 0.54  # where the second eighth of a beat falls, 0.5 is straight
DYNAMICS = {"intro": 0.72, "verse": 0.85, "chorus": 1.0, "break": 0.5, "outro": 0.75}
"""How strongly bass and guitar play in each section."""


@dataclass(frozen=True, eq=False)
class Score:
    """A song on paper.

    Parameters
    ----------
    grid : when each beat falls.
    parts : sections in bars.
    progressions : key and chords.
    chords : the chord of each beat, the last chord of the song included.
    tunes : the tune of each part; empty where nobody sings.
    """

    grid: Grid
    parts: tuple[Part, ...]
    progressions: Progressions
    chords: tuple[Chord, ...]
    tunes: tuple[tuple[Note, ...], ...]

    @property
    def meter(self) -> int:
        """Beats in a bar."""
        return self.grid.meter

    def swung(self, beat: float) -> float:
        """Seconds of a beat number, eighths between the beats swung."""
        whole, rest = divmod(beat, 1.0)
        late = rest * SWING / 0.5 if rest <= 0.5 else 1.0 - (1.0 - rest) * (1.0 - SWING) / 0.5
        return float(self.grid.time(whole + late))

    def chord_at(self, beat: float) -> Chord:
        """The chord that sounds at a beat number."""
        return self.chords[min(int(beat), len(self.chords) - 1)]


def write_score(grid: Grid, parts: tuple[Part, ...], progressions: Progressions, rng: np.random.Generator) -> Score:
    """Write chords and tunes: one tune for all verses, a higher one for all choruses, a farewell at the end."""
    meter = grid.meter
    chords = [chord for part in parts for chord in progressions.beats(part.name, part.bars, meter)]
    chords.append(progressions.key.chord(1))
    tunes: dict[str, list[Note]] = {}
    for name, centre in (("verse", 2.0), ("chorus", 4.5)):
        composer = Composer(progressions.key, meter, centre)
        rhythm = choose_rhythm(rng, meter)
        tunes[name] = composer.compose(progressions.beats(name, 8, meter), rhythm, rng, name == "chorus")
    placed: list[tuple[Note, ...]] = []
    for part, after in zip(parts, [*parts[1:], None], strict=True):
        notes = _place(tunes[part.name], part, meter) if part.name in tunes else ()
        sings_on = after is not None and after.name in tunes
        placed.append(notes if sings_on else _rest(notes, (part.first + part.bars) * meter))
    return Score(grid, parts, progressions, tuple(chords), tuple(placed))


def _rest(notes: tuple[Note, ...], end: int) -> tuple[Note, ...]:
    """Hold the cadence note instead of the pick-up to a tune that does not follow."""
    for index in range(len(notes) - 1, 0, -1):
        before = notes[index - 1]
        if notes[index].beat > before.beat + before.beats:
            return (*notes[: index - 1], before._replace(beats=end - 0.5 - before.beat))
    return notes


def _place(tune: list[Note], part: Part, meter: int) -> tuple[Note, ...]:
    """The last bars of an eight-bar tune, repeated as often as a part needs, in the song's beats."""
    notes: list[Note] = []
    end = (part.first + part.bars) * meter
    start = end
    while start > part.first * meter:
        start -= 8 * meter
        notes = [Note(note.beat + start, note.beats, note.step) for note in tune] + notes
    return tuple(note for note in notes if note.beat >= part.first * meter)
