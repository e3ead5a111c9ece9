"""``onbeat reproduce study``: the user study of 2009 with people: a page, a server that gathers answers, a test."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts
import msgspec
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.errors import OnbeatError
from onbeat.files import make_folder, write_atomically
from onbeat.reproduce.data import Data
from onbeat.reproduce.result import TableResult
from onbeat.reproduce.study.answers import read_answers
from onbeat.reproduce.study.plans import ANSWERS, PAGE, SEQUENCES, study_page
from onbeat.reproduce.study.table import outcome_of, study_table

Flag = Annotated[bool, cyclopts.Parameter(negative="")]


def study_command(
    paths: Annotated[list[Path] | None, cyclopts.Parameter(negative=(), json_list=False)] = None,
    /,
    *,
    table: Flag = False,
    page_only: Flag = False,
    motions: Annotated[
        list[Path] | None, cyclopts.Parameter(consume_multiple=True, negative=(), json_list=False)
    ] = None,
    fps: SourceRate = None,
    sequences: int = SEQUENCES,
    seed: int = 0,
    host: str = "127.0.0.1",
    port: int = 8652,
    json: Flag = False,
) -> None:
    """Ask people which motion looks more like the original, and test what they chose (2009, Table 2).

    Example: ``onbeat reproduce study my_study``, then ``onbeat reproduce study my_study --table``

    Parameters
    ----------
    paths
        A folder: the page ``study.html`` is made there if it is not, and served; each person's answers become a file in
        its folder ``answers``. Or files of answers that the page saved: prints what they come to.
    table
        Print what the answers in the folder come to; nothing is served.
    page_only
        Make the page and stop; it can be opened as a file, and answers saved from it.
    motions
        Motion files of one dance, one of each person, instead of the embedded troupe.
    fps
        Frames a second of motion files that store none (AMC, a robot's CSV).
    sequences
        Dances that each person is asked about.
    seed
        Draws which dances, their order for each person, and which is A: both are balanced over the people.
    host, port
        Where to serve. Others than this machine need the address that is printed, with its token.
    json
        Print what the answers come to as JSON.
    """
    given = paths or []
    files = [path for path in given if path.suffix.lower() == ".json"]
    if files and len(files) < len(given):
        raise OnbeatError("give a folder, or files of answers, not both")
    if not files and len(given) != 1:
        raise OnbeatError(f"{len(given)} folders; give one for the study, or files of answers")
    if files or table:
        _print(files or _answers_in(given[0]), json)
        return
    _make(given[0], Data(tuple(motions or ()), seed=seed, fps=fps), sequences)
    if page_only:
        print(given[0] / PAGE)  # noqa: T201
        return
    _serve(given[0], host, port, json)


def _answers_in(folder: Path) -> list[Path]:
    found = sorted(path for place in (folder, folder / ANSWERS) for path in place.glob("*.json"))
    if not found:
        raise OnbeatError(
            f"no answers in {folder}; serve the study there first, or put what was saved from its page there"
        )
    return found


def _make(folder: Path, data: Data, sequences: int) -> None:
    """The page; one that is there is kept, for answers belong to it."""
    page = make_folder(folder) / PAGE
    if page.exists():
        return
    from onbeat.reproduce.p3.people import people_of

    if not 0 <= data.seed < 2**63:
        raise OnbeatError(f"--seed {data.seed}: give a whole number from 0 to 2^63 - 1")
    with warnings_as_lines(), Console(stderr=True).status("making the motions"):
        made = study_page(people_of(data).spaces(), data.seed, sequences)
    write_atomically(page, made)


def _serve(folder: Path, host: str, port: int, json: bool) -> None:
    from onbeat.reproduce.study.server import serve_study

    def said(address: str) -> None:
        print(f"Open {address} (Ctrl-C ends it)", file=sys.stderr, flush=True)  # noqa: T201

    serve_study(folder, host, port, said)
    if any((folder / ANSWERS).glob("*.json")):
        _print(_answers_in(folder), json)


def _print(paths: list[Path], json: bool) -> None:
    document = read_answers(paths)
    if json:
        found = outcome_of(document)
        told = {
            "version": 1,
            "people": len(document.people),
            "dims": document.dims,
            "total": found.total._asdict(),
            "total_by_people": found.spread,
            "sequences": {name: one._asdict() for name, one in found.sequences.items()},
            "people_for_keyposes": found.people._asdict() if found.people else None,
            "a_chosen": found.left._asdict(),
        }
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(told), indent=1).decode() + "\n")
        return
    made = study_table(document)
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=160)
    screen.print(_table(made))
    screen.print(Text(made.remark))


def _table(made: TableResult) -> Table:
    table = Table(title=f"{made.number}: {made.title}", title_justify="left")
    for column in made.columns:
        table.add_column(Text(column))
    for row in made.rows:
        table.add_row(*(Text(cell) for cell in row.cells))
    return table
