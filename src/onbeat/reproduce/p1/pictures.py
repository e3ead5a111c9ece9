"""Figs. 5 and 6 of the 2006 paper, drawn anew: how a path is chosen, and what is danced."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.reproduce.p1.choice import Choice
from onbeat.reproduce.p1.dances import Danced
from onbeat.reproduce.p1.figures import bare
from onbeat.viewer.keypose.poses import pose_pictures, poses_at
from onbeat.viewer.plots.files import figure_bytes, new_figure

BEAT, STOP, INK, SOFT, FAINT, CHOSEN, NEAR = (
    "#c43d52", "#2f5fb3", "#22262e", "#6b7785", "#c9ced6", "#1d7f4f", "#e0a02f",
)  # fmt: skip
NEAR_INK = "#9a6a0c"
"""What is best by rhythm, as words: darker, for they are read."""
LABEL, HIGH = 9.5, 0.5
"""Points of the words of Fig. 5, and how high a stop is in a lane: above the clips' numbers of the lane before."""
PICTURE = (132, 190)
"""Pixels of a picture of a pose."""
POSES = 12
"""Pictures of a dance: one on each of so many beats."""


def choice_figure(choice: Choice, library: MoveLibrary) -> bytes:
    """Fig. 5: some paths over the next seconds with their stops, and Eqs. 11 and 12 of all of them."""
    figure = new_figure((10.4, 1.4 + 0.56 * (len(shown_paths(choice)) + 1)))
    left, right = figure.subplots(1, 2, width_ratios=(1.8, 1))
    bare((left, right))
    _lanes(left, choice, library)
    others = np.ones(len(choice.paths), bool)
    others[: choice.best] = False
    right.plot(choice.rhythm[others], choice.intensity[others], ".", ms=4, color=FAINT, label="other paths")
    best = slice(0, choice.best)
    right.plot(choice.rhythm[best], choice.intensity[best], "o", ms=6, color=NEAR, label="best by rhythm (BP)")
    at = choice.rhythm[choice.chosen], choice.intensity[choice.chosen]
    right.plot(*at, "*", ms=14, color=CHOSEN, mec="white", label="danced: of these the most intense")
    right.set_xlabel("Eq. 11: stops on beats", fontsize=LABEL)
    right.set_ylabel("Eq. 12: intensity of motion with the music’s", fontsize=LABEL)
    right.legend(frameon=False, fontsize=LABEL, loc="lower center", bbox_to_anchor=(0.45, 1.0), ncols=1)
    return figure_bytes(figure, "svg")


def shown_paths(choice: Choice) -> Ints:
    """The paths that are drawn: the danced one, some of the best by Eq. 11, and some of the others."""
    best = [int(k) for k in np.linspace(0, choice.best - 1, 4).round() if k != choice.chosen]
    rest = np.linspace(choice.best, len(choice.paths) - 1, 4).round() if len(choice.paths) > choice.best else []
    return np.array(list(dict.fromkeys([choice.chosen, *best, *(int(k) for k in rest)])))


def _lanes(axes: Any, choice: Choice, library: MoveLibrary) -> None:
    shown = shown_paths(choice)
    ahead = np.arange(choice.paths.shape[1]) / GRID
    degree = choice.parts.beat[choice.begin : choice.begin + len(ahead)]
    beats = np.flatnonzero(degree > 0)
    axes.vlines(beats / GRID, -len(shown) + 0.5, 1, color=BEAT, lw=0.8, alpha=0.35)
    axes.vlines(beats / GRID, 1, 1 + 0.8 * degree[beats] / max(degree.max(initial=0.0), 1e-9), color=BEAT, lw=2.5)
    axes.text(-0.06, 1.3, "$ASC_{beat}$", ha="right", va="center", color=BEAT, fontsize=LABEL)
    for lane, k in enumerate(shown.tolist()):
        _lane(axes, choice, library, lane, k, ahead)
    axes.set(xlim=(0, ahead[-1]), ylim=(-len(shown) + 0.4, 1.85), yticks=())
    axes.set_xlabel("seconds ahead; below each path the numbers of its clips", fontsize=LABEL)
    axes.spines["left"].set_visible(False)
    axes.text(
        1.01, 1.3, "Eq. 11  Eq. 12", transform=axes.get_yaxis_transform(), va="center", fontsize=LABEL, color=SOFT
    )


