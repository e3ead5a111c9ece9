"""Degree of chord change at each beat, from semitones (the default; Shiratori's own is in ``shiratori2006.py``)."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32, Times

BASS_TONES = 38  # semitones from A1 up to 500 Hz: bass sounds and their overtones (Shiratori 2006, III-B)
NEARBY = 0.25  # [s] before and after a moment, in which its harmony is compared
LEAST_CHANGE = 0.15  # that counts as a change of 1: a drum solo has none
FAINT = 0.05  # of the usual sum of tones, under which nothing sounds


def new_harmony(tones: Float32, rate: float) -> Array:
    """How much new harmony under 500 Hz begins at each frame: the quarter second after against the one before, (N,)."""
    standing = prominence(tones)[:, :BASS_TONES]
    reach = max(round(NEARBY * rate), 1)
    padded = np.pad(standing, ((reach, reach), (0, 0)))
    change = np.zeros_like(standing)
    # The frame itself is left out: its window holds sound of both sides.
    for step in range(1, reach + 1):
        change += padded[reach + step : reach + step + len(standing)]
        change -= padded[reach - step : reach - step + len(standing)]
    return np.maximum(change, 0.0).sum(axis=1, dtype=np.float64) / reach


def between_beats(frames: Array | Float32, rate: float, beats: Times) -> Array:
    """Mean of the frames from each beat to the next (the last: as long as the one before): (B, bins).

    >>> between_beats(np.arange(4.0)[:, None], 1.0, np.array([0.0, 2.0])).ravel().tolist()
    [0.5, 2.5]
    """
    if not len(beats):
        return np.zeros((0, frames.shape[1]))
    last = beats[-1] + (beats[-1] - beats[-2] if len(beats) > 1 else 1.0)
    edges = np.clip(np.round(np.append(beats, last) * rate).astype(np.int64), 0, len(frames))
    begins = np.append(np.minimum(edges[:-1], len(frames) - 1), min(edges[-1], len(frames) - 1))
    sums = np.add.reduceat(frames, begins, axis=0)[:-1].astype(np.float64)
    if edges[-1] == len(frames):
        sums[-1] = frames[edges[-2] :].sum(axis=0)
    counts = np.diff(edges)[:, None]
    return np.where(counts > 0, sums / np.maximum(counts, 1), 0.0)


def prominence(tones: Float32) -> Float32:
    """How far each semitone stands out from its neighbours in its frame, on a scale of loudness (power to the 0.3)."""
    loud = np.maximum(tones, 0.0) ** 0.3
    padded = np.pad(loud, ((0, 0), (3, 3)), mode="edge")
    ground = np.lib.stride_tricks.sliding_window_view(padded, 7, axis=1).mean(axis=2, dtype=np.float32)
    return np.maximum(loud - ground, 0.0)


def fold_octaves(tones: Array) -> Array:
    """Semitones (N, K) to the twelve of the octave (N, 12), each row of length 1 where there is sound."""
    chroma = np.stack([tones[:, note::12].sum(axis=1) for note in range(12)], axis=1)
    return chroma / np.maximum(np.linalg.norm(chroma, axis=1, keepdims=True), 1e-9)


def harmony_slices(tones: Float32, rate: float, beats: Times) -> Array:
    """What stands out of the semitones from each beat to the next: (B, semitones)."""
    return between_beats(prominence(tones), rate, beats)


def chord_change(slices: Array) -> Array:
    """How much the harmony at each beat differs from that of the beat before: (B,), 0…1.

    The mean of what Eqs. 5–6 measure (new tones under 500 Hz, as a share of all) and of the distance of the chroma.
    """
    if not len(slices):
        return np.zeros(0)
    bass = slices[:, :BASS_TONES]
    new = np.maximum(np.diff(bass, axis=0), 0.0).sum(axis=1) / np.maximum(bass[1:].sum(axis=1), 1e-9)
    chroma = fold_octaves(slices)
    distance = 1.0 - (chroma[1:] * chroma[:-1]).sum(axis=1)
    sounding = slices.sum(axis=1) > 0.05 * np.median(slices.sum(axis=1))
    change = np.where(sounding[1:], 0.5 * (new + distance), 0.0)
    usual = max(float(np.percentile(change, 95)), LEAST_CHANGE) if len(change) else 1.0
    return np.clip(np.concatenate([[0.0], change]) / usual, 0.0, 1.0)


def harmony_change(chroma: Array) -> Array:
    """How much the harmony at each beat differs from that of the beat before, in any tuning and loudness: (B,), 0…1.

    As :func:`chord_change`, but of the twelve tones in the song's own tuning, each slice as a share of its own sum: a
    song that is a quarter tone sharp, or grows louder, changes no more than another.

    Parameters
    ----------
    chroma : (B, 2, 12) from each beat to the next; the bass and the rest (``Profile.chroma``).

    Examples
    --------
    >>> chroma = np.zeros((3, 2, 12))
    >>> chroma[:2, :, 0] = chroma[2, :, 7] = 1.0
    >>> harmony_change(chroma).tolist()
    [0.0, 0.0, 1.0]
    """
    if not len(chroma):
        return np.zeros(0)
    total = chroma.sum(axis=(1, 2))
    shares = chroma.reshape(len(chroma), -1) / np.maximum(total, 1e-9)[:, None]
    new = np.maximum(np.diff(shares, axis=0), 0.0).sum(axis=1)
    tones = chroma.sum(axis=1)
    tones /= np.maximum(np.linalg.norm(tones, axis=1, keepdims=True), 1e-9)
    distance = 1.0 - (tones[1:] * tones[:-1]).sum(axis=1)
    sounding = total > FAINT * np.median(total)
    change = np.where(sounding[1:] & sounding[:-1], 0.5 * (new + distance), 0.0)
    usual = max(float(np.percentile(change, 95)), LEAST_CHANGE) if len(change) else 1.0
    return np.clip(np.concatenate([[0.0], change]) / usual, 0.0, 1.0)
