"""The melody and chord players of the embedded song: guitar, pad, fiddle, flute and mandolin."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfilt

from onbeat._shapes import Float32
from onbeat.examples.arrangement import Part
from onbeat.examples.harmony import Chord
from onbeat.examples.mixing import Desk
from onbeat.examples.score import DYNAMICS, Score
from onbeat.examples.synth import RATE, decay, hertz, oscillate, pluck, shape, swell, vibrato, wave_table
from onbeat.examples.tune import Note

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


def voicing(chord: Chord, lowest: int, count: int) -> list[int]:
    """The ``count`` lowest chord tones (MIDI notes) from ``lowest`` up.

    Examples
    --------
    >>> voicing(Chord(2, "major"), 50, 4)
    [50, 54, 57, 62]
    """
    found = [pitch for pitch in range(lowest, lowest + 12 * count) if pitch % 12 in chord.tones]
    return found[:count]


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


def _fiddle(pitch: float, seconds: float) -> Float32:
    """A bowed, reedy tone: two harmonic tones a little apart, a body formant, vibrato that opens on long notes."""
    length = int(seconds * RATE)
    table = wave_table(hertz(pitch), 1.25, 1500.0)
    bend = vibrato(length, 5.6, 16.0, 0.16)
    tone = oscillate(table, hertz(pitch), length, bend) + 0.6 * oscillate(table, hertz(pitch + 0.06), length, bend, 0.3)
    return shape(tone, swell(length, 0.035, 0.07), 0.75 + 0.25 * decay(length, 0.25))


def _flute(pitch: float, seconds: float, breath: Float32) -> Float32:
    """A wooden flute: few harmonics, a breath of noise at the start, a slow vibrato."""
    length = int(seconds * RATE)
    tone = oscillate(wave_table(hertz(pitch), 2.3), hertz(pitch), length, vibrato(length, 4.8, 11.0, 0.2))
    air = np.resize(breath, length) * (0.05 + 0.2 * decay(length, 0.03))
    return shape(tone + air, swell(length, 0.045, 0.08))


def _breath(rng: np.random.Generator) -> Float32:
    sections = butter(1, [900.0, 4500.0], btype="bandpass", fs=RATE, output="sos")
    noise = np.asarray(sosfilt(sections, rng.standard_normal(4 * RATE)))
    return (noise / np.abs(noise).max()).astype(np.float32)


def play_tune(desk: Desk, score: Score, rng: np.random.Generator) -> None:
    """Sing the tune: in the verse fiddle and flute take turns, in the chorus all play, the flute a third above."""
    desk.track("fiddle", 0.23, 0.15, 0.3)
    desk.track("flute", 0.17, -0.25, 0.35)
    desk.track("mandolin", 0.6, 0.55, 0.2)
    breath = _breath(rng)
    strings = {pitch: pluck(pitch, 1.0, 0.8, 1.3, rng) for pitch in range(52, 100)}
    for part, tune in zip(score.parts, score.tunes, strict=True):
        for note in tune:
            _sing(desk, score, part, note, strings, breath, rng)
    _play_arpeggios(desk, score, strings, rng)
    final = score.progressions.key.pitch(7)
    start = score.swung(len(score.chords) - 1)
    desk.play("fiddle", shape(_fiddle(final, 2.2), decay(int(2.2 * RATE), 0.9)), start, 0.8)
    desk.play("flute", shape(_flute(final + 12, 2.2, breath), decay(int(2.2 * RATE), 0.9)), start, 0.5)


def _sing(
    desk: Desk,
    score: Score,
    part: Part,
    note: Note,
    strings: dict[int, Float32],
    breath: Float32,
    rng: np.random.Generator,
) -> None:
    key = score.progressions.key
    pitch = key.pitch(note.step)
    start = score.swung(note.beat)
    seconds = max((score.swung(note.beat + note.beats) - start) * 0.97, 0.08) + 0.05
    accent = (1.0 if note.beat % 1 == 0 else 0.85) * float(np.exp(rng.normal(0.0, 0.06)))
    chorus = part.name == "chorus"
    call = int(note.beat // score.meter - part.first) % 4 < 2
    if chorus or call:
        desk.play("fiddle", _fiddle(pitch, seconds), start - 0.008, accent)
    if chorus:
        desk.play("flute", _flute(key.pitch(_above(score, note)), seconds, breath), start - 0.01, 0.75 * accent)
        desk.play("mandolin", strings[pitch], start, 0.8 * accent)
    elif not call:
        desk.play("flute", _flute(pitch + 12, seconds, breath), start - 0.01, 0.85 * accent)
        desk.play("mandolin", strings[pitch], start, 0.5 * accent)


def _above(score: Score, note: Note) -> int:
    """The step of a second voice: the next tone of the chord, or a third above a passing tone."""
    key, tones = score.progressions.key, score.chord_at(note.beat).tones
    if key.pitch(note.step) % 12 not in tones:
        return note.step + 2
    return next(step for step in range(note.step + 2, note.step + 5) if key.pitch(step) % 12 in tones)


def _play_arpeggios(desk: Desk, score: Score, strings: dict[int, Float32], rng: np.random.Generator) -> None:
    """Where nobody sings, the mandolin walks up and down the chord in eighths."""
    order = (0, 2, 1, 3, 2, 4, 3, 1)
    for part in score.parts:
        if part.name not in ("intro", "break", "outro"):
            continue
        for eighth in range(2 * part.first * score.meter, 2 * (part.first + part.bars) * score.meter):
            beat = eighth / 2.0
            pitches = voicing(score.chord_at(beat), 60, 5)
            level = (0.62 if eighth % 2 == 0 else 0.45) * float(np.exp(rng.normal(0.0, 0.1)))
            desk.play("mandolin", strings[pitches[order[eighth % (2 * score.meter) % 8]]], score.swung(beat), level)
