"""Short-time power spectra of sound that streams by, and bands of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.fft import rfft

from onbeat._shapes import Array, Float32


class SpectrumStream:
    """Power spectra of overlapping Hann windows; frame ``k`` is centred at ``k * hop / rate`` seconds.

    Parameters
    ----------
    window : samples in a window.
    hop : samples between windows.

    Examples
    --------
    >>> stream = SpectrumStream(8, 4)
    >>> parts = [stream.push(np.ones(10, np.float32)), stream.finish()]
    >>> np.concatenate(parts).shape
    (3, 5)
    """

    def __init__(self, window: int, hop: int) -> None:
        self._hop = hop
        self._hann = np.hanning(window + 1)[:-1].astype(np.float32)
        self._held: Float32 = np.zeros(window // 2, np.float32)
        self._samples = 0
        self._frames = 0

    def push(self, samples: Float32) -> Float32:
        """Spectra (frames, bins) of all windows that are now complete; full-scale sine = 1 at its peak."""
        self._samples += len(samples)
        return self._spectra(np.concatenate([self._held, samples]))

    def finish(self) -> Float32:
        """Spectra of the windows that reach over the end, filled with silence: ceil(samples / hop) frames in all."""
        missing = -(-self._samples // self._hop) - self._frames
        needed = max((missing - 1) * self._hop + len(self._hann), 0) if missing else 0
        return self._spectra(np.concatenate([self._held, np.zeros(max(needed - len(self._held), 0), np.float32)]))

    def _spectra(self, signal: Float32) -> Float32:
        window = len(self._hann)
        count = max((len(signal) - window) // self._hop + 1, 0)
        self._held = signal[count * self._hop :].copy()
        self._frames += count
        if not count:
            return np.zeros((0, window // 2 + 1), np.float32)
        frames = np.lib.stride_tricks.sliding_window_view(signal, window)[:: self._hop][:count]
        spectrum: Any = rfft(frames * self._hann, axis=1)
        scale = np.float32((2.0 / self._hann.sum()) ** 2)
        return np.asarray((spectrum.real**2 + spectrum.imag**2) * scale, dtype=np.float32)


def bin_frequencies(window: int, rate: int) -> Array:
    """Frequencies in Hz of the bins of a window."""
    return np.arange(window // 2 + 1, dtype=np.float64) * (rate / window)


def log_bands(frequencies: Array, low: float, high: float, per_octave: int) -> Float32:
    """Triangular bands (bins, bands) evenly spaced on the logarithm of frequency, each at least a bin wide.

    >>> log_bands(np.arange(0, 1000, 10.0), 100, 800, 12).shape
    (100, 37)
    """
    resolution = frequencies[1] - frequencies[0]
    centres = low * 2.0 ** (np.arange(int(np.floor(np.log2(high / low) * per_octave)) + 1) / per_octave)
    step = 2.0 ** (1.0 / per_octave)
    below = centres - np.maximum(centres - centres / step, resolution)
    above = centres + np.maximum(centres * step - centres, resolution)
    rising = (frequencies[:, None] - below) / (centres - below)
    falling = (above - frequencies[:, None]) / (above - centres)
    return np.maximum(np.minimum(rising, falling), 0.0).astype(np.float32)
