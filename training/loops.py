"""Drum loops drawn at random: one or two bars that repeat, built as drummers and machines build them."""

from __future__ import annotations

import numpy as np

KICK = (0.92, 0.05, 0.12, 0.15, 0.15, 0.08, 0.22, 0.25, 0.45, 0.1, 0.42, 0.2, 0.1, 0.08, 0.25, 0.14)
HATS = (
    "x.x.x.x.x.x.x.x.",
    "xxxxxxxxxxxxxxxx",
    "x...x...x...x...",
    "..x...x...x...x.",
    "x.xxx.xxx.xxx.xx",
    "xoxoxoxoxoxoxoxo",
    "Xox.Xox.Xox.Xox.",
)


def euclid(hits: int, steps: int, turn: int) -> str:
    """Hits spread as evenly as they can be, turned.

    >>> euclid(3, 8, 0)
    'x..x..x.'
    """
    at = {(-(-hit * steps // hits) + turn) % steps for hit in range(hits)}
    return "".join("x" if step in at else "." for step in range(steps))


def _kick(rng: np.random.Generator, spread: float) -> str:
    chance = np.array(KICK) ** (1.0 / spread)
    return "".join("X" if rng.random() < c else "." for c in chance)


def _snare(rng: np.random.Generator, ghosts: float) -> str:
    marks = ["o" if rng.random() < ghosts else "." for _ in range(16)]
    for at in (8,) if rng.random() < 0.12 else (4, 12):
        if rng.random() < 0.93:
            moved = at + int(rng.choice((-2, -1, 1, 2, 3))) if rng.random() < 0.1 else at
            marks[moved % 16] = "X"
    return "".join(marks)


def _hat(rng: np.random.Generator) -> str:
    if rng.random() < 0.2:
        return "".join("x" if rng.random() < 0.6 else "." for _ in range(16))
    return "".join(m if rng.random() < 0.95 else "." for m in str(rng.choice(HATS)))


def draw_loop(rng: np.random.Generator) -> dict[str, str]:
    """A pattern of 16 or 32 steps for each letter of ``KEYS`` that plays."""
    spread, ghosts = float(rng.uniform(0.6, 1.3)), float(rng.choice((0.0, 0.05, 0.15, 0.25)))
    bars = int(rng.choice((1, 2, 2)))
    loop = {
        "K": "".join(_kick(rng, spread) for _ in range(bars)),
        "S": "".join(_snare(rng, ghosts) for _ in range(bars)),
    }
    if rng.random() < 0.12:
        loop["K"] = "X...X...X...X..." * bars
    if rng.random() < 0.88:
        loop[str(rng.choice(("H", "H", "H", "D", "a", "T")))] = _hat(rng) * bars
    if rng.random() < 0.35:
        loop["O"] = euclid(int(rng.choice((1, 2, 4))), 16, int(rng.choice((2, 6, 14)))) * bars
    for letter in rng.choice(list("hlbfgkjcWRat"), int(rng.choice((0, 0, 1, 2))), replace=False):
        loop[str(letter)] = (
            euclid(int(rng.integers(2, 8)), 16, int(rng.integers(16)) if rng.random() < 0.4 else 0) * bars
        )
    return loop
