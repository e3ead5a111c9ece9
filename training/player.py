"""Playing a performance: notes from a bank, moved to their pitch and time, mixed to mono at 22050 Hz."""

# ruff: noqa: E501
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numba
import numpy as np

from training.bank import PITCHES, RATE
from training.song import Performance

LOOP_BEGIN, LOOP_END = 1.0, 2.3  # [s] a held note of a bank goes to and fro between these


@dataclass(frozen=True)
class Bank:
    """``notes`` (entries, pitches, samples), ``strokes`` (kits, keys, samples) int16; ``families`` of entries.

    ``made`` is the share of voices that play timbres of numbers.
    """

    notes: np.ndarray
    strokes: np.ndarray
    families: dict[str, np.ndarray]
    made: float = 0.15


def load(folder: Path) -> Bank:
    """The bank that ``training.bank`` wrote."""
    programs = np.load(folder / "programs.npy")
    ranges = {
        "piano": (0, 8), "mallet": (8, 16), "organ": (16, 24), "guitar": (24, 32), "bass": (32, 40), "strings": (40, 56),
        "brass": (56, 64), "reed": (64, 80), "lead": (80, 88), "pad": (88, 96), "effect": (96, 104), "folk": (104, 112),
    }  # fmt: skip
    families = {name: np.flatnonzero((programs >= low) & (programs < high)) for name, (low, high) in ranges.items()}
    return Bank(np.load(folder / "notes.npy", mmap_mode="r"), np.load(folder / "strokes.npy"), families)


@numba.njit(cache=True)
def _add(mix, sound, begin, count, step, glide, gain, release, held):
    """Add ``count`` samples of a sound read at ``step``, gliding in from ``glide``, let go at ``held``."""
    place, level = 0.0, 1.0
    low, high = LOOP_BEGIN * RATE, LOOP_END * RATE
    direction = 1.0
    for k in range(count):
        if k >= held:
            level *= release
            if level < 1e-3:
                break
        whole = int(place)
        if whole + 1 >= len(sound):
            break
        part = place - whole
        at = begin + k
        if 0 <= at < len(mix):
            mix[at] += gain * level * ((1.0 - part) * sound[whole] + part * sound[whole + 1])
        speed = step * (1.0 + glide * np.exp(-k / (0.06 * RATE)))
        place += direction * speed
        if direction > 0 and place > high:
            direction = -1.0
        elif direction < 0 and place < low:
            direction = 1.0


VOICES = (("bass",), ("piano", "guitar", "organ", "strings", "pad", "mallet", "brass"), ("pad", "strings", "organ", "guitar", "piano"),
          ("lead", "reed", "brass", "strings", "mallet", "folk", "guitar", "piano"), ("reed", "strings", "folk", "mallet", "brass"))  # fmt: skip
SETS = {
    "chip": (("lead", "synthetic"),) * 5, "synth pads": (("bass", "synthetic"), ("pad", "synthetic"), ("pad", "effect"), ("lead", "synthetic"), ("pad",)),
    "ambient arpeggio": (("synthetic", "pad"), ("synthetic", "mallet", "piano", "guitar"), ("pad", "effect"), ("lead", "synthetic"), ("pad",)),
    "strings": (("strings",),) * 5, "brass and winds": (("brass",), ("brass", "reed"), ("brass",), ("brass", "reed"), ("reed",)),
}  # fmt: skip


def choose_voices(style: str, bank: Bank, rng: np.random.Generator) -> np.ndarray:
    """An entry of the bank for each of the five voices of a style."""
    groups = SETS.get(style, VOICES)
    if style.startswith("piano"):
        groups = (("piano", "piano", "piano", "guitar", "mallet"),) * 5 if rng.random() < 0.15 else (("piano",),) * 5
    chosen = []
    for group in groups:
        names = [name for name in group if len(bank.families.get(name, ()))] or list(bank.families)
        if rng.random() < bank.made and len(bank.families.get("synthetic", ())):
            names = ["synthetic"]
        entries = bank.families[str(rng.choice(names))]
        if style.startswith("piano") and names == ["piano"] and rng.random() < 0.7:
            entries = entries[:3] if rng.random() < 0.5 else entries[-len(entries) // 3 :]
        chosen.append(int(rng.choice(entries)))
    return np.array(chosen)


def play(performance: Performance, bank: Bank, rng: np.random.Generator, seconds: float) -> np.ndarray:
    """Samples (N,) float32, peak about 1."""
    mix = np.zeros(int(seconds * RATE), np.float32)
    voices = choose_voices(performance.style, bank, rng)
    gains = 10.0 ** rng.normal(0.0, 0.25, 5) * np.array([1.0, 0.55, 0.4, 0.7, 0.6])
    ring = np.exp(-1.0 / (RATE * 10.0 ** rng.uniform(-2.0, -0.7, 5)))
    pedal = performance.style.startswith("piano") and rng.random() < 0.6
    tuning = float(rng.uniform(-0.5, 0.5)) if rng.random() < 0.3 else 0.0
    for time, length, voice, pitch, amplitude, glide in performance.notes:
        pitch = pitch + tuning
        column = int(np.abs(PITCHES - pitch).argmin())
        step = 2.0 ** ((pitch - PITCHES[column]) / 12.0)
        held = int(length * RATE) if not pedal else int((length + 0.6) * RATE)
        sound = bank.notes[voices[voice], column]
        glide = 2.0 ** (glide / 12.0) - 1.0
        _add(
            mix,
            sound,
            round(time * RATE),
            4 * RATE,
            step,
            glide,
            gains[voice] * amplitude**1.5 / 32768.0,
            ring[voice],
            held,
        )
    kits = rng.integers(0, len(bank.strokes), 2)
    tune = 2.0 ** rng.uniform(-0.35, 0.35, 100)
    loud = 10.0 ** rng.normal(0.1, 0.25)
    for time, key, amplitude in performance.strokes:
        sound = bank.strokes[kits[int(key % 7 == 0)], int(key) - 35]
        _add(
            mix, sound, round(time * RATE), len(sound), tune[key], 0.0, loud * amplitude**1.5 / 32768.0, 1.0, len(sound)
        )
    return mix / max(float(np.abs(mix).max()), 1e-6)
