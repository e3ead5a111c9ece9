"""A small band for the tests: drums, bass, chords, at known times."""

from __future__ import annotations

import numpy as np
import soxr

from onbeat.music.audio import Audio

RATE = 44100
HEARD_RATE = 22050


def decay(tone: float, seconds: float, halving: float) -> np.ndarray:
    times = np.arange(round(seconds * RATE)) / RATE
    return np.sin(2 * np.pi * tone * times) * np.exp(-times / halving)


def click() -> np.ndarray:
    return decay(1000.0, 0.02, 0.004)


def kick() -> np.ndarray:
    times = np.arange(round(0.25 * RATE)) / RATE
    return np.sin(2 * np.pi * (50 * times + 6 * (1 - np.exp(-times / 0.03)))) * np.exp(-times / 0.09)


def snare(rng: np.random.Generator) -> np.ndarray:
    noise = rng.standard_normal(round(0.2 * RATE))
    return 0.5 * noise * np.exp(-np.arange(len(noise)) / RATE / 0.05) + decay(190.0, 0.2, 0.06) * 0.5


def hat(rng: np.random.Generator, level: float = 0.3) -> np.ndarray:
    noise = np.diff(rng.standard_normal(round(0.05 * RATE)), prepend=0.0)
    return level * noise * np.exp(-np.arange(len(noise)) / RATE / 0.012)


def piano(tone: float, seconds: float = 0.8, level: float = 0.3, attack: float = 0.004) -> np.ndarray:
    times = np.arange(round(seconds * RATE)) / RATE
    sound = sum(np.sin(2 * np.pi * tone * k * times) * np.exp(-times * (2 + k)) / k for k in range(1, 7))
    return level * sound * np.minimum(times / attack, 1.0) * np.minimum((seconds - times) / 0.02, 1.0)


def mix(seconds: float, events: list[tuple[float, np.ndarray]], level: float = 0.7, rate: int = HEARD_RATE) -> Audio:
    """Sounds at their times, at a peak level."""
    sound = np.zeros(round(seconds * RATE))
    for at, samples in events:
        begin = round(at * RATE)
        if 0 <= begin < len(sound):
            sound[begin : begin + len(samples)] += samples[: len(sound) - begin]
    sound *= level / max(np.abs(sound).max(), 1e-9)
    return Audio(soxr.resample(sound, RATE, rate).astype(np.float32), rate)


def beat_times(bpm: float, seconds: float, first: float = 0.237) -> np.ndarray:
    return np.arange(first, seconds, 60.0 / bpm)


def click_track(bpm: float, seconds: float = 30.0, first: float = 0.237) -> tuple[np.ndarray, Audio]:
    beats = beat_times(bpm, seconds, first)
    return beats, mix(seconds, [(t, click()) for t in beats])
