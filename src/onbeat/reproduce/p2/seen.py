"""Sec. II of 2007 done again: Figs. 1, 3 and 4 with their numbers, beside a control that is merely played faster."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import MetricError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.troupe import SPEEDS
from onbeat.reproduce.data import Data
from onbeat.reproduce.p2.hand import FASTER, Compared, compared, hand_figure, hand_paths
from onbeat.reproduce.p2.observed import (
    TOLERANCE,
    Observed,
    bends_left,
    coarse_left,
    detail_left,
    difference,
    kept,
    likeness,
    observed,
)
from onbeat.reproduce.p2.takes import FEW, TAKES, Takes, real_takes, troupe_takes
from onbeat.reproduce.p2.valleys import valley_figure
from onbeat.reproduce.result import FigureResult, Part, Row, TableResult
from onbeat.viewer.plots.files import figure_bytes
from onbeat.viewer.plots.observe import mean_figure

FEW_DANCERS = 2
"""That are observed for a first look."""
SHOWN = (1, 2, 3)
"""Layers that the means of Fig. 3 are rebuilt of."""


@dataclass(frozen=True, eq=False)
class Seen:
    """Dancers observed at several speeds.

    Parameters
    ----------
    every : of each dancer; the first is drawn.
    controls : of each the same, merely played faster; empty for real takes.
    hands : takes of the first at the speeds of Fig. 1, and their control, if there is one.
    """

    every: tuple[Observed, ...]
    controls: tuple[Observed, ...]
    hands: tuple[Takes, ...]

    @property
    def first(self) -> Observed:
        """The one that is drawn."""
        return self.every[0]

    @property
    def control(self) -> Observed | None:
        """That of the first."""
        return self.controls[0] if self.controls else None


def see(data: Data, step: Callable[[float, str], None]) -> Seen:
    """Observe the embedded troupe, or real takes.

    Raises
    ------
    MetricError
        If real takes are no takes of one dance at two speeds or more.
    """
    if not data.embedded:
        takes = real_takes(data.motion_files(), data.fps)
        if len(takes.speeds) < 2:
            raise MetricError("all takes have one tempo; what changes in faster music needs two or more")
        step(0.0, "observing takes")
        return Seen((observed(takes, data.seed),), (), (takes,))
    count, dancers = (FEW, FEW_DANCERS) if data.quick else (TAKES, len(DANCERS))
    every, controls = list[Observed](), list[Observed]()
    for dancer in range(dancers):
        step(dancer / dancers, f"observing {DANCERS[dancer].name} at {len(SPEEDS)} speeds")
        every.append(observed(troupe_takes(dancer, SPEEDS, count, data.seed), data.seed))
        controls.append(observed(troupe_takes(dancer, SPEEDS, count, data.seed, played=True), data.seed))
    hands = [troupe_takes(0, (1.0, FASTER), count, data.seed, played=played) for played in (False, True)]
    return Seen(tuple(every), tuple(controls), tuple(hands))


def faster_of(takes: Takes) -> float:
    """The speed that is nearest to that of Fig. 1, but not the slowest."""
    return min(takes.speeds[1:], key=lambda speed: abs(speed - FASTER))


def hands_compared(takes: Takes) -> Compared:
    """The left hand at the slowest and at the faster speed."""
    normal, faster = hand_paths(takes, takes.speeds[0]), hand_paths(takes, faster_of(takes))
    return compared(normal, faster, takes.keyposes)


def seen_parts(seen: Seen) -> tuple[Part, ...]:
    """Figures and tables of Sec. II, in the paper's order."""
    return (_figure_1(seen), _figure_3(seen), _means(seen), _figure_4(seen), _layers(seen), _valleys(seen))


def _figure_1(seen: Seen) -> FigureResult:
    takes = seen.hands[0]
    normal, faster, told = (
        hand_paths(takes, takes.speeds[0]),
        hand_paths(takes, faster_of(takes)),
        hands_compared(takes),
    )
    figure = hand_figure(normal, faster, takes.at(normal.speed)[0], takes.keyposes)
    ours = (
        f"The left hand of {takes.title} in the body's own frame, {normal.speed:g}× and {faster.speed:g}×: thick the "
        f"mean of {len(normal.places)} takes each, thin the takes. The faster path is {told.length:.0%} as long"
    )
    if np.isfinite(told.at_keyposes):
        ours += f"; it is {100 * told.at_keyposes:.1f} cm away at keyposes and {100 * told.between:.1f} cm elsewhere"
    remark = ""
    if len(seen.hands) > 1:
        control = hands_compared(seen.hands[1])
        remark = (
            f"Merely played faster it is {control.length:.0%} as long, {100 * control.at_keyposes:.1f} cm away at "
            f"keyposes and {100 * control.between:.1f} cm elsewhere: dancers who are early or late by the same "
            "seconds are so by more of a beat."
        )
    return FigureResult(
        "Fig. 1",
        "A hand's path at the normal and at a faster speed",
        figure_bytes(figure, "svg"),
        "The path of a hand at the normal speed (green) and to music 1.3 times as fast (yellow): the same on the "
        "whole, different in details.",
        ours + ".",
        remark,
    )


