"""Takes as they are recorded: the dancer is early or late for every keypose, and the capture is noisy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.examples.performer import Performance
from onbeat.motion import rotations as rot

NOISE = (0.006, 0.001)
"""Standard deviation of each frame's error: radians of every joint's rotation, metres of the root."""
SPREADS = ("uniform", "normal")
"""How the timing varies: within ± ``jitter``, or with ``jitter`` as its standard deviation."""
FARTHEST = 0.45
"""How far a keypose may move at most, in shares of the time to the nearest other one: their order stays."""


def rehearse(
    performance: Performance,
    rng: np.random.Generator,
    jitter: float = 0.06,
    noise: tuple[float, float] = NOISE,
    spread: str = "uniform",
) -> Performance:
    """The same performance by a human: keyposes early and late by chance, white noise on every frame.

    All of the body is warped in time together, smoothly, so that each keypose falls on its new time; ``keyposes`` and
    ``contacts`` of the result are true for the new motion, ``beats`` are still the music's.

    Parameters
    ----------
    performance : a clip with its ground truth.
    rng : the same generator gives the same take.
    jitter : seconds, how early or late; what it means is said by ``spread``.
    noise : radians and metres, see ``NOISE``.
    spread : one of ``SPREADS``.

    Raises
    ------
    PlanError
        If ``spread`` is unknown, or ``jitter`` or ``noise`` is negative or not a number.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.dances import perform_dance
    >>> clip = perform_dance(DANCERS[0], "folk dance", 1.0, 1, np.random.default_rng(0))
    >>> take = rehearse(clip, np.random.default_rng(0))
    >>> (1000 * (take.keyposes - clip.keyposes)).round().astype(int).tolist()
    [16, -28, -55, -58, 38, 50, 13, 28]
    """
    if spread not in SPREADS:
        raise PlanError(f"no spread {spread!r}; there are {' and '.join(SPREADS)}")
    if not all(np.isfinite(value) and value >= 0 for value in (jitter, *noise)):
        raise PlanError(f"jitter {jitter} s and noise {noise} have to be numbers, none below 0")
    keyposes = performance.keyposes + _shifts(performance, rng, jitter, spread)
    motion = performance.motion
    shown = _shown(motion.times, performance.keyposes, keyposes)
    moved = motion.at(shown)
    rotations = rot.multiply(moved.rotations, rot.exp(rng.normal(0.0, noise[0], (*moved.rotations.shape[:2], 3))))
    root = moved.root_positions + rng.normal(0.0, noise[1], moved.root_positions.shape)
    frames = np.round(shown * motion.fps).astype(np.int64)
    return replace(
        performance,
        motion=moved.replace(rotations=rotations, root_positions=root),
        keyposes=keyposes,
        contacts=performance.contacts[frames],
    )


def _shifts(performance: Performance, rng: np.random.Generator, jitter: float, spread: str) -> Array:
    """Seconds (K,) by which each keypose is late."""
    count = len(performance.keyposes)
    drawn = rng.uniform(-jitter, jitter, count) if spread == "uniform" else rng.normal(0.0, jitter, count)
    last = performance.motion.times[-1]
    gaps = np.diff(np.concatenate([[0.0], performance.keyposes, [last]]))
    most = FARTHEST * np.minimum(gaps[:-1], gaps[1:])
    return np.clip(drawn, -most, most)


def _shown(times: Times, before: Times, after: Times) -> Times:
    """The moment (F,) of the performance that each frame of the take shows."""
    ends = times[[0, -1]]
    warp = PchipInterpolator(np.concatenate([ends[:1], after, ends[1:]]), np.concatenate([ends[:1], before, ends[1:]]))
    return np.clip(warp(times), *ends)
