"""``onbeat reproduce``: the papers' experiments again, every table and figure of theirs beside ours."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import cyclopts
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.errors import OnbeatError
from onbeat.reproduce.data import Data
from onbeat.reproduce.document import results_document
from onbeat.reproduce.paper import chosen
from onbeat.reproduce.place import place_for
from onbeat.reproduce.result import PaperResult, tally
from onbeat.reproduce.run import COSTS, names_for, reproduce, write_results

reproduce_app = cyclopts.App(name="reproduce", help="Do the papers' experiments again, beside what they print.")
reproduce_app.command(
    "onbeat.cli.reproduce_study:study_command",
    name="study",
    help="Ask people which motion looks more like the original, and test what they chose (2009, Table 2).\n\n"
    "Example: ``onbeat reproduce study my_study``, then ``onbeat reproduce study my_study --table``",
)

Flag = Annotated[bool, cyclopts.Parameter(negative="")]
Files = Annotated[list[Path] | None, cyclopts.Parameter(consume_multiple=True, negative=(), json_list=False)]
WIDE = 160
"""Characters of a line where no screen bounds it."""
WORKERS = 2
"""Papers that are done at the same time."""


@reproduce_app.default
def reproduce_command(
    papers: Annotated[list[str] | None, cyclopts.Parameter(negative=(), json_list=False)] = None,
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("reproduced"),
    motions: Files = None,
    songs: Files = None,
    fps: SourceRate = None,
    quick: Flag = False,
    seed: int = 0,
    json: Flag = False,
) -> None:
    """Do the papers' experiments again: every table and figure of theirs beside ours.

    Example: ``onbeat reproduce P1 -o reproduced``

    Parameters
    ----------
    papers
        P1 (dancing to music, 2006), P2 (the same dance to faster music, 2007), P3 (keyposes, 2009); all without any.
    output
        A folder for a page a paper, the drawings, ``index.html`` and ``results.json``.
    motions
        Motion files and folders of them instead of the embedded troupe, for one paper. P1: clips of dances. P2: takes
        of one dance at several speeds, each with its beats, ``NAME.beats`` (a second a line) beside ``NAME.bvh``. P3:
        takes of dances with their beats and, where known, their keyposes, ``NAME.keyposes.csv``; without either it
        cannot be told what the paper says of keyposes. Names like ``task_person_1.bvh`` say who dances what.
    songs
        Audio files instead of the embedded songs, for P1; beats in ``NAME.beats`` beside ``NAME.mp3`` are taken as
        true.
    fps
        Frames a second of motion files that store none (AMC, a robot's CSV).
    quick
        A first look: fewer repetitions, shorter songs, rougher figures.
    seed
        Of the embedded troupe and songs, and of chance; the same seed gives the same bytes.
    json
        Print ``results.json`` on stdout instead of a table.
    """
    if not 0 <= seed < 2**63:
        raise OnbeatError(f"--seed {seed}: give a whole number from 0 to 2^63 - 1")
    keys, data = chosen(papers or ()), Data(tuple(motions or ()), tuple(songs or ()), quick, seed, fps)
    with warnings_as_lines(), place_for(output, names_for(keys)), Stages() as stages:
        say = _together(stages, keys) if sys.stderr.isatty() else _in_lines()
        results = reproduce(keys, data, say, workers=WORKERS)
        write_results(output, results, quick=quick, seed=seed)
    if json:
        sys.stdout.write(results_document(results, quick=quick, seed=seed).to_json().decode())
        return
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=WIDE)
    for result in results:
        screen.print(_table(result))
    screen.print(Text(f"Look at it: open {output / 'index.html'}"), soft_wrap=True)


def _together(stages: Stages, keys: list[str]) -> Callable[[str, float, str], None]:
    """One line of progress for papers that are done at the same time."""
    shares, whole = dict.fromkeys(keys, 0.0), sum(COSTS[key] for key in keys)

    def say(key: str, share: float, what: str) -> None:
        shares[key] = share
        done = sum(COSTS[one] * share for one, share in shares.items()) / whole
        stages("papers", done, f"{key}: {what}" if what else key)

    return say


def _in_lines() -> Callable[[str, float, str], None]:
    """A line on stderr for each tenth of a paper that is begun, where it is no screen."""
    begun: dict[str, int] = {}

    def say(key: str, share: float, what: str) -> None:
        tenth = int(10 * share + 1e-9)
        if what and tenth > begun.get(key, -1):
            begun[key] = tenth
            print(f"onbeat: {key}, {10 * tenth} %: {what}", file=sys.stderr, flush=True)  # noqa: T201

    return say


def _table(result: PaperResult) -> Table:
    """What the paper says, and whether it holds here."""
    table = Table(title=Text(f"{result.key} {result.title}: {tally(result.claims)}"), title_justify="left")
    table.add_column("holds")
    table.add_column("what the paper says")
    table.add_column("what comes out")
    words = {True: "yes", False: "no", None: "?"}
    for claim in result.claims:
        table.add_row(words[claim.holds], Text(claim.said), Text(claim.told))
    return table
