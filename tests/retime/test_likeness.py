"""How alike repetitions are: of one dance, of another, shifted, and of none at all."""

from __future__ import annotations

import numpy as np

from onbeat.retime.likeness import ALIKE, likeness
from onbeat.retime.takes import DENSITY, Repetitions

BEATS = 8


def repeated(*seeds: int, still: int | None = None, turn: float = 0.0, noise: float = 0.0) -> Repetitions:
    """Repetitions of random dances of 3 joints, the same seed the same dance; ``turn`` is how one holds itself."""
    at = 2 * np.pi * np.arange(BEATS * DENSITY + 1) / (BEATS * DENSITY)
    layers = np.zeros((len(seeds), 2, len(at), 3, 3))
    for number, seed in enumerate(seeds):
        waves = np.random.default_rng(seed).normal(size=(4, 2, 3, 3))
        for rate, (sine, cosine) in enumerate(waves, 1):
            layers[number, 0] += np.sin(rate * at)[:, None, None] * sine + np.cos(rate * at)[:, None, None] * cosine
        layers[number, 1] = number * turn + noise * np.random.default_rng(99 + number).normal(size=layers.shape[2:])
    if still is not None:
        layers[still] = 0.3
    return Repetitions(at, ("a", "b", "c"), layers, np.ones(len(seeds)), np.arange(len(seeds)), 0)


def test_one_dance_is_alike_however_it_is_held_and_others_are_not() -> None:
    found = likeness(repeated(1, 1, 1, turn=0.5, noise=0.3))
    assert found.each.min() > 0.9
    assert abs(found.shifted) < 3 * found.deviation
    odd = likeness(repeated(1, 1, 1, 2))
    assert (odd.each[:3] > ALIKE).all()
    assert odd.each[3] < ALIKE
    assert likeness(repeated(1, 2)).each.max() < ALIKE


def test_a_repetition_that_begins_elsewhere_is_not_alike() -> None:
    some = repeated(1, 1)
    late = np.array(some.layers)
    late[1] = np.roll(late[1], 2 * DENSITY, axis=1)
    found = likeness(Repetitions(some.beats, some.joints, late, some.speeds, some.takes, 0))
    assert found.each.max() < ALIKE


def test_what_does_not_move_has_no_likeness() -> None:
    with np.errstate(all="raise"):
        assert np.isnan(likeness(repeated(1, 1, 1, still=0)).each).tolist() == [True, False, False]
        assert np.isnan(likeness(repeated(1, 1, still=0)).each).all()
