"""The melody players of the embedded song: fiddle, flute and mandolin."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfilt

from onbeat._shapes import Float32
from onbeat.examples.arrangement import Part
from onbeat.examples.harmony import voicing
from onbeat.examples.mixing import Desk
from onbeat.examples.score import Score
from onbeat.examples.synth import RATE, decay, hertz, oscillate, pluck, shape, swell, vibrato, wave_table
from onbeat.examples.tune import Note


def _fiddle(pitch: float, seconds: float) -> Float32:
    """A bowed, reedy tone: two harmonic tones a little apart, a body formant, vibrato that opens on long notes."""
    length = int(seconds * RATE)
    table = wave_table(hertz(pitch), 1.25, 1500.0)
    bend = vibrato(length, 5.6, 16.0, 0.16)
    tone = oscillate(table, hertz(pitch), length, bend) + 0.35 * oscillate(
        table, hertz(pitch + 0.04), length, bend, 0.3
    )
    return shape(tone, swell(length, 0.035, 0.07), 0.75 + 0.25 * decay(length, 0.25))


def _flute(pitch: float, seconds: float, breath: Float32) -> Float32:
    """A wooden flute: few harmonics, a breath of noise at the start, a slow vibrato."""
    length = int(seconds * RATE)
    tone = oscillate(wave_table(hertz(pitch), 2.3), hertz(pitch), length, vibrato(length, 4.8, 11.0, 0.2))
    air = np.resize(breath, length) * (0.05 + 0.2 * decay(length, 0.03))
    return shape(tone + air, swell(length, 0.045, 0.08), 0.8 + 0.2 * decay(length, 0.3))


def _breath(rng: np.random.Generator) -> Float32:
    sections = butter(1, [900.0, 4500.0], btype="bandpass", fs=RATE, output="sos")
    noise = np.asarray(sosfilt(sections, rng.standard_normal(4 * RATE)))
    return (noise / np.abs(noise).max()).astype(np.float32)


def play_tune(desk: Desk, score: Score, rng: np.random.Generator) -> None:
    """Sing the tune: in the verse fiddle and flute take turns, in the chorus all play, the flute a third above."""
    desk.track("fiddle", 0.25, 0.15, 0.3)
    desk.track("flute", 0.185, -0.25, 0.35)
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
