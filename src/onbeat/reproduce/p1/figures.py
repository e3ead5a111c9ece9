"""Figs. 2, 7 and 8 of the 2006 paper, drawn anew: features of motion, features matched, intensity followed."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Bools, Times
from onbeat.metrics.intensity import RATE, SMOOTHING, hand_speed
from onbeat.motion.features import HandFeatures, intensity_component, keyframe_component
from onbeat.music.song import Song
from onbeat.reproduce.p1.dances import Danced
from onbeat.reproduce.p1.tables import shown
from onbeat.viewer.plots.files import figure_bytes, new_figure

LEFT, RIGHT, STOP, MOTION, BEAT, MUSIC, SOFT = (
    "#2f6f9f", "#e0782f", "#2f5fb3", "#2f5fb3", "#c43d52", "#c43d52", "#6b7785",
)  # fmt: skip
MATCH = 0.1
"""Seconds within which a beat has its stop."""
WINDOW = 20.0
"""Seconds of a dance that are drawn where all of it would be too fine."""


def bare(axes: Any) -> None:
    """Axes without the lines above and to the right of them."""
    for one in np.ravel(axes):
        one.spines[["top", "right"]].set_visible(False)


def features_figure(features: HandFeatures, start: float, seconds: float) -> bytes:
    """Fig. 2: speeds of both hands with their stops, and the two motion components made of them."""
    figure = new_figure((9.0, 5.4))
    rows = figure.subplots(3, 1, sharex=True, height_ratios=(2, 1, 1))
    bare(rows)
    part = (features.times >= start) & (features.times <= start + seconds)
    times = features.times[part][::4]
    for hand, (name, colour) in enumerate((("left hand", LEFT), ("right hand", RIGHT))):
        speed = features.speeds[part, hand][::4]
        rows[0].plot(times, speed, color=colour, lw=1.4, label=name)
        stops = features.stops[hand]
        stops = stops[(stops >= start) & (stops <= start + seconds)]
        rows[0].plot(stops, np.interp(stops, times, speed), "o", color=colour, mec="white", ms=6, zorder=4)
        for row in rows[1:]:
            row.vlines(stops, 0, 1, transform=row.get_xaxis_transform(), color=colour, lw=0.7, alpha=0.4)
    rows[0].plot([], [], "o", color=SOFT, label="stop")
    for row, values, name in (
        (rows[1], keyframe_component(features.stops, times), "$MC_{stop}$ (Eq. 1)"),
        (rows[2], intensity_component(features, times), "$MC_{intensity}$ (Eq. 2)\n[m/s]"),
    ):
        row.fill_between(times, values, color=STOP, alpha=0.25, lw=0)
        row.plot(times, values, color=STOP, lw=1.4)
        row.set(ylabel=name, ylim=(0, None))
    rows[0].set(ylabel="speed in the body’s\nframe [m/s]", ylim=(0, None), xlim=(start, start + seconds))
    rows[0].legend(frameon=False, ncols=3, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.1)
    rows[2].set_xlabel("time [s]")
    figure.align_ylabels()
    return figure_bytes(figure, "svg")


def matched(beats: Times, stops: Times) -> Bools:
    """(B,) whether each beat has a stop within ``MATCH`` seconds.

    >>> matched(np.array([1.0, 2.0]), np.array([1.05, 1.5])).tolist()
    [True, False]
    """
    if not len(stops):
        return np.zeros(len(beats), bool)
    return np.abs(beats[:, None] - stops).min(axis=1) <= MATCH


def matching_figure(rows: list[tuple[str, Danced]], start: float) -> bytes:
    """Fig. 7: the music's beat component and the motion's keyframe component of a dance, on one clock."""
    figure = new_figure((9.6, 2.2 * len(rows) + 0.4))
    lines = figure.subplots(len(rows), 1, sharex=True, squeeze=False)[:, 0]
    bare(lines)
    for axes, (name, danced) in zip(lines, rows, strict=True):
        _matching(axes, danced, start)
        axes.set_title(name, fontsize=9, loc="left")
    lines[-1].set_xlabel("time [s]")
    marks = [
        lines[0].plot([], [], color=BEAT, lw=2, label="music beat component $ASC_{beat}$ (Eq. 6)")[0],
        lines[0].plot([], [], color=STOP, lw=1.4, label="motion keyframe component $MC_{stop}$ (Eq. 1)")[0],
        lines[0].plot([], [], "v", color=BEAT, label="beat with a stop")[0],
        lines[0].plot([], [], "v", color=BEAT, mfc="white", label="beat without")[0],
    ]
    figure.legend(handles=marks, loc="outside lower center", ncols=4, frameon=False, fontsize=8.5, columnspacing=1.4)
    return figure_bytes(figure, "svg")


def _matching(axes: Any, danced: Danced, start: float) -> None:
    song, end = danced.dance.song, min(start + WINDOW, danced.dance.song.duration)
    times = np.arange(start, end, 1 / 30)
    stop = keyframe_component(danced.features.stops, times)
    axes.fill_between(times, stop, color=STOP, alpha=0.18, lw=0)
    axes.plot(times, stop, color=STOP, lw=1.2)
    shown = (song.beats >= start) & (song.beats <= end)
    beats, degree = song.beats[shown], song.chord_change[shown]
    top = 2.0 * degree / max(float(song.chord_change.max(initial=0.0)), 1e-9)
    axes.vlines(beats, 0, top, color=BEAT, lw=2)
    good = matched(beats, danced.features.body_stops)
    axes.plot(beats[good], np.full(int(good.sum()), 2.3), "v", color=BEAT, ms=5, clip_on=False)
    axes.plot(beats[~good], np.full(int((~good).sum()), 2.3), "v", color=BEAT, mfc="white", ms=5, clip_on=False)
    axes.set(ylim=(0, 2.5), xlim=(start, end), yticks=(0, 1, 2), ylabel="stops of the\nhands at once")


def intensity_figure(columns: list[tuple[str, Danced, Danced]]) -> bytes:
    """Fig. 8: the intensity of music and motion, with both components (top) and by rhythm alone (bottom)."""
    figure = new_figure((4.9 * len(columns), 4.6))
    grid = figure.subplots(2, len(columns), sharex=True, sharey=True, squeeze=False)
    bare(grid)
    for column, (name, both, rhythm) in enumerate(columns):
        for axes, danced, kind in zip(
            grid[:, column], (both, rhythm), ("rhythm and intensity", "rhythm alone"), strict=True
        ):
            times, music, motion = intensity_curves(danced.features, danced.tune.truth)
            axes.axhline(0, color="#d9dde5", lw=0.8, zorder=0)
            axes.plot(times, music, color=MUSIC, lw=1.6, label="music")
            axes.plot(times, motion, color=MOTION, lw=1.6, label="motion: speed of the hands")
            r = shown(danced.scores["intensity_pearson"], "r")
            axes.set_title(f"{name}, {kind}: r = {r}", fontsize=9, loc="left")
        grid[-1][column].set_xlabel("time [s]")
    for line in grid:
        line[0].set_ylabel("intensity [σ]")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    return figure_bytes(figure, "svg")


def intensity_curves(features: HandFeatures, song: Song) -> tuple[Times, Array, Array]:
    """Times, and the intensity of music and motion as they are correlated: smoothed, of mean 0 and deviation 1."""
    times = np.arange(round(song.duration * RATE)) / RATE
    curves = song.intensity_at(times), hand_speed(features, times)
    music, motion = (_standard(gaussian_filter1d(curve, SMOOTHING * RATE, mode="nearest")) for curve in curves)
    return times, music, motion


def _standard(values: Array) -> Array:
    spread = float(values.std())
    return (values - values.mean()) / spread if spread > 1e-9 else values - values.mean()
