"""One pass over a song: what the default method keeps of the sound, about 20 kB a second, whatever its length."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands

ONSET_WINDOW = 0.046  # [s]
ONSET_HOP = 0.01  # [s]
TONE_WINDOW = 0.186  # [s], long enough to part semitones from 110 Hz up
TONE_HOP = 0.05  # [s]
LOWEST_TONE = 55.0  # [Hz], A1
TONES = 61  # semitones from A1 to A6
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
    onset_rate, tone_rate : frames per second of the two kinds of frames below.
    bands : (N, bands) float16, log10 power in bands an eighth of an octave apart, short windows.
    band_frequencies : (bands,) Hz.
    tones : (M, TONES) power of the semitones, long windows.
    loudness : (M,) power with the ear's weighting of frequencies.
    """

    duration: float
    peak: float
    onset_rate: float
    tone_rate: float
    bands: np.ndarray
    band_frequencies: Array
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


def hear(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Hearing:
    """Hear mono blocks at ``rate`` samples per second, in one pass."""
    onset_hop, tone_hop = round(ONSET_HOP * rate), round(TONE_HOP * rate)
    onset_window, tone_window = 2 * round(ONSET_WINDOW * rate / 2), 2 * round(TONE_WINDOW * rate / 2)
    onset_stream, tone_stream = SpectrumStream(onset_window, onset_hop), SpectrumStream(tone_window, tone_hop)
    filters = log_bands(bin_frequencies(onset_window, rate), 40.0, min(10000.0, 0.45 * rate), 8)
    frequencies = bin_frequencies(tone_window, rate)
    semitones = log_bands(frequencies, LOWEST_TONE, LOWEST_TONE * 2.0 ** ((TONES - 0.5) / 12), 12)
    ear = ear_weighting(frequencies).astype(np.float32)
    bands: list[np.ndarray] = []
    tones: list[Float32] = []
    loudness: list[Float32] = []
    samples, peak = 0, 0.0

    def keep(short: Float32, long: Float32) -> None:
        bands.append(np.log10(np.maximum(short @ filters, SILENCE)).astype(np.float16))
        tones.append(long @ semitones)
        loudness.append(long @ ear)

    for block in blocks:
        keep(onset_stream.push(block), tone_stream.push(block))
        samples += len(block)
        peak = max(peak, float(np.abs(block).max(initial=0.0)))
        if progress:
            progress(samples / rate)
    keep(onset_stream.finish(), tone_stream.finish())
    return Hearing(
        duration=samples / rate,
        peak=peak,
        onset_rate=rate / onset_hop,
        tone_rate=rate / tone_hop,
        bands=np.concatenate(bands),
        band_frequencies=40.0 * 2.0 ** (np.arange(filters.shape[1]) / 8),
        tones=np.concatenate(tones),
        loudness=np.concatenate(loudness),
    )
