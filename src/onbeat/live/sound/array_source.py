"""A song in memory, played to the ears at its own pace."""

from __future__ import annotations

import time

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.errors import AudioError
from onbeat.live.sound.played import Clock, Played


class ArraySource(Played):
    """A song that is in memory.

    Parameters
    ----------
    samples : (n,) or (n, channels), ±1.
    rate : samples per second.
    speed_up : seconds of song per second of the clock.
    loop : whether it begins again at its end.
    clock : seconds that rise.

    Raises
    ------
    AudioError
        If there are no such samples.

    Examples
    --------
    >>> seconds = iter([0.0, 0.25])
    >>> song = ArraySource(np.zeros(8000), 8000, clock=lambda: next(seconds))
    >>> song.start()
    >>> [(block.shape, rate) for block, rate in song.read()], song.position
    ([((2000, 1), 8000)], 0.25)
    """

    def __init__(
        self,
        samples: Array | Float32,
        rate: int,
        speed_up: float = 1.0,
        loop: bool = False,
        clock: Clock = time.monotonic,
    ) -> None:
        super().__init__(speed_up, loop, clock)
        if samples.ndim not in (1, 2) or not samples.size or samples.dtype.kind != "f" or rate <= 0:
            raise AudioError(
                f"a song of shape {samples.shape}, kind {samples.dtype}, {rate} samples per second; "
                "expected floats (n,) or (n, channels), one sample or more"
            )
        self._samples = np.asarray(samples if samples.ndim == 2 else samples[:, None], dtype=np.float32)
        self._rate = rate
        self.seconds = len(samples) / rate

    def start(self) -> None:
        """Begin the song."""
        self._begin()

    def _next(self, count: int) -> Float32:
        places = np.arange(self._given, self._given + count)
        if self._loop:
            return self._samples[places % len(self._samples)]
        return self._samples[self._given : self._given + count]

    def _over(self) -> bool:
        return not self._loop and self._given >= len(self._samples)
