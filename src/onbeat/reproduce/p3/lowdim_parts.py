"""Figs. 7 to 11, 13 and 14 of keyposes 2009, and the errors and counts that the paper lacks."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lowdim import LowDimensional, people_told
from onbeat.reproduce.p3.lowdim import PHASES, Spaces, grouped
from onbeat.reproduce.result import FigureResult, Row, TableResult
from onbeat.viewer.plots.files import figure_bytes, new_figure
from onbeat.viewer.plots.lowdim import cluster_figure, error_figure, trajectory_figure, variance_figure
from onbeat.viewer.plots.lowdim_pictures import dimensions_picture, most_different, posture_picture, telling_frame

PERSON = 4
"""Person five of the paper's Figs. 9 and 10: the fifth, counted from 0."""
WORDS = {
    "through": "a bone goes through another",
    "beyond": "a joint is bent beyond its range",
}


def lowdim_parts(spaces: Spaces) -> tuple[FigureResult | TableResult, ...]:
    """Figs. 7 to 11, what the paper does not measure, and Figs. 13 and 14."""
    found = spaces.found
    person = min(PERSON, len(found.motions) - 1)
    return (
        _figure_7(found),
        _figure_9(found, person),
        _figure_10(found, person),
        _figure_11(found),
        _errors_figure(found),
        _errors_table(found),
        _posture_figure(spaces, "Fig. 13", "through"),
        _posture_figure(spaces, "Fig. 14", "beyond"),
        _posture_table(spaces),
    )


def _figure_7(found: LowDimensional) -> FigureResult:
    keyposes, uniform = (
        grouped(found, "keyposes"),
        [grouped(found, "uniform", phase) for phase in PHASES],
    )
    return FigureResult(
        "Figs. 7 and 8",
        "Keyposes, and poses at equal distances in time, in their first three dimensions",
        figure_bytes(cluster_figure(found), "svg"),
        "The eight people's keyposes in their first three dimensions, in tight groups by their number in the dance; "
        "the poses of uniform sampling, which are not grouped as well.",
        f"The same for {people_told(len(found.motions))}, the first dimension over the second and the third; groups "
        "bear their numbers in the cycle, shapes are people.",
        f"Of the spread in three dimensions {keyposes:.0%} is between the numbers for keyposes, and "
        f"{min(uniform):.0%} to {max(uniform):.0%} for uniform sampling, by its phase.",
    )


def _figure_9(found: LowDimensional, person: int) -> FigureResult:
    return FigureResult(
        "Fig. 9",
        "A dance as a path through the keypose space",
        figure_bytes(trajectory_figure(found, person), "svg"),
        "The cycle of the fifth person as a curve through the space's first three dimensions, past the person's "
        "keyposes, which are numbered, among everybody's.",
        f"The same for {found.taught[person].person}.",
    )


def _figure_10(found: LowDimensional, person: int) -> FigureResult:
    errors = 1000 * found.frames.keypose[0]
    told = ", ".join(f"{error:.0f}" for error in errors[:4])
    return FigureResult(
        "Fig. 10",
        "A pose in one, two, three and four dimensions",
        figure_bytes(picture_figure(dimensions_picture(found, person, telling_frame(found, person))), "svg"),
        "One moment of the fifth person in one, two, three and four dimensions of the keypose space; three are said "
        "to look right.",
        f"The same for {found.taught[person].person}, at the most outstretched keypose, and the original.",
        f"On frames that were not used the points are off by {told} mm in the mean, in 1, 2, … dimensions.",
    )


def _figure_11(found: LowDimensional) -> FigureResult:
    ours, theirs = (found.spaces[space].cumulative for space in SPACES)
    figure = variance_figure(found)
    figure.set_size_inches(8.6, 3.6)
    told = ", ".join(f"{k}: {ours[k - 1]:.1%} and {theirs[k - 1]:.1%}" for k in (1, 2, 3, 4) if k <= len(ours))
    return FigureResult(
        "Fig. 11",
        "How much of the variance the first dimensions have",
        figure_bytes(figure, "svg"),
        "The share of the variance in the first dimensions, of keyposes and of uniform sampling; that of keyposes is "
        "larger.",
        "The same; each line is of the variance of its own poses.",
        f"Of keyposes and of uniform sampling, by dimensions: {told}. Each has the variance of other poses, so that "
        "this does not tell which space rebuilds a dance better; the next figure does.",
    )


