"""Composing a singable tune: rhythm cells that come back, and pitches found by dynamic programming.

A phrase of four bars is call (two bars) and response (two bars); the third bar answers the first with the same
rhythm and contour on its own chord. Pitches minimise a cost that prefers steps to leaps, chord tones on strong
beats and a contour; tones foreign to the chord are only entered and left by step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array
from onbeat.examples.harmony import Chord, Key

# Note lengths in eighths; negative is a rest.
_CELLS = {
    4: ((2, 1, 1, 2, 2), (3, 1, 2, 2), (2, 1, 1, 2, 1, 1), (2, 2, 3, 1), (1, 1, 2, 2, 1, 1), (3, 1, 3, 1)),
    3: ((2, 2, 2), (3, 1, 2), (2, 1, 1, 2), (2, 2, 1, 1), (4, 2)),
}
_PAUSES = {4: ((2, 2, 3, -1), (1, 1, 2, 3, -1), (3, 1, 3, -1)), 3: ((2, 3, -1), (3, 2, -1), (4, -2))}
_CLOSES = {4: ((1, 1, 2, -2, 1, 1), (4, -2, 1, 1), (2, 2, -2, 2)), 3: ((2, -2, 1, 1), (3, -1, 2), (4, -1, 1))}
_LOWEST, _HIGHEST = -2, 9  # the range of the tune in scale steps above the tonic: an octave and a half
_LEAPS = np.array([1.1, 0.0, 0.45, 1.1, 1.5, 3.0, 5.0, 3.5, *[9.0] * 8])  # cost of moving by so many steps


class Note(NamedTuple):
    """A note of the tune: first beat and length (in beats of the song), and its scale step."""

    beat: float
    beats: float
    step: int


@dataclass(frozen=True)
class Rhythm:
    """A section's rhythm cells: call, response and cadence, in eighths."""

    call: tuple[int, ...]
    response: tuple[int, ...]
    pause: tuple[int, ...]
    close: tuple[int, ...]

    def bars(self) -> list[tuple[int, ...]]:
        """Eight bars: question and answer."""
        return [self.call, self.response, self.call, self.pause, self.call, self.response, self.call, self.close]


def choose_rhythm(rng: np.random.Generator, meter: int) -> Rhythm:
    """Draw two different cells and two cadences."""
    call, response = rng.permutation(len(_CELLS[meter]))[:2]
    return Rhythm(
        _CELLS[meter][call],
        _CELLS[meter][response],
        _PAUSES[meter][rng.integers(len(_PAUSES[meter]))],
        _CLOSES[meter][rng.integers(len(_CLOSES[meter]))],
    )


def _slots(cell: tuple[int, ...], bar: int, meter: int) -> list[tuple[float, float]]:
    """Start and length in beats of the notes of a cell put at a bar."""
    starts = np.concatenate([[0], np.cumsum(np.abs(cell))[:-1]]) / 2.0 + bar * meter
    return [(float(start), eighths / 2.0) for start, eighths in zip(starts, cell, strict=True) if eighths > 0]


def _note_costs(slots: list[tuple[float, float]], tones: Array, meter: int) -> Array:
    """(N, S) cost of each step as each note by harmony alone; ``tones`` (N, S) says which belong to the chord."""
    costs = np.empty(tones.shape)
    for row, (beat, length) in enumerate(slots):
        strong = beat % meter == 0 or length >= 1.5 or (meter == 4 and beat % 2 == 0)
        foreign = 7.0 if strong else 1.5 if beat % 1 == 0 else 0.3
        costs[row] = np.where(tones[row] > 0, 0.0, foreign)
    return costs


