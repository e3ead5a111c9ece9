"""What lies between a band and a microphone: reverberation, colour, noise, compression, clipping, a telephone."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, fftconvolve, lfilter, sosfilt

from training.bank import RATE


def _room(sound: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Exponentially decaying noise (RT60 0.15–1.2 s) after the direct sound."""
    reverberation = float(rng.uniform(0.15, 1.2))
    time = np.arange(int(reverberation * RATE)) / RATE
    tail = rng.standard_normal(len(time)) * 10.0 ** (-3.0 * time / reverberation)
    tail = lfilter([0.5], [1.0, -rng.uniform(0.0, 0.8)], tail)
    tail[: int(rng.uniform(0.001, 0.012) * RATE)] = 0.0
    tail *= 10.0 ** rng.uniform(-1.1, 0.05) / np.sqrt((tail**2).sum() + 1e-9)
    tail[0] = 1.0
    return fftconvolve(sound, tail)[: len(sound)]


def _colour(sound: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A tilt and a limited band."""
    tilt = rng.uniform(-0.6, 0.6)
    sound = lfilter([1.0, -tilt], [1.0], sound)
    if rng.random() < 0.5:
        sound = sosfilt(butter(1, rng.uniform(40, 250), "highpass", fs=RATE, output="sos"), sound)
    if rng.random() < 0.4:
        sound = sosfilt(butter(2, rng.uniform(3000, 9000), "lowpass", fs=RATE, output="sos"), sound)
    return sound


def _noise(length: int, rng: np.random.Generator) -> np.ndarray:
    white = rng.standard_normal(length)
    kind = rng.integers(3)
    if kind == 0:
        return white
    brown = lfilter([1.0], [1.0, -0.97], white)
    if kind == 1:
        return brown / brown.std()
    babble = sosfilt(butter(2, [200, 3500], "bandpass", fs=RATE, output="sos"), white)
    swing = np.interp(
        np.arange(length) / 2205, np.arange(length // 2205 + 2), np.abs(rng.standard_normal(length // 2205 + 2))
    )
    return babble * swing / (babble * swing).std()


def record(sound: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The sound as some microphone or master has it; half of the time nearly as it was."""
    if rng.random() < 0.5:
        sound = _room(sound, rng)
    if rng.random() < 0.5:
        sound = _colour(sound, rng)
    sound = sound / max(float(np.abs(sound).max()), 1e-6)
    if rng.random() < 0.3:  # compression: the loud made softer
        level = np.sqrt(lfilter([0.001], [1.0, -0.999], sound**2) + 1e-4)
        sound = sound / level ** rng.uniform(0.3, 0.8)
        sound = sound / max(float(np.abs(sound).max()), 1e-6)
    if rng.random() < 0.15:
        sound = np.tanh(sound * rng.uniform(2, 8))
    if rng.random() < 0.4:
        sound = sound + _noise(len(sound), rng) * np.sqrt((sound**2).mean()) * 10.0 ** (-rng.uniform(8, 45) / 20)
    return (sound / max(float(np.abs(sound).max()), 1e-6) * 10.0 ** (-rng.uniform(0, 30) / 20)).astype(np.float32)
