"""Clips for training: composed, played, recorded; of each the bands that onbeat hears, and its beats.

Usage: ``python -m training.clips BANK_FOLDER OUT.npz FIRST_SEED COUNT [validation] [made] [hard]``.
``made``: more timbres of numbers, of a third set; ``hard``: more of what is hard to hear.
"""

# ruff: noqa: T201
from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from onbeat.music.hearing import BANDS_PER_OCTAVE, ONSET_HOP, ONSET_WINDOW, SILENCE
from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands
from training import timbres
from training.bank import RATE
from training.pattern import SECONDS, compose
from training.player import Bank, load, play
from training.rooms import record
from training.song import Performance

WINDOW, HOP = 2 * round(ONSET_WINDOW * RATE / 2), round(ONSET_HOP * RATE)
FRAMES = round(SECONDS * RATE) // HOP


def bands_of(samples: np.ndarray) -> np.ndarray:
    """Log10 power (N, B) float16, as :func:`onbeat.music.hearing.hear` has it."""
    stream = SpectrumStream(WINDOW, HOP)
    spectra = np.concatenate([stream.push(samples), stream.finish()])
    weights = log_bands(bin_frequencies(WINDOW, RATE), 40.0, 0.45 * RATE, BANDS_PER_OCTAVE)
    return np.log10(np.maximum(spectra @ weights, SILENCE)).astype(np.float16)


def bank_for(folder: Path, validation: bool, more: bool = False) -> Bank:
    """The soundfont's notes and made timbres for training; for validation other made timbres alone."""
    if validation:
        notes = timbres.notes(9, 42)
        everything = np.arange(len(notes))
        families = {
            "synthetic": everything,
            "piano": everything[3::7],
            "bass": everything[:6],
            "lead": everything[4::7],
        }
        return Bank(notes, timbres.strokes(9, 5), families)
    bank = load(folder)
    made = timbres.notes(2 if more else 1, 84 if more else 42)
    families = {**bank.families, "synthetic": np.arange(len(made)) + len(bank.notes)}
    return Bank(
        np.concatenate([bank.notes, made]),
        np.concatenate([bank.strokes, timbres.strokes(2 if more else 1, 8 if more else 4)]),
        families,
        0.5 if more else 0.15,
    )


def make(seed: int, bank: Bank, hard: bool = False) -> tuple[np.ndarray, Performance]:
    """Samples of a clip and what was played."""
    performance = compose(seed, hard=hard)
    rng = np.random.default_rng([seed, 8])
    return record(play(performance, bank, rng, SECONDS), rng), performance


def main() -> None:
    """Write features and beats of many clips."""
    folder, out, first, count = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    validation = "validation" in sys.argv
    bank = bank_for(folder, validation, "made" in sys.argv)
    bands, beats, downs, styles, sounds = [], [], [], [], []
    begun = time.monotonic()
    for seed in range(first, first + count):
        samples, performance = make(seed, bank, "hard" in sys.argv)
        inside = (performance.beats >= 0) & (performance.beats < SECONDS)
        bands.append(bands_of(samples)[:FRAMES])
        beats.append(performance.beats[inside])
        downs.append(performance.downbeats[inside])
        styles.append(performance.style)
        if validation:
            sounds.append(np.round(samples * 32767).astype(np.int16))
        if seed % 50 == 49:
            print(seed, f"{time.monotonic() - begun:.0f} s", flush=True)
    ends = np.cumsum([len(one) for one in beats])
    np.savez(
        out,
        bands=np.array(bands),
        beats=np.concatenate(beats),
        downs=np.concatenate(downs),
        ends=ends,
        styles=np.array(styles),
        sounds=np.array(sounds),
    )


if __name__ == "__main__":
    main()
