"""What T1 and T2 do to precision and recall (keyposes 2009, Sec. 3.3, Figs. 4 and 5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Reading
from onbeat.reproduce.p3.dances import Danced
from onbeat.reproduce.p3.extraction import LEARNED, beat_score, inside, learned
from onbeat.reproduce.result import Claim, FigureResult
from onbeat.viewer.plots.files import figure_bytes, new_figure

VALUES = np.concatenate((np.arange(0.0, 2.0, 0.1), np.arange(2.0, 10.01, 0.5)))
"""Of the threshold that is varied, in units of the mean energy; the paper's range, finer where something happens."""
LOOKS = {"as published": ("#c43d52", "-"), "ours": ("#2f6f9f", "-")}
ABOUT_ALIKE = 0.05
"""How much precision or recall may vary where a curve is called flat."""


@dataclass(frozen=True, eq=False)
class Sweeps:
    """Precision and recall over one threshold, the other held where it was learned; the global energy alone.

    Parameters
    ----------
    values : (V,) of the threshold that is varied.
    curves : by method, and by the threshold's name: (V, 2) precision and recall, means over dances.
    floor : precision of taking every beat.
    held : by method, the thresholds of each dance, of which the other is held.
    """

    values: Array
    curves: Mapping[str, Mapping[str, Array]]
    floor: float
    held: Mapping[str, Sequence[Thresholds]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values))


def globally_learned(dances: Sequence[Danced]) -> dict[str, tuple[Thresholds, ...]]:
    """By method, thresholds of each dance that were learned from others' dances by the global energy alone.

    Those of Table 1 leave to the local energy what the global one does not find, and would be held beside themselves.
    """
    readings = {
        method: [Reading(one.motion, one.beats, replace(options, order="global")) for one in dances]
        for method, options in LEARNED.items()
    }
    return {method: learned(dances, own, lambda share: None) for method, own in readings.items()}


def swept(dances: Sequence[Danced], held: Mapping[str, Sequence[Thresholds]], values: Array = VALUES) -> Sweeps:
    """Vary both thresholds over some dances, each with thresholds of its own, by the method as published and ours."""
    curves: dict[str, dict[str, Array]] = {}
    for method, options in LEARNED.items():
        readings = [Reading(one.motion, one.beats, replace(options, order="global")) for one in dances]
        own = list(zip(dances, readings, held[method], strict=True))
        curves[method] = {
            "T1": frozen([_at(own, lambda pair, v=value: Thresholds(v, pair.t2)) for value in values.tolist()]),
            "T2": frozen([_at(own, lambda pair, v=value: Thresholds(pair.t1, v)) for value in values.tolist()]),
        }
    every = [beat_score(np.arange(one.first, one.end), one).precision for one in dances]
    return Sweeps(values, curves, float(np.mean(every)), held)


def _at(
    own: Sequence[tuple[Danced, Reading, Thresholds]], varied: Callable[[Thresholds], Thresholds]
) -> tuple[float, float]:
    """Mean precision and recall with every dance's thresholds varied."""
    scores = [beat_score(inside(reading.keyposes(varied(pair)), one), one) for one, reading, pair in own]
    return float(np.mean([one.precision for one in scores])), float(np.mean([one.recall for one in scores]))


def threshold_figure(sweeps: Sweeps, name: str) -> FigureResult:
    """Fig. 4 (``name`` T1) or Fig. 5 (T2)."""
    number, other = ("Fig. 4", "T2") if name == "T1" else ("Fig. 5", "T1")
    told = (
        "both stay level over a large part of the range"
        if name == "T1"
        else "both are high over a large part of it, at the worst 50%"
    )
    return FigureResult(
        number,
        f"Recall and precision over {name}",
        figure_bytes(_drawn(sweeps, name), "svg"),
        f"Recall and precision with {name} from 0 to 10, by the global energy alone: {told}.",
        f"The same, {other} held where it was learned by the global energy alone ({_held(sweeps, other)}). The units "
        "are the mean energy, since the paper does not tell its own. Dotted: the precision of taking every beat. Where "
        "nothing is found precision counts as 0.",
        " ".join(_flat(sweeps, method, name) for method in sweeps.curves),
    )


def _held(sweeps: Sweeps, other: str) -> str:
    """The values at which a threshold is held, in words."""
    at = {method: sorted({pair[other == "T2"] for pair in pairs}) for method, pairs in sweeps.held.items()}
    return "; ".join(f"{method}: {' or '.join(f'{value:g}' for value in values)}" for method, values in at.items())


def _flat(sweeps: Sweeps, method: str, name: str) -> str:
    """From where on a method's curves are level, and how low they get, in words."""
    curve = sweeps.curves[method][name]
    first = level_from(sweeps, method, name)
    words = f"level from {name} = {sweeps.values[first]:.1f} on" if first < len(curve) - 1 else "level nowhere"
    return (
        f"{method[0].upper()}{method[1:]}: {words}, at recall {curve[-1, 1]:.0%} and precision {curve[-1, 0]:.0%}; "
        f"the lowest are {curve[:, 1].min():.0%} and {curve[:, 0].min():.0%}."
    )


def level_from(sweeps: Sweeps, method: str, name: str) -> int:
    """The first value from which on neither precision nor recall varies by more than ``ABOUT_ALIKE``."""
    curve = sweeps.curves[method][name]
    return next(k for k in range(len(curve)) if np.ptp(curve[k:], axis=0).max() <= ABOUT_ALIKE)


def _drawn(sweeps: Sweeps, name: str) -> Any:
    figure = new_figure((8.6, 3.1))
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, column, label in ((left, 1, "recall [%]"), (right, 0, "precision [%]")):
        for method, (colour, style) in LOOKS.items():
            curve = 100 * sweeps.curves[method][name][:, column]
            axes.plot(sweeps.values, curve, style, color=colour, lw=1.8, label=method)
        axes.set(xlabel=f"{name} [mean energy]", ylabel=label, ylim=(0, 104), xlim=(0, 10))
        axes.grid(alpha=0.3)
    right.axhline(100 * sweeps.floor, color="#7d8796", lw=1.2, ls=":", label="every beat")
    right.legend(loc="lower right", frameon=False)
    return figure


def threshold_claims(sweeps: Sweeps) -> tuple[Claim, ...]:
    """That precision and recall depend little on the thresholds, and how low they get."""
    curves = {name: sweeps.curves["as published"][name] for name in ("T1", "T2")}
    share = {
        name: float(1 - sweeps.values[level_from(sweeps, "as published", name)] / sweeps.values[-1]) for name in curves
    }
    worst, where = min(
        (float(value), f"{('precision', 'recall')[column]} at {name} = {sweeps.values[k]:.1f}")
        for name, curve in curves.items()
        for k, pair in enumerate(curve)
        for column, value in enumerate(pair)
    )
    return (
        Claim(
            "Precision and recall are level over a large part of T1 and T2 from 0 to 10.",
            min(share.values()) > 0.5,
            f"As published over the last {share['T1']:.0%} of T1's range and {share['T2']:.0%} of T2's. Where T1 is "
            "large every minimum near a beat passes: the beats do the work then, at a precision of "
            f"{curves['T1'][-1, 0]:.0%}, and {sweeps.floor:.0%} for taking all beats.",
            ("Fig. 4", "Fig. 5"),
        ),
        Claim(
            "Even the worst thresholds give a precision and a recall of 50%.",
            worst >= 0.5,
            f"The worst is a {where} of {worst:.0%}, with {'T2' if 'T1' in where else 'T1'} where it was learned.",
            ("Fig. 4" if "T1" in where else "Fig. 5",),
        ),
    )
