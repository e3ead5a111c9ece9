"""The sound of a video: samples coded as AAC in small blocks, in step with the pictures."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import soxr

from onbeat._shapes import Float32

BLOCK = 1024
"""Samples in a frame of AAC."""
RATES = (44100, 48000)
"""Rates that are kept; others become the last."""


class SoundTrack:
    """An AAC stream in an open container, filled up to any time asked for.

    Parameters
    ----------
    av, container : PyAV and its open container.
    samples : (N, channels) or (N,), -1…1; more than two channels are mixed to one.
    rate : samples a second.
    duration : seconds; the sound is cut or followed by silence to be as long.
    """

    def __init__(self, av: Any, container: Any, samples: Float32, rate: int, duration: float) -> None:
        self._av, self._container = av, container
        self._samples = samples[:, None] if samples.ndim == 1 else samples
        self._rate = rate
        self._coded_rate = rate if rate in RATES else RATES[-1]
        self._channels = 2 if self._samples.shape[1] == 2 else 1
        self._end = round(duration * self._coded_rate)
        self._written = self._read = 0
        self._waiting = np.zeros((0, self._channels), np.float32)
        self._resampler = (
            None if rate == self._coded_rate else soxr.ResampleStream(rate, self._coded_rate, self._channels)
        )
        layout = "stereo" if self._channels == 2 else "mono"
        self._stream = container.add_stream("aac", rate=self._coded_rate, layout=layout)
        self._stream.bit_rate = 96_000 * self._channels

    def write_until(self, time: float) -> None:
        """Code whole blocks until ``time`` seconds are covered."""
        while self._written < min(time * self._coded_rate, self._end):
            self._code(min(BLOCK, self._end - self._written))

    def close(self) -> None:
        """Code what is left and end the stream."""
        self.write_until(np.inf)
        self._container.mux(self._stream.encode(None))

    def _code(self, count: int) -> None:
        block = self._next(count)
        frame = self._av.AudioFrame.from_ndarray(
            np.ascontiguousarray(block.T), format="fltp", layout="stereo" if self._channels == 2 else "mono"
        )
        frame.sample_rate = self._coded_rate
        frame.pts = self._written
        frame.time_base = Fraction(1, self._coded_rate)
        self._written += count
        self._container.mux(self._stream.encode(frame))

    def _next(self, count: int) -> Float32:
        """The next ``count`` samples at the coded rate; silence after the end."""
        while len(self._waiting) < count:
            part = self._samples[self._read : self._read + 8 * BLOCK]
            self._read += 8 * BLOCK
            last = self._read >= len(self._samples)
            part = np.asarray(part, np.float32)
            if part.shape[1] != self._channels:
                part = part.mean(1, keepdims=True, dtype=np.float32)
            if self._resampler is not None and len(part):
                part = self._resampler.resample_chunk(part, last=last).reshape(-1, self._channels)
            if not len(part) and last:
                part = np.zeros((count, self._channels), np.float32)
            self._waiting = np.concatenate((self._waiting, part))
        block, self._waiting = self._waiting[:count], self._waiting[count:]
        return np.clip(block, -1.0, 1.0)
