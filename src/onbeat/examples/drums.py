"""Drum sounds of the embedded song, each made once from sines and noise."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfilt

from onbeat._shapes import Array, Float32
from onbeat.examples.synth import RATE, decay, swell


def _length(seconds: float) -> int:
    return int(seconds * RATE)


def _noise(seconds: float, low: float, high: float, rng: np.random.Generator) -> Array:
    """Noise between two frequencies [Hz], peak 1."""
    sections = butter(2, [low, high], btype="bandpass", fs=RATE, output="sos")
    noise = np.asarray(sosfilt(sections, rng.standard_normal(_length(seconds))))
    return noise / np.abs(noise).max()


def _sweep(seconds: float, top: float, bottom: float, fall: float) -> Array:
    """A sine whose frequency falls from ``top`` to ``bottom`` [Hz] with half-life ``fall`` seconds."""
    frequency = bottom + (top - bottom) * decay(_length(seconds), fall)
    return np.sin(2.0 * np.pi * np.cumsum(frequency, dtype=np.float64) / RATE)


def _finish(sound: Array, level: float) -> Float32:
    """To a peak of ``level`` and without a click at its end."""
    return (sound / np.abs(sound).max() * level * swell(len(sound), 0.0, 0.02)).astype(np.float32)


def _kick(rng: np.random.Generator) -> Float32:
    body = _sweep(0.34, 155.0, 52.0, 0.018) * decay(_length(0.34), 0.06)
    click = np.zeros(len(body))
    click[: _length(0.012)] = _noise(0.012, 900.0, 5000.0, rng) * decay(_length(0.012), 0.002)
    return _finish(body + 0.25 * click, 1.0)


def _snare(rng: np.random.Generator) -> Float32:
    length = _length(0.26)
    body = _sweep(0.26, 260.0, 185.0, 0.012) * decay(length, 0.028)
    wires = _noise(0.26, 900.0, 9000.0, rng) * decay(length, 0.042)
    return _finish(0.55 * body + 0.6 * wires, 0.8)


def _frame_drum(rng: np.random.Generator) -> Float32:
    length = _length(0.4)
    skin = _sweep(0.4, 150.0, 98.0, 0.03) * decay(length, 0.07)
    hand = _noise(0.4, 400.0, 3500.0, rng) * decay(length, 0.008)
    return _finish(skin + 0.35 * hand, 0.8)


def _hat(rng: np.random.Generator) -> Float32:
    return _finish(_noise(0.09, 7000.0, 15000.0, rng) * decay(_length(0.09), 0.012), 0.5)


def _open_hat(rng: np.random.Generator) -> Float32:
    return _finish(_noise(0.32, 6500.0, 15000.0, rng) * decay(_length(0.32), 0.06), 0.45)


def _shaker(rng: np.random.Generator) -> Float32:
    return _finish(_noise(0.11, 4500.0, 12000.0, rng) * swell(_length(0.11), 0.012, 0.09), 0.35)


def _tambourine(rng: np.random.Generator) -> Float32:
    length = _length(0.3)
    times = np.arange(length) / RATE
    jingles = sum(np.sin(2.0 * np.pi * tone * times + start) for tone, start in ((6120, 0), (7430, 1), (9170, 2)))
    noise = _noise(0.3, 5500.0, 14000.0, rng) * decay(length, 0.035)
    return _finish(noise + 0.08 * jingles * decay(length, 0.05), 0.45)


def _clap(rng: np.random.Generator) -> Float32:
    """Some hands, each a few milliseconds after the other."""
    length = _length(0.24)
    noise = _noise(0.24, 700.0, 4200.0, rng)
    shape = np.zeros(length)
    for hand in range(4):
        start = _length(0.006 * hand)
        shape[start:] = np.maximum(shape[start:], decay(length - start, 0.003 if hand < 3 else 0.03))
    return _finish(noise * shape, 0.7)


def _tom(rng: np.random.Generator) -> Float32:
    length = _length(0.45)
    return _finish(
        _sweep(0.45, 190.0, 118.0, 0.04) * decay(length, 0.09)
        + 0.05 * rng.standard_normal(length) * decay(length, 0.006),
        0.8,
    )


def _cymbal(rng: np.random.Generator) -> Float32:
    length = _length(2.2)
    return _finish(_noise(2.2, 3500.0, 14000.0, rng) * decay(length, 0.33) * swell(length, 0.002, 0.5), 0.5)


_MAKERS = {
    "kick": _kick,
    "snare": _snare,
    "frame drum": _frame_drum,
    "hat": _hat,
    "open hat": _open_hat,
    "shaker": _shaker,
    "tambourine": _tambourine,
    "clap": _clap,
    "tom": _tom,
    "cymbal": _cymbal,
}


def drum_kit(rng: np.random.Generator) -> dict[str, Float32]:
    """All drum sounds by name, mono, peak at most 1.

    Examples
    --------
    >>> sorted(drum_kit(np.random.default_rng(0)))[:3]
    ['clap', 'cymbal', 'frame drum']
    """
    return {name: make(rng) for name, make in _MAKERS.items()}
