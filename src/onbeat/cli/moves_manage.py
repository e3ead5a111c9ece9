"""``onbeat moves verify``, ``remove`` and ``merge``: libraries as wholes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts

from onbeat.cli.moves_show import print_summary
from onbeat.cli.progress import Stages
from onbeat.moves.engine import Engine
from onbeat.moves.manage import merge_libraries, remove_recordings
from onbeat.moves.verify import verify_library

Names = Annotated[list[str], cyclopts.Parameter(negative=(), json_list=False)]
Folders = Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)]


def verify_command(library: Path) -> None:
    """Check a motion library: every checksum and every reference.

    Exits with 1 and a line on stdout for each thing that is wrong.

    Example: ``onbeat moves verify my_library``

    Parameters
    ----------
    library
        A folder that ``onbeat moves build`` wrote.
    """
    with Stages() as stages:
        wrong = verify_library(library, lambda what, share: stages("verify", share, what))
    sys.stdout.write("".join(f"{line}\n" for line in wrong) or f"{library}: all is as it was built\n")
    if wrong:
        sys.exit(1)


def remove_command(library: Path, names: Names, /) -> None:
    """Take recordings, with their mirror images, out of a motion library.

    Example: ``onbeat moves remove my_library walk_01 "jump*"``

    Parameters
    ----------
    library
        A folder that ``onbeat moves build`` wrote.
    names
        Names of recordings as ``onbeat moves show`` tells them, or patterns.
    """
    with Stages() as stages:
        found = remove_recordings(library, names, step=lambda what, share: stages("remove", share, what))
    print_summary(found)


def merge_command(
    libraries: Folders,
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    workers: int | None = None,
    scheduler: str | None = None,
) -> None:
    """Make one motion library of several on the same body; no motion file is read again.

    Example: ``onbeat moves merge monday tuesday -o week``

    Parameters
    ----------
    libraries
        Folders that ``onbeat moves build`` wrote.
    output
        The new library's folder.
    workers
        Processes on this machine; without it two threads.
    scheduler
        Address of a Dask scheduler (tcp://host:8786) whose workers find the joins.
    """
    engine = Engine.of(scheduler if scheduler is not None else workers)
    with Stages() as stages:
        found = merge_libraries(libraries, output, engine=engine, step=lambda what, share: stages("merge", share, what))
    print_summary(found)
