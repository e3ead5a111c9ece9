"""A sheet of a dance's keyposes to print and dance from (keyposes 2009, Fig. 3): energy, beats, and the poses."""

from __future__ import annotations

import bisect
import contextlib
import io
import itertools
import warnings
from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.keyposes.extract import Keyposes
from onbeat.motion import Markers, Motion
from onbeat.viewer.keypose.drawing import INK, SOFT, Content, Measures, draw_row, look_of
from onbeat.viewer.keypose.poses import Poses, fitted, pose_pictures, poses_at
from onbeat.viewer.keypose.rows import MOST, Row, in_beats, rows_of

A4 = (11.69, 8.27)
"""Inches."""
DPI = 200
"""Pixels an inch of PNG files, and of the poses in all."""
ENDINGS = (".png", ".svg", ".pdf")
MOST_FILES = 12
"""Pages that are written as PNG or SVG files; a PDF has all."""
ROWS, LARGE, FEW = 3, 2, 6
"""Rows of a page, and of a page of a sheet of few rows that are not to be compared with each other."""
LEFT, RIGHT, TOP, FOOT = 0.85, 11.34, 0.9, 0.24
TURNED = 0.5
"""Radians by which the dancer has to turn for arrows to tell it."""
_RC: dict[Any, Any] = {
    "font.family": "DejaVu Sans", "svg.hashsalt": "onbeat", "image.composite_image": False, "path.simplify": False,
    "text.parse_math": False,
}  # fmt: skip


def write_keypose_sheet(
    path: Path,
    found: Keyposes,
    source: Motion | Markers,
    *,
    title: str = "",
    downbeats: Times | None = None,
    cycle: int | None = None,
) -> list[Path]:
    """Draw a sheet to a PNG, SVG or PDF file of A4 pages; the files that were written.

    A PDF holds all pages. Of PNG and SVG those after the first are ``NAME_2.png``, ``NAME_3.png``, …, up to
    ``NAME_12.png``: the first ``MOST_FILES`` pages are written, no more. Files of such names that follow the last, left
    from an earlier, longer sheet, are removed.

    Parameters
    ----------
    path : the file.
    found : the keyposes.
    source : what they were found in; to markers a body is fitted where they tell one.
    title : written above.
    downbeats : seconds; those among the beats are drawn heavier.
    cycle : beats after which the dance repeats. Cycles stand under each other, and the keyposes of a beat of the cycle
        under each other, with one number.

    Raises
    ------
    OnbeatError
        If the ending is none of these, or the cycle is shorter than a beat.
    """
    return save_pages(keypose_pages(found, source, title=title, downbeats=downbeats, cycle=cycle), path)


def keypose_pages(
    found: Keyposes,
    source: Motion | Markers,
    *,
    title: str = "",
    downbeats: Times | None = None,
    cycle: int | None = None,
) -> list[Any]:
    """The pages of a sheet as matplotlib figures; arguments and errors as :func:`write_keypose_sheet`."""
    if cycle is not None and cycle < 1:
        raise OnbeatError(f"a cycle of {cycle} beats cannot be; give 1 or more")
    down = np.zeros(0) if downbeats is None else np.asarray(downbeats, np.float64)
    rows = rows_of(found.beats, found.song_beats, down, cycle)
    together = min(len(rows), ROWS if cycle is not None or len(rows) > FEW else LARGE)
    pages = [rows[first : first + together] for first in range(0, len(rows), together)]
    sizes = _measures(rows, together)
    if not len(found.energy.local):
        sizes = replace(sizes, graph=2 * sizes.graph + sizes.gap)  # one graph has the room of both
    content = _content(found, down, poses_at(fitted(source), found.times) if len(found) else None, sizes)
    return [_page(one, (number, len(pages)), title, cycle, sizes, content) for number, one in enumerate(pages, 1)]


