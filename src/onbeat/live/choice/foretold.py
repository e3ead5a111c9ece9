"""What stops are worth on beats that are foretold."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.dance.score import FINE, HIT_WIDTH, OFF_BEAT
from onbeat.errors import PlanError
from onbeat.live.choice.ground import PAD
from onbeat.moves.graph import GRID

REACH = 30.0
"""Seconds that are looked ahead at most."""


def beat_worths(beats: Times, weights: Array, total: int) -> Float32:
    """((T + 2 PAD) · FINE,) what a stop at each instant is worth, from ``PAD`` frames before now.

    As ``score.score_music``; but before the first beat and after the last, where nothing is known, a stop costs
    nothing.

    Examples
    --------
    >>> worth = beat_worths(np.array([0.5, 1.0]), np.ones(2), 60)
    >>> at = lambda second: round(float(worth[round((second * GRID + PAD) * FINE)]), 2)
    >>> at(0.5), at(0.75), at(1.9)
    (0.58, -0.42, 0.0)
    """
    times = (np.arange((total + 2 * PAD) * FINE) / FINE - PAD) / GRID
    worth = np.zeros(len(times))
    if len(beats):
        gap = float(np.median(np.diff(beats))) / 2 if len(beats) > 1 else 0.25
        worth -= OFF_BEAT * ((times > beats[0] - gap) & (times < beats[-1] + gap))
    for beat, weight in zip(beats.tolist(), weights.tolist(), strict=True):
        low, high = np.searchsorted(times, (beat - 5 * HIT_WIDTH, beat + 5 * HIT_WIDTH))
        bump = weight * np.exp(-0.5 * ((times[low:high] - beat) / HIT_WIDTH) ** 2)
        worth[low:high] = np.maximum(worth[low:high], bump - OFF_BEAT)
    return worth.astype(np.float32)


def checked_beats(beats: Times, weights: Array | None) -> tuple[Times, Array]:
    """Beats in reach, and their weights; a ``PlanError`` says what is wrong with them."""
    beats = np.asarray(beats, dtype=np.float64)
    weights = np.ones(len(beats)) if weights is None else np.asarray(weights, dtype=np.float64)
    if beats.ndim != 1 or weights.shape != beats.shape:
        raise PlanError(f"beats of shape {beats.shape} and weights of {weights.shape}; expected (B,) of both")
    if not (np.isfinite(beats).all() and np.isfinite(weights).all() and (np.diff(beats) > 0).all()):
        raise PlanError("beats and their weights have to be numbers, and beats have to rise")
    near = (beats > -1.0) & (beats < 2 * REACH)
    return beats[near], weights[near]
