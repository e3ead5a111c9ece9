"""A motion library in words: a table, a line, or JSON."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table

from onbeat.moves.joins import mean_link_error
from onbeat.moves.library import MoveLibrary

VERSION = 1


def tell_problems(library: MoveLibrary) -> None:
    """What is not in a library and what was assumed, a line each on stderr."""
    for line in library.notes:
        print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201
    for line in library.problems:
        print(f"onbeat: left out {line}", file=sys.stderr)  # noqa: T201


def _clip_rows(library: MoveLibrary) -> list[dict[str, Any]]:
    """One row a clip, its joins out and the share of it that lies in the core."""
    graph = library.graph
    leaving = np.bincount(graph.clip_of[graph.sources], minlength=len(library.clips))
    core = np.bincount(graph.clip_of, graph.core, len(library.clips)) / np.diff(library.starts)
    return [
        {
            "name": clip.name,
            "source": clip.source,
            "mirrored": clip.mirrored,
            "seconds": round(clip.seconds, 3),
            "fps": clip.fps,
            "performer": clip.about.performer,
            "genre": clip.about.genre,
            "licence": clip.about.licence,
            "stops": len(clip.stops),
            "keyposes": len(clip.keyposes),
            "joins": int(leaving[n]),
            "core": round(float(core[n]), 4),
        }
        for n, clip in enumerate(library.clips)
    ]


def _head(library: MoveLibrary) -> dict[str, Any]:
    error = mean_link_error(library)
    return {
        "seconds": round(library.seconds, 3),
        "joins": library.graph.join_count,
        "joins_link_error": None if error is None else round(error, 3),
        "core": round(float(library.graph.core.mean()), 4),
    }


def print_library(library: MoveLibrary, folder: Path, *, as_json: bool) -> None:
    """All that is in a library, on stdout."""
    head, rows = _head(library), _clip_rows(library)
    if not as_json:
        _print_table(rows)
        _print_line(library, head)
        return
    document = {
        "version": VERSION,
        "library": folder.name,
        **head,
        "body": list(library.clips[0].motion.skeleton.names),
        "clips": rows,
        "problems": list(library.problems),
        "notes": list(library.notes),
    }
    sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n")


def print_summary(library: MoveLibrary) -> None:
    """A library in one line, on stdout."""
    _print_line(library, _head(library))


def _print_table(rows: list[dict[str, Any]]) -> None:
    table = Table(
        "clip", "seconds", "fps", "performer", "stops", "keyposes", "joins", "in the core", box=None, pad_edge=False
    )
    for column in table.columns[1:]:
        column.justify = "right"
    for row in rows:
        counts = [str(row[name]) for name in ("stops", "keyposes", "joins")]
        place = (f"{row['seconds']:.1f}", f"{row['fps']:g}", row["performer"] or "unknown")
        table.add_row(row["name"], *place, *counts, f"{row['core']:.0%}")
    Console().print(table, markup=False, emoji=False)


def _print_line(library: MoveLibrary, head: dict[str, Any]) -> None:
    error = head["joins_link_error"]
    fit = "" if error is None else f" of {error:.1f}° link error on average"
    clips = "1 clip" if len(library.clips) == 1 else f"{len(library.clips)} clips"
    Console().print(
        f"{clips}, {library.seconds:.0f} s of recordings; {head['joins']} joins{fit}; "
        f"{head['core']:.0%} of the frames in the core",
        highlight=False,
        soft_wrap=True,
    )
