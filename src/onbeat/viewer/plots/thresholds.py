"""Precision and recall over T1 and T2 (keyposes 2009, Figs. 4 and 5), and F over both."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.thresholds import Sweep


def write_threshold_figure(path: Path, swept: Sweep, at: Thresholds) -> None:
    """Draw a sweep to a PNG, SVG or PDF file; one threshold is varied, the other is held at ``at``.

    Raises
    ------
    OnbeatError
        If the ending is none of these.
    """
    from onbeat.viewer.plots.files import new_figure, save_figure

    figure = new_figure((11.0, 3.6))
    left, middle, right = figure.subplots(1, 3)
    mean = swept.scores.mean(axis=0)
    a, b = int(np.abs(swept.t1 - at.t1).argmin()), int(np.abs(swept.t2 - at.t2).argmin())
    for axes, values, curves, name, held in (
        (left, swept.t1, mean[:, b], "T1", f"T2 = {swept.t2[b]:g}"),
        (middle, swept.t2, mean[a], "T2", f"T1 = {swept.t1[a]:g}"),
    ):
        for column, (label, style) in enumerate((("precision", "-"), ("recall", "--"), ("F", ":"))):
            axes.plot(values, curves[:, column], style, label=label, lw=1.8)
        axes.set(xlabel=f"{name} [mean energy], {held}", ylim=(-0.02, 1.02), xlim=(0, float(values[-1])))
        axes.grid(alpha=0.3)
    left.legend(loc="lower right", frameon=False)
    drawn = right.imshow(swept.f.T, origin="lower", vmin=0.0, vmax=1.0, cmap="viridis", aspect="auto")
    for axis, values, name in ((right.xaxis, swept.t1, "T1"), (right.yaxis, swept.t2, "T2")):
        shown = range(0, len(values), 4)
        axis.set_ticks(list(shown), [f"{values[k]:g}" for k in shown])
        axis.set_label_text(name)
    right.plot(a, b, "o", mfc="none", mec="white", ms=9, mew=2)
    figure.colorbar(drawn, ax=right, label="F")
    save_figure(figure, path)
