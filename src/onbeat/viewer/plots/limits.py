"""Which joints a dance asks too much of: how much of its speed limit each one needs, as wished and as retimed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from onbeat.retime.retime import Retimed
from onbeat.viewer.plots.files import new_figure, save_figure
from onbeat.viewer.plots.retime import GRID, INK, LIMIT, WISH, colour_of
from onbeat.viewer.plots.retime_curves import joint_told, one_dance, speed_told, speed_use

MOST = 3.0
"""Bars end here at the latest; their number is told."""
APART = 0.22
"""Rows between the marks of methods."""


def limits_figure(results: Sequence[Retimed]) -> Any:
    """Bars of the joints, those over their limits on top, and a mark for each method; 1 is the limit.

    Parameters
    ----------
    results : of methods on one dance in one time.

    Raises
    ------
    OnbeatError
        If there is no result, or they are of different dances.
    """
    first = one_dance(results)
    wished, over = speed_use(first, first.demand.wish)
    order = np.argsort(wished, kind="stable")
    figure = new_figure((9.0, 1.6 + 0.21 * len(order)))
    axes = figure.subplots()
    end = min(max(1.15, 1.08 * float(wished.max(initial=0.0))), MOST)
    _bars(axes, wished[order], over[order], end)
    for place, result in enumerate(results):
        reached = speed_use(result, result.answer.trajectory).highest[order]
        rows = np.arange(len(order)) + APART * ((len(results) - 1) / 2 - place)
        style = {"color": colour_of(result.method), "ms": 5, "mec": "white", "mew": 0.5}
        axes.plot(np.minimum(reached, end), rows, "o", label=result.method, zorder=4, **style)
    names = [joint_told(first.source.joints[place]) for place in order.tolist()]
    axes.set_yticks(np.arange(len(order)), names, fontsize=8, parse_math=False)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=8)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.set_xlim(0.0, end)
    axes.set_xlabel("highest speed, as a share of the joint's limit", fontsize=9)
    axes.grid(color=GRID, lw=0.6, axis="x")
    axes.margins(y=0.01)
    knots = first.demand.wish.knots
    told = [speed_told(first, knots.start, knots.end), first.limits.name, first.source.name]
    count = int((over > 0).sum())
    head = f"{count} of {len(order)} joints would be over their speed limit"
    figure.suptitle(" · ".join([head, *filter(None, told)]), fontsize=10, parse_math=False)
    handles, labels = axes.get_legend_handles_labels()
    first_bars = [*range(len(results), len(labels)), *range(len(results))]
    shown = [handles[k] for k in first_bars], [labels[k] for k in first_bars]
    figure.legend(*shown, loc="outside lower center", ncols=8, frameon=False, fontsize=9)
    return figure


def write_limits_figure(path: Path, results: Sequence[Retimed]) -> None:
    """Draw it to a PNG, SVG or PDF file; arguments and errors as :func:`limits_figure`."""
    save_figure(limits_figure(results), path)


def _bars(axes: Any, wished: np.ndarray, over: np.ndarray, end: float) -> None:
    """The wish: what is inside the limit grey, what is over it red, with the seconds in all that it is."""
    rows = np.arange(len(wished))
    axes.barh(rows, np.minimum(wished, 1.0), color=WISH, alpha=0.75, height=0.72, label="wish", zorder=2)
    red = over > 0
    if red.any():
        wide = np.minimum(wished[red], end) - 1.0
        axes.barh(
            rows[red], wide, left=1.0, color=LIMIT, height=0.72, label="wish over the limit, for so long", zorder=2
        )
    axes.axvline(1.0, color=INK, lw=1.2, zorder=3)
    for row in rows[red].tolist():
        told = f"{over[row]:.2f} s" + (f", up to {wished[row]:.1f}" if wished[row] > end else "")
        axes.annotate(
            told,
            (min(wished[row], end), row),
            (4, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.5,
            color=LIMIT,
        )
