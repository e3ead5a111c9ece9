"""Which tones sound: spectral peaks to a fraction of a semitone, and the tuning they are in."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32

STEPS = 5  # of a semitone
FINE = 12 * STEPS
LOWEST, HIGHEST = 60.0, 2200.0  # [Hz] roots of chords, and melodies
SPLIT = 262.0  # [Hz] bass below
TUNED_FROM = 150.0  # [Hz] below, a window cannot tell a few cents
NEAR = 8  # bins on either side that a peak has to stand out from
LOUDNESS = 0.3  # exponent on power (Stevens)


def fine_pitches(power: Float32, frequencies: Array) -> tuple[np.ndarray, complex]:
    """How much sounds at each fifth of a semitone, C first, octaves folded, (N, 2, FINE) float16; and the tuning.

    Every local maximum of the spectrum counts by how far it stands out from the bins around it; its frequency is that
    of the parabola through the logarithms of its three bins. The tuning is the sum over all of them of their weight,
    turned by their place between two semitones: its angle, of a whole turn, is the part of a semitone above A = 440 Hz.

    Parameters
    ----------
    power : (N, bins) of Hann windows.
    frequencies : (bins,) Hz.
    """
    step = frequencies[1]
    low, high = max(int(LOWEST / step), NEAR + 1), min(int(HIGHEST / step) + 1, len(frequencies) - NEAR - 2)
    pitches = np.zeros((len(power), 2 * FINE))
    if not len(power) or high <= low:
        return pitches.reshape(-1, 2, FINE).astype(np.float16), 0j
    loud = power[:, low - NEAR - 1 : high + NEAR + 1] ** np.float32(LOUDNESS)
    sums = np.cumsum(np.pad(loud, ((0, 0), (1, 0))), axis=1, dtype=np.float64)
    ground = (sums[:, 2 * NEAR + 1 :] - sums[:, : -2 * NEAR - 1])[:, 1:-1] / (2 * NEAR + 1)
    inner = loud[:, NEAR + 1 : -NEAR - 1]
    left, right = loud[:, NEAR : -NEAR - 2], loud[:, NEAR + 2 : -NEAR]
    frame, bin_ = np.nonzero((inner > left) & (inner >= right) & (inner > 1.5 * ground))
    weight = inner[frame, bin_] - ground[frame, bin_]
    a, b, c = (np.log(np.maximum(part[frame, bin_], 1e-12)) for part in (left, inner, right))
    shift = np.clip(0.5 * (a - c) / np.minimum(a - 2.0 * b + c, -1e-9), -0.5, 0.5)
    hertz = (bin_ + low + shift) * step
    semitone = 69.0 + 12.0 * np.log2(hertz / 440.0)
    place = semitone * STEPS
    whole = np.floor(place).astype(np.int64)
    part = place - whole
    row = frame * 2 * FINE + (hertz > SPLIT) * FINE
    for index, share in ((whole, 1.0 - part), (whole + 1, part)):
        pitches += np.bincount(row + index % FINE, weight * share, pitches.size).reshape(pitches.shape)
    tuned = hertz > TUNED_FROM
    turn = complex((weight[tuned] * np.exp(2j * np.pi * semitone[tuned])).sum())
    return pitches.reshape(-1, 2, FINE).astype(np.float16), turn


def fold_to_semitones(pitches: Array, tuning: float) -> Array:
    """Fifths of a semitone (..., FINE) to twelve semitones (..., 12) of a tuning in cents above A = 440 Hz.

    >>> fold_to_semitones(np.eye(60)[2], 40.0).round(2).tolist()[:2]
    [1.0, 0.0]
    """
    offset = np.arange(FINE)[:, None] / STEPS - tuning / 100.0 - np.arange(12)
    distance = np.abs((offset + 6.0) % 12.0 - 6.0)
    return pitches @ np.clip(2.5 * (0.7 - distance), 0.0, 1.0)
