"""Figures of motions in few dimensions, after keyposes 2009: variance, clusters, a trajectory, held-out errors."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from onbeat.keyposes.held_out import MEASURES, HeldOut, Taught
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.keyposes.space import uniform_times
from onbeat.viewer.plots.files import new_figure, save_figure

KEYPOSES, UNIFORM, PATH = "#c43d52", "#2f6f9f", "#3b4a5f"
TITLES = {"keyposes": "keyposes", "uniform": "uniform sampling"}
MARKERS = "osD^vP*X<>ph"
_SEEN = {"all": "all frames", "rest": "frames at rest", "keyposes": "keyposes"}


def variance_figure(found: LowDimensional) -> Any:
    """Fig. 11: the share of the variance in the first dimensions, by both spaces."""
    figure = new_figure((5.6, 3.6))
    axes = figure.subplots()
    for name, colour, marker in (("keyposes", KEYPOSES, "o"), ("uniform", UNIFORM, "s")):
        shares = np.concatenate(([0.0], found.spaces[name].cumulative))[:13]
        axes.plot(np.arange(len(shares)), shares, color=colour, marker=marker, ms=4, label=TITLES[name])
    axes.axvline(found.dims, color="#b9c2cd", lw=1, zorder=0)
    axes.set(xlabel="dimensions K′", ylabel="share of the variance ρ", xlim=(0, None), ylim=(0, 1.02))
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right", frameon=False)
    axes.set_title("each of its own poses, so that neither tells which rebuilds better", fontsize=8, color="#6b7785")
    return figure


def cluster_figure(found: LowDimensional) -> Any:
    """Figs. 7, 8: the poses of both spaces in their first dimensions; groups bear their numbers, shapes are people."""
    pairs = _pairs(found)
    figure = new_figure((9.6, 4.3 * len(pairs) + 0.6))
    grid = figure.subplots(len(pairs), 2, squeeze=False)
    for column, name in enumerate(SPACES):
        for row, (first, second) in enumerate(pairs):
            axes = grid[row][column]
            for person, one in enumerate(found.taught):
                colours = _numbers(found, one, name)
                _drawn(axes, _places(found, one, name), colours, (first, second), MARKERS[person % len(MARKERS)])
            for numbers, place in _labels(_middles(found, name)[:, [first, second]]):
                axes.annotate(
                    numbers, place, (0, 10), textcoords="offset points", ha="center", fontsize=8, color="#333b47"
                )
            _named(axes, first, second)
        grid[0][column].set_title(f"{TITLES[name]}: {sum(len(one.keyposes) for one in found.taught)} poses")
    marks = [
        grid[0][0].plot([], [], MARKERS[n % len(MARKERS)], color="#6b7785", label=one.person)[0]
        for n, one in enumerate(found.taught[:16])
    ]
    figure.legend(handles=marks, loc="outside lower center", ncols=min(len(marks), 8), frameon=False)
    return figure


def trajectory_figure(found: LowDimensional, which: int) -> Any:
    """Fig. 9: one person's cycle as a path through the keypose space, and everybody's keyposes around it."""
    one, space, pairs = found.taught[which], found.spaces["keyposes"], _pairs(found)
    times = np.linspace(one.start, min(one.end, one.vectors.duration), 240)
    path, own = (space.project(one.vectors.at(at), 3) for at in (times, one.keyposes))
    figure = new_figure((4.8 * len(pairs), 4.6))
    for axes, (first, second) in zip(figure.subplots(1, len(pairs), squeeze=False)[0], pairs, strict=True):
        for person, other in enumerate(found.taught):
            marker = MARKERS[person % len(MARKERS)]
            colours = _numbers(found, other, "keyposes")
            _drawn(axes, _places(found, other, "keyposes"), colours, (first, second), marker, 0.35)
        axes.plot(path[:, first], path[:, second], color=PATH, lw=1.6, zorder=3)
        for numbers, place in _labels(own[:, [first, second]]):
            axes.annotate(
                numbers, place, ha="center", va="center", zorder=5, fontsize=8, color="white",
                bbox={"boxstyle": "round,pad=0.3", "fc": KEYPOSES, "ec": "white"},
            )  # fmt: skip
        _named(axes, first, second)
    figure.suptitle(f"{one.person}: one cycle in the keypose space", fontsize=10)
    return figure


def error_figure(found: LowDimensional) -> Any:
    """Held-out errors over K′: unseen frames and unseen people, of all frames, of those at rest and of keyposes."""
    known = "between taught poses" if found.between else "unseen frames"
    rows = [(known, found.frames), *([] if found.people is None else [("unseen people", found.people)])]
    figure = new_figure((10.2, 3.1 * len(rows)))
    grid = figure.subplots(len(rows), len(MEASURES), squeeze=False, sharex=True)
    for line, (title, measured) in zip(grid, rows, strict=True):
        for axes, kind in zip(line, range(len(MEASURES)), strict=True):
            _errors(axes, measured, kind)
            axes.set_title(f"{title}: {_SEEN[MEASURES[kind]]}", fontsize=9)
        line[0].set_ylabel("mean distance [mm]")
    for axes in grid[-1]:
        axes.set_xlabel("dimensions K′")
    grid[0][0].legend(frameon=False, fontsize=8)
    return figure


def _errors(axes: Any, measured: HeldOut, kind: int) -> None:
    if not np.isfinite(measured.keypose[kind]).all():
        axes.text(0.5, 0.5, "none unseen", ha="center", transform=axes.transAxes, color="#8593a6")
        return
    phases = 1000 * measured.uniform[:, kind]
    axes.fill_between(measured.dims, phases.min(axis=0), phases.max(axis=0), color=UNIFORM, alpha=0.18, lw=0)
    axes.plot(measured.dims, phases.mean(axis=0), color=UNIFORM, marker="s", ms=3.5, label="uniform, all phases")
    axes.plot(measured.dims, 1000 * measured.keypose[kind], color=KEYPOSES, marker="o", ms=3.5, label="keyposes")
    axes.set_ylim(0, None)
    axes.grid(alpha=0.3)


def _pairs(found: LowDimensional) -> list[tuple[int, int]]:
    """Which dimensions are drawn over which: the first and second, and the third where there is one."""
    most = min(3, *(len(space) for space in found.spaces.values()))
    return list(itertools.combinations(range(most), 2))[:2]


def _places(found: LowDimensional, one: Taught, name: str) -> np.ndarray:
    """(K, 3) a person's poses in the first dimensions of a space, those it was made of."""
    times = one.keyposes if name == "keyposes" else uniform_times(one.start, one.end, len(one.keyposes))
    return found.spaces[name].project(one.vectors.at(times), 3)


