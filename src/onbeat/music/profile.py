"""What is kept of a song's sound beside its beats: harmony in any tuning, loudness, colour and new sound, over time.

It is gathered while the sound streams by, whatever method hears the beats: about 600 bytes a second.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.music.harmony.chords import between_beats
from onbeat.music.harmony.pitch import FINE, fine_pitches, fold_to_semitones
from onbeat.music.loudness import mean_square, perceptual_weighting
from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands

WINDOW, HOP = 0.186, 0.05  # [s] long enough to part semitones from 110 Hz up
COLOURS = 8  # bands of an octave and more


@dataclass(frozen=True)
class Profile:
    """What was gathered, in frames of which the k-th is centred at ``k / rate`` seconds.

    Parameters
    ----------
    rate : frames per second.
    duration : seconds.
    pitches : (N, 2, FINE) float16: how much sounds at each fifth of a semitone, octaves folded; bass, then the rest.
    colours : (N, COLOURS) fourth root of the power in wide bands.
    power : (N,) mean square, with the weighting of loudness meters.
    news : (N,) how much of the sound is new: rises of the colours.
    tuning : cents above A = 440 Hz, −50…50; 0 where no tones are heard.
    """

    rate: float
    duration: float
    pitches: np.ndarray
    colours: Float32
    power: Float32
    news: Float32
    tuning: float

    def chroma(self, beats: Times) -> Array:
        """How much each of the twelve tones, C first, sounds from each beat to the next: (B, 2, 12); bass, rest."""
        flat = self.pitches.reshape(len(self.pitches), 2 * FINE).astype(np.float32)
        slices = between_beats(flat, self.rate, beats).reshape(len(beats), 2, FINE)
        return fold_to_semitones(slices, self.tuning)

    def at(self, frames: Float32, times: Times) -> Array:
        """Values of a row of frames at any times, by linear interpolation."""
        return np.interp(times, np.arange(len(frames)) / self.rate, frames)


class Profiler:
    """Gathers a profile of the blocks that pass by.

    >>> profiler = Profiler(22050)
    >>> blocks = [np.sin(0.125 * np.arange(22050)).astype(np.float32)]
    >>> passed = [len(block) for block in profiler.watch(blocks)]
    >>> profiler.profile().pitches.shape
    (21, 2, 60)
    """

    def __init__(self, rate: int) -> None:
        window, self._hop = 2 * round(WINDOW * rate / 2), round(HOP * rate)
        self._rate = rate
        self._samples = 0
        self._stream = SpectrumStream(window, self._hop)
        self._frequencies = bin_frequencies(window, rate)
        highest = min(9000.0, 0.45 * rate)
        self._bands = log_bands(self._frequencies, 60.0, highest, 1)[:, :COLOURS]
        self._weights = perceptual_weighting(self._frequencies).astype(np.float32)
        self._before = np.zeros((1, self._bands.shape[1]), np.float32)
        self._turn = 0j
        self._parts: list[tuple[np.ndarray, Float32, Float32, Float32]] = []

    def watch(self, blocks: Iterable[Float32]) -> Iterator[Float32]:
        """The same blocks, each noted as it passes."""
        for block in blocks:
            self._samples += len(block)
            self._keep(self._stream.push(block))
            yield block

    def profile(self) -> Profile:
        """What was gathered; call it once, at the end."""
        self._keep(self._stream.finish())
        pitches, colours, power, news = (np.concatenate(part) for part in zip(*self._parts, strict=True))
        tuning = 100.0 * float(np.angle(self._turn)) / (2.0 * np.pi) if abs(self._turn) > 0.0 else 0.0
        return Profile(
            self._rate / self._hop, self._samples / self._rate, pitches, colours, power, news, round(tuning, 6)
        )

    def _keep(self, power: Float32) -> None:
        pitches, turn = fine_pitches(power, self._frequencies)
        self._turn += turn
        colours = np.sqrt(np.sqrt(power @ self._bands))
        levels = np.concatenate([self._before, colours])
        self._before = levels[-1:]
        news = np.maximum(np.diff(levels, axis=0), 0.0).sum(axis=1)
        self._parts.append((pitches, colours, mean_square(power, self._weights), news))
