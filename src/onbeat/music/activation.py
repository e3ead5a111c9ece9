"""The learned activation: how likely each moment is a beat and a downbeat, by a small network.

Its weights were trained on songs of a pattern generator (the folder ``training/`` of the repository, which also says
with what licences); nothing that onbeat is tested with was used. Where ``p`` is a probability, ``log(p / (1 − p))`` is
the log odds that the bar-pointer model takes.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.hearing import ONSET_HOP
from onbeat.music.levels import FORGIVING, QUIETEST, loud_level, relative, with_rises
from onbeat.music.network import CHUNK, Weights, front, logits

BANDS = 64  # that the network hears: an eighth of an octave apart from 40 Hz
CHUNKS = 5 * CHUNK  # frames whose features are in memory at once
MARGIN = 8  # frames more on either side, as much as the features and the front look around


@cache
def network(name: str) -> Weights:
    """The weights called ``offline`` or ``causal``."""
    with files("onbeat.music").joinpath("activation_weights.npz").open("rb") as stream:
        stored: Any = np.load(stream, allow_pickle=False)
        prefix = f"{name}_"
        return {key.removeprefix(prefix): stored[key] for key in stored.files if key.startswith(prefix)}


def _fitted(bands: np.ndarray) -> np.ndarray:
    """Exactly ``BANDS`` bands: upper ones are left out or silent."""
    missing = BANDS - bands.shape[1]
    return np.pad(bands, ((0, 0), (0, missing)), constant_values=-10.0) if missing > 0 else bands[:, :BANDS]


def _features(bands: np.ndarray, level: Float32, begin: int, end: int) -> Float32:
    """Features of the frames from ``begin`` to ``end``."""
    first = max(begin - 2, 0)
    levels = relative(_fitted(bands[first:end]), level[first:end])
    before = np.zeros((2, BANDS), np.float32)
    before[2 - (begin - first) :] = levels[: begin - first]
    return with_rises(levels[begin - first :], before)


def activation_log_odds(bands: np.ndarray, rate: float) -> Float32:
    """Log odds (N, 2) that a beat, and that a downbeat, lies at each frame of a whole song.

    Parameters
    ----------
    bands : (N, B) log10 power as :func:`onbeat.music.hearing.hear` gives it.
    rate : frames per second.

    Examples
    --------
    >>> activation_log_odds(np.full((200, 64), -6.0, np.float16), 100.0).shape
    (200, 2)
    """
    if not len(bands):
        return np.zeros((0, 2), np.float32)
    weights = network("offline")
    level = loud_level(bands.max(axis=1).astype(np.float32), rate)
    parts: list[Float32] = []
    for begin in range(0, len(bands), CHUNKS):
        first, end = max(begin - MARGIN, 0), min(begin + CHUNKS + MARGIN, len(bands))
        parts.append(front(_features(bands, level, first, end), weights, False)[begin - first :][:CHUNKS])
    return logits(np.concatenate(parts), weights, False)


class CausalActivation:
    """Probabilities of a beat and a downbeat, frame by frame, with no look-ahead.

    Examples
    --------
    >>> CausalActivation().push(np.full((3, 64), -6.0, np.float32)).shape
    (3, 2)
    """

    def __init__(self) -> None:
        weights = network("causal")
        layers, channels = len(weights["wide"]), len(weights["third_bias"])
        lengths = [4 * 2**layer + 1 for layer in range(layers)]
        self._begins = np.concatenate([[0], np.cumsum(lengths)[:-1]])
        self._state: Array = np.array([0.0, QUIETEST])
        self._near = np.zeros((3, 2, BANDS + 4), np.float32)
        self._inner = np.zeros((3, BANDS // 2 + 2, len(weights["first_bias"])), np.float32)
        self._rings = np.zeros((sum(lengths), channels), np.float32)
        names = ("first", "second", "third", "wide", "mix", "last")
        self._weights = [weights[key] for name in names for key in (name, f"{name}_bias")]

    def push(self, bands: Float32) -> Float32:
        """Probabilities (n, 2) of a beat and a downbeat at each of the frames (n, B) of log10 power."""
        from onbeat.music.streaming.network import run  # compiled: not for those who hear whole songs

        frames = np.ascontiguousarray(_fitted(bands), dtype=np.float32)
        step: Any = run
        odds = step(
            frames,
            self._state,
            self._near,
            self._inner,
            self._rings,
            self._begins,
            *self._weights,
            FORGIVING * ONSET_HOP,
        )
        return (1.0 / (1.0 + np.exp(-odds))).astype(np.float32)
