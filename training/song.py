"""One clip in the making: its time, its chords, its notes and strokes."""

# ruff: noqa: E501
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from training.styles import Style
from training.tempo_map import beat_grid

PROGRESSIONS = (
    (0, 4, 5, 3), (0, 3, 4, 0), (0, 5, 3, 4), (5, 3, 0, 4), (0, 0, 3, 4), (1, 4, 0, 0), (0, 5, 1, 4), (0, 6, 5, 4), (0, 3, 0, 4),
    (0, 2, 3, 4), (3, 4, 2, 5), (0, 0, 0, 0), (0, 4, 0, 4), (0, 3), (0, 6), (0, 0, 4, 4, 0, 0, 4, 0), (0, 0, 3, 0, 4, 3, 0, 4), (5, 1, 4, 0),
)  # fmt: skip
SCALES = (
    (0, 2, 4, 5, 7, 9, 11),
    (0, 2, 3, 5, 7, 8, 10),
    (0, 2, 3, 5, 7, 9, 10),
    (0, 2, 3, 5, 7, 8, 11),
    (0, 2, 4, 5, 7, 9, 10),
)


@dataclass
class Performance:
    """Notes and strokes of one clip.

    ``notes`` rows: time [s], length [s], voice (which of the clip's timbres), pitch, amplitude, glide [semitones].
    ``strokes`` rows: time [s], key, amplitude.
    """

    style: str
    beats: np.ndarray
    downbeats: np.ndarray
    notes: list[tuple[float, float, int, float, float, float]] = field(default_factory=list)
    strokes: list[tuple[float, int, float]] = field(default_factory=list)


class Grid:
    """Where things are in time: bars, beats, steps with swing."""

    def __init__(self, beats: np.ndarray, meter: int, div: int, swing: float) -> None:
        self.beats, self.meter, self.div, self.swing = beats, meter, div, swing
        self.bars = (len(beats) - 1) // meter

    def time(self, beat: float | np.ndarray) -> np.ndarray:
        """Seconds of places counted in beats, off-beats delayed by the swing."""
        whole = np.floor(beat)
        part = np.asarray(beat) - whole
        halves = 2.0 if self.div == 4 else 1.0
        inner = part * halves - np.floor(part * halves)
        bent = np.where(inner < 0.5, inner * 2 * self.swing, self.swing + (inner - 0.5) * 2 * (1 - self.swing))
        warped = whole + (np.floor(part * halves) + bent) / halves
        return np.interp(warped, np.arange(len(self.beats)), self.beats)


class Song:
    """One clip in the making."""

    def __init__(self, style: Style, rng: np.random.Generator, seconds: float) -> None:
        self.rng, self.style = rng, style
        swing = float(rng.uniform(*style.swing)) if style.div != 3 else 0.5
        if swing == 0.5 and style.div == 4 and rng.random() < 0.1:
            swing = float(rng.uniform(0.5, 0.62))
        expressive = style.name.startswith("piano") or (not style.drums and rng.random() < 0.4)
        tempo = float(np.exp(rng.uniform(*np.log(style.tempo))))
        beats = beat_grid(rng, tempo, style.meter, seconds, expressive)
        self.grid = Grid(beats, style.meter, style.div, swing)
        self.key = int(rng.integers(12))
        self.scale = np.array(SCALES[rng.choice(len(SCALES), p=(0.5, 0.2, 0.12, 0.1, 0.08))])
        self.jitter = float(rng.choice([0.0, 0.003, 0.006, 0.011], p=(0.3, 0.3, 0.25, 0.15)))
        self.chords = self._chords()
        self.performance = Performance(style.name, beats, np.arange(len(beats)) % style.meter == 0)

    def _chords(self) -> np.ndarray:
        """Scale degree of the chord at each beat."""
        rng, grid = self.rng, self.grid
        progression = np.array(PROGRESSIONS[rng.integers(len(PROGRESSIONS))])
        bars = float(rng.choice(self.style.chord_bars))
        span = max(round(bars * grid.meter), 1) if bars >= 1 or grid.meter % 2 == 0 else grid.meter
        chords = progression[
            (np.arange(len(grid.beats)) // span + int(rng.integers(len(progression)))) % len(progression)
        ]
        if rng.random() < 0.2:  # now and then a chord of its own on the last beat of a bar, or pushed
            odd = (np.arange(len(chords)) % grid.meter == grid.meter - 1) & (rng.random(len(chords)) < 0.3)
            chords = np.where(odd, rng.integers(0, 7, len(chords)), chords)
        return chords

    def pitch(self, degree: int, octave: int) -> float:
        """MIDI pitch of a degree of the scale."""
        return float(12 * (octave + degree // 7) + self.key + self.scale[degree % 7])

    def chord_tones(self, beat: float, low: float, count: int) -> np.ndarray:
        """``count`` pitches of the chord at a beat from ``low`` up."""
        root = int(self.chords[int(np.clip(beat, 0, len(self.chords) - 1))])
        pitches = np.array([self.pitch(root + step, octave) for octave in range(2, 9) for step in (0, 2, 4)])
        pitches = np.sort(pitches)
        return pitches[pitches >= low][:count]

    def add(
        self,
        beat: float,
        length: float,
        voice: int,
        pitch: float,
        amplitude: float,
        late: float = 0.0,
        glide: float = 0.0,
    ) -> None:
        """A note of ``length`` beats."""
        begin = float(self.grid.time(beat)) + late + self.rng.normal() * self.jitter
        end = float(self.grid.time(min(beat + length, len(self.grid.beats) - 1.01))) + late
        self.performance.notes.append(
            (begin, max(end - begin, 0.05), voice, pitch, amplitude * float(self.rng.uniform(0.8, 1.1)), glide)
        )
