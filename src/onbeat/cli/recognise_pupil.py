"""``onbeat recognise pupil``: how far a pupil is from a master, by parts of the body."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from onbeat._shapes import Array
from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, Probe, Read, read_probes
from onbeat.cli.recognise_output import VERSION, Flag, Folder, made_folder, print_json, print_table
from onbeat.errors import MetricError
from onbeat.recognition.ghost import Beside, beside
from onbeat.recognition.pupil import BAND, Comparison, compare, lateness_by_element, pairing

PACE = 20.0
"""Moments a second at which segments are compared."""
FEWEST, MOST = 32, 400
"""Moments of a segment; more of them would take the square of the time."""


COARSE = 0.1
"""Seconds from moment to moment above which lateness is told too roughly."""


NOTICED = 0.03
"""Seconds of lateness under which nobody is late."""
UNLIKE = 2.0
"""Times as long as the master's from which a pupil's segment may be of another step."""


class CoarseWarning(UserWarning):
    """What is compared is so long that its moments are far apart, or may not be the same."""


class Found(NamedTuple):
    """A pupil beside a master: the comparison, how late each element is, and where each is at the other's moments."""

    comparison: Comparison
    late: Array
    pairs: Array


def pupil_command(
    master: Path,
    pupil: Path,
    /,
    *,
    span: int | None = None,
    flags: BeatFlags = NO_BEATS,
    output: Folder = None,
    band: float = BAND,
    json: Flag = False,
) -> None:
    """Measure how far a pupil is from a master, by parts of the body.

    Example: ``onbeat recognise pupil master.bvh pupil.bvh -o lesson``

    Parameters
    ----------
    master
        A motion file, or a label file (.csv: file,from,to).
    pupil
        The same of the pupil; stretches of label files are compared in order.
    span
        Cut both at their keyposes, so many keyposes a segment, and compare segment by segment.
    flags
        Where the beats of motion files come from that are cut.
    output
        A folder for the page ``pupil.html`` and the figure ``pupil.png``.
    band
        Share of a segment by which a moment may be early or late and still be compared.
    json
        Print all figures as JSON on stdout instead of a table.
    """
    cut = Cut(span, every=False).checked()
    with warnings_as_lines():
        theirs, mine = (read_probes([path], flags, cut) for path in (master, pupil))
        _check_counts(theirs, mine, master, pupil)
        found = _found(theirs, mine, band)
        rows = _rows(found)
        if output:
            _write(made_folder(output), found, theirs, mine, rows)
    if json:
        print_json(_document(found, theirs, mine, rows))
    else:
        shown = [(row["element"], f"{row['cm']:.1f}", f"{row['share']:.0%}", _late(row["late"])) for row in rows]
        print_table(("part", "cm", "of the worst", "late"), shown, ("cm", "of the worst", "late"))


def _check_counts(theirs: Read, mine: Read, master: Path, pupil: Path) -> None:
    counts = len(theirs.probes), len(mine.probes)
    if counts[0] != counts[1]:
        raise MetricError(
            f"{master} has {counts[0]} segment{'s' * (counts[0] != 1)}, {pupil} has {counts[1]}; they are compared in "
            "order: label the same steps in both (.csv: file,from,to), or take both whole (without --span)"
        )


def _found(theirs: Read, mine: Read, band: float) -> Found:
    longest = max(probe.end - probe.start for probe in (*theirs.probes, *mine.probes))
    moments = int(np.clip(round(PACE * longest), FEWEST, MOST))
    if longest / MOST > COARSE:
        warnings.warn(f"{longest:.0f} s in one segment are compared coarsely; cut them with --span", CoarseWarning, 2)
    for a, b in zip(theirs.probes, mine.probes, strict=True):
        ratio = (b.end - b.start) / max(a.end - a.start, 1e-9)
        if not 1 / UNLIKE <= ratio <= UNLIKE:
            warnings.warn(
                f"{Path(b.file).name} takes {b.end - b.start:.2f} s for what takes {a.end - a.start:.2f} s in "
                f"{Path(a.file).name}; are both the same step?", CoarseWarning, 2,
            )  # fmt: skip
    of = (mine.segments("ground", moments), theirs.segments("ground", moments))
    return Found(compare(*of, band), lateness_by_element(*of, band), pairing(*of, band))


