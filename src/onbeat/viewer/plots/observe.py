"""Figures of a dance's repetitions at several speeds, after 2007: means, variances, and what is left of layers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.retime.attenuation import Attenuation
from onbeat.retime.observe import Curves, Observation
from onbeat.viewer.plots.files import new_figure, save_figure

INK, KEYPOSE, TOGETHER, GRID = "#3b4a5f", "#c43d52", "#27408b", "#d5dbe3"
LOW, HIGH = np.array([44, 138, 88]) / 255, np.array([89, 183, 230]) / 255
MIDDLE = np.array([226, 164, 0]) / 255
"""Green, yellow and light blue, as in the paper: the slowest, the middle, the fastest."""
SHOWN = 3
"""Layers of Fig. 3: reconstructions of 1, 2 and 3."""


def speed_colours(count: int) -> list[Array]:
    """A colour for each speed, slowest first."""
    at = np.linspace(0.0, 1.0, count) if count > 1 else np.zeros(1)
    table = np.stack((LOW, MIDDLE, HIGH))
    return list(np.stack([np.interp(at, (0.0, 0.5, 1.0), channel) for channel in table.T], axis=1))


def mean_figure(found: Observation, joint: str, keyposes: Array | None = None) -> Any:
    """Fig. 3: the mean of a joint's rotation at each speed, rebuilt of 1, 2 and 3 layers."""
    every = found.repetitions
    layers = min(SHOWN, every.layers.shape[1])
    place = every.joints.index(joint)
    figure = new_figure((4.0 * layers + 0.6, 5.6))
    grid = figure.subplots(3, layers, squeeze=False, sharex=True, sharey="row")
    for column in range(layers):
        for row, name in enumerate("xyz"):
            axes = grid[row][column]
            _marked(axes, keyposes)
            for curves, colour in zip(found.speeds, speed_colours(len(found.speeds)), strict=True):
                axes.plot(every.beats, curves.mean[column, :, place, row], color=colour, lw=1.5, label=_named(curves))
            axes.set_xlim(every.beats[0], every.beats[-1])
            if column == 0:
                axes.set_ylabel(f"{name} [rad]")
        grid[0][column].set_title(f"{column + 1} layer{'s' if column else ''}", fontsize=9)
        grid[-1][column].set_xlabel("beat")
    figure.suptitle(f"{joint}: mean logarithm of the quaternion (half the angle, Eq. 8)", fontsize=10)
    _legend(figure, grid[0][0])
    return figure


def variance_figure(found: Observation, joint: str, common: Array, keyposes: Array | None = None) -> Any:
    """Fig. 4: the variance of a joint and of all joints at each speed and of all together, with the common valleys."""
    every = found.repetitions
    place = every.joints.index(joint)
    figure = new_figure((10.5, 5.8))
    above, below = figure.subplots(2, 1, sharex=True)
    colours: list[Any] = [*speed_colours(len(found.speeds)), TOGETHER]
    for axes, title in ((above, joint), (below, f"{len(every.joints)} joints, geometric mean")):
        _marked(axes, keyposes)
        for curves, colour in zip((*found.speeds, found.all), colours, strict=True):
            if not any(curves is each for each in found.repeated):
                continue
            values = curves.variance[-1, :, place] if axes is above else curves.pooled
            axes.plot(every.beats, np.where(values > 0, values, np.nan), color=colour, lw=1.5, label=_named(curves))
        axes.set_yscale("log")
        axes.set_xlim(every.beats[0], every.beats[-1])
        axes.set_title(title, fontsize=9, loc="left")
        axes.set_ylabel("variance (Eq. 9)")
    if len(common):
        foot = np.full(len(common), 0.03)
        below.plot(
            common, foot, "^", color=INK, ms=7, transform=below.get_xaxis_transform(), clip_on=False, zorder=5,
            label="valley of all curves",
        )  # fmt: skip
    below.set_xlabel("beat")
    _legend(figure, below)
    return figure


def layer_figure(energies: Attenuation) -> Any:
    """Insight 1: the layers' energies over speed with what takes do not share, and what of them is left."""
    figure = new_figure((10.5, 4.4))
    left, right = figure.subplots(1, 2)
    for k in range(energies.rms.shape[1]):
        style = {"color": _shade(k), "marker": "os^Dv"[k % 5], "ms": 5}
        left.plot(energies.speeds, energies.rms[:, k], lw=1.6, label=f"layer {k + 1}", **style)
        left.plot(energies.speeds, energies.noise[:, k], ":", lw=1.2, color=style["color"])
        slope, low, high = energies.slopes[0, k]
        told = f": slope {slope:+.2f}" if np.isfinite(slope) else ""
        told += f" [{low:+.2f}, {high:+.2f}]" if np.isfinite(low) else ""
        right.plot(energies.speeds, energies.ratios[0][:, k], lw=1.6, label=f"layer {k + 1}{told}", **style)
    left.plot([], [], ":", color=INK, label="not shared by repetitions")
    left.set_yscale("log")
    left.set(xlabel="speed", ylabel="rms [rad]")
    left.set_title("energy of the layers", fontsize=10)
    right.axhline(1.0, color=KEYPOSE, lw=1.2, ls="--", label="merely played faster")
    right.set(xlabel="speed", ylabel=f"share of the rms at speed {energies.speeds[energies.base]:g}")
    right.set_title("what is left of them", fontsize=10)
    right.set_ylim(0.0, None)
    for axes in (left, right):
        axes.set_xticks(energies.speeds, [f"{speed:g}" for speed in energies.speeds])
        axes.grid(color=GRID, lw=0.6)
        axes.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    return figure


def _shade(layer: int) -> Array:
    """From dark, the coarsest, to light."""
    return np.minimum(np.array([0.16, 0.25, 0.45]) + layer * np.array([0.13, 0.12, 0.08]), 0.85)


def _marked(axes: Any, keyposes: Array | None) -> None:
    for number, beat in enumerate(() if keyposes is None else keyposes.tolist()):
        axes.axvline(beat, color=KEYPOSE, lw=0.9, ls="--", alpha=0.6, zorder=0, label="" if number else "keypose")
    axes.grid(color=GRID, lw=0.5, axis="y")


def _named(curves: Curves) -> str:
    return f"{curves.speed:g}× ({curves.count})" if curves.speed else f"all ({curves.count})"


def _legend(figure: Any, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 6), frameon=False)


def write_observe_figures(
    folder: Path, found: Observation, energies: Attenuation, joint: str, common: Array, keyposes: Array | None = None
) -> list[str]:
    """Draw all figures to a folder, each as PNG and SVG; their names.

    Parameters
    ----------
    folder : where to.
    found, energies : what is drawn.
    joint : whose curves.
    common : beats of the valleys that all curves have.
    keyposes : beats of the known ones, or None.
    """
    figures: Sequence[tuple[str, Any]] = (
        ("means", mean_figure(found, joint, keyposes)),
        ("variance", variance_figure(found, joint, common, keyposes)),
        ("layers", layer_figure(energies)),
    )
    names: list[str] = []
    for name, figure in figures:
        for ending in (".png", ".svg"):
            save_figure(figure, folder / (name + ending))
            names.append(name + ending)
    return names
