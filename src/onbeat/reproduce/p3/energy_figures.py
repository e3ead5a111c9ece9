"""Energy over a dance with its keyposes, drawn as in keyposes 2009, Figs. 3 and 6."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.keyposes.extract import PAPER, Keyposes, Options, Reading
from onbeat.reproduce.p3.dances import Danced
from onbeat.reproduce.p3.extraction import LEARNED
from onbeat.reproduce.result import Claim, FigureResult
from onbeat.viewer.keypose.poses import pose_pictures, poses_at
from onbeat.viewer.plots.files import figure_bytes, new_figure

WORLD, BODY, CANDIDATE, KEYPOSE, BEAT = "#1f3f77", "#c2621c", "#aab2bf", "#22262e", "#7d8796"
PICTURE = (150, 190)
"""Pixels of a pose's picture."""


@dataclass(frozen=True, eq=False)
class Window:
    """A stretch of a dance that is drawn: seconds from and to, and the true keyposes in it."""

    start: float
    end: float
    truth: Times

    @classmethod
    def of(cls, danced: Danced, more: int = 1) -> Window:
        """The first cycle, and ``more`` keyposes of the next one, as the paper draws it."""
        first, end = danced.cycles[0]
        in_cycle = int(((danced.true_beats >= first) & (danced.true_beats < end)).sum())
        truth = danced.truth[: in_cycle + more]
        period = float(np.median(np.diff(danced.beats)))
        return cls(float(truth[0]) - 0.9 * period, float(truth[-1]) + 0.9 * period, truth)

    def inside(self, times: Times) -> Times:
        """Those of some seconds that are drawn."""
        return times[(times >= self.start) & (times <= self.end)]


def keypose_figure(danced: Danced, found: Keyposes, title: str) -> Any:
    """Fig. 3: both energies with beats, candidates and keyposes; below them the poses found, and those of the book."""
    window, shown = Window.of(danced), Window.of(danced).inside(found.times)
    slots = max(len(shown), len(window.truth))
    tall = min(9.0 / slots * (PICTURE[1] + 22) / PICTURE[0], 1.6)  # inches of a row of pictures
    figure = new_figure((9.6, 3.2 + 2 * tall))
    figure.suppressComposite = True  # an SVG keeps the pictures as they are
    rows = figure.subplots(4, 1, height_ratios=(1.0, 1.0, tall, tall))
    for axes, name, curve in zip(rows, ("global", "local"), (found.energy.world, found.energy.local), strict=False):
        _draw_energy(axes, name, found.energy.times, curve, window)
        _draw_beats(axes, found.song_beats, window)
        for time in window.inside(found.candidates[name]):
            axes.axvline(time, color=CANDIDATE, lw=1.4, ls=(0, (4, 2)), zorder=1)
        for time, source in zip(found.times, found.sources, strict=True):
            if source == name and window.start <= time <= window.end:
                axes.axvline(time, color=KEYPOSE, lw=1.6, zorder=2)
    _number(rows[0], shown, danced)
    rows[0].set_title(title, fontsize=10, pad=18)
    rows[1].set_xlabel("time [s]")
    _pictures(rows[2], danced, shown, slots, "found")
    _pictures(rows[3], danced, window.truth, slots, "by the book")
    return figure


def _draw_energy(axes: Any, name: str, times: Times, curve: Array, window: Window) -> None:
    part = (times >= window.start) & (times <= window.end)
    axes.plot(times[part], curve[part], color=WORLD if name == "global" else BODY, lw=1.5, zorder=3)
    axes.set(xlim=(window.start, window.end), ylim=(0, None), ylabel=f"{name} energy\n[its mean]")


def _draw_beats(axes: Any, beats: Times, window: Window) -> None:
    for beat in window.inside(beats):
        axes.axvline(beat, color=BEAT, lw=0.8, ls=(0, (1, 2)), zorder=0)


def _number(axes: Any, shown: Times, danced: Danced) -> None:
    """Above what is found, the number of the true keypose on the same beat."""
    for time, number in zip(shown, _numbers_at(danced, shown), strict=True):
        axes.text(
            time, 1.03, number, transform=axes.get_xaxis_transform(), ha="center", va="bottom", fontsize=8
        )  # fmt: skip


def _numbers_at(danced: Danced, times: Times) -> list[str]:
    """Numbers in brackets of the true keyposes on the beats of some seconds; a cross where there is none."""
    numbers = dict(zip(danced.true_beats.tolist(), _numbers(danced), strict=True))
    beats = np.abs(times[:, None] - danced.beats[None]).argmin(axis=1).tolist()
    return [f"({numbers[beat]})" if beat in numbers else "×" for beat in beats]


def _numbers(danced: Danced) -> list[int]:
    """Of each true keypose its number in its cycle, from 1."""
    starts = np.searchsorted(danced.true_beats, [first for first, _ in danced.cycles])
    return [k - int(starts[starts <= k].max()) + 1 for k in range(len(danced.truth))]