def _rows(found: Found) -> list[dict[str, Any]]:
    """The elements, the farthest first."""
    cm = found.comparison.centimetres
    order = np.argsort(-cm, kind="stable").tolist()
    most = max(float(cm.max()), 1e-9)
    names = found.comparison.elements
    return [
        {
            "element": names[i].replace("_", " "),
            "cm": round(float(cm[i]), 2),
            "share": round(float(cm[i]) / most, 4),
            "late": round(float(found.late[i]), 3) if np.isfinite(found.late[i]) else None,
        }
        for i in order
    ]


def _late(seconds: float | None) -> str:
    return "–" if seconds is None else f"{seconds:+.2f} s"


def _words(seconds: float | None) -> str:
    if seconds is None or abs(seconds) < NOTICED:
        return ""
    return f", {abs(seconds):.2f} s {'late' if seconds > 0 else 'early'}"


def _document(found: Found, theirs: Read, mine: Read, rows: list[dict[str, Any]]) -> dict[str, Any]:
    """All figures, and of each segment where it is, how far off and how late on the whole."""

    def place(probe: Probe) -> dict[str, Any]:
        return {"file": probe.file, "from": round(probe.start, 6), "to": round(probe.end, 6)}

    errors, sizes = found.comparison.errors, found.comparison.sizes
    cm = 100.0 * sizes * np.sqrt(np.square(errors).mean(axis=(1, 2)))
    late = found.comparison.lateness.mean(axis=1)
    segments = [
        {"master": place(a), "pupil": place(b), "cm": round(c, 2), "late": round(s, 3)}
        for a, b, c, s in zip(theirs.probes, mine.probes, cm.tolist(), late.tolist(), strict=True)
    ]
    return {"version": VERSION, "elements": rows, "segments": segments}


def _write(folder: Path, found: Found, theirs: Read, mine: Read, rows: list[dict[str, Any]]) -> None:
    from onbeat.viewer.pages.pupil import write_pupil_page
    from onbeat.viewer.plots.pupil import write_pupil_figure

    seen, master = _beside(found, theirs, mine)
    title = f"{Path(mine.probes[0].file).stem} beside {master}"
    told = [(row["element"], f"{row['cm']:.1f} cm{_words(row['late'])}") for row in rows]
    write_pupil_page(folder / "pupil.html", seen, master=master, title=title, told=told)
    comparison = found.comparison
    write_pupil_figure(folder / "pupil.png", seen, comparison.elements, comparison.centimetres, title)


def _beside(found: Found, theirs: Read, mine: Read) -> tuple[Beside, str]:
    """Both bodies for the page: of the first file of each, and the segments that both have in them."""
    first = theirs.probes[0].file, mine.probes[0].file
    pairs = list(enumerate(zip(theirs.probes, mine.probes, strict=True)))
    kept = [(i, a, b) for i, (a, b) in pairs if (a.file, b.file) == first]
    kept.sort(key=lambda one: one[2].start)
    if len(kept) < len(pairs):
        print(f"drawn are the {len(kept)} of {len(pairs)} segments of {first[1]} and {first[0]}", file=sys.stderr)  # noqa: T201
    spans: list[Sequence[Probe]] = [[b for _, _, b in kept], [a for _, a, _ in kept]]
    own, other = ([(probe.start, probe.end) for probe in probes] for probes in spans)
    seen = beside(mine.motions[0], theirs.motions[0], own, other, found.pairs[[i for i, _, _ in kept]])
    return seen, Path(first[0]).stem
