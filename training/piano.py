"""Textures of a piano alone: broken chords, oom-pah, chorales, two voices, octaves, nocturnes; hands not together."""

from __future__ import annotations

import numpy as np

from training.song import Song

ALBERTI = (0, 2, 1, 2)


def _left(song: Song, bar: int, kind: str) -> None:
    rng, meter, div = song.rng, song.style.meter, song.style.div
    first = bar * meter
    if kind == "alberti":
        per = 4 if div == 4 else 3
        per = per if song.fast else max(per // 2, 1) if div == 4 else 3
        for step in range(meter * per):
            tones = song.chord_tones(first + step / per, 46, 3)
            song.add(
                first + step / per,
                1.1 / per,
                0,
                float(tones[ALBERTI[step % 4] if per != 3 else step % 3]),
                0.45 if step % per else 0.55,
                song.hand,
            )
    elif kind == "oom-pah":
        for beat in range(meter):
            tones = song.chord_tones(first + beat, 36 if beat == 0 else 50, 3)
            if beat == 0:
                song.add(first, 1.0, 0, float(tones[0]), 0.7, song.hand)
            else:
                for tone in tones:
                    song.add(first + beat, 0.6, 0, float(tone), 0.4, song.hand)
    elif kind == "nocturne":
        per = int(song.per)
        for step in range(meter * per):
            tones = song.chord_tones(first + step / per, 38, 6)
            song.add(
                first + step / per,
                1.5,
                0,
                float(tones[(0, 2, 4, 5, 4, 2, 3, 1)[step % 8 if per == 4 else step % 6] % len(tones)]),
                0.4,
                song.hand,
            )
    elif kind == "chords":
        for beat in range(meter):
            if beat and rng.random() < 0.35:
                continue
            tones = song.chord_tones(first + beat, 45, 3)
            roll = 0.03 if rng.random() < song.rolls else 0.0
            for number, tone in enumerate(tones):
                song.add(first + beat, 0.9, 0, float(tone), 0.5, song.hand + number * roll)
    elif kind == "repeated":
        for step in range(meter * 2):
            for tone in song.chord_tones(first + step / 2, 48, 3):
                song.add(first + step / 2, 0.35, 0, float(tone), 0.45 if step % 2 else 0.5, song.hand)
    elif kind == "octaves":
        for beat in range(meter):
            if rng.random() < 0.8:
                root = song.chord_tones(first + beat, 33, 1)[0]
                for tone in (root, root + 12):
                    song.add(first + beat, 0.9, 0, float(tone), 0.6, song.hand)
    else:  # a running voice
        _run(song, first, 0, 3, song.hand)


def _run(song: Song, first: float, voice: int, octave: int, late: float) -> None:
    rng, meter = song.rng, song.style.meter
    per = int(song.per)
    degree = int(rng.integers(0, 7))
    rest = rng.random() < 0.15
    for step in range(meter * per):
        degree = int(np.clip(degree + rng.choice((-1, 1, 1, -1, 2, -2, 3)), -4, 12))
        if (rest and step < per) or rng.random() < 0.06:
            continue
        song.add(first + step / per, 0.95 / per, voice, song.pitch(degree, octave), 0.6 if step % per else 0.7, late)


def _right(song: Song, bar: int, kind: str) -> None:
    rng, meter = song.rng, song.style.meter
    first = bar * meter
    if kind == "run":
        _run(song, first, 0, 5, 0.0)
    elif kind == "chorale":
        for beat in range(meter):
            tones = song.chord_tones(first + beat, 60 + int(rng.integers(0, 5)), 3)
            for tone in tones:
                song.add(first + beat, 0.97, 0, float(tone), 0.55)
            if rng.random() < 0.3:
                song.add(first + beat + 0.5, 0.45, 0, float(tones[-1]) + 2.0, 0.5)
    elif kind == "melody":
        for at, length in song.tune[bar % len(song.tune)]:
            song.degree = int(np.clip(song.degree + rng.integers(-2, 3), -1, 12))
            pitch = song.pitch(song.degree, 5)
            lead = -float(rng.uniform(0.0, song.lead))
            song.add(first + at, length, 0, pitch, 0.9 * float(rng.uniform(0.8, 1.1)), lead)
            if song.doubled:
                song.add(first + at, length, 0, pitch - 12, 0.6, lead)
            if rng.random() < 0.05:  # a grace note
                song.add(first + at, 0.1, 0, pitch + 2.0, 0.5, lead - 0.07)


def _tune(song: Song) -> list[tuple[float, float]]:
    """A bar of melody."""
    rng, meter = song.rng, song.style.meter
    at, result = 0.0 if rng.random() < 0.85 else 0.5, []
    choices = (0.5, 1.0, 1.5, 2.0, 0.25, 0.75) if song.style.div == 4 else (1 / 3, 2 / 3, 1.0, 4 / 3, 2.0)
    weights = np.array((4, 4, 1, 1.5, 1, 1)[: len(choices)]) ** rng.uniform(0.4, 2.0)
    while at < meter - 0.05:
        length = float(rng.choice(choices, p=weights / weights.sum()))
        if rng.random() < 0.92:
            result.append((at, min(length, meter - at)))
        at += length
    return result


def play_piano(song: Song) -> None:
    """A piece in sections, each with a texture for either hand."""
    rng, style = song.rng, song.style
    song.fast = float(np.diff(song.grid.beats).mean()) > 0.5
    song.per = float(rng.choice((2, 4) if song.fast else (2, 2, 1))) if style.div == 4 else 3.0
    song.hand = float(rng.normal(0.0, 0.008))
    song.rolls = float(rng.choice((0.0, 0.0, 0.3, 0.8)))
    song.lead = float(rng.choice((0.0, 0.015, 0.035)))
    song.jitter = float(rng.choice((0.003, 0.007, 0.012)))
    song.degree = int(rng.integers(3, 9))
    bar = 0
    while bar < song.grid.bars:
        song.doubled = rng.random() < 0.2
        left = str(rng.choice(("alberti", "oom-pah", "nocturne", "chords", "repeated", "octaves", "run", "none")))
        right = str(rng.choice(("melody", "melody", "run", "chorale", "none" if left != "none" else "run")))
        song.tune = [_tune(song) for _ in range(int(rng.integers(1, 4)))]
        stop = min(bar + int(rng.choice((2, 4, 4, 8))), song.grid.bars)
        loud = float(rng.choice((0.4, 0.7, 1.0)))
        begin = len(song.performance.notes)
        for one in range(bar, stop):
            _left(song, one, left)
            _right(song, one, right)
        notes = song.performance.notes
        notes[begin:] = [(*note[:4], note[4] * loud, note[5]) for note in notes[begin:]]
        bar = stop
