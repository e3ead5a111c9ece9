"""The pattern generator: seeded songs in many styles as lists of notes and strokes, with their exact beats and bars."""

from __future__ import annotations

import numpy as np

from training.loops import draw_loop
from training.piano import play_piano
from training.song import Performance, Song
from training.styles import KEYS, STYLES

SECONDS = 20.0
STRENGTH = {"X": 1.0, "x": 0.75, "o": 0.3}


def _accent(place: float, meter: int) -> float:
    """A little louder on the first beat and on beats."""
    return 1.0 if place % meter == 0 else 0.88 if place % 1 == 0 else 0.78


def play_drums(song: Song, bars: range, fill: bool) -> None:
    """Drums over some bars; strokes of a line share its lateness."""
    rng, style, grid = song.rng, song.style, song.grid
    for letter, patterns in song.drum_parts.items():
        pattern, key, level, late = patterns
        length = style.meter * style.div
        for bar in bars:
            begin = bar * length % len(pattern)
            for step, mark in enumerate(pattern[begin : begin + length]):
                if mark == "." or (mark == "?" and rng.random() < 0.5) or (mark == "o" and rng.random() < 0.15):
                    continue
                beat = bar * style.meter + step / style.div
                if fill and bar == bars[-1] and step >= length - 2 * style.div and letter not in "KC":
                    continue
                strength = STRENGTH.get(mark, 0.7) * level * float(rng.uniform(0.8, 1.05))
                song.performance.strokes.append(
                    (float(grid.time(beat)) + late + rng.normal() * song.jitter, key, strength)
                )
    if fill:
        first = (bars[-1] + 1) * style.meter - 2
        steps = 2 * style.div
        for step in range(steps):
            if rng.random() < 0.7:
                key = (38, 48, 47, 45, 43)[min(step * 5 // steps, 4)] if rng.random() < 0.8 else 38
                song.performance.strokes.append(
                    (float(grid.time(first + step / style.div)), key, float(rng.uniform(0.5, 1.0)))
                )
        if rng.random() < 0.6:
            song.performance.strokes.append(
                (float(grid.time(first + 2)), int(rng.choice((49, 57))), float(rng.uniform(0.5, 1.0)))
            )


def choose_drums(song: Song) -> None:
    """A pattern for each letter of the style, mutated a little, some left out."""
    rng, style = song.rng, song.style
    song.drum_parts = {}
    loop = {letter: (line,) for letter, line in draw_loop(rng).items()} if "loop" in style.name.split() else {}
    for letter, choices in (loop or style.drums).items():
        pattern = list(str(rng.choice(choices)))
        for step in range(len(pattern)):
            if rng.random() < (0.0 if loop else 0.04):
                pattern[step] = "." if pattern[step] != "." else str(rng.choice(list("xo")))
        if not set(pattern) - {"."} or rng.random() < 0.1:
            continue
        late = float(rng.normal(0.0, 0.004)) + (
            float(rng.uniform(0, 0.015)) if letter == "S" and rng.random() < 0.3 else 0.0
        )
        level = float(10 ** rng.normal(0.0, 0.15)) * (0.45 if letter in "HODPTaB" else 0.9)
        song.drum_parts[letter] = ("".join(pattern), int(rng.choice(KEYS[letter])), level, late)


def play_bass(song: Song, bars: range, pattern: str, voice: int, late: float) -> None:
    """A bass line."""
    style, rng = song.style, song.rng
    steps = [step for step, mark in enumerate(pattern) if mark != "."]
    for bar in bars:
        for index, step in enumerate(steps):
            if rng.random() < 0.03:
                continue
            beat = bar * style.meter + step / style.div
            root = int(song.chords[min(int(beat), len(song.chords) - 1)])
            move = {"r": 0, "5": 4, "3": 2, "8": 7}.get(pattern[step], int(rng.integers(-2, 5)))
            following = steps[index + 1] if index + 1 < len(steps) else len(pattern)
            length = (following - step) / style.div * (0.9 if rng.random() < 0.8 else 0.5)
            song.add(
                beat,
                length,
                voice,
                song.pitch(root % 7 + move, 2 if rng.random() < 0.9 else 3),
                0.9 * _accent(beat, style.meter),
                late,
            )


def play_chords(song: Song, bars: range, pattern: str, voice: int, kind: str, low: float, late: float) -> None:
    """Chords, struck or broken, short or held."""
    style, rng = song.style, song.rng
    count = int(rng.integers(3, 5))
    order = rng.permutation(6) if rng.random() < 0.3 else np.array([0, 1, 2, 3, 2, 1])
    steps = [step for step, mark in enumerate(pattern) if mark != "."]
    for bar in bars:
        for index, step in enumerate(steps):
            beat = bar * style.meter + step / style.div
            tones = song.chord_tones(beat + 0.01, low, count)
            following = steps[index + 1] if index + 1 < len(steps) else len(pattern)
            held = (following - step) / style.div
            length = held * 0.97 if pattern[step] == "X" or kind == "held" else min(held, 0.4)
            loud = _accent(beat, style.meter)
            if kind == "broken":
                song.add(beat, held, voice, float(tones[order[index % 6] % len(tones)]), 0.8 * loud, late)
                continue
            for number, tone in enumerate(tones):
                song.add(
                    beat, length, voice, float(tone), 0.5 * loud, late + (number * 0.008 if kind == "strummed" else 0.0)
                )


def motif(song: Song) -> list[tuple[float, float]]:
    """Beats and lengths of a tune of one or two bars: strong places are likelier, with syncopation and pick-ups."""
    rng, style = song.rng, song.style
    bars = int(rng.choice((1, 2, 2)))
    steps = np.arange(bars * style.meter * style.div)
    div = style.div
    chance = np.where(steps % div == 0, 0.65, np.where((div % 2 == 0) & (steps % max(div // 2, 1) == 0), 0.4, 0.12))
    chance = chance * rng.uniform(0.4, 1.25)
    if rng.random() < 0.25:
        chance = chance[::-1].copy()  # syncopated: off the beat more than on it
    if rng.random() < 0.3:
        chance[steps % div == 0] *= 0.4
    at = np.flatnonzero(rng.random(len(steps)) < chance)
    if not len(at):
        at = np.array([0])
    lengths = np.diff(np.append(at, len(steps))) / div
    return [(float(a) / div, float(min(length, 2.5))) for a, length in zip(at, lengths, strict=True)]


def play_melody(song: Song, bars: range, voice: int, octave: int, late: float, gliding: bool) -> None:
    """A tune: motifs that come again, a walk on the scale towards tones of the chord."""
    rng, style = song.rng, song.style
    motifs = [motif(song) for _ in range(int(rng.integers(1, 4)))]
    degree, bar = int(rng.integers(0, 8)), bars[0]
    shift = float(rng.choice((0.0, 0.0, 0.0, -0.5, 0.5)))  # a tune that begins before or after the bar
    while bar < bars.stop:
        if rng.random() < 0.12:
            bar += 1
            continue
        for at, length in motifs[rng.integers(len(motifs))]:
            beat = bar * style.meter + at + shift
            if beat < 0 or beat > bars.stop * style.meter:
                continue
            degree = int(np.clip(degree + rng.integers(-2, 3), -3, 11))
            if at % 1 == 0 and rng.random() < 0.6:
                root = int(song.chords[min(int(beat), len(song.chords) - 1)])
                degree = int(
                    min(
                        (root + step + octaves for step in (0, 2, 4) for octaves in (-7, 0, 7)),
                        key=lambda d: abs(d - degree),
                    )
                )
            glide = float(rng.uniform(-2.5, 2.5)) if gliding and rng.random() < 0.5 else 0.0
            delay = float(rng.uniform(0.0, 0.04)) if gliding else 0.0
            song.add(
                beat,
                length * float(rng.uniform(0.6, 1.0)),
                voice,
                song.pitch(degree, octave),
                0.8 * _accent(beat, style.meter),
                late + delay,
                glide,
            )
        bar += 2 if len(motifs) else 1


def play_band(song: Song) -> None:
    """Sections of a few bars each, in each of which some of the parts play."""
    rng, style, grid = song.rng, song.style, song.grid
    choose_drums(song)
    late = rng.normal(0.0, 0.005, 6)
    has = rng.random(6) < (0.97, 0.9, 0.85, 0.35, 0.6, 0.25)
    has[0] |= not style.chords
    bass = str(rng.choice(style.bass)) if style.bass else ""
    chords = [str(rng.choice(style.chords)) for _ in range(2)] if style.chords else []
    kinds = rng.choice(("struck", "broken", "strummed", "held"), 2, p=(0.4, 0.3, 0.15, 0.15))
    if style.name in ("chip", "ambient arpeggio") and rng.random() < 0.7:
        kinds[0] = "broken"
    bar = 0
    while bar < grid.bars:
        bars = range(bar, min(bar + int(rng.choice((4, 4, 8, 2 if grid.meter > 3 else 6))), grid.bars))
        playing = has & (rng.random(6) < (0.88, 0.9, 0.9, 0.8, 0.85, 0.8))
        if (not playing.any() or (not style.chords and not style.name.startswith("piano"))) and rng.random() < 0.9:
            playing = has.copy()
        if playing[0] and song.drum_parts:
            play_drums(song, bars, rng.random() < 0.3)
        if playing[1] and bass:
            play_bass(song, bars, bass, 0, late[1])
        if playing[2] and chords:
            play_chords(song, bars, chords[0], 1, str(kinds[0]), float(52), late[2])
        if playing[3] and chords:
            play_chords(
                song,
                bars,
                chords[1] if kinds[1] != "held" else "X" + "." * (len(chords[1]) - 1),
                2,
                str(kinds[1]),
                float(60),
                late[3],
            )
        if playing[4] and (style.chords or rng.random() < 0.1):
            play_melody(song, bars, 3, 5, late[4], rng.random() < 0.4)
        if playing[5] and style.chords:
            play_melody(song, bars, 4, 4, late[5], False)
        bar = bars.stop


def compose(seed: int, seconds: float = SECONDS, style: str | None = None, hard: bool = False) -> Performance:
    """One clip; the same seed gives the same notes. ``hard``: of loops, solo piano and songs without drums alone."""
    rng = np.random.default_rng([seed, 7])
    weights = np.array([one.weight for one in STYLES])
    if hard:
        weights = weights * [4.0 if "loop" in one.name else not one.drums for one in STYLES]
    chosen = STYLES[rng.choice(len(STYLES), p=weights / weights.sum())]
    if style is not None:
        chosen = next(one for one in STYLES if one.name == style)
    song = Song(chosen, rng, seconds)
    if chosen.name.startswith("piano"):
        play_piano(song)
    else:
        play_band(song)
    return song.performance
