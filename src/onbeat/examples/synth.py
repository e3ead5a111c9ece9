"""Sound sources of the embedded song: band-limited oscillators, plucked strings, envelopes."""

from __future__ import annotations

import functools

import numpy as np

from onbeat._shapes import Array, Float32

RATE = 44100  # samples a second
_TABLE = 4096


def hertz(pitch: float) -> float:
    """Frequency of a MIDI note, equal temperament, A4 (69) = 440 Hz.

    Examples
    --------
    >>> hertz(57)
    220.0
    """
    return 440.0 * 2.0 ** ((pitch - 69.0) / 12.0)


@functools.lru_cache(maxsize=512)
def wave_table(frequency: float, roll_off: float, formant: float = 0.0) -> Float32:
    """One period of a harmonic sound with amplitudes h^(−roll_off), nothing above 16 kHz, so that nothing aliases.

    A ``formant`` [Hz] raises the harmonics near it, as the body of an instrument does; 0 is none.
    """
    count = max(1, min(int(16000.0 / frequency), 60))
    harmonics = np.arange(1, count + 1)
    amplitudes = harmonics**-roll_off
    if formant:
        amplitudes *= 1.0 + 1.5 * np.exp(-(np.log2(harmonics * frequency / formant) ** 2) * 2.0)
    phases = np.arange(_TABLE) / _TABLE * 2.0 * np.pi
    table = (np.sin(phases[:, None] * harmonics[None, :]) * amplitudes).sum(axis=1)
    table = (table / np.abs(table).max()).astype(np.float32)
    table.setflags(write=False)
    return table


def oscillate(
    table: Float32, frequency: float, length: int, bend: Float32 | None = None, phase: float = 0.0
) -> Float32:
    """Read a wave table at ``frequency`` [Hz] for ``length`` samples; ``bend`` (length,) multiplies the frequency."""
    step = frequency / RATE * _TABLE
    places = (np.arange(length) if bend is None else np.cumsum(bend, dtype=np.float64)) * step
    return table[(places + phase * _TABLE).astype(np.int64) & (_TABLE - 1)]


def swell(length: int, attack: float, release: float) -> Float32:
    """(length,) an envelope that rises in ``attack`` and falls in ``release`` seconds, both as half cosines."""
    envelope = np.ones(length, dtype=np.float32)
    rise = min(max(int(attack * RATE), 1), length)
    fall = min(max(int(release * RATE), 1), length)
    envelope[:rise] *= (0.5 - 0.5 * np.cos(np.pi * np.arange(rise) / rise)).astype(np.float32)
    envelope[length - fall :] *= (0.5 + 0.5 * np.cos(np.pi * np.arange(1, fall + 1) / fall)).astype(np.float32)
    return envelope


def decay(length: int, halflife: float) -> Float32:
    """(length,) an envelope that halves every ``halflife`` seconds."""
    return np.exp2(-np.arange(length) / (halflife * RATE)).astype(np.float32)


def vibrato(length: int, rate: float, cents: float, delay: float, phase: float = 0.0) -> Float32:
    """(length,) frequency ratios of a vibrato of ``rate`` [Hz] that opens over ``delay`` seconds."""
    times = np.arange(length) / RATE
    depth = cents / 1200.0 * np.log(2.0) * np.clip((times - delay) / max(delay, 1e-3), 0.0, 1.0)
    return (1.0 + depth * np.sin(2.0 * np.pi * (rate * times + phase))).astype(np.float32)


def shape(sound: Array | Float32, *envelopes: Array | Float32) -> Float32:
    """A sound times its envelopes, in single precision."""
    shaped = sound.astype(np.float32)
    for envelope in envelopes:
        shaped *= envelope.astype(np.float32)
    return shaped


def pluck(pitch: float, seconds: float, bright: float, ring: float, rng: np.random.Generator) -> Float32:
    """A plucked string after Karplus and Strong (1983), its period tuned between samples.

    ``y[n] = x[n] + g·((1−b)(1−f)·y[n−P] + ((1−b)f + b(1−f))·y[n−P−1] + bf·y[n−P−2])``, a burst of noise x of one
    period, P + f + b samples a period, b the damping of high tones (less when ``bright``, 0…1), g so that it decays by
    60 dB in ``ring`` seconds. Computed a period at a time, for the loop only looks back further than that.
    """
    period = RATE / hertz(pitch)
    damp = 0.5 - 0.45 * bright
    delay = int(period - damp)
    rest = period - damp - delay
    gain = 10.0 ** (-3.0 * period / RATE / ring)
    near, middle, far = (
        gain * weight for weight in ((1 - damp) * (1 - rest), (1 - damp) * rest + damp * (1 - rest), damp * rest)
    )
    sound = np.zeros(int(seconds * RATE) + delay + 2)
    burst = rng.uniform(-1.0, 1.0, delay)
    burst = np.convolve(burst, np.hanning(7 if bright > 0.6 else 13), mode="same")
    comb = burst - np.roll(burst, int(delay * 0.18))  # plucked at a fifth of the string: those harmonics are missing
    sound[2 : delay + 2] = comb - comb.mean()
    for start in range(delay + 2, len(sound), delay):
        stop = min(start + delay, len(sound))
        here = slice(start - delay, stop - delay)
        one, two = (slice(here.start - back, here.stop - back) for back in (1, 2))
        sound[start:stop] = near * sound[here] + middle * sound[one] + far * sound[two]
    sound = sound[2 : int(seconds * RATE) + 2]
    sound[:32] *= np.linspace(0.0, 1.0, 32)
    return shape(sound / np.abs(sound).max(), swell(len(sound), 0.0, 0.06))
