"""Building a library from motion files; what is in stock already is used again."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from onbeat.errors import LibraryError
from onbeat.moves.about import read_about, with_about
from onbeat.moves.disk.index import DamagedIndexError, remove_index
from onbeat.moves.disk.lock import building
from onbeat.moves.engine import Engine
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.generations import Entry, Options
from onbeat.moves.making.steps import Making, Step, silent
from onbeat.moves.making.stock import Stock
from onbeat.moves.methods import method_digest
from onbeat.moves.recordings import Recording, find_recordings
from onbeat.moves.similarity import Method
from onbeat.moves.store import Stored, library_of, open_library, read_stored

THREADS = Engine()


def build_library(
    paths: Sequence[str | os.PathLike[str]],
    folder: str | os.PathLike[str],
    *,
    mirror: bool = True,
    fps: float | None = None,
    about: Path | None = None,
    search: Method | None = None,
    step: Step | None = None,
    workers: int = 2,
    engine: Engine | None = None,
) -> MoveLibrary:
    """Build the library of motion files in ``folder``; what it already holds of unchanged files is used again.

    All clips are put on the skeleton that most of the motion is on. Files that are broken, too short or no body are
    told in ``MoveLibrary.problems``.

    Parameters
    ----------
    paths : motion files and folders of them.
    folder : where to keep it.
    mirror : follow each clip by its mirror image.
    fps : the rate of files that store none.
    about : a table that tells performers, genres and licences (see ``about.read_about``).
    search : how pairs are found, "exact", "coarse" or "approximate"; by default as suits the size.
    step : called with what is done now and the share of all done, 0…1.
    workers : threads, where no engine is told.
    engine : where the work is done; the result does not depend on it. A cluster finds pairs; files are read here.

    Raises
    ------
    LibraryError
        If no file is good, another builder is at work in the folder, or it cannot be written.
    """
    recordings = find_recordings([Path(path) for path in paths], fps)
    if about is not None:
        recordings = with_about(recordings, read_about(about))
    options = Options(mirror, fps, search)
    return build_recordings(recordings, Path(folder), options, step=step, engine=engine or Engine(workers=workers))


def build_recordings(
    recordings: Sequence[Recording],
    folder: Path,
    options: Options,
    *,
    step: Step | None = None,
    engine: Engine = THREADS,
) -> MoveLibrary:
    """As :func:`build_library`, of recordings that were found already."""
    if is_current(folder, recordings, options):
        return open_library(folder)  # in a folder that only others may write, too
    with building(folder):
        if not is_current(folder, recordings, options):
            stock = opened_stock(folder)
            try:
                Making(stock, recordings, options, engine, _readers(engine), step or silent).make()
            except LibraryError:
                _leave_nothing(stock)
                raise
            finally:
                stock.close()
    return open_library(folder)


def assemble(recordings: Sequence[Recording], options: Options, *, step: Step | None = None) -> MoveLibrary:
    """The library of some recordings, in memory only."""
    stock = Stock(None)
    graph = Making(stock, recordings, options, THREADS, THREADS, step or silent).make()
    stored = Stored.of(stock.index)
    assert stored is not None  # it was just made
    assert graph is not None
    return library_of(stored, stock.clips, graph)


def _leave_nothing(stock: Stock) -> None:
    """Take the index away again where no file could be used: then there is no library."""
    if stock.folder is not None and not stock.rows("SELECT 1 FROM clips UNION SELECT 1 FROM generations"):
        stock.close()
        remove_index(stock.folder)


def _readers(engine: Engine) -> Engine:
    """Where files are read: here, for the machines of a cluster may not see them."""
    return Engine.of(os.cpu_count() or 1) if engine.kind == "cluster" else engine


def opened_stock(folder: Path) -> Stock:
    """The stock of a folder; emptied if its index cannot be used."""
    try:
        return Stock(folder)
    except DamagedIndexError:
        remove_index(folder)
        return Stock(folder)


def is_current(folder: Path, recordings: Sequence[Recording], options: Options) -> bool:
    """Whether the library of a folder is what a build of these recordings would give."""
    try:
        found = read_stored(folder).generation
    except LibraryError:
        return False
    if (found.method, found.options) != (method_digest(), options):
        return False
    told = [Entry(r.file, r.name, r.content, *r.about) for r in recordings]
    return told == [entry._replace(problem=None) for entry in found.entries] and _opens(folder)


def _opens(folder: Path) -> bool:
    try:
        open_library(folder)
    except LibraryError:
        return False
    return True
