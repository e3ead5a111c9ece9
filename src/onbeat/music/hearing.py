"""One pass over a song: what the default method keeps of the sound, about 20 kB a second, whatever its length."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands

ONSET_WINDOW = 0.046  # [s]
ONSET_HOP = 0.01  # [s]
ATTACK_WINDOW = 0.023  # [s], short: for the exact time of an onset
ATTACK_HOP = 0.005  # [s]
TONE_WINDOW = 0.186  # [s], long enough to part semitones from 110 Hz up
TONE_HOP = 0.05  # [s]
LOWEST_TONE = 55.0  # [Hz], A1
TONES = 61  # semitones from A1 to A6
BANDS_PER_OCTAVE = 8
SILENCE = 1e-10  # power (−100 dB) below which everything counts as silence

Progress = Callable[[float], None]
"""Called with the seconds heard so far."""


@dataclass(frozen=True)
class Hearing:
    """What was heard.

    Parameters
    ----------
    duration : seconds.
    peak : highest absolute sample.
    onset_rate, attack_rate, tone_rate : frames per second of the three kinds of frames below.
    bands : (N, bands) float16, log10 power in bands an eighth of an octave apart, short windows.
    band_frequencies : (bands,) Hz.
    attacks : (A,) rise of the fourth root of the power from the frame before, very short windows: sharp in time.
    tones : (M, TONES) power of the semitones, long windows.
    loudness : (M,) power with the ear's weighting of frequencies.
    """

    duration: float
    peak: float
    onset_rate: float
    attack_rate: float
    tone_rate: float
    bands: np.ndarray
    band_frequencies: Array
    attacks: Float32
    tones: Float32
    loudness: Float32


def ear_weighting(frequencies: Array) -> Array:
    """The A-weighting curve (IEC 61672) as a factor on power.

    >>> bool(abs(ear_weighting(np.array([1000.0]))[0] - 1.0) < 0.01)
    True
    """
    squared = frequencies**2
    low = (squared + 20.6**2) * np.sqrt((squared + 107.7**2) * (squared + 737.9**2)) * (squared + 12194.0**2)
    return (1.2589 * 12194.0**2 * squared**2 / np.maximum(low, 1e-30)) ** 2


class _Streams:
    """The three kinds of spectra of the sound that streams by, and what is kept of them."""

    def __init__(self, rate: int) -> None:
        self.hops = [round(hop * rate) for hop in (ONSET_HOP, ATTACK_HOP, TONE_HOP)]
        windows = [2 * round(window * rate / 2) for window in (ONSET_WINDOW, ATTACK_WINDOW, TONE_WINDOW)]
        self._spectra = [SpectrumStream(window, hop) for window, hop in zip(windows, self.hops, strict=True)]
        highest = min(10000.0, 0.45 * rate)
        onset, attack, tone = (bin_frequencies(window, rate) for window in windows)
        self._bands = log_bands(onset, 40.0, highest, BANDS_PER_OCTAVE)
        self._coarse = log_bands(attack, 100.0, highest, 4)
        self._semitones = log_bands(tone, LOWEST_TONE, LOWEST_TONE * 2.0 ** ((TONES - 0.5) / 12), 12)
        self._ear = ear_weighting(tone).astype(np.float32)
        self._before = np.zeros((1, self._coarse.shape[1]), np.float32)
        self.bands: list[np.ndarray] = []
        self.attacks: list[Float32] = []
        self.tones: list[Float32] = []
        self.loudness: list[Float32] = []

    def push(self, block: Float32) -> None:
        self._keep(*(stream.push(block) for stream in self._spectra))

    def finish(self) -> None:
        self._keep(*(stream.finish() for stream in self._spectra))

    def _keep(self, onset: Float32, attack: Float32, tone: Float32) -> None:
        self.bands.append(np.log10(np.maximum(onset @ self._bands, SILENCE)).astype(np.float16))
        roots = np.concatenate([self._before, np.sqrt(np.sqrt(attack @ self._coarse))])
        self._before = roots[-1:]
        self.attacks.append(np.maximum(np.diff(roots, axis=0), 0.0).sum(axis=1))
        self.tones.append(tone @ self._semitones)
        self.loudness.append(tone @ self._ear)


def _joined(parts: list[np.ndarray]) -> np.ndarray:
    """The parts as one array; the list is emptied, so that hours are in memory once only."""
    whole = np.concatenate(parts)
    parts.clear()
    return whole


def hear(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Hearing:
    """Hear mono blocks at ``rate`` samples per second, in one pass."""
    streams = _Streams(rate)
    samples, peak = 0, 0.0
    for block in blocks:
        streams.push(block)
        samples += len(block)
        peak = max(peak, float(np.abs(block).max(initial=0.0)))
        if progress:
            progress(samples / rate)
    streams.finish()
    bands = _joined(streams.bands)
    onset_rate, attack_rate, tone_rate = (rate / hop for hop in streams.hops)
    return Hearing(
        duration=samples / rate,
        peak=peak,
        onset_rate=onset_rate,
        attack_rate=attack_rate,
        tone_rate=tone_rate,
        bands=bands,
        band_frequencies=40.0 * 2.0 ** (np.arange(bands.shape[1]) / BANDS_PER_OCTAVE),
        attacks=_joined(streams.attacks),
        tones=_joined(streams.tones),
        loudness=_joined(streams.loudness),
    )
