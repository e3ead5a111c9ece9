"""How a robot keeps its balance over a dance: the zero-moment point's margin, the feet that stand, what was measured.

The margin is how far inside the soles' hull the point lies; where it is below zero the robot tips. To its right the
point's path over the soles as seen from above.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from onbeat._shapes import Array, Bools, Times, frozen
from onbeat.errors import OnbeatError
from onbeat.viewer.plots.files import new_figure, save_figure

PLANNED, MEASURED, FALL, INK = "#0b5fa5", "#d9730d", "#c43d52", "#2b3543"
BEAT, GRID, SOLE, HULL = "#c9d1dc", "#e6eaf0", "#7d8897", "#e9eef5"
BOTH, ONE = "#5f86b3", "#2f5f94"
"""Of feet that stand: together with the other, and alone."""
DEEPEST = -50.0
"""Millimetres under which a margin is told, not drawn."""
HAIR = 0.05
"""Millimetres: what is less far outside is on the edge, which no robot feels."""
AROUND = 0.05
"""Metres of floor shown about the soles."""
AWAY = 0.25
"""Metres from the soles within which what was measured is shown too."""
PLACES = 60
"""Stretches of standing whose hulls are drawn at most, evenly spread over the dance."""
NONE: Times = np.zeros(0)


@dataclass(frozen=True, eq=False)
class Measured:
    """What a simulation or a robot measured at T times of the dance; NaN where there was nothing to measure.

    Parameters
    ----------
    times : (T,) seconds.
    margin : (T,) metres of the pressure's centre inside the soles' hull, or None.
    error : (T,) degrees between the joints and what they were told, or None.
    torque : (T,) parts of the motors' greatest torque, 1 being all of it, or None.
    zmp : (T, 2) metres, the pressure's centre, or None.
    """

    times: Times
    margin: Array | None = None
    error: Array | None = None
    torque: Array | None = None
    zmp: Array | None = None

    def __post_init__(self) -> None:
        count = len(np.asarray(self.times))
        for name, width in (("times", ()), ("margin", ()), ("error", ()), ("torque", ()), ("zmp", (2,))):
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, frozen(values))
                _fits(f"measured {name}", getattr(self, name), (count, *width))


def robot_figure(
    times: Times,
    margin: Array,
    zmp: Array,
    corners: Array,
    standing: Bools,
    *,
    measured: Measured | None = None,
    fell_at: float | None = None,
    beats: Times = NONE,
    title: str = "",
) -> Any:
    """The figure of one dance of F frames.

    Parameters
    ----------
    times : (F,) seconds of the music.
    margin : (F,) metres of the planned zero-moment point inside the support polygon, negative outside.
    zmp : (F, 2) metres on the floor, that point.
    corners : (F, 2, K, 2) metres on the floor, the corners of the left and the right sole.
    standing : (F, 2) whether they stand.
    measured : in a simulation or on a robot; None where the dance was only planned.
    fell_at : seconds at which the robot fell.
    beats : (B,) seconds.
    title : above everything.

    Raises
    ------
    OnbeatError
        If there is no frame, or shapes disagree.
    """
    times, margin, zmp, corners = (np.asarray(values, np.float64) for values in (times, margin, zmp, corners))
    standing = np.asarray(standing, np.bool_)
    _check(times, margin, zmp, corners, standing)
    rows = [(3.0, "margin"), (0.75, "support")]
    if measured is not None:
        rows += [(1.3, name) for name in ("error", "torque") if getattr(measured, name) is not None]
    figure = new_figure((12.5, 0.8 + 1.0 * sum(height for height, _ in rows)))
    grid = figure.add_gridspec(len(rows), 2, width_ratios=(3.1, 1.0), height_ratios=[height for height, _ in rows])
    panels = {name: figure.add_subplot(grid[row, 0]) for row, (_, name) in enumerate(rows)}
    _margins(panels["margin"], times, margin, measured)
    _support(panels["support"], times, standing)
    if measured is not None:
        _measures(panels, measured)
    _clocked(list(panels.values()), times, measured, beats, fell_at)
    _from_above(figure.add_subplot(grid[:, 1]), zmp, corners, standing, measured)
    figure.suptitle(title, fontsize=10.5, parse_math=False)
    _legend(figure, panels["margin"], len(beats) > 0, fell_at)
    return figure


def write_robot_figure(
    path: Path,
    times: Times,
    margin: Array,
    zmp: Array,
    corners: Array,
    standing: Bools,
    *,
    measured: Measured | None = None,
    fell_at: float | None = None,
    beats: Times = NONE,
    title: str = "",
) -> None:
    """Draw it to a PNG, SVG or PDF file; arguments and errors as :func:`robot_figure`."""
    made = robot_figure(
        times, margin, zmp, corners, standing, measured=measured, fell_at=fell_at, beats=beats, title=title
    )
    save_figure(made, path)


def stretches(standing: Bools) -> list[tuple[int, int]]:
    """First frames and ends of the stretches in which the same feet (F, 2) stand.

    Examples
    --------
    >>> stretches(np.array([[1, 1], [1, 1], [0, 1], [1, 1]], bool))
    [(0, 2), (2, 3), (3, 4)]
    """
    cuts = np.flatnonzero((standing[1:] != standing[:-1]).any(axis=1)) + 1
    edges = [0, *cuts.tolist(), len(standing)]
    return list(itertools.pairwise(edges))


def _check(times: Times, margin: Array, zmp: Array, corners: Array, standing: Bools) -> None:
    frames = len(times) if times.ndim == 1 else 0
    if frames == 0 or not np.isfinite(times).all():
        raise OnbeatError("a figure of a robot's balance needs one frame at least, and finite times (frames,)")
    _fits("margin", margin, (frames,))
    _fits("zmp", zmp, (frames, 2))
    _fits("standing", standing, (frames, 2))
    _fits("corners", corners, (frames, 2, corners.shape[2] if corners.ndim == 4 else 4, 2))


def _fits(name: str, values: Array | Bools, shape: tuple[int, ...]) -> None:
    if values.shape != shape:
        raise OnbeatError(f"{name} has the shape {values.shape}; {shape} is needed, one value for each time")


def _margins(axes: Any, times: Times, margin: Array, measured: Measured | None) -> None:
    curves = [("planned", PLANNED, 1.3, times, 1e3 * margin)]
    if measured is not None and measured.margin is not None:
        curves.insert(0, ("measured", MEASURED, 0.8, measured.times, 1e3 * measured.margin))
    least, most = 0.0, 10.0
    for name, colour, width, at, values in curves:
        axes.plot(at, values, color=colour, lw=width, label=name, zorder=3)
        known = values[np.isfinite(values)]
        least, most = float(known.min(initial=least)), float(known.max(initial=most))
    room = 0.06 * (most - max(least, DEEPEST))
    axes.set_ylim(max(least, DEEPEST) - room, most + room)
    axes.axhspan(axes.get_ylim()[0], 0.0, color=FALL, alpha=0.09, lw=0, zorder=0)
    axes.axhline(0.0, color=FALL, lw=1.1, ls=(0, (5, 2)), zorder=2)
    told = "; ".join(_told(name, values) for name, *_, values in reversed(curves))
    _named(axes, "margin [mm]", f"zero-moment point inside the soles' hull: {told}")


def _told(name: str, millimetres: Array) -> str:
    known = millimetres[np.isfinite(millimetres)]
    if not len(known):
        return f"{name} nowhere known"
    share = 100.0 * float((known >= -HAIR).mean())
    # 99.97 % is not all of it.
    told = f"{share:.0f}" if share in (0.0, 100.0) else f"{min(share, 99.9):.1f}"
    least = float(known.min())
    deep = "0" if abs(least) < HAIR else f"{least:.{0 if abs(least) >= 1 else 1}f}"
    return f"{name} {told} % inside, least {deep} mm".replace("-", "−")


def _support(axes: Any, times: Times, standing: Bools) -> None:
    step = float(np.median(np.diff(times))) if len(times) > 1 else 0.1
    for first, end in stretches(standing):
        both = bool(standing[first].all())
        bar = [(float(times[first]), float(times[end - 1] - times[first]) + step)]
        for side in np.flatnonzero(standing[first]).tolist():
            axes.broken_barh(bar, (0.6 - side, 0.8), color=BOTH if both else ONE, lw=0)
    axes.set_ylim(-0.6, 1.6)
    axes.set_yticks([1, 0], ["left", "right"])
    axes.tick_params(axis="y", length=0)
    one, none = float((standing.sum(axis=1) == 1).mean()), float((~standing.any(axis=1)).mean())
    told = f"feet that stand: on one {100 * one:.0f} % of the time"
    _named(axes, "", told if not none else f"{told}, on none {100 * none:.0f} %", grid=False)


def _measures(panels: dict[str, Any], measured: Measured) -> None:
    rows = (
        ("error", "error [°]", "joints off their target", 1.0, "°"),
        ("torque", "torque [%]", "of the motors' greatest torque", 100.0, " %"),
    )
    for name, label, words, scale, unit in rows:
        if name not in panels:
            continue
        values = scale * np.asarray(getattr(measured, name))
        panels[name].plot(measured.times, values, color=MEASURED, lw=0.9, zorder=3)
        known = values[np.isfinite(values)]
        _named(panels[name], label, f"{words}: {known.max(initial=0.0):.1f}{unit} at most")
        panels[name].set_ylim(bottom=0.0)


def _clocked(
    panels: Sequence[Any], times: Times, measured: Measured | None, beats: Times, fell_at: float | None
) -> None:
    """One axis of time for all panels, with beats and the fall."""
    last = max(float(times[-1]), float(measured.times[-1]) if measured is not None and len(measured.times) else 0.0)
    last = max(last, float(times[0]) + 0.1, fell_at or 0.0)
    for axes in panels:
        axes.set_xlim(float(times[0]), last)
        axes.tick_params(labelsize=8, labelbottom=axes is panels[-1])
        for beat in beats[(beats >= times[0]) & (beats <= last)].tolist():
            axes.axvline(beat, color=BEAT, lw=0.8, zorder=0.5)
        if fell_at is not None:
            axes.axvline(fell_at, color=FALL, lw=2.0, zorder=5)
            axes.axvspan(fell_at, last, color=FALL, alpha=0.09, lw=0, zorder=0.4)
    panels[-1].set_xlabel("time of the music [s]", fontsize=9)


def _from_above(axes: Any, zmp: Array, corners: Array, standing: Bools, measured: Measured | None) -> None:
    runs = [run for run in stretches(standing) if standing[run[0]].any()]
    for first, end in runs[:: max(-(-len(runs) // PLACES), 1)]:
        soles = corners[(first + end) // 2][standing[first]]
        axes.fill(*_hull(soles.reshape(-1, 2)).T, color=HULL, lw=0, zorder=0)
        for sole in soles:
            axes.fill(*_hull(sole).T, fill=False, ec=SOLE, lw=0.8, zorder=1)
    if measured is not None and measured.zmp is not None:
        axes.plot(*measured.zmp.T, color=MEASURED, lw=0.5, alpha=0.7, zorder=2)
    axes.plot(*zmp.T, color=PLANNED, lw=0.8, zorder=3)
    _framed(axes, corners[standing].reshape(-1, 2), zmp if measured is None or measured.zmp is None else measured.zmp)
    axes.set_aspect("equal", adjustable="box")
    axes.tick_params(labelsize=8)
    axes.set_xlabel("x [m]", fontsize=9)
    _named(axes, "y [m]", "over the soles, from above")


def _framed(axes: Any, soles: Array, path: Array) -> None:
    """Shows all of the soles' corners (N, 2), and of a path (T, 2) what is near them."""
    soles = soles[np.isfinite(soles).all(axis=1)]
    if not len(soles):
        return
    low, high = soles.min(axis=0), soles.max(axis=0)
    with np.errstate(invalid="ignore"):
        near = path[((path > low - AWAY) & (path < high + AWAY)).all(axis=1)]
    seen = np.concatenate((soles, near))
    for limit, bottom, top in zip((axes.set_xlim, axes.set_ylim), seen.min(axis=0), seen.max(axis=0), strict=True):
        limit(bottom - AROUND, top + AROUND)


def _hull(points: Array) -> Array:
    """The corners of the convex hull of points (K, 2), or these themselves where they span none."""
    try:
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        return points


def _named(axes: Any, label: str, title: str, grid: bool = True) -> None:
    axes.set_ylabel(label, fontsize=9)
    axes.set_title(title, fontsize=9, loc="left", color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    if grid:
        axes.grid(color=GRID, lw=0.6, axis="y")
        axes.set_axisbelow(True)


def _legend(figure: Any, axes: Any, beats: bool, fell_at: float | None) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles, labels = axes.get_legend_handles_labels()
    known = dict(zip(reversed(labels), reversed(handles), strict=True))
    known |= {"both feet": Patch(color=BOTH), "one foot": Patch(color=ONE)}
    if beats:
        known["beat"] = Line2D([], [], color=BEAT, lw=1.4)
    if fell_at is not None:
        known[f"fall at {fell_at:.1f} s"] = Line2D([], [], color=FALL, lw=2.0)
    figure.legend(known.values(), known.keys(), loc="outside lower center", ncols=len(known), frameon=False, fontsize=9)
