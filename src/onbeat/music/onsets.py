"""Onset strength: how much new sound begins at each moment, in five bands of frequency."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from onbeat._shapes import Array, Float32
from onbeat.music.hearing import Hearing

EDGES = (40.0, 150.0, 400.0, 1200.0, 4000.0, 20000.0)  # [Hz] bass drum, bass, voice, snare, cymbals
FLOOR = 4.0  # [log10 power] a sound 40 dB under the loud ones is as good as none
LAG = 0.02  # [s] a rise is measured over this time
LOCAL = 6.0  # [s] loudness is adapted to over this time
SHARED = 0.35  # share of the whole song's level in that adaptation
CHUNK = 30000  # frames worked on at a time


def rise(levels: Float32, lag: int) -> Float32:
    """Increase of level over ``lag`` frames, against the loudest of three bands then (SuperFlux, Böck 2013).

    A voice that glides into the next band is no onset.
    """
    before = maximum_filter1d(levels, 3, axis=1)
    result = np.zeros_like(levels)
    result[lag:] = np.maximum(levels[lag:] - before[:-lag], 0.0)
    return result


def band_flux(hearing: Hearing) -> Float32:
    """Rises summed in the five bands: (N, 5)."""
    lag = max(round(LAG * hearing.onset_rate), 1)
    floor = float(np.percentile(hearing.bands[:: max(len(hearing.bands) // 20000, 1)].astype(np.float32), 95)) - FLOOR
    groups = np.clip(np.searchsorted(EDGES, hearing.band_frequencies, side="right") - 1, 0, len(EDGES) - 2)
    members = np.eye(len(EDGES) - 1, dtype=np.float32)[groups]
    flux = np.zeros((len(hearing.bands), len(EDGES) - 1), np.float32)
    for begin in range(0, len(flux), CHUNK):
        first = max(begin - lag, 0)
        levels = np.maximum(hearing.bands[first : begin + CHUNK].astype(np.float32), floor)
        # A soft floor: what comes out of silence counts by how far it comes out.
        levels = np.log10(1.0 + 10.0 ** (levels - floor) * 0.1)
        flux[begin : begin + CHUNK] = rise(levels, lag)[begin - first :] @ members
    return flux


def adapt(flux: Float32, rate: float) -> Float32:
    """Divide each band by its root mean square nearby and over the whole song: quiet passages have beats too."""
    squared = flux.astype(np.float64) ** 2
    nearby = uniform_filter1d(squared, max(round(LOCAL * rate), 1), axis=0, mode="nearest")
    overall = squared.mean(axis=0, keepdims=True)
    level = np.sqrt((1.0 - SHARED) * nearby + SHARED * overall)
    return np.where(overall > 1e-12, flux / np.maximum(level, 1e-9), 0.0).astype(np.float32)


def onset_strength(hearing: Hearing) -> tuple[Float32, Array]:
    """Adapted flux per band (N, 5), and its mean over the bands (N,)."""
    flux = adapt(band_flux(hearing), hearing.onset_rate)
    return flux, flux.mean(axis=1, dtype=np.float64)
