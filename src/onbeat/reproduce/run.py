"""Papers done again, and what comes out written into a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from threadpoolctl import threadpool_limits

from onbeat.errors import OnbeatError
from onbeat.files import make_folder, write_atomically
from onbeat.reproduce.data import Data
from onbeat.reproduce.document import drawing_name, results_document
from onbeat.reproduce.page import index_page, page_name, paper_page
from onbeat.reproduce.paper import chosen, paper
from onbeat.reproduce.result import FigureResult, PaperResult
from onbeat.reproduce.side_by_side import side_by_side

Step = Callable[[str, float, str], None]
"""Told the paper's key, the share of it that is done, and what of it is done now."""
RESULTS, INDEX = "results.json", "index.html"
"""What is written beside the pages of the papers."""
COSTS = {"P1": 3.5, "P2": 1.5, "P3": 1.0}
"""Minutes that a paper takes, about; the longest is begun first."""


def reproduce(
    keys: Sequence[str] = (), data: Data | None = None, step: Step | None = None, *, workers: int = 1
) -> list[PaperResult]:
    """Do the experiments of papers again.

    Parameters
    ----------
    keys : of :data:`onbeat.reproduce.paper.PAPERS`; all of them where none is named.
    data : what to do them on; by default the embedded troupe and songs.
    step : told what is done now.
    workers : papers done at the same time, each in a process of its own; the results are the same.

    Raises
    ------
    OnbeatError
        If there is no such paper, or the data do not suit it. Files of one's own go with one paper: each asks for
        others.
    """
    asked, data, say = chosen(keys), data or Data(), step or _silent
    if len(asked) > 1 and (data.motions or data.songs):
        raise OnbeatError(
            f"motions and songs of your own go with one paper, not with {', '.join(asked)}: each asks for other takes; "
            "name one"
        )
    jobs = {key: partial(reproduce_one, key, data) for key in sorted(asked, key=COSTS.__getitem__, reverse=True)}
    if workers > 1 and len(asked) > 1:
        results = side_by_side(jobs, say, workers)
    else:
        results = {key: jobs[key](partial(say, key)) for key in asked}
    return [results[key] for key in asked]


def reproduce_one(key: str, data: Data, step: Callable[[float, str], None]) -> PaperResult:
    """Do the experiments of one paper again."""
    step(0.0, "")
    with threadpool_limits(1, "blas"):  # products of matrices on more threads differ in their last bits
        return paper(key).reproduce(data, step)


def names_for(keys: Sequence[str]) -> list[str]:
    """The files at the top of a folder of results of some papers.

    >>> names_for(["P1"])
    ['p1.html', 'results.json', 'index.html']
    """
    return [*map(page_name, keys), RESULTS, INDEX]


def write_results(
    folder: str | Path, results: Sequence[PaperResult], *, quick: bool = False, seed: int = 0
) -> list[Path]:
    """Write a page for each paper, the drawings, ``index.html`` and ``results.json``; what was written, in order."""
    place = make_folder(folder)
    keys = [result.key for result in results]
    files: list[tuple[str, bytes]] = []
    for result in results:
        drawn = [part for part in result.parts if isinstance(part, FigureResult)]
        files += [(drawing_name(result.key, figure), figure.svg) for figure in drawn]
        files += [(page_name(result.key), paper_page(result, keys)), *result.files]
    files.append((RESULTS, results_document(results, quick=quick, seed=seed).to_json()))
    files.append((INDEX, index_page(results)))
    for name, content in files:
        if (place / name).parent != place:
            make_folder((place / name).parent)
        write_atomically(place / name, content)
    return [place / name for name, _ in files]


def _silent(key: str, share: float, what: str) -> None:
    """Nobody watches."""
