"""``onbeat moves``: build and show motion libraries."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import cyclopts
import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table

from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.errors import LibraryError
from onbeat.moves.build import build_library
from onbeat.moves.joins import joins_table
from onbeat.moves.library import MoveLibrary
from onbeat.moves.store import open_library

moves_app = cyclopts.App(name="moves", help="Build and show motion libraries: clips and the joins between them.")
VERSION = 1


@moves_app.command(name="build")
def build_command(
    paths: Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)],
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    mirror: bool = True,
    fps: float | None = None,
    workers: int = 2,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Build a motion library from motion files; built again, only what changed is read.

    Example: ``onbeat moves build my_clips -o my_library``

    Parameters
    ----------
    paths
        Motion files (.bvh, .amc, .npz) and folders of them.
    output
        The library's folder.
    mirror
        Follow each clip by its mirror image.
    fps
        Frames per second of files that store none (AMC).
    workers
        Threads.
    json
        Print the library as JSON on stdout instead of a table.
    """
    if fps is not None and not 0.1 <= fps <= 10000:
        raise LibraryError(f"{fps:g} frames a second cannot be; give a rate from 0.1 to 10000")
    with warnings_as_lines(), Stages() as stages:
        library = build_library(
            paths,
            output,
            mirror=mirror,
            fps=fps,
            step=lambda what, share: stages("moves", share, what),
            workers=workers,
        )
    tell_problems(library)
    _print(library, output, as_json=json)
    print(f"next: onbeat dance SONG --moves {output}", file=sys.stderr)  # noqa: T201


@moves_app.command(name="show")
def show_command(library: Path, *, json: Annotated[bool, cyclopts.Parameter(negative=())] = False) -> None:
    """Show what is in a motion library.

    Example: ``onbeat moves show my_library``

    Parameters
    ----------
    library
        A folder that ``onbeat moves build`` wrote.
    json
        Print it as JSON on stdout instead of a table.
    """
    found = open_library(library)
    tell_problems(found)
    _print(found, library, as_json=json)


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
            "seconds": round(clip.motion.duration, 3),
            "fps": clip.motion.fps,
            "performer": None,
            "stops": len(clip.stops),
            "keyposes": len(clip.keyposes),
            "joins": int(leaving[n]),
            "core": round(float(core[n]), 4),
        }
        for n, clip in enumerate(library.clips)
    ]


def _document(library: MoveLibrary, folder: Path) -> dict[str, Any]:
    error = joins_table(library).link_error
    return {
        "version": VERSION,
        "library": folder.name,
        "seconds": round(library.seconds, 3),
        "joins": library.graph.join_count,
        "joins_link_error": round(float(error.mean()), 3) if len(error) else None,
        "core": round(float(library.graph.core.mean()), 4),
        "body": list(library.clips[0].motion.skeleton.names),
        "clips": _clip_rows(library),
        "problems": list(library.problems),
        "notes": list(library.notes),
    }


def _print(library: MoveLibrary, folder: Path, *, as_json: bool) -> None:
    document = _document(library, folder)
    if as_json:
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n")
        return
    table = Table(
        "clip", "seconds", "fps", "performer", "stops", "keyposes", "joins", "in the core", box=None, pad_edge=False
    )
    for column in table.columns[1:]:
        column.justify = "right"
    for row in document["clips"]:
        counts = [str(row[name]) for name in ("stops", "keyposes", "joins")]
        core = f"{row['core']:.0%}"
        table.add_row(row["name"], f"{row['seconds']:.1f}", f"{row['fps']:g}", "unknown", *counts, core)
    screen = Console()
    screen.print(table, markup=False, emoji=False)
    error = document["joins_link_error"]
    fit = "" if error is None else f" of {error:.1f}° link error on average"
    clips = "1 clip" if len(library.clips) == 1 else f"{len(library.clips)} clips"
    screen.print(
        f"{clips}, {library.seconds:.0f} s of recordings; {document['joins']} joins{fit}; "
        f"{document['core']:.0%} of the frames in the core",
        highlight=False,
        soft_wrap=True,
    )
