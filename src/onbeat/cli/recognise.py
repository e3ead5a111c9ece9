"""``onbeat recognise``: which step is danced, and who dances it, or that it is something or somebody new."""

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

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Probe, read_segments
from onbeat.errors import OnbeatError
from onbeat.recognition.model_file import load_recogniser, save_recogniser
from onbeat.recognition.recogniser import Match, Prediction, Recogniser

recognise_app = cyclopts.App(name="recognise", help="Say which step is danced, and by whom, or that it is new.")
VERSION = 1
LISTED = 3  # matches that the table names
WIDE = 240  # characters of a line where no screen bounds it
Paths = Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)]
Flag = Annotated[bool, cyclopts.Parameter(negative=())]


@recognise_app.default
def predict_command(
    model: Path,
    probes: Paths,
    /,
    *,
    span: int | None = None,
    flags: BeatFlags = NO_BEATS,
    json: Flag = False,
) -> None:
    """Recognise motions, or labelled stretches of them.

    Example: ``onbeat recognise model.npz unknown.bvh``

    Parameters
    ----------
    model
        What ``onbeat recognise train`` wrote.
    probes
        Motion files, or label files (.csv: file,from,to).
    span
        Cut motion files at their keyposes: so many keyposes a segment. Without it each file is one segment.
    flags
        Where the beats of motion files come from that are cut.
    json
        Print all matches as JSON on stdout instead of a table.
    """
    if span is not None and span < 1:
        raise OnbeatError(f"--span {span}: give 1 or more keyposes")
    recogniser = load_recogniser(model)
    with warnings_as_lines():
        found, segments = read_segments(probes, flags, span)
        predictions = recogniser.predict(segments)
    if json:
        rows = [_row(probe, one) for probe, one in zip(found, predictions, strict=True)]
        _print_json({"version": VERSION, "segments": rows})
        return
    table = Table(box=None, pad_edge=False)
    for head in ("file", "from", "to", "task", "person"):
        table.add_column(head, justify="right" if head in ("from", "to") else "left")
    for probe, one in zip(found, predictions, strict=True):
        names = (_told(one.task_scores, one.task_known), _told(one.person_scores, one.person_known))
        cells = (Path(probe.file).name, f"{probe.start:.2f}", f"{probe.end:.2f}", *names)
        table.add_row(*(Text(cell) for cell in cells))
    _screen().print(table)


def _screen() -> Console:
    """Stdout; tables that go to a file are not cut to a screen's width."""
    screen = Console()
    return screen if screen.is_terminal else Console(width=WIDE)


def _told(matches: Sequence[Match], known: bool) -> str:
    """The likeliest, with their chances; "new" first where none is near enough."""
    if not matches:
        return "–"
    names = ", ".join(f"{match.name} {match.probability:.0%}" for match in matches[:LISTED])
    return names if known else f"new (nearest {names})"


def _row(probe: Probe, one: Prediction) -> dict[str, Any]:
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


def _print_json(document: dict[str, Any]) -> None:
    sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=1).decode() + "\n")


@recognise_app.command(name="train")
def train_command(
    labels: Paths,
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    across: Flag = False,
    fps: float | None = None,
    seed: int = 0,
) -> None:
    """Learn tasks and persons from labelled stretches of motion files.

    Example: ``onbeat recognise train labels.csv -o model.npz``

    Parameters
    ----------
    labels
        Label files: CSV with the columns file, from, to, task, person, cycle.
    output
        The model's file.
    across
        Known may be as far away as a known task by a new person, or a known person in a new task; without it as
        another repetition by the same.
    fps
        Frames a second of motion files that store none (AMC).
    seed
        Of the choice among many segments.
    """
    if seed < 0:
        raise OnbeatError(f"--seed {seed}: give 0 or more")
    with warnings_as_lines():
        _, segments = read_segments(labels, BeatFlags(fps=fps), None)
    with Console(stderr=True).status(Text(f"learning from {len(segments)} segments")):
        recogniser = Recogniser.train(segments, np.random.default_rng(seed), across=across)
    save_recogniser(recogniser, output)
    counts = [len(expert.names) if expert else 0 for expert in (recogniser.task, recogniser.person)]
    told = [f"{n} {name}{'' if n == 1 else 's'}" for n, name in zip(counts, ("task", "person"), strict=True)]
    of = f"{len(segments)} segment{'' if len(segments) == 1 else 's'}"
    _screen().print(Text(f"{output}: {told[0]} and {told[1]} from {of}"))


@recognise_app.command(name="evaluate")
def evaluate_command(model: Path, labels: Paths, /, *, fps: float | None = None, json: Flag = False) -> None:
    """Measure a model on labelled segments that it has not learned from.

    Example: ``onbeat recognise evaluate model.npz other_labels.csv``

    Parameters
    ----------
    model
        What ``onbeat recognise train`` wrote.
    labels
        Label files, as for ``onbeat recognise train``.
    fps
        Frames a second of motion files that store none (AMC).
    json
        Print the confusion matrices as JSON on stdout instead of tables.
    """
    recogniser = load_recogniser(model)
    with warnings_as_lines():
        probes, segments = read_segments(labels, BeatFlags(fps=fps), None)
        predictions = recogniser.predict(segments)
    if not any(probe.task or probe.person for probe in probes):
        raise OnbeatError(f"no task and no person in {', '.join(map(str, labels))}; label what is to be held against")
    document: dict[str, Any] = {"version": VERSION}
    for factor, expert in (("task", recogniser.task), ("person", recogniser.person)):
        if expert is None:
            continue
        pairs = [
            (getattr(probe, factor), getattr(one, factor) if getattr(one, f"{factor}_known") else "new")
            for probe, one in zip(probes, predictions, strict=True)
            if getattr(probe, factor)
        ]
        right = [found == (true if true in expert.names else "new") for true, found in pairs]
        document[factor] = {"right": sum(right), "of": len(right), "confusion": _confusion(pairs)}
        if not json and pairs:
            _print_confusion(factor, document[factor])
    if json:
        _print_json(document)


def _confusion(pairs: Sequence[tuple[str, str]]) -> dict[str, dict[str, int]]:
    """How often each true name was taken for which."""
    table: dict[str, dict[str, int]] = {}
    for true, found in sorted(pairs):
        row = table.setdefault(true, {})
        row[found] = row.get(found, 0) + 1
    return table


def _print_confusion(factor: str, scored: dict[str, Any]) -> None:
    confusion: dict[str, dict[str, int]] = scored["confusion"]
    names = [*sorted({name for row in confusion.values() for name in row} - {"new"}), "new"]
    table = Table(box=None, pad_edge=False)
    table.add_column(Text(f"{factor}: {scored['right']} of {scored['of']} right"))
    for name in names:
        table.add_column(Text(name), justify="right")
    for true, row in confusion.items():
        table.add_row(Text(true), *(str(row.get(name, "·")) for name in names))
    _screen().print(table)
