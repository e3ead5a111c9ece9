"""One row of a keypose sheet, drawn in inches: energy with beats, candidates and keyposes, and the poses below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.keyposes.extract import Keyposes
from onbeat.viewer.keypose.rows import Row, downbeats_among, in_beats, spread

INK, SOFT, FAINT = "#22262e", "#6b7280", "#c9ced6"
NARROWEST = 0.82
"""Inches that the words under a picture need."""


class Look(NamedTuple):
    """How what rests in one way is drawn: shape and colour, of different greys in print; and words for it."""

    marker: str
    colour: str
    words: str


LOOKS = {
    "global": Look("o", "#1f3f77", "in the world"),
    "local": Look("s", "#e0782f", "in the body's frame"),
    "hands": Look("D", "#2f8f83", "of the hands"),
    "effectors": Look("D", "#2f8f83", "of hands and feet"),
    "beat": Look("h", "#7d8796", "on the beat"),
}
"""By the source of a keypose."""


@dataclass(frozen=True)
class Measures:
    """Inches of the parts of a row, and of the whole of it."""

    left: float
    right: float
    head: float
    graph: float
    gap: float
    leader: float
    picture: tuple[float, float]
    caption: float
    whole: float


@dataclass(frozen=True, eq=False)
class Content:
    """What all rows of a sheet draw from.

    Parameters
    ----------
    found : the keyposes.
    downbeats : seconds.
    at : (N,) the energy's times in beats.
    top : the energy at which graphs end.
    pictures : one (H, W, 3) a keypose.
    yaws : (K,) radians, where each pose faces; None where all face alike.
    """

    found: Keyposes
    downbeats: Times
    at: Array
    top: float
    pictures: list[np.ndarray]
    yaws: Array | None


def look_of(source: str) -> Look:
    """How a source is drawn; unknown ones as beats."""
    return LOOKS.get(source, LOOKS["beat"])


def draw_row(page: Any, row: Row, y: float, sizes: Measures, content: Content) -> None:
    """Draw a row whose upper edge is at height ``y`` of the page."""
    found, end = content.found, row.end - 0.5
    scale = (sizes.right - sizes.left) / (row.end - row.first)

    def x_of(beats: Any) -> Any:
        return sizes.left + (np.asarray(beats) - (row.first - 0.5)) * scale

    upper = y - sizes.head - sizes.graph
    graphs = [("global", upper, found.energy.world)]
    if len(found.energy.local):  # none where the body's frame is not known
        graphs.append(("local", upper - sizes.gap - sizes.graph, found.energy.local))
    lower = graphs[-1][1]
    page.text(sizes.left, y - 0.11, row.title, size=8, color=INK, weight="bold", va="center")
    _draw_beats(page, row, x_of, lower, upper + sizes.graph, content)
    for name, base, curve in graphs:
        _draw_graph(page, name, base, sizes, content.top)
        part = (content.at >= row.first - 0.5) & (content.at <= end)
        if part.any():
            heights = base + np.minimum(curve[part] / content.top, 1.0) * sizes.graph
            page.plot(x_of(content.at[part]), heights, color=look_of(name).colour, lw=1.2, zorder=4)
        _draw_candidates(page, row, name, curve, x_of, base, sizes, content)
    _draw_keyposes(page, row, x_of, (upper, lower), y, sizes, content)


def _draw_beats(page: Any, row: Row, x_of: Any, low: float, high: float, content: Content) -> None:
    beats = content.found.song_beats
    shown = np.arange(max(row.first, 0), min(row.end, len(beats)))
    down = np.isin(shown, downbeats_among(beats, content.downbeats))
    page.vlines(x_of(shown[~down]), low, high, color=FAINT, lw=0.7, linestyles=(0, (4, 3)), zorder=1)
    page.vlines(x_of(shown[down]), low, high, color="#8a919d", lw=1.3, zorder=1)


def _draw_graph(page: Any, name: str, base: float, sizes: Measures, top: float) -> None:
    """Its ground line, its name, and the heights of the mean energy and its multiples."""
    page.plot([sizes.left, sizes.right], [base, base], color=SOFT, lw=0.8, zorder=2)
    page.text(
        sizes.left - 0.24, base + sizes.graph / 2, name, size=7, color=look_of(name).colour, rotation=90, ha="center",
        va="center",
    )  # fmt: skip
    for value in range(1, 1 + int(top)):
        height = base + value / top * sizes.graph
        if value == 1:
            page.plot([sizes.left, sizes.right], [height, height], color=FAINT, lw=0.6, ls=":", zorder=1)
        if value in (1, int(top)):
            page.text(sizes.left - 0.06, height, str(value), size=6, color=SOFT, ha="right", va="center")


def _draw_candidates(
    page: Any, row: Row, name: str, curve: Array, x_of: Any, base: float, sizes: Measures, content: Content
) -> None:
    """Hollow marks on the curve; those of methods without an energy stand on the upper graph."""
    found = content.found
    names = [name] if name == "local" else [one for one in found.candidates if one != "local"]
    for one in names:
        times = found.candidates.get(one, np.zeros(0))
        times = times[~np.isnan(times)]
        at = in_beats(times, found.song_beats)
        part = (at >= row.first - 0.5) & (at < row.end - 0.5)
        heights = base + _level(found, curve, times[part], content.top) * sizes.graph
        look = look_of(one)
        page.plot(x_of(at[part]), heights, look.marker, mfc="white", mec=look.colour, mew=1.0, ms=4.2, zorder=5)


def _level(found: Keyposes, curve: Array, times: Times, top: float) -> Array:
    """(K,) 0…1 the height of the curve at some times."""
    return np.minimum(np.interp(times, found.energy.times, curve) / top, 1.0)


def _draw_keyposes(
    page: Any, row: Row, x_of: Any, bases: tuple[float, float], y: float, sizes: Measures, content: Content
) -> None:
    """Marks on the curves, numbers above, lines down to the pictures, and the pictures with what is told of them."""
    found, (upper, lower) = content.found, bases
    if not len(row.chosen):
        return
    times = found.times[row.chosen]
    exact = x_of(in_beats(times, found.song_beats))
    width, height = sizes.picture
    edges = sizes.left - 0.3, sizes.right
    room = max(width, NARROWEST)
    centres = spread(x_of(row.first + row.columns), room + 0.03, edges[0] + room / 2, edges[1] - room / 2)[row.column]
    labels = spread(exact, 0.21, sizes.left, sizes.right)
    for k, keypose in enumerate(row.chosen.tolist()):
        look = look_of(found.sources[keypose])
        local = found.sources[keypose] == "local"
        base, curve = (lower, found.energy.local) if local else (upper, found.energy.world)
        level = base + _level(found, curve, times[k : k + 1], content.top)[0] * sizes.graph
        top = lower - sizes.leader
        line_x, line_y = (
            [labels[k], exact[k], exact[k], centres[k]],
            [y - sizes.head + 0.02, upper + sizes.graph, lower, top],
        )
        page.plot(line_x, line_y, color=INK, lw=0.8, zorder=3)
        page.plot(exact[k], level, look.marker, color=look.colour, mec="white", mew=0.6, ms=6.4, zorder=6)
        page.text(
            labels[k], y - sizes.head + 0.08, str(row.numbers[k]), size=8, weight="bold", ha="center", va="center"
        )
        place = centres[k] - width / 2, top - height
        _draw_pose(page, keypose, place, sizes, content)
        _caption(page, keypose, int(row.numbers[k]), look, place, sizes, content)


def _draw_pose(page: Any, keypose: int, place: tuple[float, float], sizes: Measures, content: Content) -> None:
    (x, y), (width, height) = place, sizes.picture
    page.imshow(content.pictures[keypose], extent=(x, x + width, y, y + height), aspect="auto", zorder=2)
    page.plot([x, x, x + width, x + width, x], [y, y + height, y + height, y, y], color=FAINT, lw=0.5, zorder=2)
    if content.yaws is None:
        return
    # The arrow is the floor seen from above; up is where the dancer faced at first.
    yaw, reach, middle = float(content.yaws[keypose] - content.yaws[0]), 0.075, (x + width - 0.12, y + height - 0.12)
    step = -np.sin(yaw) * reach, np.cos(yaw) * reach
    page.annotate(
        "", (middle[0] + step[0], middle[1] + step[1]), (middle[0] - step[0], middle[1] - step[1]),
        arrowprops={"arrowstyle": "-|>", "color": SOFT, "lw": 0.9, "mutation_scale": 6, "shrinkA": 0, "shrinkB": 0},
        zorder=3,
    )  # fmt: skip


def _caption(
    page: Any, keypose: int, number: int, look: Look, place: tuple[float, float], sizes: Measures, content: Content
) -> None:
    found, middle = content.found, place[1] - sizes.caption / 2 - 0.01
    left = place[0] + sizes.picture[0] / 2 - 0.36
    page.plot(left + 0.12, middle, look.marker, color=look.colour, ms=14 if look.marker == "D" else 15.5, mec="none")
    size = 8.5 if number < 100 else 6.5
    page.text(
        left + 0.12, middle - 0.005, str(number), size=size, weight="bold", color="white", ha="center", va="center"
    )
    words = f"beat {int(found.beats[keypose]) + 1}\n{found.times[keypose]:.2f} s"
    page.text(left + 0.28, middle, words, size=6.8, color=INK, ha="left", va="center", linespacing=1.15)
