"""Sound as it comes from anywhere, to ticks of 10 ms, mono, at one rate.

What devices get wrong is put right here and said: another rate or number of channels from one block to the next,
samples that are no numbers, a constant offset, clipping, gaps. The same blocks give the same ticks, bit for bit.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.signal import lfilter

from onbeat._shapes import Array, Bools, Float32
from onbeat.errors import AudioError
from onbeat.live.sound.resampling import Resampler
from onbeat.live.sound.trouble import Trouble

EAR_RATE = 44100
"""Samples per second of a tick."""
TICK = 441
"""Samples of a tick: 10 ms."""
LOWEST_RATE, HIGHEST_RATE = 4000, 400000  # [Hz]
MOST_CHANNELS = 64
KEPT = 2.0  # [s] of sound until it is heard; more is too old to dance to
GAP = 100  # ticks without sound until that is said
SOUNDING = 1e-4  # of full scale, from which a channel counts
FULL = 0.999  # of full scale: as loud as can be
PASSED = 4.0  # [Hz] from which sound passes; below is no sound, but an offset
SELDOM = 5.0  # [s] between two notes of a changed rate


class Ears:
    """Takes blocks of any sound and gives ticks.

    Parameters
    ----------
    tell_gaps : whether it is said that no sound comes; not needed where the source itself says so.

    Examples
    --------
    >>> ears = Ears()
    >>> ears.take(np.zeros((480, 2), np.int16), 48000)
    >>> ears.take(np.full((480, 2), np.nan), 48000)
    >>> ears.tick().shape, ears.tick() is None, ears.problems()
    ((441,), True, ['not-a-number samples are left out'])
    """

    def __init__(self, tell_gaps: bool = True) -> None:
        Resampler(48000, EAR_RATE)  # loaded now: the rate may change in the middle of a dance
        self._rate = EAR_RATE
        self._resampler: Resampler | None = None
        self._heard = np.zeros(1, dtype=bool)  # channels in which something sounds
        self._held = np.zeros(round(KEPT * EAR_RATE), np.float32)
        self._count = 0
        self._settled = False
        self._offset = np.zeros(1)
        self._missing = 0
        self._tell_gaps = tell_gaps
        self._said = list[str]()
        self._since_change = SELDOM
        self.dropped = 0
        """Samples at EAR_RATE that were too old when they were asked for."""
        self._nans = Trouble("not-a-number samples are left out", "all samples are numbers again", 0.0, 0.0)
        self._clips = Trouble("the sound clips: turn the input down", "the sound clips no more", 0.02, 0.01, 0.5)
        self._leans = Trouble("the sound has a constant offset", "the constant offset is gone", 0.05, 0.02, 0.5)
        self._late = Trouble("sound is heard too late: the oldest is left out", "sound is heard in time again", 0, 0)

    @property
    def latency(self) -> float:
        """Seconds of sound that are held back for another rate."""
        return self._resampler.latency if self._resampler else 0.0

    def take(self, block: Array | Float32, rate: int) -> None:
        """Take the next samples (n,) or (n, channels) of a source, floats of ±1 or integers of full scale.

        Raises
        ------
        AudioError
            If they are not 1 to 64 channels of numbers at 4 to 400 kHz; none of them is taken then.
        """
        raw = _checked(block, rate)
        if rate != self._rate:
            self._change(rate)
        left_out = max(len(raw) - round(KEPT * rate), 0)
        raw = raw[left_out:]
        if not len(raw):
            return
        seconds = len(raw) / rate
        self._since_change += seconds
        mono = self._mono(_floats(raw), seconds)
        sound = self._without_offset(self._resampler.push(mono) if self._resampler else mono)
        self._keep(sound, left_out * EAR_RATE // rate, seconds)

    def tick(self) -> Float32 | None:
        """The next 441 samples, of ±1 at most; None where fewer are there."""
        if self._count < TICK:
            self._missing += 1
            if self._missing == GAP and self._settled and self._tell_gaps:
                self._said.append("no sound comes any more")
            return None
        if self._missing >= GAP and self._settled and self._tell_gaps:
            self._said.append("the sound is there again")
        self._missing = 0
        tick = self._held[:TICK].copy()
        self._held[: self._count - TICK] = self._held[TICK : self._count]
        self._count -= TICK
        tick.setflags(write=False)
        return tick

    def problems(self) -> list[str]:
        """What people should know, since this was last asked: each trouble once, and once more when it is over."""
        said, self._said = self._said, []
        return said

    def _change(self, rate: int) -> None:
        if self._resampler:
            self._keep(self._without_offset(self._resampler.flush()), 0, 0.0)
        if self._settled and self._since_change >= SELDOM:
            self._said.append(f"the sound comes at {rate} samples a second now, not at {self._rate}")
            self._since_change = 0.0
        self._rate = rate
        self._resampler = Resampler(rate, EAR_RATE) if rate != EAR_RATE else None

    def _mono(self, samples: Float32, seconds: float) -> Float32:
        """The mean of the channels in which anything has sounded, clipped, numbers only."""
        numbers = np.isfinite(samples)
        whole = bool(numbers.all())
        self._hear(self._nans, float(not whole), seconds)
        if not whole:
            samples = np.where(numbers, samples, np.float32(0.0))
        sizes = np.abs(samples)
        self._heard = _sounding(self._heard, sizes.max(axis=0))
        self._hear(self._clips, float((sizes[:, self._heard] >= FULL).mean()) if self._heard.any() else 0.0, seconds)
        channels = np.clip(samples[:, self._heard] if self._heard.any() else samples, -1.0, 1.0)
        mono = np.ascontiguousarray(channels.mean(axis=1, dtype=np.float32))
        self._hear(self._leans, float(mono.mean(dtype=np.float64)), seconds)
        return mono

    def _without_offset(self, sound: Float32) -> Float32:
        """``y[n] = x[n] − x[n−1] + r y[n−1]``: what is slower than 4 Hz is taken away."""
        if not len(sound):
            return sound
        if not self._settled:  # a device that begins with an offset does not begin with a click
            self._offset = np.array([-float(sound[0])])
            self._settled = True
        keep = math.exp(-2.0 * math.pi * PASSED / EAR_RATE)
        passed, self._offset = lfilter([1.0, -1.0], [1.0, -keep], sound.astype(np.float64), zi=self._offset)
        return np.clip(passed, -1.0, 1.0).astype(np.float32)

    def _keep(self, sound: Float32, left_out: int, seconds: float) -> None:
        """Hold on to sound until it is asked for; what is too much is left out at the old end."""
        room = len(self._held)
        sound = sound[-room:]
        excess = max(self._count + len(sound) - room, 0)
        self._held[: self._count - excess] = self._held[excess : self._count]
        self._count -= excess
        self._held[self._count : self._count + len(sound)] = sound
        self._count += len(sound)
        self.dropped += excess + left_out
        self._hear(self._late, float(excess + left_out), seconds)

    def _hear(self, trouble: Trouble, amount: float, seconds: float) -> None:
        if said := trouble.hear(amount, seconds):
            self._said.append(said)


def _checked(block: Any, rate: int) -> np.ndarray:
    """The samples as (n, channels)."""
    raw = np.asarray(block)
    raw = raw[:, None] if raw.ndim == 1 else raw
    if raw.ndim != 2 or raw.dtype.kind not in "fiu" or not 1 <= raw.shape[1] <= MOST_CHANNELS:
        raise AudioError(
            f"sound of shape {np.shape(block)} and kind {raw.dtype}; expected numbers (n,) or (n, channels), "
            f"1 to {MOST_CHANNELS} channels: check what the source gives"
        )
    if not LOWEST_RATE <= rate <= HIGHEST_RATE or rate != int(rate):
        raise AudioError(
            f"sound of {rate} samples per second; expected a whole number, {LOWEST_RATE} to {HIGHEST_RATE}: "
            "set the source to another rate"
        )
    return raw


def _floats(raw: np.ndarray) -> Float32:
    """Samples of ±1, of any type that devices give; what is louder is so still, and what is no number."""
    if raw.dtype.kind == "f":
        return np.clip(raw, -2.0, 2.0).astype(np.float32) if np.isfinite(raw).all() else _bounded(raw)
    bits = 8 * raw.dtype.itemsize
    middle = 2.0 ** (bits - 1)
    return ((raw.astype(np.float64) - (middle if raw.dtype.kind == "u" else 0.0)) / middle).astype(np.float32)


def _bounded(raw: np.ndarray) -> Float32:
    """Floats of ±2, all that are not finite made not-a-number."""
    with np.errstate(invalid="ignore"):  # bits that are no number may be worse ones still
        return np.where(np.isfinite(raw), np.clip(raw, -2.0, 2.0), np.nan).astype(np.float32)


def _sounding(before: Bools, peaks: Float32) -> Bools:
    """Channels in which something sounds or has sounded; all begin anew where their number is another."""
    now = peaks > SOUNDING
    return (before | now) if len(before) == len(now) else now
