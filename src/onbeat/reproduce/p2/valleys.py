"""Fig. 4 of 2007: the variance of takes over the dance, the postures in its valleys, and the keyposes below."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.reproduce.p2.observed import Observed
from onbeat.retime.observe import Curves
from onbeat.retime.takes import rhythm_of
from onbeat.viewer.keypose.poses import pose_pictures, poses_at
from onbeat.viewer.plots.files import new_figure
from onbeat.viewer.plots.observe import GRID, INK, KEYPOSE, TOGETHER, speed_colours

PICTURE = (140, 240)
"""Pixels of a posture."""
TALL = 1.08
"""Inches that a posture is tall."""
MOST = 16
"""Postures in a row."""


def valley_figure(seen: Observed) -> Any:
    """The variance of the left shoulder and of all joints at each speed, with postures on their beats."""
    figure = new_figure((11.0, 8.2 if seen.keyposes is not None else 6.8))
    rows = [1.0, 1.0, 0.75, *([0.75] if seen.keyposes is not None else [])]
    axes = figure.subplots(len(rows), 1, sharex=True, height_ratios=rows)
    curves = (*seen.found.speeds, seen.found.all)
    colours = [*speed_colours(len(seen.found.speeds)), TOGETHER]
    for panel, title in zip(axes, ("left shoulder", "all joints of the upper body, geometric mean"), strict=False):
        _variances(panel, seen, curves, colours, own=panel is axes[0])
        panel.set_title(title, fontsize=9, loc="left")
    for panel, title, beats, colour in zip(axes[2:], *_postures(seen), strict=True):
        _pictures(panel, seen, beats, colour)
        panel.set_title(title, fontsize=9, loc="left", pad=10)  # above the marks
    every = seen.found.repetitions.beats
    axes[-1].set_xlim(every[0] - 0.35, every[-1] + 0.35)
    axes[-1].set_xlabel("beat")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


def _variances(axes: Any, seen: Observed, curves: tuple[Curves, ...], colours: list[Any], *, own: bool) -> None:
    beats = seen.found.repetitions.beats
    for one, colour in zip(curves, colours, strict=True):
        if one.count < 2 or not any(one is each for each in seen.found.repeated):
            continue
        values = one.variance[-1, :, seen.place] if own else one.pooled
        name = f"{one.speed:g}× ({one.count} takes)" if one.speed else f"all {one.count} takes"
        axes.plot(beats, np.where(values > 0, values, np.nan), color=colour, lw=1.5, label=name)
    for number, beat in enumerate(() if seen.keyposes is None else seen.keyposes.tolist()):
        axes.axvline(beat, color=KEYPOSE, lw=0.9, ls="--", alpha=0.7, zorder=0, label="" if number else "keypose")
    foot = np.full(len(seen.common), 0.05)
    style = {"color": INK, "ms": 7, "zorder": 5, "label": "valley of all curves"}
    axes.plot(seen.common, foot, "^", transform=axes.get_xaxis_transform(), **style)
    axes.set_yscale("log")
    axes.set_ylabel("variance (Eq. 9)")
    axes.grid(color=GRID, lw=0.5, axis="y")


def _postures(seen: Observed) -> tuple[list[str], list[Array], list[str]]:
    """Title, beats and colour of each row of postures."""
    titles, beats, colours = ["postures in the common valleys"], [seen.common], [INK]
    if seen.keyposes is not None:
        titles.append("keyposes, as they are known")
        beats.append(seen.keyposes)
        colours.append(KEYPOSE)
    return titles, beats, colours


def _pictures(axes: Any, seen: Observed, beats: Array, colour: str) -> None:
    """Postures of the first take at the slowest speed, each on its beat."""
    from matplotlib.offsetbox import AnnotationBbox, OffsetImage

    take = seen.takes.at(seen.takes.speeds[0])[0]
    shown = (
        beats[np.linspace(0, len(beats) - 1, min(len(beats), MOST)).round().astype(np.int64)] if len(beats) else beats
    )
    times = np.clip(rhythm_of(take).inverse(shown + seen.found.repetitions.first), 0.0, take.motion.times[-1])
    for beat, picture in zip(shown.tolist(), pose_pictures(poses_at(take.motion, times), PICTURE), strict=True):
        image = OffsetImage(picture, zoom=TALL * 72 / PICTURE[1], interpolation="lanczos")
        axes.add_artist(AnnotationBbox(image, (beat, 0.45), frameon=False, pad=0.0))
        axes.plot([beat], [1.0], "v", zorder=6, color=colour, ms=5, clip_on=False)
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.spines[["left", "top", "right"]].set_visible(False)
