"""What a retiming makes of one joint: angle, velocity and the layers' weights, several methods over the wish.

After 2007, Figs. 6 (layers lowered to stay inside the limits) and 8 (two methods beside the original: angle and
angular velocity).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.retime.bspline import Spline
from onbeat.retime.hierarchy import LAYERS, SPACING
from onbeat.retime.retime import Retimed
from onbeat.viewer.plots.files import new_figure, save_figure
from onbeat.viewer.plots.retime_curves import Look, joint_told, look_at, one_dance, speed_told

COLOURS: Mapping[str, str] = {
    "qp": "#0b5fa5",
    "layers-qp": "#0a8f6c",
    "layers2007": "#d9730d",
    "pollard2002": "#b0418f",
    "clamp": "#7a5c3e",
    "uniform": "#b59b00",
}
"""Of methods, the same in every figure."""
OTHER, WISH, LIMIT, INK, BEAT, GRID = "#5b6472", "#a9b2c0", "#c43d52", "#2b3543", "#c9d1dc", "#e6eaf0"
NEAR = 0.25
"""A limit of the angle that is farther from the curves than this share of their range is told, not drawn."""
SLOW = 0.3
"""A limit of the velocity is told, not drawn, where all velocities are under this share of it."""
FAST = 3.0
"""The panel of velocities ends at so many times the limit at most: a wish may be many times too fast."""
MANY = 5
"""Of more layers every other one's spacing is told."""
RATE = 240.0
"""Moments a second at which curves are drawn."""
_FRACTIONS = {0.5: "½", 0.25: "¼", 0.125: "⅛"}


def retime_figure(results: Sequence[Retimed], joint: str | None = None, span: tuple[float, float] | None = None) -> Any:
    """The figure of one joint.

    Parameters
    ----------
    results : of methods on one dance in one time, the first one's limits and keyposes are drawn.
    joint : its name; the joint that the first result changed most without it.
    span : seconds of the music, from and to; 8 s about the joint's largest change without it.

    Raises
    ------
    OnbeatError
        If there is no result, they are of different dances, there is no such joint, or the stretch is outside.
    """
    first = one_dance(results)
    look = look_at(first, joint, span)
    layered = [(result, weights) for result in results if (weights := look.weights(result)) is not None]
    heights = [2.6, 2.0, *(0.25 + 0.12 * weights.shape[1] for _, weights in layered)]
    figure = new_figure((11.0, 0.9 + sum(heights) * 1.05))
    angle, velocity, *strips = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    times = np.linspace(look.start, look.end, max(round((look.end - look.start) * RATE), 2))
    curves = [("wish", first.demand.wish), *((result.method, result.answer.trajectory) for result in results)]
    _angles(angle, first, look, times, curves)
    _velocities(velocity, first, look, times, curves)
    for axes, (result, weights) in zip(strips, layered, strict=True):
        _weights(axes, result, weights)
    inside = first.beats[(first.beats >= look.start) & (first.beats <= look.end)]
    panels = (angle, velocity, *strips)
    for axes in panels:
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=8)
        for beat in inside.tolist():
            axes.axvline(beat, color=BEAT, lw=0.9, zorder=0.5)
    panels[-1].set_xlabel("time of the music [s]", fontsize=9)
    angle.set_xlim(look.start, look.end)
    _titled(figure, results, look)
    _legend(figure, (angle, velocity), bool(len(first.beats)))
    return figure


def write_retime_figure(
    path: Path, results: Sequence[Retimed], joint: str | None = None, span: tuple[float, float] | None = None
) -> None:
    """Draw it to a PNG, SVG or PDF file; arguments and errors as :func:`retime_figure`."""
    save_figure(retime_figure(results, joint, span), path)


def colour_of(method: str) -> str:
    """The colour in which a method is drawn."""
    return COLOURS.get(method, OTHER)


def _angles(axes: Any, result: Retimed, look: Look, times: Times, curves: Sequence[tuple[str, Spline]]) -> None:
    drawn = _lines(axes, times, [(name, look.angle(curve, times)) for name, curve in curves])
    hinge = result.source.size == 1
    low, high = look.angles_allowed(result)
    _keyposes(axes, *look.keyposes(result))
    bottom, top = float(drawn.min()), float(drawn.max())
    room = NEAR * max(top - bottom, 1.0)
    near = [limit for limit in (low, high) if bottom - room <= limit <= top + room]
    _beyond(axes, *_widened(min([bottom, *near]), max([top, *near])), low, high)
    told = f"limits {low:.0f}° and {high:.0f}°".replace("-", "−") if np.isfinite([low, high]).any() else "no limits"
    _named(axes, "angle [°]", f"{'angle' if hinge else 'turn about its main axis'}, {told}")


