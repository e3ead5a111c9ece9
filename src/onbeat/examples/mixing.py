"""Mixing the embedded song: tracks, stereo places, a room, and the last loudness."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.signal import butter, oaconvolve, sosfilt

from onbeat._shapes import Float32
from onbeat.examples.synth import RATE

LOUDNESS = -16.3  # root mean square of the whole song [dB full scale]; near −14 LUFS for this band
CEILING = 0.95


class Desk:
    """Mono tracks, each with a level, a place from left (−1) to right (1) and a share sent to the room."""

    def __init__(self, length: int) -> None:
        self.length = length
        self._tracks: dict[str, Float32] = {}
        self._places: dict[str, tuple[float, float, float]] = {}

    def track(self, name: str, level: float, pan: float, room: float) -> None:
        """Open a track."""
        self._tracks[name] = np.zeros(self.length, dtype=np.float32)
        self._places[name] = (level, pan, room)

    def play(self, name: str, sound: Float32, time: float, level: float = 1.0) -> None:
        """Add a sound to a track at a time [s], to the nearest sample; what is beyond the song's ends is lost."""
        start = round(time * RATE)
        sound = sound[max(-start, 0) : max(self.length - start, 0)]
        start = max(start, 0)
        self._tracks[name][start : start + len(sound)] += np.float32(level) * sound

    def listen(self, name: str) -> Float32:
        """The sound of one track alone, (N,), before its level."""
        return self._tracks[name]

    def mix(self, rng: np.random.Generator) -> Float32:
        """(N, 2) all tracks at their places and the room's answer; constant power across the width."""
        dry = np.zeros((2, self.length), dtype=np.float32)
        sent = np.zeros((2, self.length), dtype=np.float32)
        for name, sound in self._tracks.items():
            level, pan, room = self._places[name]
            angle = (pan + 1.0) * np.pi / 4.0
            for side, gain in enumerate((np.cos(angle), np.sin(angle))):
                placed = sound * np.float32(gain * level)
                dry[side] += placed
                sent[side] += placed * np.float32(room)
        return (dry + reverberate(sent, rng)).T


def reverberate(sent: Float32, rng: np.random.Generator, seconds: float = 1.3) -> Float32:
    """The answer of a small hall, (2, N): convolution with noise that loses 60 dB in ``seconds``, high tones first."""
    length = int(seconds * RATE)
    times = np.arange(length) / RATE
    noise = rng.standard_normal((2, length))
    dull = np.asarray(sosfilt(butter(1, 2200.0, fs=RATE, output="sos"), noise, axis=1))
    tail = dull * 10.0 ** (-3.0 * times / seconds) + 0.3 * noise * 10.0 ** (-3.0 * times / (0.45 * seconds))
    tail *= np.clip(times / 0.02, 0.0, 1.0)  # the hall opens within 20 ms, after the direct sound
    tail = np.asarray(sosfilt(butter(2, 180.0, btype="highpass", fs=RATE, output="sos"), tail, axis=1))
    tail = tail / np.sqrt((tail**2).sum(axis=1, keepdims=True))
    wet = oaconvolve(sent, tail.astype(np.float32), axes=1)
    return np.asarray(wet[:, : sent.shape[1]], dtype=np.float32)


def master(samples: Float32, fade: float) -> Float32:
    """Make an (N, 2) mix a finished song: no rumble, loudness, limiter, silence at both ends.

    The limiter looks 4 ms ahead: the gain is the smoothed least gain that keeps peaks under the ceiling, so that it
    moves before a peak, without a click.
    """
    sections = butter(2, 28.0, btype="highpass", fs=RATE, output="sos")
    sound = np.asarray(sosfilt(sections, samples, axis=0), dtype=np.float32)
    sound *= np.float32(10.0 ** (LOUDNESS / 20.0) / np.sqrt(np.mean(sound.astype(np.float64) ** 2) + 1e-12))
    sound *= limiter_gain(np.abs(sound).max(axis=1))[:, None]
    falling = min(int(fade * RATE), len(sound))
    rising = min(int(0.01 * RATE), len(sound))
    sound[len(sound) - falling :] *= (0.5 + 0.5 * np.cos(np.pi * np.linspace(0, 1, falling)))[:, None].astype(
        np.float32
    )
    sound[:rising] *= np.linspace(0.0, 1.0, rising, dtype=np.float32)[:, None]
    return np.clip(sound, -CEILING, CEILING)


def limiter_gain(peaks: Float32) -> Float32:
    """(N,) gains ≤ 1 that keep (N,) peaks under the ceiling: least gain within ±4 ms, then averaged over 4 ms."""
    reach = int(0.004 * RATE)
    held = maximum_filter1d(peaks, 2 * reach + 1, mode="nearest")
    gain = np.minimum(1.0, CEILING / np.maximum(held, 1e-9))
    return np.asarray(uniform_filter1d(gain, reach, mode="nearest"), dtype=np.float32)