def _figure_3(seen: Seen) -> FigureResult:
    first = seen.first
    counts = ", ".join(f"{one.count} at {one.speed:g}×" for one in first.found.speeds)
    return FigureResult(
        "Fig. 3",
        "Mean joint angles of the left shoulder, of one, two and three layers",
        figure_bytes(mean_figure(first.found, first.joint, first.keyposes), "svg"),
        "The mean rotation of the left shoulder at 1.0× (green), 1.2× (yellow) and 1.5× (light blue). Of one layer "
        "the curves are much alike, with two and three layers they differ more, and the fast one is a smoothed "
        "version of the normal one.",
        f"The same of {first.takes.title}: takes {counts} (their numbers stand in brackets); x, y and "
        "z of the quaternion's logarithm.",
        "What of this is so in numbers is in the next table.",
    )


def _means(seen: Seen) -> TableResult:
    first, control = seen.first, seen.control
    rows = list[Row]()
    for place, curves in enumerate(first.found.speeds[1:], 1):
        for layers in SHOWN:
            own = (f"{value:.2f}" for value in (likeness(first, curves, layers), bends_left(first, curves, layers)))
            others = ("–", "–")
            if control is not None:
                played = control.found.speeds[place]
                others = (f"{difference(control, played, layers):.1f}°", f"{bends_left(control, played, layers):.2f}")
            said = {1: "“quite similar”", 2: "differs slightly"} if place == 1 else {1: "similar", 2: "smoothed"}
            words = said.get(layers, "slightly smoothed" if place == 1 else "much smoothed")
            label = f"{curves.speed:g}×, {layers} layer{'s' if layers > 1 else ''}"
            like, bends = own
            rows.append(Row(label, words, f"{difference(first, curves, layers):.1f}°", "", (bends, like, *others)))
    heads = ("left shoulder", "paper", "ours: off by", "bends", "correlation", "control: off by", "control: bends", "")
    return TableResult(
        "Fig. 3, numbers",
        "How the left shoulder's mean at a faster speed differs from that at the normal one",
        tuple(rows),
        heads,
        "“Off by” is the root mean square of the angle between both means; “bends” is the second derivative by beats, "
        "divided by that at the normal speed: under 1 where the curve is smoother. The control is merely played "
        "faster.",
    )


def _figure_4(seen: Seen) -> FigureResult:
    first, told = seen.first, kept(seen.first)
    ours = (
        f"The same of {first.takes.title}, {len(first.takes.takes)} takes, on a logarithmic scale; below it the "
        f"geometric mean over the {len(first.found.repetitions.joints)} joints of the upper body, whose valleys count. "
        f"{len(first.common)} valleys are common to all curves"
    )
    if told is not None:
        ours += f"; {told.precision:.0%} of them are keyposes, and {told.recall:.0%} of the {told.keyposes} keyposes "
        ours += f"have one ({told.chance:.0%} where the valleys are moved at random)"
    return FigureResult(
        "Fig. 4",
        "Variance over the dance, the postures in its valleys, and the keyposes",
        figure_bytes(valley_figure(first), "svg"),
        "The variance of the left shoulder at each speed and of all takes (blue). There are valleys that all curves "
        "have; the postures in them are shown below, and under these the stop motions that dance masters named: most "
        "valleys are such stops.",
        ours + ".",
        ""
        if not seen.controls
        else "That dancers rest on keyposes, and are early or late most between them, is made so in the troupe.",
    )


def _percents(values: Array) -> tuple[str, ...]:
    return tuple(f"{value:.0%}" for value in values.tolist())


def _layers(seen: Seen) -> TableResult:
    """What is left of details and of the rest."""
    speeds = [f"{speed:g}×" for speed in seen.first.takes.speeds[1:]]
    rows = list[Row]()
    for place, one in enumerate(seen.every):
        control = _percents(detail_left(seen.controls[place])[1:]) if seen.controls else ("–",) * len(speeds)
        first, *details = _percents(detail_left(one)[1:])
        rows.append(
            Row(one.takes.dancer, "attenuated", first, "", (*details, *_percents(coarse_left(one)[1:]), *control))
        )
    heads = [f"{words}, {speed}" for words in ("ours: details", "the rest", "control: details") for speed in speeds]
    return TableResult(
        "Insight 1",
        "What is left of the layers in faster music, as root mean square of all joints of the upper body",
        tuple(rows),
        ("dancer", "paper", *heads, ""),
        "Details are the layers with knots on quarter beats and finer, the rest those on beats and half beats. The "
        "paper shows this in curves and gives no number.",
    )


def _valleys(seen: Seen) -> TableResult:
    rows = list[Row]()
    for one in seen.every:
        told = kept(one)
        if told is None:
            rows.append(Row(one.takes.dancer, "most", "keyposes not known", f"{len(one.common)} valleys", ("–",) * 3))
            continue
        others = (f"{told.recall:.0%}", f"{told.chance:.0%}", f"{told.contrast:.2f}")
        note = f"{told.valleys} valleys, {told.keyposes} keyposes"
        rows.append(Row(one.takes.dancer, "most", f"{told.precision:.0%}", note, others))
    return TableResult(
        "Insight 2",
        "Valleys of all curves of variance that are keyposes, and keyposes that have such a valley",
        tuple(rows),
        ("dancer", "paper", "ours: valleys on keyposes", "keyposes with a valley", "by chance", "variance there", ""),
        f"Within {TOLERANCE:g} beat. “By chance” is the share of the keyposes with a valley where the same valleys are "
        "moved along the dance by a random amount; “variance there” is that of all takes at keyposes, divided by that "
        "at other times.",
    )
