"""``onbeat moves``: build, show, check and change motion libraries."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

import cyclopts

from onbeat.cli.fetching import moves_path
from onbeat.cli.moves_show import print_library, tell_problems
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.errors import LibraryError

moves_app = cyclopts.App(name="moves", help="Build, show, check and change motion libraries: clips and their joins.")
# Named by path, so that they are imported when they are called; their help stands here, so that a list needs none.
_LATER = {
    "verify": (
        "onbeat.cli.moves_manage:verify_command",
        "Check a motion library: every checksum and every reference.\n\n"
        "Exits with 1 and a line on stdout for each thing that is wrong.\n\n"
        "Example: ``onbeat moves verify my_library``",
    ),
    "remove": (
        "onbeat.cli.moves_manage:remove_command",
        "Take recordings, with their mirror images, out of a motion library.\n\n"
        'Example: ``onbeat moves remove my_library walk_01 "jump*"``',
    ),
    "merge": (
        "onbeat.cli.moves_manage:merge_command",
        "Make one motion library of several on the same body; no motion file is read again.\n\n"
        "Example: ``onbeat moves merge monday tuesday -o week``",
    ),
    "fetch": (
        "onbeat.cli.moves_fetch:fetch_command",
        "Fetch motion capture that others have made free, or list what is known.\n\n"
        "Its licence is shown first and kept with it. A download that was stopped goes on when it is run again. Where "
        "it was put is printed on stdout; ``onbeat dance`` takes its name for ``--moves``.\n\n"
        "Example: ``onbeat moves fetch cmu-dance``",
    ),
}
for _name, (_path, _help) in _LATER.items():
    moves_app.command(_path, name=_name, help=_help)
Flag = cyclopts.Parameter(negative=())


@moves_app.command(name="build")
def build_command(
    paths: Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)],
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    mirror: bool = True,
    fps: SourceRate = None,
    about: Path | None = None,
    search: Literal["exact", "coarse", "approximate"] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    json: Annotated[bool, Flag] = False,
) -> None:
    """Build a motion library from motion files; built again, only what changed is read.

    It may be stopped at any moment, and goes on where it was when it is run again.

    Example: ``onbeat moves build my_clips -o my_library``

    Parameters
    ----------
    paths
        Motion files (.bvh, .amc, .c3d, .trc, .csv, .npz, .pkl), folders of them, and names of sets that ``onbeat moves
        fetch`` fetched.
    output
        The library's folder.
    mirror
        Follow each clip by its mirror image.
    fps
        Frames per second of files that store none (AMC, a robot's CSV); all files are read at it.
    about
        A table (CSV) with the columns file, performer, genre, licence; file may be a pattern such as S01/*.
    search
        How joins are found: exact looks at all pairs of frames, coarse at every fourth frame first, approximate at
        those that an index finds near. By default as suits the size.
    workers
        Processes on this machine; without it two threads, which is best for small libraries.
    scheduler
        Address of a Dask scheduler (tcp://host:8786) whose workers find the joins.
    json
        Print the library as JSON on stdout instead of a table.
    """
    from onbeat.moves.build import build_library
    from onbeat.moves.engine import Engine

    if fps is not None and not 0.1 <= fps <= 10000:
        raise LibraryError(f"{fps:g} frames a second cannot be; give a rate from 0.1 to 10000")
    engine = Engine.of(scheduler if scheduler is not None else workers)
    paths = [moves_path(path) for path in paths]
    with warnings_as_lines(), Stages() as stages:
        library = build_library(
            paths,
            output,
            mirror=mirror,
            fps=fps,
            about=about,
            search=search,
            step=lambda what, share: stages("moves", share, what),
            engine=engine,
        )
    tell_problems(library)
    print_library(library, output, as_json=json)
    print(f"next: onbeat dance SONG --moves {output}", file=sys.stderr)  # noqa: T201


@moves_app.command(name="show")
def show_command(
    library: Path, *, problems: Annotated[bool, Flag] = False, json: Annotated[bool, Flag] = False
) -> None:
    """Show what is in a motion library.

    Example: ``onbeat moves show my_library``

    Parameters
    ----------
    library
        A folder that ``onbeat moves build`` wrote.
    problems
        Only the files that are left out, a line each on stdout.
    json
        Print it as JSON on stdout instead of a table.
    """
    from onbeat.moves.store import open_library

    found = open_library(library)
    if problems and not json:
        sys.stdout.write("".join(f"{line}\n" for line in found.problems))
        return
    tell_problems(found)
    print_library(found, library, as_json=json)
