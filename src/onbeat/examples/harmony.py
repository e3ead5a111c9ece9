"""Keys, modes and chord progressions of the embedded song."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

MODES: dict[str, tuple[int, ...]] = {
    "major": (0, 2, 4, 5, 7, 9, 11),
    "mixolydian": (0, 2, 4, 5, 7, 9, 10),
    "dorian": (0, 2, 3, 5, 7, 9, 10),
}
"""Semitones of the seven steps of each mode above the tonic."""

# Scale degrees, one word a bar; "4/5" changes chord in mid-bar. Verses stay open (they end on the chord that
# wants to go on), choruses close on the tonic. The first and second four bars are question and answer.
_VERSES = {
    "major": ("1 6 4 5 1 6 2 5", "1 4 1 5 1 4 2 5", "1 5 6 4 1 5 4 5"),
    "mixolydian": ("1 7 4 1 1 7 4 7", "1 4 7 1 1 4 1 7"),
    "dorian": ("1 4 1 7 1 4 3 7", "1 7 3 4 1 7 4 7"),
}
_CHORUSES = {
    "major": ("1 5 6 4 1 5 4/5 1", "4 1 5 6 4 1 4/5 1", "1 4 5 1 6 4 1/5 1"),
    "mixolydian": ("4 1 7 1 4 1 4/7 1", "1 7 4 1 1 7 4/7 1"),
    "dorian": ("3 7 1 4 3 7 4/7 1", "1 3 7 4 1 3 4/7 1"),
}
_BREAKS = {"major": "6 4 2 5", "mixolydian": "4 1 4 7", "dorian": "3 1 4 7"}
_INTROS = {"major": "1 4 1 5", "mixolydian": "1 4 1 7", "dorian": "1 4 1 7"}
_OUTROS = {"major": "1 4 4/5", "mixolydian": "1 4 4/7", "dorian": "1 4 4/7"}


class Chord(NamedTuple):
    """A triad: its root as a pitch class (0 = C … 11 = B) and its quality, ``major``, ``minor`` or ``diminished``."""

    root: int
    quality: str

    @property
    def tones(self) -> tuple[int, int, int]:
        """The three pitch classes, root first."""
        third = 4 if self.quality == "major" else 3
        fifth = 6 if self.quality == "diminished" else 7
        return self.root, (self.root + third) % 12, (self.root + fifth) % 12

    def change_from(self, before: Chord) -> float:
        """Share of this chord's tones that the chord before did not have, 0…1."""
        return 1.0 - len(set(self.tones) & set(before.tones)) / 3.0


@dataclass(frozen=True)
class Key:
    """A tonic (pitch class) and a mode; steps count along the scale, 0 is the tonic, 7 the tonic an octave up.

    Examples
    --------
    >>> Key(2, "major").pitch(4)  # the fifth above D4 (62) is A4
    69
    >>> Key(2, "major").chord(6)
    Chord(root=11, quality='minor')
    """

    tonic: int
    mode: str

    def pitch(self, step: int) -> int:
        """The MIDI note of a scale step, step 0 in the octave of middle C."""
        octave, degree = divmod(step, 7)
        return 60 + self.tonic + 12 * octave + MODES[self.mode][degree]

    def chord(self, degree: int) -> Chord:
        """The triad on a scale degree, counted from 1 as musicians do."""
        root, third, fifth = (self.pitch(degree - 1 + above) for above in (0, 2, 4))
        if fifth - root == 6:
            return Chord(root % 12, "diminished")
        return Chord(root % 12, "major" if third - root == 4 else "minor")


@dataclass(frozen=True)
class Progressions:
    """The chords of a song's sections: a key, and which verse and chorus progression it has."""

    key: Key
    verse: str
    chorus: str

    def bars(self, section: str, count: int) -> list[str]:
        """Degrees of each bar of a section of ``count`` bars; sections end as their progression ends."""
        mode = self.key.mode
        words = {
            "verse": self.verse,
            "chorus": self.chorus,
            "break": _BREAKS[mode],
            "intro": _INTROS[mode],
            "outro": _OUTROS[mode],
        }[section].split()
        repeats = -(-count // len(words))
        return (words * repeats)[len(words) * repeats - count :]

    def beats(self, section: str, count: int, meter: int) -> list[Chord]:
        """The chord of every beat of a section."""
        chords: list[Chord] = []
        for word in self.bars(section, count):
            degrees = [int(digit) for digit in word.split("/")]
            first = -(-meter // len(degrees))
            chords += [self.key.chord(degrees[0])] * first + [self.key.chord(degrees[-1])] * (meter - first)
        return chords


def choose_progressions(rng: np.random.Generator) -> Progressions:
    """Draw a key, a mode and the progressions of verse and chorus."""
    mode = str(rng.choice(["major", "mixolydian", "dorian"], p=[0.5, 0.2, 0.3]))
    tonic = int(rng.choice([0, 2, 4, 5, 7, 9]))
    return Progressions(Key(tonic, mode), str(rng.choice(_VERSES[mode])), str(rng.choice(_CHORUSES[mode])))


def voicing(chord: Chord, lowest: int, count: int) -> list[int]:
    """The ``count`` lowest chord tones (MIDI notes) from ``lowest`` up.

    Examples
    --------
    >>> voicing(Chord(2, "major"), 50, 4)
    [50, 54, 57, 62]
    """
    found = [pitch for pitch in range(lowest, lowest + 12 * count) if pitch % 12 in chord.tones]
    return found[:count]
