"""A bank of single notes and drum strokes, rendered dry by fluidsynth from a General MIDI soundfont, kept at 22050 Hz.

Usage: ``python -m training.bank BANK.npz [SOUNDFONT]``. The soundfont is MuseScore_General (MIT). Mixing songs from a
bank is fifty times as fast as rendering each, and puts every note on its time to a sample.
"""

# ruff: noqa: T201
from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import soxr

RATE = 22050
SOUNDFONT = "/usr/share/sounds/sf3/MuseScore_General.sf3"
PITCHES = np.arange(31, 97, 5)
LENGTH = int(2.6 * RATE)
STROKE = int(1.2 * RATE)
KITS = (0, 8, 16, 24, 25, 32, 40, 48)
KEYS = np.arange(35, 82)
SOFT_TOO = (0, 1, 2, 4, 24, 25, 26, 40, 48)  # programs that are kept softly struck as well


def _synth(soundfont: str) -> tuple[Any, int]:
    import fluidsynth

    synth = fluidsynth.Synth(samplerate=44100.0, gain=1.0)
    synth.setting("synth.reverb.active", 0)
    synth.setting("synth.chorus.active", 0)
    return synth, synth.sfload(soundfont)


def _note(synth: Any, channel: int, pitch: int, velocity: int, hold: int, length: int) -> np.ndarray:
    synth.noteon(channel, int(pitch), velocity)
    parts = [synth.get_samples(2 * hold)]
    synth.noteoff(channel, int(pitch))
    parts.append(synth.get_samples(2 * (length - hold)))
    synth.system_reset()
    synth.get_samples(4096)  # what is left in its buffer
    stereo = np.concatenate(parts).reshape(-1, 2).astype(np.float32) / 32768.0
    return soxr.resample(stereo.mean(axis=1), 44100, RATE)[:length]


def _scaled(sounds: np.ndarray) -> np.ndarray:
    peak = np.abs(sounds).max(axis=-1, keepdims=True)
    return np.round(sounds / np.maximum(peak, 1e-4) * 32000.0).astype(np.int16)


def build(soundfont: str = SOUNDFONT) -> dict[str, np.ndarray]:
    """``notes`` (entries, pitches, samples), ``programs``, ``velocities``, ``strokes`` (kits, keys, samples)."""
    synth, font = _synth(soundfont)
    entries = [(program, 95) for program in range(119)] + [(p, v) for p in SOFT_TOO for v in (40, 68)]
    notes = np.zeros((len(entries), len(PITCHES), LENGTH), np.int16)
    for index, (program, velocity) in enumerate(entries):
        for column, pitch in enumerate(PITCHES):
            synth.program_select(0, font, 0, program)
            notes[index, column] = _scaled(_note(synth, 0, pitch, velocity, LENGTH - 600, LENGTH))
        print(program, velocity, flush=True)
    strokes = np.zeros((len(KITS), len(KEYS), STROKE), np.int16)
    for index, kit in enumerate(KITS):
        for column, key in enumerate(KEYS):
            synth.program_select(9, font, 128, kit)
            sound = _note(synth, 9, key, 100, STROKE // 2, STROKE)
            strokes[index, column] = np.round(np.clip(sound / 0.9, -1, 1) * 32000.0)
    return {
        "notes": notes,
        "programs": np.array([program for program, _ in entries]),
        "velocities": np.array([velocity for _, velocity in entries]),
        "strokes": strokes,
    }


if __name__ == "__main__":
    bank = build(*sys.argv[2:3])
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, values in bank.items():
        np.save(folder / f"{name}.npy", values)
