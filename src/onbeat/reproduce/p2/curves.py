"""Figs. 6 and 8 of 2007: one joint of a retimed dance, by the method of the paper, by ours, and by Pollard's filter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.retime.retime import Retimed
from onbeat.viewer.plots.files import new_figure
from onbeat.viewer.plots.retime import GRID, INK, LIMIT, WISH, colour_of
from onbeat.viewer.plots.retime_curves import Look, joint_told, look_at

JOINT = "L_SHOULDER_Y"
"""The left shoulder's yaw, as in the paper's Fig. 8."""
RATE = 240.0
"""Moments a second at which curves are drawn."""
ZOOM = 1.6
"""Seconds of an enlarged stretch."""
SHOWN = 10.0
"""Seconds of the dance that are drawn at most."""
APART = 0.3
"""Seconds from a limit that is past within which detail may have to go."""
FINE = 0.06
"""Seconds over which a velocity is smoothed to tell what of it is detail."""


class Stretch(NamedTuple):
    """Seconds of the music that are enlarged."""

    start: float
    end: float


def drawn_joint(result: Retimed) -> str:
    """The left shoulder's yaw, or of another robot the joint that is changed most."""
    return JOINT if JOINT in result.source.joints else look_at(result).joint


def looked_at(result: Retimed) -> Look:
    """The joint over the first ``SHOWN`` seconds of the dance."""
    knots = result.demand.wish.knots
    return look_at(result, drawn_joint(result), (knots.start, min(knots.end, knots.start + SHOWN)))


def curve_figure(results: Sequence[Retimed]) -> Any:
    """Fig. 8: (a) the angle, (b) its velocity, and enlarged (b.1) where nothing is past, (b.2) at the limit.

    Parameters
    ----------
    results : of methods on one wish; the last one is drawn on top.
    """
    first, look = results[0], looked_at(results[0])
    figure = new_figure((11.0, 7.6))
    grid = figure.add_gridspec(3, 2)
    angle, velocity = (figure.add_subplot(grid[row, :]) for row in (0, 1))
    times = np.linspace(look.start, look.end, round((look.end - look.start) * RATE))
    for axes, curves in ((angle, look.angle), (velocity, look.velocity)):
        axes.plot(times, curves(first.demand.wish, times), color=WISH, lw=3.4, label="the original")
        for result in results:
            axes.plot(
                times,
                curves(result.answer.trajectory, times),
                color=colour_of(result.method),
                lw=1.5,
                label=result.method,
            )
        axes.set_xlim(look.start, look.end)
        axes.grid(color=GRID, lw=0.6)
    _keyposes(angle, first, look)
    _limited(velocity, first, look)
    angle.set(ylabel="angle [°]")
    velocity.set(ylabel="velocity [°/s]", xlabel="time of the music [s]")
    angle.set_title(f"(a) {_told(look.joint)}: angle", fontsize=9, loc="left")
    velocity.set_title(f"(b) its velocity; the limit is ±{_limit(first, look):.0f} °/s", fontsize=9, loc="left")
    for place, (name, stretch) in enumerate(zip(("(b.1)", "(b.2)"), stretches(results), strict=True)):
        panel = figure.add_subplot(grid[2, place])
        _enlarged(panel, velocity, stretch, name, look, times, results)
    handles, labels = angle.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


def _told(joint: str) -> str:
    return f"left shoulder yaw ({JOINT})" if joint == JOINT else joint_told(joint)


def _limit(result: Retimed, look: Look) -> float:
    return float(np.degrees(result.limits.of([look.joint]).speed[0]))


def _limited(axes: Any, result: Retimed, look: Look) -> None:
    limit = _limit(result, look)
    low, high = axes.get_ylim()
    axes.set_ylim(max(min(low, -1.1 * limit), -2.2 * limit), min(max(high, 1.1 * limit), 2.2 * limit))
    for sign in (-1, 1):
        axes.axhline(sign * limit, color=LIMIT, lw=1.1, ls=(0, (5, 2)), zorder=1)


