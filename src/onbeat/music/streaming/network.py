"""The learned activation's arithmetic frame by frame: the same network with what it has heard kept in rings.

Compiled and in one order, so that the size of the blocks changes no bit.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from onbeat._shapes import Array, Float32, Ints
from onbeat.music.levels import QUIETEST, RANGE

TAPS = 5  # of a dilated layer
TIMES = 3  # frames that a convolution over frequency sees


@numba.njit(cache=True)
def _elu(value: float) -> float:
    return value if value > 0.0 else math.expm1(value)


@numba.njit(cache=True)
def _features(frame: Float32, level: float, ring: Float32, now: int) -> None:
    """Levels and rises of a frame into ``ring`` (3, 2, bands + 4), whose margins stay 0."""
    bands = len(frame)
    row, old = ring[now % TIMES], ring[(now - 2) % TIMES, 0]
    for band in range(bands):
        above = max(frame[band] - level + RANGE, -4.0)
        row[0, band + 2] = math.log10(1.0 + 10.0**above) * 2.0 / RANGE
    for band in range(bands):
        highest = max(old[band + 1], old[band + 2], old[band + 3])
        row[1, band + 2] = max(row[0, band + 2] - highest, np.float32(0.0))


@numba.njit(cache=True)
def _first(ring: Float32, now: int, kernel: Float32, bias: Float32, out: Float32) -> None:
    """Convolution over time and frequency into ``out`` (34, channels), whose margins stay 0."""
    for place in range(len(out) - 2):
        total = out[place + 1]
        total[:] = bias
        for time in range(TIMES):
            row = ring[(now - 2 + time) % TIMES]
            for channel in range(2):
                for step in range(5):
                    value = row[channel, 2 * place + step]
                    if value != 0.0:
                        weight = kernel[(time * 2 + channel) * 5 + step]
                        for index in range(len(total)):
                            total[index] += value * weight[index]
        for index in range(len(total)):
            total[index] = _elu(total[index])


@numba.njit(cache=True)
def _second(ring: Float32, now: int, kernel: Float32, bias: Float32, out: Float32) -> None:
    """Convolution over time and frequency into ``out`` (10, channels)."""
    channels = ring.shape[2]
    for place in range(len(out)):
        total = out[place]
        total[:] = bias
        for time in range(TIMES):
            for step in range(5):
                row = ring[(now - 2 + time) % TIMES, 3 * place + step]
                for channel in range(channels):
                    value = row[channel]
                    weight = kernel[(time * 5 + step) * channels + channel]
                    for index in range(len(total)):
                        total[index] += value * weight[index]
        for index in range(len(total)):
            total[index] = _elu(total[index])


@numba.njit(cache=True)
def _product(values: Float32, matrix: Float32, total: Float32) -> None:
    """Add ``values`` times ``matrix`` (inputs, outputs) to ``total``."""
    for row in range(len(values)):
        value, weight = values[row], matrix[row]
        for index in range(len(total)):
            total[index] += value * weight[index]


@numba.njit(cache=True)
def _layers(
    values: Float32,
    now: int,
    rings: Float32,
    begins: Ints,
    wide: Float32,
    wide_bias: Float32,
    mix: Float32,
    mix_bias: Float32,
) -> None:
    """All dilated layers on ``values`` (channels,), in place; ``rings`` holds each layer's past inputs."""
    inner = np.empty_like(values)
    for layer in range(len(wide)):
        dilation = 2**layer
        length = 4 * dilation + 1
        begin = begins[layer]
        rings[begin + now % length] = values
        inner[:] = wide_bias[layer]
        for tap in range(TAPS):
            back = now - (TAPS - 1 - tap) * dilation
            if back >= 0:
                _product(rings[begin + back % length], wide[layer, tap], inner)
        for index in range(len(inner)):
            inner[index] = _elu(inner[index])
            values[index] += mix_bias[layer, index]
        _product(inner, mix[layer], values)


@numba.njit(cache=True)
def run(
    bands: Float32,
    state: Array,
    near: Float32,
    inner: Float32,
    rings: Float32,
    begins: Ints,
    first: Float32,
    first_bias: Float32,
    second: Float32,
    second_bias: Float32,
    third: Float32,
    third_bias: Float32,
    wide: Float32,
    wide_bias: Float32,
    mix: Float32,
    mix_bias: Float32,
    last: Float32,
    last_bias: Float32,
    forgiving: float,
) -> Float32:
    """Log odds (n, 2) at frames (n, B); ``state`` (frames so far, level of the loud passages) and the rings go on."""
    result = np.empty((len(bands), 2), np.float32)
    middle = np.empty((len(third) // len(second_bias), len(second_bias)), np.float32)
    values = np.empty(len(third_bias), np.float32)
    for frame in range(len(bands)):
        now = int(state[0])
        state[0] += 1.0
        state[1] = max(float(bands[frame].max()), state[1] - forgiving, QUIETEST)
        _features(bands[frame], state[1], near, now)
        _first(near, now, first, first_bias, inner[now % TIMES])
        _second(inner, now, second, second_bias, middle)
        values[:] = third_bias
        _product(middle.reshape(-1), third, values)
        for index in range(len(values)):
            values[index] = _elu(values[index])
        _layers(values, now, rings, begins, wide, wide_bias, mix, mix_bias)
        for index in range(len(values)):
            values[index] = _elu(values[index])
        result[frame] = last_bias
        _product(values, last, result[frame])
    return result
