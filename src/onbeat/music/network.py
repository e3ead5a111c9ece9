"""The learned activation's arithmetic on whole songs: convolutions over frequency, then dilated ones over time.

After Davies & Böck 2019 ("Temporal convolutional networks for musical audio beat tracking"), smaller. Every sum of
products is a product of matrices on a fixed number of frames, so that a song always gives the same bits.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from onbeat._shapes import Float32

Weights = Mapping[str, Float32]
"""``first``, ``second``, ``third``, ``wide``, ``mix``, ``last`` and the ``_bias`` of each: (…, inputs, outputs)."""

CHUNK = 4096  # frames worked on at a time
FRONT_REACH = 2  # frames that the two convolutions over frequency reach over time, each


def elu(values: Float32) -> Float32:
    """``x`` above 0, ``exp(x) − 1`` below; in place.

    >>> elu(np.array([0.0, 2.0], np.float32)).tolist()
    [0.0, 2.0]
    """
    np.maximum(values, np.expm1(np.minimum(values, 0.0)), out=values)
    return values


def dilations(weights: Weights) -> list[int]:
    """Frames between the taps of each dilated layer: 1, 2, 4, …"""
    return [2**layer for layer in range(len(weights["wide"]))]


def _windows(values: Float32, axis: int, size: int, stride: int) -> Float32:
    """All windows of ``size`` along an axis; their places stay on it, what is in them is the last axis."""
    windows = np.lib.stride_tricks.sliding_window_view(values, size, axis=axis)
    return np.moveaxis(np.moveaxis(windows, axis, 0)[::stride], 0, axis)


def _padded(values: Float32, axis: int, before: int, after: int) -> Float32:
    width = [(0, 0)] * values.ndim
    width[axis] = (before, after)
    return np.pad(values, width)


def _time_windows(values: Float32, causal: bool) -> Float32:
    """(N, …, 3): each frame with the two before it, or the one before and the one after."""
    return _windows(_padded(values, 0, *((2, 0) if causal else (1, 1))), 0, 3, 1)


def _front(features: Float32, weights: Weights, causal: bool) -> Float32:
    """(N, 2, B) to (N, channels): two convolutions over time and frequency, and a product over what is left."""
    near = _time_windows(_windows(_padded(features, 2, 2, 2), 2, 5, 2), causal)  # (N, 2, 32, 5, 3)
    frames = len(features)
    rows = near.transpose(0, 2, 4, 1, 3).reshape(frames, -1, len(weights["first"]))
    inner = elu(rows @ weights["first"] + weights["first_bias"])
    near = _time_windows(_windows(_padded(inner, 1, 1, 1), 1, 5, 3), causal)  # (N, 10, 8, 5, 3)
    rows = near.transpose(0, 1, 4, 3, 2).reshape(frames, -1, len(weights["second"]))
    inner = elu(rows @ weights["second"] + weights["second_bias"])
    return elu(inner.reshape(frames, -1) @ weights["third"] + weights["third_bias"])


def front(features: Float32, weights: Weights, causal: bool) -> Float32:
    """(N, channels) of a stretch of features (N, 2, B), worked on in chunks."""
    parts: list[Float32] = []
    reach = 2 * FRONT_REACH
    for begin in range(0, len(features), CHUNK):
        first = max(begin - reach, 0)
        part = _front(features[first : begin + CHUNK + reach], weights, causal)
        parts.append(part[begin - first :][:CHUNK])
    return np.concatenate(parts)


def _layer(values: Float32, layer: int, weights: Weights, causal: bool) -> Float32:
    """One dilated layer: values + mix · elu(taps)."""
    taps, dilation = weights["wide"][layer], dilations(weights)[layer]
    shift = [(tap - (4 if causal else 2)) * dilation for tap in range(len(taps))]
    result = values.copy()
    for begin in range(0, len(values), CHUNK):
        end = min(begin + CHUNK, len(values))
        inner = np.tile(weights["wide_bias"][layer], (end - begin, 1))
        for tap, step in enumerate(shift):
            first, last = max(begin + step, 0), min(end + step, len(values))
            if first < last:
                inner[first - begin - step : last - begin - step] += values[first:last] @ taps[tap]
        result[begin:end] += elu(inner) @ weights["mix"][layer] + weights["mix_bias"][layer]
    return result


def logits(values: Float32, weights: Weights, causal: bool) -> Float32:
    """Log odds (N, 2) of a beat and of a downbeat from what :func:`front` gives (N, channels)."""
    for layer in range(len(weights["wide"])):
        values = _layer(values, layer, weights, causal)
    return elu(values.copy()) @ weights["last"] + weights["last_bias"]
