"""Timbres made from numbers alone: additive, frequency modulation, pulses, formants, plucked strings; drums of sweeps and noise.

Two sets from two seeds: one joins the soundfont's in training, the other, with other parameters, sounds in the validation.
"""

# ruff: noqa: E501
from __future__ import annotations

import numpy as np
from scipy.signal import butter, lfilter, sosfilt

from training.bank import KEYS, LENGTH, PITCHES, RATE, STROKE

KINDS = ("additive", "pulse", "fm", "pluck", "formant", "saw", "bell")


def _envelope(rng: np.random.Generator, decaying: bool) -> np.ndarray:
    time = np.arange(LENGTH) / RATE
    attack = 10.0 ** rng.uniform(-3.0, -1.1 if not decaying else -2.2)
    rise = np.minimum(time / attack, 1.0)
    fall = np.exp(-time / 10.0 ** rng.uniform(-0.8, 0.4)) if decaying else 0.6 + 0.4 * np.exp(-time / 0.2)
    return rise * fall


def _tone(kind: str, frequency: float, rng: np.random.Generator) -> np.ndarray:
    time = np.arange(LENGTH) / RATE
    count = max(int(9000 / frequency), 1)
    harmonics = np.arange(1, min(count, 40) + 1)
    if kind == "fm":
        ratio, index = float(rng.choice((1, 2, 3, 0.5, 1.41, 3.5))), rng.uniform(0.5, 5)
        return np.sin(
            2 * np.pi * frequency * time
            + index * np.exp(-time / rng.uniform(0.05, 1.5)) * np.sin(2 * np.pi * frequency * ratio * time)
        )
    if kind == "bell":
        partials = frequency * np.array([1, 2.0, 2.76, 4.1, 5.4]) * rng.uniform(0.98, 1.02, 5)
        partials = partials[partials < 9000]
        return (
            np.sin(2 * np.pi * partials[:, None] * time)
            * np.exp(-time * partials[:, None] / frequency * rng.uniform(0.5, 3))
        ).sum(axis=0)
    if kind == "pluck":
        period = max(int(RATE / frequency), 2)
        burst = np.zeros(LENGTH)
        burst[:period] = rng.uniform(-1, 1, period)
        mixing, gain = rng.uniform(0.3, 0.5), rng.uniform(0.985, 0.998)
        feedback = np.zeros(period + 2)
        feedback[0], feedback[period], feedback[period + 1] = 1.0, -gain * (1 - mixing), -gain * mixing
        return lfilter([1.0], feedback, burst)
    if kind == "pulse":
        amplitude = np.sin(np.pi * harmonics * rng.choice((0.5, 0.25, 0.125))) / harmonics
    elif kind == "formant":
        at = harmonics * frequency
        amplitude = (
            sum(np.exp(-((at - f) ** 2) / (2 * 150.0**2)) for f in rng.uniform((300, 900, 2200), (800, 2000, 3200)))
            + 0.05 / harmonics
        )
    else:
        amplitude = harmonics ** -rng.uniform(0.8, 2.2) * (
            rng.uniform(0, 1, len(harmonics)) if kind == "additive" else 1.0
        )
    wobble = 1.0 + 0.004 * rng.choice((0.0, 1.0)) * np.sin(2 * np.pi * rng.uniform(4.5, 6.5) * time)
    phase = 2 * np.pi * frequency * np.cumsum(wobble) / RATE
    phases = rng.uniform(0, 2 * np.pi, len(harmonics))
    return sum(a * np.sin(h * phase + p) for a, h, p in zip(amplitude, harmonics, phases, strict=True))


def notes(seed: int, count: int) -> np.ndarray:
    """(count, pitches, samples) int16."""
    result = np.zeros((count, len(PITCHES), LENGTH), np.int16)
    for index in range(count):
        kind = KINDS[index % len(KINDS)]
        parent = np.random.default_rng([seed, index])
        envelope = _envelope(parent, bool(parent.random() < 0.5))
        breath = float(parent.choice((0.0, 0.0, 0.03)))
        for column, pitch in enumerate(PITCHES):
            rng = np.random.default_rng([seed, index, 99])
            sound = _tone(kind, 440.0 * 2.0 ** ((pitch - 69) / 12), rng) * (
                envelope if kind not in ("pluck", "bell") else 1.0
            )
            sound = sound + breath * rng.standard_normal(LENGTH) * envelope * np.abs(sound).max()
            result[index, column] = np.round(sound / np.abs(sound).max() * 32000)
    return result


def _noise(rng: np.random.Generator, low: float, high: float) -> np.ndarray:
    sos = butter(2, [low, min(high, 0.48 * RATE)], "bandpass", fs=RATE, output="sos")
    noise = sosfilt(sos, rng.standard_normal(STROKE))
    return noise / np.abs(noise).max()


def _drum(key: int, rng: np.random.Generator) -> np.ndarray:
    time = np.arange(STROKE) / RATE
    decay = lambda t: np.exp(-time / t)  # noqa: E731
    sweep = lambda top, bottom, fall: np.sin(2 * np.pi * np.cumsum(bottom + (top - bottom) * decay(fall)) / RATE)  # noqa: E731
    if key in (35, 36):
        return sweep(rng.uniform(110, 260), rng.uniform(40, 62), rng.uniform(0.01, 0.05)) * decay(
            rng.uniform(0.06, 0.4)
        ) + 0.2 * rng.random() * _noise(rng, 1000, 6000) * decay(0.004)
    if key in (38, 40, 37, 39):
        body = sweep(rng.uniform(220, 400), rng.uniform(150, 220), 0.015) * decay(rng.uniform(0.02, 0.08)) * (key != 39)
        return 0.6 * rng.random() * body + 0.7 * _noise(rng, rng.uniform(400, 1500), rng.uniform(5000, 10000)) * decay(
            rng.uniform(0.02, 0.12) * (0.3 if key == 37 else 1)
        )
    if key in (41, 43, 45, 47, 48, 50, 60, 61, 62, 63, 64, 65, 66):
        tone = 70.0 * 2.0 ** ((key - 41) / 9.0)
        return sweep(tone * 1.4, tone, 0.03) * decay(rng.uniform(0.05, 0.25)) + 0.2 * _noise(rng, 500, 4000) * decay(
            0.01
        )
    if key in (42, 44, 54, 69, 70):
        return (
            0.5
            * _noise(rng, rng.uniform(4000, 7000), 10500)
            * decay(rng.uniform(0.01, 0.06))
            * np.minimum(time / (0.015 if key > 60 else 0.001), 1)
        )
    if key in (46, 49, 51, 53, 57, 59, 52, 55):
        return 0.5 * _noise(rng, rng.uniform(2500, 6000), 10500) * decay(rng.uniform(0.08, 0.6))
    tone = 400.0 * 2.0 ** ((key % 12) / 6.0) * rng.uniform(0.8, 1.3)
    return (sweep(tone, tone, 1) + 0.6 * np.sin(2 * np.pi * 1.5 * tone * time)) * decay(rng.uniform(0.015, 0.12))


def strokes(seed: int, kits: int) -> np.ndarray:
    """(kits, keys, samples) int16."""
    result = np.zeros((kits, len(KEYS), STROKE), np.int16)
    for kit in range(kits):
        for column, key in enumerate(KEYS):
            sound = _drum(int(key), np.random.default_rng([seed, kit, int(key)]))
            result[kit, column] = np.round(np.clip(sound / max(np.abs(sound).max(), 1.0), -1, 1) * 28000)
    return result
