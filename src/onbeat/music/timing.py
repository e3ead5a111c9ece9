"""From frames of the decoder to times: each beat on its attack, and only where there is sound."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Bools, Float32, Ints, Times
from onbeat.music.hearing import Hearing

DELAY = 0.0015  # [s] midway between what clicks and drums (5 ms early) and soft attacks (7 ms late) need
AUDIBLE = 1e-4  # of the power of the loud passages
AROUND = 2  # frames around a beat over which that centre is taken
REACH = 0.025  # [s] around a frame of the decoder, in which the attack of the beat is looked for


def refine(times: Times, attacks: Float32, rate: float) -> Times:
    """Each beat moves to the strongest attack within ``REACH`` seconds, to a fraction of a frame; increasing.

    An attack at the edge of the reach counts for half of one at its centre.
    """
    frames = np.round(times * rate).astype(np.int64)
    reach = max(round(REACH * rate), 1)
    near = frames[:, None] + np.arange(-reach, reach + 1)
    weight = 1.0 - 0.5 * np.abs(np.arange(-reach, reach + 1)) / reach
    heard = np.pad(attacks.astype(np.float64), (reach + 1, reach + 2))
    best = frames + (heard[np.clip(near, 0, len(attacks)) + reach + 1] * weight).argmax(axis=1) - reach
    left, middle, right = (heard[np.clip(best, 0, len(attacks)) + reach + 1 + step] for step in (-1, 0, 1))
    curve = left - 2.0 * middle + right
    peaked = (curve < 0.0) & (middle >= left) & (middle >= right)
    shift = np.where(peaked, 0.5 * (left - right) / np.where(peaked, curve, -1.0), 0.0)
    return np.maximum.accumulate(np.where(middle > 0.0, (best + shift) / rate, times))


def sounding_stretch(loudness: Float32, rate: float) -> tuple[float, float]:
    """Seconds between which there is sound: within 40 dB of the loud passages; no beat is heard outside.

    >>> sounding_stretch(np.array([0, 0, 1, 1, 1, 0], np.float32), 10.0)
    (0.1, 0.5)
    """
    sounding = np.flatnonzero(loudness > AUDIBLE * np.percentile(loudness, 95))
    return (float(sounding[0] - 1) / rate, float(sounding[-1] + 1) / rate) if len(sounding) else (0.0, 0.0)


def accents(flux: Float32, beats: Ints) -> Array:
    """Highest flux of each band within two frames of each beat: (B, bands)."""
    return maximum_filter1d(flux, 5, axis=0)[np.clip(beats, 0, len(flux) - 1)].astype(np.float64)


def centred(frames: Ints, log_odds: Array | Float32) -> Array:
    """Each beat at the centre of the chances around it, to a fraction of a frame: (B,).

    Rooms and soft attacks make the strongest onset late; the learned activation has heard both.

    >>> odds = np.full(100, -9.0)
    >>> odds[[50, 51]] = 1.0
    >>> centred(np.array([50]), odds).round(2).tolist()
    [50.5]
    """
    if not len(frames):
        return np.zeros(0)
    steps = np.arange(-AROUND, AROUND + 1)
    near = np.clip(frames[:, None] + steps, 0, len(log_odds) - 1)
    chance = 1.0 / (1.0 + np.exp(-log_odds.astype(np.float64)[near]))
    return frames + (chance * steps).sum(axis=1) / chance.sum(axis=1)


def sounding(hearing: Hearing, times: Times) -> Bools:
    """Which of the times (B,) lie where there is sound."""
    begin, end = sounding_stretch(hearing.loudness, hearing.tone_rate)
    return (times >= max(begin, 0.0)) & (times < min(end, hearing.duration))


def attack_times(hearing: Hearing, frames: Ints) -> Times:
    """Times of beats at frames of the decoder (B,): of the strongest attack nearby."""
    return refine(frames / hearing.onset_rate, hearing.attacks, hearing.attack_rate) - DELAY


def learned_times(hearing: Hearing, frames: Ints, log_odds: Array | Float32) -> Times:
    """Times of beats at frames of the decoder (B,), by the learned log odds of a beat (N,)."""
    return np.maximum.accumulate(centred(frames, log_odds) / hearing.onset_rate)
