"""A confusion matrix as a figure: how often what was danced was taken for which."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

NEW = "new"
"""What is taken for none of those known; the last column."""
_CELL, _MARGIN, _LARGEST = 0.42, 2.2, 24.0  # inches
_LEGIBLE = 60  # names a side, above which cells hold no numbers


def write_confusion(path: Path, confusion: Mapping[str, Mapping[str, int]], title: str = "") -> None:
    """Draw a confusion matrix to a PNG, SVG or PDF file, each row in shares of its own.

    Parameters
    ----------
    path : the file.
    confusion : of each true name, how often it was taken for which.
    title : above it.

    Raises
    ------
    OnbeatError
        If the ending is none of these.
    """
    from onbeat.viewer.plots.files import new_figure, save_figure

    rows, columns = names_of(confusion)
    counts = np.array([[confusion[true].get(found, 0) for found in columns] for true in rows], np.float64)
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    wide, high = (min(_MARGIN + _CELL * n, _LARGEST) for n in (len(columns), len(rows)))
    figure = new_figure((max(wide, 4.0), high))
    axes = figure.subplots()
    drawn = axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="equal")
    small = 8.0 if max(len(rows), len(columns)) <= _LEGIBLE else 4.0
    plain = {"parse_math": False, "fontsize": small}  # names may hold dollars
    axes.set_xticks(range(len(columns)), columns, rotation=45, ha="right", rotation_mode="anchor", **plain)
    axes.set_yticks(range(len(rows)), rows, **plain)
    axes.set(xlabel="taken for", ylabel="danced")
    axes.set_title(title, fontsize=10, parse_math=False)
    axes.axvline(len(columns) - 1.5, color="#8d93a5", lw=1.0)
    if small > 4.0:
        for row, column in zip(*np.nonzero(counts), strict=True):
            ink = "white" if shares[row, column] > 0.55 else "#262b3d"
            axes.text(column, row, f"{counts[row, column]:.0f}", ha="center", va="center", color=ink, fontsize=8)
    figure.colorbar(drawn, ax=axes, label="share of the row", shrink=0.8)
    save_figure(figure, path)


def names_of(confusion: Mapping[str, Mapping[str, int]]) -> tuple[list[str], list[str]]:
    """The names of rows and of columns: those danced first in both, so that what is right lies on the diagonal.

    Examples
    --------
    >>> names_of({"bow": {"new": 1}, "turn": {"turn": 2, "jump": 1}})
    (['bow', 'turn'], ['bow', 'turn', 'jump', 'new'])
    """
    rows = sorted(name for name in confusion)
    others = sorted({found for row in confusion.values() for found in row} - {*rows, NEW})
    return rows, [*(name for name in rows if name != NEW), *others, NEW]