def _keyposes(axes: Any, result: Retimed, look: Look) -> None:
    times, angles, _ = look.keyposes(result)
    axes.plot(times, angles, "D", ms=6, mfc=INK, mec="white", zorder=6, label="keypose")


def stretches(results: Sequence[Retimed]) -> tuple[Stretch, Stretch]:
    """The stretch away from limits in which the wish has most detail, and that in which a method is longest at one."""
    first, look = results[0], looked_at(results[0])
    times = np.arange(look.start, look.end, 1 / RATE)
    limit, wide = _limit(first, look), round(ZOOM * RATE)
    wish = look.velocity(first.demand.wish, times)
    others = np.stack([np.abs(look.velocity(one.answer.trajectory, times)) for one in results])
    detail = np.abs(wish - np.convolve(np.pad(wish, round(FINE * RATE), "edge"), _hat(round(FINE * RATE)), "valid"))
    # Where something is past, its neighbourhood may have to change, too: detail is looked at elsewhere.
    near = np.convolve(np.abs(wish) >= limit, np.ones(2 * round(APART * RATE) + 1), "same") > 0
    return (
        _best(times, wide, np.where(near, -np.square(limit), np.square(detail))),
        _best(times, wide, (others > 0.98 * limit).sum(axis=0).astype(np.float64)),
    )


def _hat(half: int) -> Array:
    return np.ones(2 * half + 1) / (2 * half + 1)


def _best(times: Times, wide: int, worth: Array) -> Stretch:
    """The stretch that is worth most, the first of them."""
    summed = np.concatenate(([0.0], np.cumsum(worth)))
    wide = min(wide, len(worth))
    at = int(np.argmax(summed[wide:] - summed[:-wide]))
    return Stretch(float(times[at]), float(times[min(at + wide, len(times) - 1)]))


def _enlarged(
    panel: Any, whole: Any, stretch: Stretch, name: str, look: Look, times: Times, results: Sequence[Retimed]
) -> None:
    inside = (times >= stretch.start) & (times <= stretch.end)
    wish = look.velocity(results[0].demand.wish, times[inside])
    own = [look.velocity(result.answer.trajectory, times[inside]) for result in results]
    panel.plot(times[inside], wish, color=WISH, lw=4.0)
    for result, values in zip(results, own, strict=True):
        panel.plot(times[inside], values, color=colour_of(result.method), lw=1.8)
    low, high = float(np.min(own)), float(np.max(own))
    limit = _limit(results[0], look)
    panel.set_ylim(low - 0.15 * (high - low), high + 0.15 * (high - low))
    for sign in (-1, 1):
        if low - 1 <= sign * limit <= high + 1:
            panel.axhline(sign * limit, color=LIMIT, lw=1.1, ls=(0, (5, 2)), zorder=1)
    panel.set_xlim(*stretch)
    panel.grid(color=GRID, lw=0.6)
    panel.set_title(f"{name} of (b), {stretch.start:.1f} to {stretch.end:.1f} s", fontsize=9, loc="left")
    panel.set(xlabel="time of the music [s]", ylabel="velocity [°/s]")
    whole.axvspan(*stretch, color="#eef1f6", zorder=0)
    whole.annotate(
        name, (stretch.start, 1.0), (3, -11), xycoords=("data", "axes fraction"), textcoords="offset points", fontsize=8
    )


def lowered(result: Retimed) -> tuple[float, float]:
    """Of the rule that Fig. 6 shows: how much is lowered, and how often a finer layer has more weight than a coarser.

    Shares of the moments and channels, 0…1.
    """
    weights = result.answer.weights
    assert weights is not None
    broken = (np.diff(weights, axis=1) > 1e-9).any(axis=1)
    return float((weights.min(axis=1) < 1 - 1e-9).mean()), float(broken.mean())