def _errors_figure(found: LowDimensional) -> FigureResult:
    return FigureResult(
        "Sec. 4.3",
        "What the paper does not measure: how far off poses are rebuilt that were not used",
        figure_bytes(error_figure(found), "svg"),
        "Nothing; the paper compares variances, and asks people.",
        "The mean distance of rebuilt points from the true ones over the number of dimensions, on frames of other "
        "cycles and on people of whom the spaces know nothing: all frames, the slower half of them, and keyposes; "
        "the band is of eight phases of uniform sampling.",
    )


def _errors_table(found: LowDimensional) -> TableResult:
    rows: list[Row] = []
    for name, held in (("unseen frames", found.frames), ("unseen people", found.people)):
        for kind, title in enumerate(("all frames", "frames at rest", "keyposes")):
            if held is not None and len(held.dims) >= found.dims and np.isfinite(held.keypose[kind]).all():
                ours, theirs = (1000 * errors[kind, found.dims - 1] for errors in (held.keypose, held.uniform_mean))
                rows.append(
                    Row(f"{name}: {title}", None, f"{ours:.1f} mm", _word(ours / theirs), (f"{theirs:.1f} mm",))
                )
    return TableResult(
        "Sec. 4.3, errors",
        f"Mean distance of rebuilt points in {found.dims} dimensions, on poses that were not used",
        tuple(rows),
        ("", "paper", "ours: keyposes", "ours: uniform sampling", "note"),
        "Where a dance rests it is looked at. Over all frames uniform sampling is a fair sample of just these frames, "
        "and hard to beat.",
    )


def _word(ratio: float) -> str:
    if abs(ratio - 1) < 0.02:
        return "alike"
    return f"keyposes {abs(1 - ratio):.0%} {'nearer' if ratio < 1 else 'farther off'}"


def _posture_figure(spaces: Spaces, number: str, kind: str) -> FigureResult:
    found, picked = spaces.found, spaces.worst(kind)
    which, frame = picked or most_different(found)
    shown = {
        "through": "A moment at which with uniform sampling a hand is inside the body, with keyposes it is not.",
        "beyond": "A moment at which with uniform sampling the head and a leg are bent unnaturally, the leg forwards "
        "at the knee, from the front and from the side; with keyposes they are not.",
    }[kind]
    if picked:
        amount = float(getattr(spaces.unnatural["uniform"][which], kind)[frame])
        told = f"{100 * amount:.0f} cm deep" if kind == "through" else f"by {np.degrees(amount):.0f}°"
        remark = f"With uniform sampling {WORDS[kind]}, {told}; with keyposes nothing is unnatural. It was looked for."
    else:
        remark = (
            f"No frame was found at which, with uniform sampling alone, {WORDS[kind]}. Shown is the moment at which "
            "uniform sampling is farther off than keyposes are, by most."
        )
    back = spaces.worst(kind, "uniform", "keyposes")
    remark += (
        " The other way round there is such a moment, too." if back else " The other way round there is no such moment."
    )
    return FigureResult(
        number,
        f"An unnatural posture: {WORDS[kind]}" if picked else f"None found: {WORDS[kind]}",
        figure_bytes(picture_figure(posture_picture(found, which, frame)), "svg"),
        shown,
        f"{found.taught[which].person} at {frame / found.motions[which].fps:.2f} s, from the front and from the side: "
        "by keyposes, the original, by uniform sampling, in three dimensions.",
        remark,
    )


def _posture_table(spaces: Spaces) -> TableResult:
    rows = [
        Row(
            words, None, f"{spaces.share('keyposes', kind):.1%}", "share of all frames",
            (f"{spaces.share('uniform', kind):.1%}",),
        )
        for kind, words in WORDS.items()
    ]  # fmt: skip
    rows.append(
        Row(
            "either, in this space alone", None, f"{spaces.alone('uniform', 'keyposes'):.1%}", "share of all frames",
            (f"{spaces.alone('keyposes', 'uniform'):.1%}",),
        )
    )  # fmt: skip
    return TableResult(
        "Sec. 4.3, postures",
        "How often a posture is unnatural in three dimensions, as the motions play",
        tuple(rows),
        ("", "paper", "ours: keyposes", "ours: uniform sampling", "note"),
        "The paper shows two moments and does not count. Natural is what the originals do, with a little room.",
    )


def picture_figure(picture: Array) -> Any:
    """A picture (H, W, 3) as a figure, so that it is one file with the others."""
    tall, wide = picture.shape[:2]
    figure = new_figure((9.0, 9.0 * tall / wide))
    axes = figure.subplots()
    axes.imshow(picture, interpolation="none")
    axes.axis("off")
    return figure
