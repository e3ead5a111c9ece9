"""The bass player of the embedded song."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32
from onbeat.examples.mixing import Desk
from onbeat.examples.score import DYNAMICS, Score
from onbeat.examples.synth import RATE, decay, hertz, oscillate, shape, swell, wave_table


def _bass_note(pitch: float, seconds: float) -> Float32:
    """A round bass string: a bright tone that fades into a dull one, over a sine."""
    length = int(seconds * RATE)
    bright = oscillate(wave_table(hertz(pitch), 1.0), hertz(pitch), length) * decay(length, 0.1)
    dull = oscillate(wave_table(hertz(pitch), 2.2), hertz(pitch), length)
    return shape(0.45 * bright + 0.8 * dull, decay(length, 0.6), swell(length, 0.004, 0.05))


# Bars of bass: (beat, length, what to play); root, fifth, octave, or a step that leads to the next root.
_BASS_LINES = {
    4: {
        "intro": (((0, 1.8, "root"), (2, 1.6, "fifth")),),
        "verse": (
            ((0, 0.9, "root"), (1.5, 0.45, "root"), (2, 0.9, "fifth"), (3, 0.45, "root"), (3.5, 0.45, "lead")),
            ((0, 1.3, "root"), (1.5, 0.45, "octave"), (2, 0.9, "fifth"), (3.5, 0.45, "lead")),
        ),
        "chorus": (
            tuple(
                (eighth / 2, 0.42, ("root", "octave", "root", "octave", "root", "octave", "root", "lead")[eighth])
                for eighth in range(8)
            ),
            (
                (0, 0.9, "root"),
                (1, 0.4, "root"),
                (1.5, 0.4, "octave"),
                (2, 0.9, "fifth"),
                (3, 0.4, "octave"),
                (3.5, 0.45, "lead"),
            ),
        ),
        "break": (((0, 3.6, "root"),),),
        "outro": (((0, 0.9, "root"), (2, 0.9, "root"), (3, 0.9, "lead")),),
    },
    3: {
        "intro": (((0, 2.5, "root"),),),
        "verse": (((0, 1.6, "root"), (2, 0.9, "fifth")), ((0, 1.6, "root"), (2, 0.45, "fifth"), (2.5, 0.45, "lead"))),
        "chorus": (((0, 0.9, "root"), (1, 0.6, "octave"), (2, 0.45, "fifth"), (2.5, 0.45, "lead")),),
        "break": (((0, 2.7, "root"),),),
        "outro": (((0, 1.5, "root"), (2, 0.8, "lead")),),
    },
}


def play_bass(desk: Desk, score: Score, rng: np.random.Generator) -> None:
    """Play the bass: roots on the one, fifths and octaves between, steps that lead to the next bar's root."""
    desk.track("bass", 0.36, 0.0, 0.03)
    choice = int(rng.integers(2))
    for part in score.parts:
        lines = _BASS_LINES[score.meter][part.name]
        line = lines[choice % len(lines)]
        for bar in range(part.first, part.first + part.bars):
            for beat, length, what in line:
                strength = DYNAMICS[part.name] * (0.92 + 0.08 * float(rng.random()))
                _play_bass_note(desk, score, bar * score.meter + beat, length, what, strength)
    last = len(score.chords) - 1
    desk.play("bass", _bass_note(_low(score.chords[-1].root), 2.4), score.swung(last), 0.9)


def _low(root: int) -> int:
    """A pitch class between E1 (28) and D#2 (39)."""
    return 28 + (root - 28) % 12


def _play_bass_note(desk: Desk, score: Score, beat: float, length: float, what: str, strength: float) -> None:
    chord = score.chord_at(beat)
    pitch = _low(chord.root)
    if what == "fifth":
        pitch += 7 if pitch < 34 else -5
    elif what == "octave":
        pitch += 12
    elif what == "lead":
        pitch = _lead(score, beat)
    seconds = float(score.grid.time(beat + length) - score.grid.time(beat))
    desk.play("bass", _bass_note(pitch, seconds), score.swung(beat), strength)


def _lead(score: Score, beat: float) -> int:
    """The scale step just under the next root, or over it where that is nearer to the present one."""
    now, after = _low(score.chord_at(beat).root), _low(score.chord_at(int(beat) + 1).root)
    scale = {score.progressions.key.pitch(step) % 12 for step in range(7)}
    towards = 1 if now > after else -1
    return next(after + towards * move for move in (1, 2, 3) if (after + towards * move) % 12 in scale)