def _lane(axes: Any, choice: Choice, library: MoveLibrary, lane: int, k: int, ahead: Array) -> None:
    """One path: its stops as a curve, its joins as ticks, the clips it goes through, and what it is worth."""
    path, base = choice.paths[k], -lane
    colour = CHOSEN if k == choice.chosen else NEAR_INK if k < choice.best else SOFT
    axes.fill_between(ahead, base, base + choice.parts.stop[path] / 2.0 * HIGH, color=STOP, alpha=0.45, lw=0)
    joins = np.flatnonzero(np.diff(path) != 1) + 1
    axes.plot([0, ahead[-1]], [base, base], color=colour, lw=3, solid_capstyle="butt")
    axes.plot(ahead[joins], np.full(len(joins), base), "|", color=INK, ms=11, mew=1.6)
    for begin, end in zip([0, *joins.tolist()], [*joins.tolist(), len(path)], strict=True):
        clip = int(np.searchsorted(library.starts, path[begin], side="right"))  # counted from 1
        middle = (begin + end - 1) / 2 / GRID
        axes.text(middle, base - 0.13, str(clip), fontsize=LABEL, color=INK, va="top", ha="center")
    name = "danced" if k == choice.chosen else f"no. {k + 1}"
    axes.text(-0.06, base + 0.1, name, ha="right", va="center", fontsize=LABEL, color=colour)
    worth = f"{choice.rhythm[k]:6.2f}   {choice.intensity[k]:6.1f}"
    axes.text(1.01, base + 0.1, worth, transform=axes.get_yaxis_transform(), va="center", fontsize=LABEL, color=colour)


def dance_figure(danced: Danced, first: int) -> bytes:
    """Fig. 6: the dance on one beat after the other from beat ``first`` on, over sound and the speed of the hands."""
    song = danced.dance.song
    beats = song.beats[first : first + POSES]
    start, end = float(beats[0]) - 0.4, min(float(beats[-1]) + 0.4, song.duration)
    pictures = pose_pictures(poses_at(danced.motion, np.minimum(beats, danced.motion.duration - 1e-6)), PICTURE)
    figure = new_figure((11.0, 4.9))
    parts = figure.subfigures(2, 1, height_ratios=(1, 1.5))
    for number, (axes, picture) in enumerate(zip(parts[0].subplots(1, len(pictures)), pictures, strict=True)):
        axes.imshow(picture, interpolation="bilinear")
        axes.set_axis_off()
        axes.set_title(f"{beats[number]:.2f} s", fontsize=8)
    lines = parts[1].subplots(2, 1, sharex=True, height_ratios=(1, 1.5))
    bare(lines)
    _sound(lines[0], danced, start, end)
    _hands(lines[1], danced, start, end)
    for axes in lines:
        axes.vlines(beats, 0, 1, transform=axes.get_xaxis_transform(), color=BEAT, lw=1.1, zorder=1)
    lines[1].set(xlim=(start, end), xlabel="time [s]")
    parts[1].align_ylabels()
    return figure_bytes(figure, "svg")


def _sound(axes: Any, danced: Danced, start: float, end: float) -> None:
    times, low, high = danced.tune.envelope.within(start, end)
    axes.fill_between(times, low, high, color="#8593a6", lw=0, zorder=2)
    axes.set(yticks=(), ylabel="music,\nbeats")
    axes.spines["left"].set_visible(False)


def _hands(axes: Any, danced: Danced, start: float, end: float) -> None:
    features = danced.features
    part = (features.times >= start) & (features.times <= end)
    times, speed = features.times[part][::4], features.speeds[part].max(axis=1)[::4]
    axes.plot(times, speed, color=STOP, lw=1.4, zorder=3)
    stops = features.body_stops
    stops = stops[(stops >= start) & (stops <= end)]
    axes.plot(stops, np.interp(stops, times, speed), "o", color=STOP, mec="white", ms=6, zorder=4)
    axes.set(ylim=(0, None), ylabel="faster hand\n[m/s], stops")
