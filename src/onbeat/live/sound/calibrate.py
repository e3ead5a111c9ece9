"""How late sound is heard: clicks are played, and found again in what the input hears.

A click is a chirp of 30 ms, so that it is told from talk and knocks and found to a fraction of a sample: what was
recorded is correlated with it, and the first strong peak of the envelope is the way of the direct sound.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.errors import AudioError
from onbeat.live.sound.ears import HIGHEST_RATE, LOWEST_RATE
from onbeat.live.sound.sound_card import sound_card

LENGTH = 0.03  # [s] of a chirp
LOWEST, HIGHEST = 1000.0, 6000.0  # [Hz], its ends
LONGEST = 0.6  # [s] after which a click is not waited for any more
EARLY = 0.005  # [s] before its time from which it is looked for
DIRECT = 0.6  # of the highest peak, which the direct sound has at the least: what comes later is an echo
CLEAR = 5.0  # times the median of the envelope; noise gets there once in 2^25 samples
AGREES = 0.005  # [s] around the median delay, within which a click is one that was played
APART = 0.75  # [s] between two clicks, at the least
LEVEL = 0.5  # of full scale
RATE = 48000  # [Hz] at which most cards play and record

PlayAndRecord = Callable[[Float32, int], Float32]
"""Plays samples (n,) of a rate and gives what was recorded meanwhile (m,), from the same moment on."""


@dataclass(frozen=True)
class Latency:
    """How late sound is.

    Parameters
    ----------
    seconds : between playing and hearing, the median over the clicks.
    spread : seconds, standard deviation by the median absolute deviation.
    heard, clicks : how many were found, and played.
    """

    seconds: float
    spread: float
    heard: int
    clicks: int

    def __str__(self) -> str:
        spread = f"± {1e3 * self.spread:.2f} ms"
        return f"{1e3 * self.seconds:.1f} ms {spread}, {self.heard} of {self.clicks} clicks heard"


def chirp(rate: int) -> Float32:
    """One click (n,): a tone that rises from 1 to 6 kHz within 30 ms and swells and fades; lower at low rates.

    >>> chirp(48000).shape
    (1440,)
    """
    times = np.arange(round(LENGTH * rate)) / rate
    highest = min(HIGHEST, 0.4 * rate)
    rising = LOWEST + 0.5 * (highest - LOWEST) * times / LENGTH
    swell = np.sin(np.pi * times / LENGTH) ** 2
    return (np.sin(2.0 * np.pi * rising * times) * swell).astype(np.float32)


def clicks_to_play(clicks: int, rate: int) -> tuple[Times, Float32]:
    """Seconds (K,) of clicks, unevenly apart so that none is taken for another, and the sound with them.

    >>> times, sound = clicks_to_play(3, 48000)
    >>> times.round(2).tolist(), sound.shape
    ([0.5, 1.25, 2.08], (130080,))
    """
    steps = APART + 0.01 * (np.arange(max(clicks - 1, 0)) * 8 % 13)
    times = np.round((0.5 + np.concatenate((np.zeros(1), np.cumsum(steps)))) * rate) / rate
    sound = np.zeros(round((times[-1] + LONGEST + LENGTH) * rate), np.float32)
    one = LEVEL * chirp(rate)
    for time in times.tolist():
        sound[round(time * rate) :][: len(one)] += one
    return times, sound


def delays(clicks_at: Times, recording: Float32, rate: int) -> Latency:
    """How late clicks are heard.

    Parameters
    ----------
    clicks_at : (K,) seconds at which they were played.
    recording : (n,) what was heard, from second 0 on.
    rate : samples per second.

    Raises
    ------
    AudioError
        If fewer than half of them are heard, or what is given is no such thing.

    Examples
    --------
    >>> times, sound = clicks_to_play(8, 44100)
    >>> late = np.concatenate((np.zeros(4410), 0.1 * sound))
    >>> print(delays(times, late, 44100))
    100.0 ms ± 0.00 ms, 8 of 8 clicks heard
    """
    sound = _checked(clicks_at, recording, rate)
    one = chirp(rate)
    found = [_delay(sound, one, time, rate) for time in np.asarray(clicks_at, dtype=np.float64).tolist()]
    late = np.array([delay for delay in found if delay is not None])
    near = late[np.abs(late - np.median(late)) <= AGREES] if len(late) else late
    if 2 * len(near) < len(found):
        raise AudioError(
            f"{len(near)} of {len(found)} clicks are heard within {LONGEST:g} s: turn the output up, hold the input to "
            "it, and let the room be quiet; or give the latency yourself (--latency)"
        )
    middle = float(np.median(near))
    return Latency(middle, 1.4826 * float(np.median(np.abs(near - middle))), len(near), len(found))


def calibrate(play_and_record: PlayAndRecord | None = None, clicks: int = 12, rate: int = RATE) -> Latency:
    """Play clicks, listen, and tell how late they are heard: the way out, through the room, and in.

    Parameters
    ----------
    play_and_record : plays samples and gives what is heard; the default output and input of the sound card.
    clicks : how many.
    rate : samples per second.

    Raises
    ------
    MissingExtraError
        If a sound card is needed, and sounddevice or PortAudio is not installed.
    AudioError
        If there is no output or no input, or fewer than half of the clicks are heard.
    """
    if clicks < 1:
        raise AudioError(f"{clicks} clicks; expected 1 or more")
    times, sound = clicks_to_play(clicks, rate)
    return delays(times, (play_and_record or through_card())(sound, rate), rate)


def through_card(card: Any = None) -> PlayAndRecord:
    """Plays on the default output of the sound card, and records from its default input, with blocks of 10 ms.

    Parameters
    ----------
    card : the module ``sounddevice``, or one like it.
    """
    card = card or sound_card()

    def play_and_record(sound: Float32, rate: int) -> Float32:
        asked = {"channels": 1, "dtype": "float32", "blocksize": rate // 100, "latency": 0.03}
        try:
            heard = card.playrec(sound[:, None], samplerate=rate, **asked)
            card.wait()
        except (card.PortAudioError, ValueError) as error:
            raise AudioError(
                f"clicks cannot be played and recorded ({error}); an output and an input are needed; "
                "or give the latency yourself (--latency)"
            ) from None
        return np.asarray(heard, dtype=np.float32)[:, 0]

    return play_and_record


def _checked(clicks_at: Times, recording: Float32, rate: int) -> Array:
    times, heard = np.asarray(clicks_at), np.asarray(recording)
    if times.ndim != 1 or not len(times) or not np.isfinite(times).all() or (times < 0).any():
        raise AudioError(f"{times.size} clicks; expected their seconds (K,), one or more, 0 or later")
    if heard.ndim != 1 or heard.dtype.kind != "f":
        raise AudioError(f"a recording of shape {heard.shape} and kind {heard.dtype}; expected floats (n,)")
    if not LOWEST_RATE <= rate <= HIGHEST_RATE:
        raise AudioError(f"a recording of {rate} samples per second; expected {LOWEST_RATE} to {HIGHEST_RATE}")
    return np.clip(np.nan_to_num(heard, nan=0.0, posinf=0.0, neginf=0.0), -1e3, 1e3).astype(np.float64)


def _delay(sound: Array, one: Float32, time: float, rate: int) -> float | None:
    """Seconds from the time of a click to where it is heard; None where nothing like it is."""
    begin = round((time - EARLY) * rate)
    stretch = sound[max(begin, 0) : round((time + LONGEST + LENGTH) * rate)]
    envelope = _envelope(stretch, one)
    if len(envelope) < 3 or envelope.max() <= CLEAR * max(float(np.median(envelope)), 1e-9):
        return None
    high = envelope[1:-1]
    peaks = (high >= envelope[:-2]) & (high >= envelope[2:]) & (high >= DIRECT * envelope.max())
    if not peaks.any():
        return None
    at = 1 + int(peaks.argmax())
    before, here, after = envelope[at - 1 : at + 2]
    curved = before - 2.0 * here + after
    within = 0.5 * (before - after) / curved if curved else 0.0
    return (max(begin, 0) + at + within) / rate - time


def _envelope(stretch: Array, one: Float32) -> Array:
    """How much each place looks like the beginning of a click, whatever its phase: |analytic cross-correlation|."""
    if len(stretch) < len(one):
        return np.zeros(0)
    size = 2 ** math.ceil(math.log2(len(stretch) + len(one)))
    product = np.fft.fft(stretch, size) * np.conj(np.fft.fft(one, size))
    product[size // 2 :] = 0.0
    return np.abs(np.fft.ifft(product))[: len(stretch) - len(one) + 1]