def _pictures(axes: Any, danced: Danced, times: Times, slots: int, label: str) -> None:
    """Pictures of the poses at some seconds, side by side, each with its second."""
    pictures = pose_pictures(poses_at(danced.motion, times), PICTURE)
    wide, tall = PICTURE
    numbers = _numbers_at(danced, times)
    for place, (time, picture) in enumerate(zip(times.tolist(), pictures, strict=True)):
        left = place * (wide + 8)
        axes.imshow(picture, extent=(left, left + wide, 0, tall), interpolation="none", zorder=2)
        axes.text(
            left + wide / 2, -4, f"{numbers[place]} {time:.2f} s", ha="center", va="top", fontsize=7, color="#4a5260"
        )
    axes.set(xlim=(0, slots * (wide + 8)), ylim=(-26, tall), xticks=[], yticks=[], ylabel=label, aspect="equal")
    for side in axes.spines.values():
        side.set_visible(False)


def weight_figure(danced: Danced) -> Any:
    """Fig. 6: both energies as published, with weights by mass and alike."""
    window = Window.of(danced)
    figure = new_figure((9.6, 5.6))
    grid = figure.subplots(4, 1, sharex=True)
    for number, (weights, title) in enumerate((("mass", "by mass"), ("uniform", "all alike"))):
        energy = Reading(danced.motion, danced.beats, replace(PAPER, weights=weights)).energy
        for axes, name, curve in zip(
            grid[2 * number :], ("global", "local"), (energy.world, energy.local), strict=False
        ):
            _draw_energy(axes, name, energy.times, curve, window)
            _draw_beats(axes, danced.beats, window)
        grid[2 * number].set_title(f"weights {title}", fontsize=9, loc="left")
    grid[-1].set_xlabel("time [s]; dotted: beats")
    return figure


def figure_3(danced: Danced, found: Keyposes, number: str, how: str, told: str) -> FigureResult:
    """Fig. 3 of a dance, by the method as published or ours."""
    window = Window.of(danced)
    true = danced.true_beats[: len(window.truth)]
    beats = found.beats[(found.times >= window.start) & (found.times <= window.end)]
    right, more = len(np.intersect1d(beats, true)), len(np.setdiff1d(beats, true))
    return FigureResult(
        number,
        f"Keyposes of the {danced.dance}, {how}",
        figure_bytes(keypose_figure(danced, found, f"{danced.dance} by {danced.person}, {how}"), "svg"),
        "For a cycle of Aizu-bandaisan the global and the local energy over time with the beats, the candidates and "
        "the eight keyposes that were taken; below them the poses, and the masters' drawings of the same eight.",
        f"A cycle of the {danced.dance} and the first keypose of the next: both energies, beats dotted, candidates "
        "dashed, keyposes as lines, with the number of the true keypose on that beat and a cross where there is none. "
        "Below them the poses found, and those at which the choreography rests, by the book.",
        f"{right} of {len(true)} keyposes are found here, and {more} more that are none. {told}",
    )


Roughness = Mapping[str, Mapping[str, tuple[float, float]]]
"""By method and energy, how alike the curves are with both weights, and how much rougher they are by mass."""


def roughness(dances: Sequence[Danced]) -> Roughness:
    """Of both energies how alike they are with both weights (correlation), and how much rougher by mass they are.

    Rougher by the mean second difference, in units of the curve's mean; as published and by root mean square.
    """
    return {method: _roughness(dances, options) for method, options in LEARNED.items()}


def _roughness(dances: Sequence[Danced], options: Options) -> dict[str, tuple[float, float]]:
    pairs = [
        [Reading(one.motion, one.beats, replace(options, weights=weights)).energy for weights in ("mass", "uniform")]
        for one in dances
    ]
    found: dict[str, tuple[float, float]] = {}
    for name in ("world", "local"):
        curves = [[np.asarray(getattr(energy, name)) for energy in pair] for pair in pairs]
        alike = float(np.mean([np.corrcoef(mass, even)[0, 1] for mass, even in curves]))
        bends = [[float(np.abs(np.diff(curve, 2)).mean()) for curve in pair] for pair in curves]
        found[name] = alike, float(np.mean([mass / even for mass, even in bends]))
    return found


def figure_6(danced: Danced, found: Roughness) -> FigureResult:
    """Fig. 6: one dance drawn, and of all of them how much the weights matter."""
    return FigureResult(
        "Fig. 6",
        "Energy with weights by mass, and with all points alike",
        figure_bytes(weight_figure(danced), "svg"),
        "Global and local energy of a dance, with weights by the mass of the body's parts and with uniform ones: "
        "roughly the same, by mass noisier; the authors take uniform weights.",
        f"The same for the {danced.dance} by {danced.person}, the energy as published.",
        f"Over all dances, roughness by mean second difference. As published: {_rougher(found['as published'])}. "
        f"As the root mean square of the points' speeds: {_rougher(found['ours'])}.",
    )


def _rougher(found: Mapping[str, tuple[float, float]]) -> str:
    return "; ".join(
        f"{words}: correlation {alike:.2f}, by mass {abs(ratio - 1):.0%} {'rougher' if ratio > 1 else 'smoother'}"
        for words, (alike, ratio) in (("global", found["world"]), ("local", found["local"]))
    )


def weight_claim(found: Roughness) -> Claim:
    """That weights matter little, and those by mass make the energy noisier."""
    own = found["as published"]
    alike, rougher = (min(values[k] for values in own.values()) for k in (0, 1))
    return Claim(
        "Weights matter little; by mass the energy is roughly the same, and noisier.",
        alike > 0.8 and rougher > 1.0,
        f"As published they correlate by {alike:.2f} at least; by mass the mean second difference is "
        f"{own['world'][1]:.2f} times that with all alike (global), {own['local'][1]:.2f} times (local).",
        ("Fig. 6",),
    )