def find_steps(costs: Array, tones: Array, before: int | None) -> list[int]:
    """The cheapest sequence of scale steps (Viterbi) under note costs and the costs of moving between notes."""
    steps = np.arange(_LOWEST, _HIGHEST + 1)
    distance = np.abs(steps[:, None] - steps[None, :])
    total = costs[0].copy()
    if before is not None:
        total += _LEAPS[np.abs(steps - before)]
    choices = np.zeros(costs.shape, dtype=np.int64)
    for row in range(1, len(costs)):
        foreign = (tones[row - 1][:, None] == 0) | (tones[row][None, :] == 0)
        ways = total[:, None] + _LEAPS[distance] + np.where(foreign & (distance != 1), 3.0, 0.0)
        choices[row] = ways.argmin(axis=0)
        total = ways.min(axis=0) + costs[row]
    path = [int(total.argmin())]
    for row in range(len(costs) - 1, 0, -1):
        path.append(int(choices[row, path[-1]]))
    return [int(steps[index]) for index in reversed(path)]


@dataclass(frozen=True)
class Composer:
    """Writes eight-bar tunes over chords.

    Parameters
    ----------
    key : the key.
    meter : beats in a bar.
    centre : the scale step around which the tune moves.
    """

    key: Key
    meter: int
    centre: float

    def compose(self, chords: list[Chord], rhythm: Rhythm, rng: np.random.Generator, closed: bool) -> list[Note]:
        """Eight bars over the ``chords`` of their beats; ``closed`` ends on the tonic."""
        bars = rhythm.bars()
        tune: list[list[Note]] = []
        for first in range(0, 8, 2):
            slots = [slot for bar in (first, first + 1) for slot in _slots(bars[bar], bar, self.meter)]
            wish, firm = self._contour(slots, tune, chords)
            costs, tones = self._costs(slots, chords)
            steps = np.arange(_LOWEST, _HIGHEST + 1)
            costs += firm[:, None] * (steps[None, :] - wish[:, None]) ** 2 + rng.normal(0.0, 0.35, costs.shape)
            last = self._cadence_note(slots) if first in (2, 6) else None
            if last is not None:
                costs[last] += np.where(steps % 7 == 0, 0.0, 12.0) if first == 6 and closed else 0.0
            found = find_steps(costs, tones, tune[-1][-1].step if tune else None)
            tune.append([Note(beat, length, step) for (beat, length), step in zip(slots, found, strict=True)])
        return [note for pair in tune for note in pair]

    def _costs(self, slots: list[tuple[float, float]], chords: list[Chord]) -> tuple[Array, Array]:
        steps = range(_LOWEST, _HIGHEST + 1)
        tones = np.array(
            [[self.key.pitch(step) % 12 in chords[int(beat)].tones for step in steps] for beat, _ in slots]
        )
        tones = tones.astype(np.float64)
        return _note_costs(slots, tones, self.meter), tones

    def _cadence_note(self, slots: list[tuple[float, float]]) -> int:
        """The note before the rest: where the phrase comes to rest."""
        return next(
            index
            for index, (beat, length) in enumerate(slots)
            if index == len(slots) - 1 or slots[index + 1][0] > beat + length
        )

    def _contour(
        self, slots: list[tuple[float, float]], tune: list[list[Note]], chords: list[Chord]
    ) -> tuple[Array, Array]:
        """The step each note would like to have, and how firmly: an arch, or an echo of the call."""
        along = np.linspace(0.0, 1.0, len(slots))
        wish = self.centre + 1.8 * np.sin(np.pi * along * 0.9 + 0.3) - 1.0
        firm = np.full(len(slots), 0.1)
        if not tune:
            return wish, firm
        span = 2 * self.meter
        home = chords[0].root
        for index, (beat, _) in enumerate(slots):
            for note in tune[0]:
                if note.beat == beat % span and (len(tune) == 2 or beat % span < self.meter):
                    wish[index] = note.step + self._shift(home, chords[int(beat)].root, len(tune) == 2)
                    firm[index] = 0.6
        return wish, firm

    def _shift(self, home: int, root: int, repeat: bool) -> float:
        """How far an echo is carried with its chord: not at all in a repeat, else half way, nearest octave."""
        if repeat:
            return 0.0
        semitones = (root - home + 6) % 12 - 6
        return semitones * 7.0 / 12.0 / 2.0