def _velocities(axes: Any, result: Retimed, look: Look, times: Times, curves: Sequence[tuple[str, Spline]]) -> None:
    drawn = _lines(axes, times, [(name, look.velocity(curve, times)) for name, curve in curves])
    hinge = result.source.size == 1
    limit = float(np.degrees(result.limits.of([look.joint]).speed[0]))
    name, told = "velocity" if hinge else "speed", "no limit"
    bottom, top = float(drawn.min()) if hinge else 0.0, float(drawn.max())
    if np.isfinite(limit):
        told = f"limit {'±' if hinge else ''}{limit:.0f} °/s"
        most = max(FAST * limit, 1.05 * float(np.abs(drawn[1:]).max()))
        wished = float(np.abs(drawn[0]).max())
        if wished > limit:
            told += f", wished up to {wished:.0f} °/s" + (", beyond the figure" if wished > most else "")
        if max(top, -bottom) > SLOW * limit:
            bottom, top = max(min(bottom, -limit if hinge else 0.0), -most), min(max(top, limit), most)
    bottom, top = _widened(bottom, top)
    _beyond(axes, bottom if hinge else 0.0, top, -limit, limit)
    _named(axes, f"{name} [°/s]", f"angular {name}, {told}")


def _lines(axes: Any, times: Times, curves: Sequence[tuple[str, Array]]) -> Array:
    """The wish as a broad line behind, the methods over it, the first one on top; all values (curves, N)."""
    for place, (name, values) in enumerate(curves):
        wish = place == 0
        colour = WISH if wish else colour_of(name)
        axes.plot(
            times, values, color=colour, lw=3.6 if wish else 1.5, label=name, zorder=2 if wish else 4 - 0.1 * place
        )
    return np.stack([values for _, values in curves])


def _keyposes(axes: Any, times: Times, angles: Array, feasible: np.ndarray) -> None:
    for kept, face, label in ((feasible, INK, "keypose"), (~feasible, "white", "keypose out of reach")):
        if kept.any():
            style = {"mfc": face, "mec": INK, "mew": 1.2, "ms": 6.5, "zorder": 6, "clip_on": False}
            axes.plot(times[kept], angles[kept], "D", label=label, **style)


def _widened(low: float, high: float) -> tuple[float, float]:
    room = 0.07 * (high - low + 1.0)
    return low - room, high + room


def _beyond(axes: Any, bottom: float, top: float, low: float, high: float) -> None:
    """Shades what is beyond limits."""
    axes.set_ylim(bottom, top)
    label = "limit"
    for limit, from_, to in ((low, bottom, min(low, top)), (high, max(high, bottom), top)):
        if from_ < to:
            axes.axhspan(from_, to, color=LIMIT, alpha=0.09, lw=0, zorder=0)
            axes.axhline(limit, color=LIMIT, lw=1.2, ls=(0, (5, 2)), zorder=3, label=label)
            label = "_"


def _weights(axes: Any, result: Retimed, weights: Array) -> None:
    """The layers' weights over time, the coarsest on top; the darker, the more of it is left out."""
    from matplotlib.colors import LinearSegmentedColormap

    knots = result.demand.wish.knots
    scale = LinearSegmentedColormap.from_list("weight", [colour_of(result.method), "#f4f6f9"])
    extent = (knots.start - knots.step / 2, knots.end + knots.step / 2, weights.shape[1] - 0.5, -0.5)
    drawn = axes.imshow(weights.T, cmap=scale, vmin=0, vmax=1, aspect="auto", extent=extent, interpolation="nearest")
    shown = range(0, weights.shape[1], 1 if weights.shape[1] <= MANY else 2)
    axes.set_yticks(shown, [_spacing(layer, weights.shape[1]) for layer in shown])
    axes.tick_params(axis="y", length=0)
    bar = axes.figure.colorbar(drawn, cax=axes.inset_axes((1.008, 0.0, 0.01, 1.0)))
    bar.set_ticks([0, 1], labels=["0", "1"], fontsize=8)
    bar.outline.set_visible(False)
    _named(axes, "knots [beats]", f"{result.method}: weights of the layers", grid=False)


def _spacing(layer: int, layers: int) -> str:
    """Beats between a layer's knots: more layers than five go on to coarser ones, the finest is the same."""
    beats = SPACING * 2.0 ** (layers - LAYERS - layer)
    return _FRACTIONS.get(beats) or (f"{beats:g}" if beats >= 1 else f"1/{1 / beats:g}")


def _named(axes: Any, label: str, title: str, grid: bool = True) -> None:
    axes.set_ylabel(label, fontsize=9)
    axes.set_title(title, fontsize=9, loc="left", color=INK)
    if grid:
        axes.grid(color=GRID, lw=0.6, axis="y")


def _titled(figure: Any, results: Sequence[Retimed], look: Look) -> None:
    first = results[0]
    methods = ", ".join(result.method for result in results)
    speed = speed_told(first, look.start, look.end)
    parts = [joint_told(look.joint), speed, methods, first.limits.name, first.source.name]
    figure.suptitle(" · ".join(filter(None, parts)), fontsize=10.5, parse_math=False)


def _legend(figure: Any, panels: Sequence[Any], beats: bool) -> None:
    from matplotlib.lines import Line2D

    known: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            known.setdefault(label, handle)
    if beats:
        known["beat"] = Line2D([], [], color=BEAT, lw=1.4)
    figure.legend(
        known.values(), known.keys(), loc="outside lower center", ncols=min(len(known), 10), frameon=False, fontsize=9
    )
