"""How the ``onbeat recognise`` commands print: tables that are not cut where no screen bounds them, and JSON."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import cyclopts
import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.recognise_input import Probe
from onbeat.errors import OnbeatError
from onbeat.recognition.recogniser import Match, Prediction

VERSION = 1
LISTED = 3  # matches that the table names
WIDE = 240  # characters of a line where no screen bounds it
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


def told(matches: Sequence[Match], known: bool) -> str:
    """The likeliest, with their chances; "new" first where none is near enough."""
    if not matches:
        return "–"
    names = ", ".join(f"{match.name} {match.probability:.0%}" for match in matches[:LISTED])
    return names if known else f"new (nearest {names})"


def row_of(probe: Probe, one: Prediction) -> dict[str, Any]:
    """A probe and what it is taken for, as JSON tells it."""

    def factor(matches: Sequence[Match], known: bool, margin: float) -> dict[str, Any]:
        return {
            "known": known,
            "margin": round(margin, 4) if np.isfinite(margin) else None,
            "matches": [{"name": m.name, "probability": round(m.probability, 4)} for m in matches],
        }

    return {
        "file": probe.file,
        "from": round(probe.start, 6),
        "to": round(probe.end, 6),
        "task": factor(one.task_scores, one.task_known, one.margins[0]),
        "person": factor(one.person_scores, one.person_known, one.margins[1]),
    }
