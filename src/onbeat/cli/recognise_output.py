"""How the ``onbeat recognise`` commands print: tables that are not cut where no screen bounds them, and JSON."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import cyclopts
import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.recognise_input import Probe
from onbeat.errors import OnbeatError
from onbeat.recognition.recogniser import Match, Prediction, Recogniser

VERSION = 1
LISTED = 3  # matches that the table names
WIDE = 240  # characters of a line where no screen bounds it
Factor = Literal["task", "person"]
Paths = Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)]
Flag = Annotated[bool, cyclopts.Parameter(negative=())]
Folder = Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])]


def screen() -> Console:
    """Stdout; tables that go to a file are not cut to a screen's width."""
    found = Console()
    return found if found.is_terminal else Console(width=WIDE)


def print_table(heads: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[str] = ()) -> None:
    """Print a table, the columns named in ``right`` flush right."""
    table = Table(box=None, pad_edge=False)
    for head in heads:
        table.add_column(Text(head), justify="right" if head in right else "left")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    screen().print(table)


def print_json(document: dict[str, Any], indent: int = 1) -> None:
    """Print a document as JSON; with ``indent`` 0 as one line, at once."""
    data = msgspec.json.encode(document)
    sys.stdout.write((msgspec.json.format(data, indent=indent) if indent else data).decode() + "\n")
    sys.stdout.flush()


def made_folder(folder: Path) -> Path:
    """The folder, which is there now."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OnbeatError(f"cannot make the folder {folder}: {error.strerror}; give another one to -o") from None
    return folder


FACTORS: tuple[Factor, Factor] = ("task", "person")
_BY = {"task": "by somebody new", "person": "in a new step"}
FAR = 100.0  # times too far; beyond it is only far


def told(one: Prediction, factor: Factor) -> str:
    """The likeliest, with their chances; a guess as such; of what is new how much too far the nearest is."""
    matches, known = (one.task_scores, one.task_known) if factor == "task" else (one.person_scores, one.person_known)
    if not matches:
        return "–"
    if known:
        return _chances(matches)
    if one.perhaps == factor:
        guess = (one.task_across if factor == "task" else one.person_across)[0]
        return f"perhaps {guess.name} {guess.probability:.0%}, {_BY[factor]}"
    return f"new (nearest {matches[0].name}, {_times(one.margins[FACTORS.index(factor)])} too far)"


def _chances(matches: Sequence[Match]) -> str:
    return ", ".join(f"{match.name} {match.probability:.0%}" for match in matches[:LISTED])


def _times(margin: float) -> str:
    """How many times the distance is that of the threshold."""
    times = float(np.exp(min(-margin, 700.0)))
    return f"over {FAR:.0f} times" if times > FAR else f"{times:.0f} times" if times >= 10 else f"{times:.2f} times"


def tell_guesses(recogniser: Recogniser, predictions: Sequence[Prediction]) -> None:
    """What "perhaps" says and, where a model cannot say it, why; on stderr, where any of it was printed."""
    strangers = [one for one in predictions if not one.task_known and not one.person_known]
    if any(one.perhaps for one in strangers):
        print(GUESSED, file=sys.stderr)  # noqa: T201
    elif strangers and recogniser.task and not recogniser.across.task:
        print(CANNOT_GUESS, file=sys.stderr)  # noqa: T201


GUESSED = (
    '"perhaps": too far for a repetition by anybody known, near enough for a known step by somebody new, or somebody '
    "known in a new step; what is new in both can be as near"
)
CANNOT_GUESS = (
    '"new" may be a known step by somebody new: this model cannot tell those from new steps; train it again, on three '
    "steps or more, the same by several people"
)


def row_of(probe: Probe, one: Prediction) -> dict[str, Any]:
    """A probe and what it is taken for, as JSON tells it."""

    def listed(matches: Sequence[Match]) -> list[dict[str, Any]]:
        return [{"name": m.name, "probability": round(m.probability, 4)} for m in matches]

    def factor(matches: Sequence[Match], known: bool, margin: float, across: Sequence[Match]) -> dict[str, Any]:
        return {
            "known": known,
            "margin": round(margin, 4) if np.isfinite(margin) else None,
            "matches": listed(matches),
            "across": listed(across),
        }

    return {
        "file": probe.file,
        "from": round(probe.start, 6),
        "to": round(probe.end, 6),
        "task": factor(one.task_scores, one.task_known, one.margins[0], one.task_across),
        "person": factor(one.person_scores, one.person_known, one.margins[1], one.person_across),
        "perhaps": one.perhaps,
    }
