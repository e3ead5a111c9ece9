"""The chord players of the embedded song: a strummed guitar and a soft pad."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32
from onbeat.examples.harmony import voicing
from onbeat.examples.mixing import Desk
from onbeat.examples.score import DYNAMICS, Score
from onbeat.examples.synth import RATE, hertz, oscillate, pluck, shape, swell, wave_table

# Strums of a bar: (beat, strength, length in beats, up or down).
_STRUMS = {
    4: {
        "intro": ((0, 0.7, 1.9, "down"), (2, 0.5, 0.9, "down"), (3, 0.45, 0.9, "down"), (3.5, 0.3, 0.5, "up")),
        "verse": (
            (0, 0.35, 0.8, "down"),
            (1, 0.75, 0.5, "down"),
            (1.5, 0.35, 0.4, "up"),
            (3, 0.8, 0.5, "down"),
            (3.5, 0.4, 0.45, "up"),
        ),
        "chorus": (
            (0, 0.6, 0.9, "down"),
            (1, 0.9, 0.5, "down"),
            (1.5, 0.5, 0.5, "up"),
            (2, 0.4, 0.45, "down"),
            (2.5, 0.55, 0.45, "up"),
            (3, 0.9, 0.5, "down"),
            (3.5, 0.55, 0.45, "up"),
        ),
        "break": ((0, 0.5, 3.8, "down"),),
        "outro": ((0, 0.7, 0.9, "down"), (1, 0.5, 0.9, "down"), (2, 0.7, 0.9, "down"), (3, 0.6, 0.9, "down")),
    },
    3: {
        "intro": ((0, 0.6, 2.8, "down"),),
        "verse": ((1, 0.7, 0.6, "down"), (2, 0.7, 0.6, "down")),
        "chorus": ((0, 0.4, 0.8, "down"), (1, 0.85, 0.6, "down"), (2, 0.85, 0.45, "down"), (2.5, 0.5, 0.4, "up")),
        "break": ((0, 0.5, 2.8, "down"),),
        "outro": ((0, 0.6, 0.9, "down"), (1, 0.6, 0.9, "down"), (2, 0.6, 0.9, "down")),
    },
}


def _guitar_strings(rng: np.random.Generator) -> dict[int, Float32]:
    return {pitch: pluck(pitch, 2.6, 0.55, 2.4, rng) for pitch in range(48, 76)}


def play_guitar(desk: Desk, score: Score, rng: np.random.Generator) -> None:
    """Strum the chords, strings a few milliseconds apart, damped where the pattern says so."""
    desk.track("guitar", 0.28, -0.45, 0.14)
    strings = _guitar_strings(rng)
    for part in score.parts:
        for bar in range(part.first, part.first + part.bars):
            for beat, strength, length, way in _STRUMS[score.meter][part.name]:
                strength *= DYNAMICS[part.name]
                _strum(desk, score, strings, bar * score.meter + beat, length, strength, way == "up", rng)
    _strum(desk, score, strings, len(score.chords) - 1, 4.0, 0.9, False, rng)


def _strum(
    desk: Desk,
    score: Score,
    strings: dict[int, Float32],
    beat: float,
    beats: float,
    strength: float,
    up: bool,
    rng: np.random.Generator,
) -> None:
    pitches = voicing(score.chord_at(beat), 49, 5)
    start = score.swung(beat) + float(rng.normal(0.0, 0.002))
    length = int((float(score.grid.time(beat + beats)) - start) * RATE)
    for order, pitch in enumerate(pitches[:1:-1] if up else pitches):
        sound = strings[pitch][:length]
        level = strength * float(np.exp(rng.normal(0.0, 0.12)))
        desk.play("guitar", shape(sound, swell(len(sound), 0.0, 0.05)), start + 0.007 * order, level)


def play_pad(desk: Desk, score: Score) -> None:
    """Hold the chords softly, a little apart in tuning to the left and the right."""
    level = {"intro": 0.8, "verse": 0.6, "chorus": 0.95, "break": 1.0, "outro": 0.9}
    for side, pan in (("left", -0.85), ("right", 0.85)):
        desk.track(f"pad {side}", 0.05, pan, 0.5)
    for part in score.parts:
        first, last = part.first * score.meter, (part.first + part.bars) * score.meter
        start = first
        for beat in range(first + 1, last + 1):
            if beat == last or score.chords[beat] != score.chords[start]:
                _hold(desk, score, start, beat, level[part.name])
                start = beat
    _hold(desk, score, len(score.chords) - 1, len(score.chords) + 3, 0.9)


def _hold(desk: Desk, score: Score, first: int, last: int, level: float) -> None:
    start = float(score.grid.time(first))
    length = int((float(score.grid.time(last)) - start + 0.3) * RATE)
    envelope = shape(swell(length, 0.18, 0.34), np.full(length, level))
    for order, pitch in enumerate(voicing(score.chords[first], 57, 4)):
        table = wave_table(hertz(pitch), 1.7)
        for side, cents in (("left", 4.0), ("right", -4.0)):
            frequency = hertz(pitch + cents / 100.0)
            desk.play(f"pad {side}", shape(oscillate(table, frequency, length, phase=0.37 * order), envelope), start)
