"""What the learned activation is worth: the default method beside the unlearned one, category by category.

Usage: ``python benchmarks/activation.py FOLDER``, a folder as ``beats.py`` takes it. Of each gain the interval holds
95 % of 10,000 draws of the pieces with replacement (paired bootstrap). *set* is a piece's name up to the first
underscore.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from beats import COLUMNS, Piece, hear_ourselves, read_pieces, scores

WITHOUT, WITH = "onsets", "barpointer"
SCORES = 4  # the first columns
DRAWS = 10_000


def groups(pieces: Sequence[Piece]) -> dict[str, list[int]]:
    """Pieces (their indices) of each set and category, and all of them."""
    found: dict[str, list[int]] = {}
    for index, piece in enumerate(pieces):
        found.setdefault(f"set {piece.path.stem.partition('_')[0]}", []).append(index)
    for index, piece in enumerate(pieces):
        found.setdefault(piece.category, []).append(index)
    return found | {"all": list(range(len(pieces)))}


def gain(without: np.ndarray, learned: np.ndarray) -> str:
    """Both means, their difference and its interval."""
    difference = learned - without
    rng = np.random.default_rng(0)
    means = difference[rng.integers(0, len(difference), (DRAWS, len(difference)))].mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return f"{without.mean():.2f} {learned.mean():.2f} {difference.mean():+.3f} [{low:+.2f} {high:+.2f}]"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    pieces = read_pieces(parser.parse_args().folder)
    rows = {
        method: np.array([scores(*pair) for pair in zip(pieces, hear_ourselves(pieces, method), strict=True)])
        for method in (WITHOUT, WITH)
    }
    print(f"{'':<27}" + "".join(f"{name:^33}" for name in COLUMNS[:SCORES]))
    print(f"{'':<27}" + f"{'without with gain [95 %]':^33}" * SCORES)
    for label, chosen in groups(pieces).items():
        cells = [gain(rows[WITHOUT][chosen, column], rows[WITH][chosen, column]) for column in range(SCORES)]
        print(f"{label[:22]:<23}{len(chosen):>3} " + "".join(f"{cell:^33}" for cell in cells))


if __name__ == "__main__":
    main()
