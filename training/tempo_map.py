"""Where the beats of a clip are: steady, drifting, ramps, steps, and the breathing of a soloist."""

from __future__ import annotations

import numpy as np

SLOWEST, FASTEST = 38.0, 245.0


def _curve(rng: np.random.Generator, count: int, meter: int, beat: float) -> np.ndarray:
    """Ratio to the tempo at each beat."""
    kind = rng.choice(("steady", "drift", "ramp", "step"), p=(0.55, 0.2, 0.12, 0.13))
    index = np.arange(count)
    if kind == "drift":
        return 1.0 + rng.uniform(0.02, 0.13) * np.sin(2 * np.pi * (index * beat / rng.uniform(8, 40) + rng.random()))
    if kind == "ramp":
        begin, end = np.sort(rng.integers(0, count, 2))
        return np.interp(index, [begin, max(end, begin + 8)], [1.0, 1.0 + rng.uniform(-0.3, 0.4)])
    if kind == "step":
        ratios = 1.0 + rng.uniform(-0.3, 0.3, 3) * (rng.random(3) < 0.7)
        bars = np.sort(rng.integers(1, max(count // meter, 2), 2)) * meter
        return ratios[np.searchsorted(bars, index, side="right")]
    return np.ones(count)


def _breathing(rng: np.random.Generator, count: int, meter: int) -> np.ndarray:
    """Phrases that slow down at their ends, and a slow wandering."""
    index = np.arange(count)
    phrase = meter * int(rng.choice((2, 4, 4, 8)))
    place = ((index + int(rng.integers(phrase))) % phrase) / phrase
    depth = rng.uniform(0.0, 0.35) * rng.random()
    arc = 1.0 + depth * (0.35 * np.sin(np.pi * place) - np.maximum(place - 0.75, 0.0) * 2.2)
    wander = np.zeros(count)
    noise = rng.normal(size=count) * rng.uniform(0.01, 0.06)
    for beat in range(1, count):
        wander[beat] = 0.85 * wander[beat - 1] + noise[beat]
    single = rng.normal(size=count) * rng.uniform(0.0, 0.05)
    pauses = 1.0 - (rng.random(count) < 0.01) * rng.uniform(0.2, 0.5)
    return np.clip(arc * np.exp(wander + single) * pauses, 0.45, 1.9)


def beat_grid(rng: np.random.Generator, tempo: float, meter: int, seconds: float, expressive: bool) -> np.ndarray:
    """Times of beats, the first a downbeat at or before 0; music may begin late and end early."""
    beat = 60.0 / tempo
    count = int((seconds + 2 * meter * beat) / beat * 2.2) + 2 * meter
    ratio = _curve(rng, count, meter, beat) if not expressive or rng.random() < 0.15 else np.ones(count)
    if expressive:
        ratio = ratio * _breathing(rng, count, meter)
    bpm = np.clip(tempo * ratio, SLOWEST, FASTEST)
    start = -rng.uniform(0.0, meter * beat) if rng.random() < 0.7 else rng.uniform(0.0, 3.0)
    beats = start + np.concatenate([[0.0], np.cumsum(60.0 / bpm)])
    end = seconds if rng.random() < 0.85 else seconds - rng.uniform(0.5, 3.0)
    return beats[: max(int(np.searchsorted(beats, end)), 2 * meter + 1)]