def _numbers(found: LowDimensional, one: Taught, name: str) -> np.ndarray:
    """(K,) numbers of a person's poses, those of the first person's that they are like (cycles begin anywhere)."""
    own, first = _places(found, one, name), _places(found, found.taught[0], name)
    numbers = np.arange(len(own))
    rows, columns = linear_sum_assignment(cdist(own, first))
    numbers[rows] = columns
    return numbers


def _middles(found: LowDimensional, name: str) -> np.ndarray:
    """(K, 3) the middle of the poses of each number."""
    places = np.concatenate([_places(found, one, name) for one in found.taught])
    numbers = np.concatenate([_numbers(found, one, name) for one in found.taught])
    return np.array([places[numbers == number].mean(axis=0) for number in np.unique(numbers)])


def _drawn(
    axes: Any, places: np.ndarray, numbers: np.ndarray, pair: tuple[int, int], marker: str, alpha: float = 0.9
) -> None:
    axes.scatter(
        places[:, pair[0]], places[:, pair[1]], c=numbers % 10, cmap="tab10", vmin=0, vmax=9.5, marker=marker, s=34,
        alpha=alpha, edgecolors="white", linewidths=0.5,
    )  # fmt: skip


def _labels(places: np.ndarray) -> list[tuple[str, np.ndarray]]:
    """Numbers from 1 and where to write them; those of poses at one place together."""
    near = 0.05 * float(np.ptp(places, axis=0).max()) if len(places) else 0.0
    groups: list[tuple[list[int], np.ndarray]] = []
    for number, place in enumerate(places, 1):
        for numbers, where in groups:
            if np.linalg.norm(place - where) < near:
                numbers.append(number)
                break
        else:
            groups.append(([number], place))
    return [(", ".join(map(str, numbers)), where) for numbers, where in groups]


def _named(axes: Any, first: int, second: int) -> None:
    axes.set(xlabel=f"dimension {first + 1} [body sizes]", ylabel=f"dimension {second + 1} [body sizes]")
    axes.set_aspect("equal", "datalim")
    axes.grid(alpha=0.25)


def write_lowdim_figures(folder: Path, found: LowDimensional, which: int = 0) -> list[str]:
    """Draw all figures to a folder, each as PNG and SVG; their names. Spaces of one dimension have no clusters.

    Parameters
    ----------
    folder : where to.
    found : what is drawn.
    which : the person whose trajectory is drawn.
    """
    figures: dict[str, Callable[[], Any]] = {
        "variance": lambda: variance_figure(found),
        "held_out": lambda: error_figure(found),
    }
    if _pairs(found):
        figures["clusters"] = lambda: cluster_figure(found)
        figures["trajectory"] = lambda: trajectory_figure(found, which)
    names: list[str] = []
    for name, draw in figures.items():
        figure = draw()
        for ending in (".png", ".svg"):
            save_figure(figure, folder / (name + ending))
            names.append(name + ending)
    return names
