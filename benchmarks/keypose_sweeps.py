"""Precision and recall over T1 and T2 from 0 to 10 (keyposes 2009, Figs. 4 and 5)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from keypose_troupe import Take, inside
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import DEFAULT, ORDERS
from onbeat.keyposes.matching import score

VALUES = np.arange(0.0, 10.0001, 0.1)
SHOWN = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0)
NEVER = 1000.0
"""A T2 that no rise exceeds."""
PLATEAU = 0.02

Curves = np.ndarray
"""(T, 3) precision, recall and F by beat over ``VALUES``."""


def sweeps(everyone: Mapping[str, Sequence[Take]], plot: Path | None) -> None:
    """Print, and draw, T1 and T2 swept, each with the other held at its default and switched off."""
    print("\nT1 and T2 from 0 to 10 in steps of 0.1, by beat, inside the cycles")
    print("plateau: where F is within .02 of its best; flat: the longest stretch over which F varies by .02 at most")
    drawn: dict[str, dict[str, Curves]] = {}
    for dance, made in everyone.items():
        drawn[dance] = {}
        for order in ("global-local", "global"):
            for name, pairs in swept().items():
                curves = over(made, pairs, order)
                drawn[dance][f"{name}, {order}"] = curves
                describe(f"{dance}, {order}, {name}", curves)
    if plot is not None:
        draw(drawn, plot)


def swept() -> dict[str, list[Thresholds]]:
    """Both thresholds swept with the other held: at its default, and where it passes nothing."""
    return {
        f"T1, T2 {DEFAULT.t2:g}": [Thresholds(v, DEFAULT.t2) for v in VALUES],
        "T1, T2 off": [Thresholds(v, NEVER) for v in VALUES],
        f"T2, T1 {DEFAULT.t1:g}": [Thresholds(DEFAULT.t1, v) for v in VALUES],
        "T2, T1 off": [Thresholds(0.0, v) for v in VALUES],
    }


def over(made: Sequence[Take], pairs: Sequence[Thresholds], order: str) -> Curves:
    assert order in ORDERS
    total = np.zeros((len(pairs), 3))
    for take in made:
        take.reading.options = replace(take.reading.options, order=order)
        truth = take.truth.astype(float)
        for row, pair in zip(total, pairs, strict=True):
            row += score(inside(take.reading.keyposes(pair), take).beats.astype(float), truth, 0.1)
        take.reading.options = replace(take.reading.options, order=ORDERS[0])
    return total / len(made)


def describe(name: str, curves: Curves) -> None:
    f = curves[:, 2]
    good = f >= f.max() - PLATEAU
    spans = ", ".join(f"{a:.1f}–{b:.1f}" for a, b in stretches(good))
    worst = int(f.argmin())
    first, last = flattest(f)
    print(f"\n{name}: best F {f.max():.3f}; plateau {good.mean():.0%} of the range ({spans}); flat over "
          f"{(last - first + 1) / len(f):.0%} ({VALUES[first]:.1f}–{VALUES[last]:.1f}) at "
          f"{f[first : last + 1].mean():.3f}; worst F {f[worst]:.3f} at {VALUES[worst]:.1f}")  # fmt: skip
    at = [round(value / 0.1) for value in SHOWN]
    print(f"{'':12s}" + "".join(f"{VALUES[k]:7.1f}" for k in at))
    for label, column in zip(("precision", "recall", "F"), curves.T, strict=True):
        print(f"{label:12s}" + "".join(f"{column[k]:7.3f}" for k in at), flush=True)


def flattest(f: np.ndarray) -> tuple[int, int]:
    """The longest stretch over which F varies by no more than ``PLATEAU``, at whatever height."""
    best = (0, 0)
    for first in range(len(f)):
        varies = np.maximum.accumulate(f[first:]) - np.minimum.accumulate(f[first:]) > PLATEAU + 1e-9
        last = first + (int(varies.argmax()) if varies.any() else len(varies)) - 1
        best = max(best, (first, last), key=lambda pair: pair[1] - pair[0])
    return best


def stretches(good: np.ndarray) -> list[tuple[float, float]]:
    edges = np.diff(np.concatenate([[0], good.astype(int), [0]]))
    return [
        (float(VALUES[a]), float(VALUES[b - 1]))
        for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
    ]


def draw(drawn: Mapping[str, Mapping[str, Curves]], path: Path) -> None:
    """A row of charts for each dance, a column for each sweep."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = max(len(own) for own in drawn.values())
    figure, axes = pyplot.subplots(
        len(drawn), columns, figsize=(3.2 * columns, 2.4 * len(drawn)), sharex=True, sharey=True, squeeze=False
    )
    for row, (dance, own) in zip(axes, drawn.items(), strict=True):
        for chart, (name, curves) in zip(row, own.items(), strict=True):
            for label, column in zip(("precision", "recall", "F"), curves.T, strict=True):
                chart.plot(VALUES, column, label=label)
            chart.set_title(f"{dance}\n{name}", fontsize=8)
            chart.set_ylim(0, 1.03)
            chart.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=90)