def save_pages(pages: Sequence[Any], path: Path) -> list[Path]:
    """Write pages to a PDF, or the first 12 to a PNG or SVG file each; the same bytes for the same pages.

    See :func:`write_keypose_sheet` for the names and for what is removed.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    path, kind = Path(path), Path(path).suffix.lower()
    if kind not in ENDINGS:
        raise OnbeatError(f"{path}: cannot draw {kind or 'a file without ending'}; use {', '.join(ENDINGS)}")
    shown = pages[:MOST_FILES]
    names = [path, *(_numbered(path, n) for n in range(2, len(shown) + 1))]
    with _drawing():
        if kind == ".pdf":
            buffer = io.BytesIO()
            with PdfPages(buffer, metadata={"CreationDate": None}) as pdf:
                for page in pages:
                    pdf.savefig(page, dpi=DPI)
            write_atomically(path, buffer.getvalue())
            return [path]
        undated: dict[str, Any] = {"Date": None} if kind == ".svg" else {"Software": None}
        for page, name in zip(shown, names, strict=True):
            buffer = io.BytesIO()
            page.savefig(buffer, format=kind[1:], dpi=DPI, metadata=undated)
            write_atomically(name, buffer.getvalue())
    _remove_after(path, len(names))
    return names


def _numbered(path: Path, number: int) -> Path:
    return path.with_name(f"{path.stem}_{number}{path.suffix}")


def _remove_after(path: Path, count: int) -> None:
    """Remove the pages that an earlier run with more of them left behind."""
    names = itertools.takewhile(Path.is_file, (_numbered(path, n) for n in itertools.count(max(count, 1) + 1)))
    try:
        for name in reversed(list(names)):
            name.unlink(missing_ok=True)
    except OSError as error:
        raise OnbeatError(f"cannot remove the old {error.filename}: {error.strerror or error}; remove it") from None


@contextlib.contextmanager
def _drawing() -> Generator[None]:
    """Our fonts; and a title in letters that they have not shows boxes, without a warning."""
    import matplotlib as mpl

    with mpl.rc_context(_RC), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph")
        yield


def _measures(rows: Sequence[Row], on_page: int) -> Measures:
    """The sizes of the parts of every row, for ``on_page`` of them on a page."""
    head, gap, leader, caption, apart = 0.38, 0.06, 0.14, 0.31, 0.1
    room = (A4[1] - TOP - FOOT) / on_page - head - gap - leader - caption - apart
    graph = min(0.27 * room, 0.9) if on_page < ROWS else 0.21 * room
    most = max(2, min(MOST, max(len(row.chosen) for row in rows)))
    height = min(room - 2 * graph, 3.2)
    width = min(0.9 * height, (RIGHT - LEFT + 0.3) / most - 0.04)
    width, height = (round(value * DPI) / DPI for value in (width, min(height, 1.9 * width)))
    return Measures(LEFT, RIGHT, head, graph, gap, leader, (width, height), caption, (A4[1] - TOP - FOOT) / on_page)


def _content(found: Keyposes, downbeats: Times, poses: Poses | None, sizes: Measures) -> Content:
    size = round(sizes.picture[0] * DPI), round(sizes.picture[1] * DPI)
    return Content(
        found,
        downbeats,
        in_beats(found.energy.times, found.song_beats),
        _top(found),
        pose_pictures(poses, size) if poses else [],
        poses.yaws if poses and _turns(poses.yaws) else None,
    )


def _turns(yaws: Array) -> bool:
    return float(np.abs(np.angle(np.exp(1j * (yaws - yaws[0])))).max()) > TURNED


def _top(found: Keyposes) -> float:
    """The energy at which graphs end: the highest between the beats, but for a leap that would flatten all else."""
    times = found.energy.times
    part = (times >= found.song_beats[0]) & (times <= found.song_beats[-1])
    curves = [curve for curve in (found.energy.world, found.energy.local) if len(curve)]
    both = np.concatenate([curve[part] for curve in curves])
    return max(1.2, min(1.03 * float(both.max()), 2.0 * float(np.percentile(both, 98)))) if len(both) else 1.2


def _page(
    rows: Sequence[Row], number: tuple[int, int], title: str, cycle: int | None, sizes: Measures, content: Content
) -> Any:
    from matplotlib.figure import Figure

    with _drawing():
        figure = Figure(figsize=A4, dpi=DPI, facecolor="white")
        page = figure.add_axes((0, 0, 1, 1))
        page.axis("off")
        _heading(page, number, title, cycle, content)
        for k, row in enumerate(rows):
            draw_row(page, row, A4[1] - TOP - k * sizes.whole, sizes, content)
        page.set(xlim=(0, A4[0]), ylim=(0, A4[1]), autoscale_on=False)
    return figure


def _heading(page: Any, number: tuple[int, int], title: str, cycle: int | None, content: Content) -> None:
    found, y = content.found, A4[1] - 0.42
    told = f"{len(found)} keyposes on {len(found.song_beats)} beats · {_tempo(found):.0f} beats a minute"
    told += f" · cycles of {cycle} beats" if cycle else ""
    told += f" · page {number[0]} of {number[1]}" if number[1] > 1 else ""
    page.text(RIGHT, y, told, size=8, color=SOFT, va="center", ha="right")
    room = RIGHT - LEFT - _width(told, 8)
    words = _shortened(f"Keyposes of {title}" if title else "Keyposes", room, 14, "bold")
    page.text(LEFT - 0.3, y, words, size=14, weight="bold", color=INK, va="center")
    _legend(page, y - 0.3, content)


def _width(words: str, size: float, weight: str = "normal") -> float:
    """Inches of a line of text."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    return float(TextPath((0, 0), words, prop=FontProperties(size=size, weight=weight)).get_extents().x1) / 72


def _shortened(words: str, room: float, size: float, weight: str) -> str:
    """As much of a text as has room, with an ellipsis where some is left out."""
    words = " ".join(words.split())[:200]
    if _width(words, size, weight) <= room:
        return words
    fits = bisect.bisect(range(len(words)), room, key=lambda n: _width(words[:n] + "…", size, weight)) - 1
    return words[: max(fits, 0)].rstrip() + "…"


def _legend(page: Any, y: float, content: Content) -> None:
    x = LEFT - 0.22
    for source in sorted({*content.found.candidates, *content.found.sources}):
        look = look_of(source)
        page.plot(x, y, look.marker, color=look.colour, ms=6, mec="white", mew=0.6)
        page.plot(x + 0.14, y, look.marker, mfc="white", mec=look.colour, ms=4.2)
        words = f"{source}: rest {look.words}"
        page.text(x + 0.25, y, words, size=7, color=INK, va="center")
        x += 0.5 + _width(words, 7)
    words = "filled: keypose, hollow: candidate · energy in units of its mean"
    words += " · strong lines: bars" if len(content.downbeats) else ""
    words += " · arrow: facing, from above" if content.yaws is not None else ""
    page.text(RIGHT, y, words, size=7, color=SOFT, va="center", ha="right")


def _tempo(found: Keyposes) -> float:
    return 60.0 / float(np.median(np.diff(found.song_beats)))
