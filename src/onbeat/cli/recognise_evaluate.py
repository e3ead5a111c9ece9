"""``onbeat recognise evaluate``: a model held against labels, as confusion matrices."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, Probe, read_segments
from onbeat.cli.recognise_output import (
    FACTORS,
    VERSION,
    Factor,
    Flag,
    Folder,
    Paths,
    made_folder,
    print_json,
    print_table,
)
from onbeat.errors import OnbeatError
from onbeat.recognition.model_file import load_recogniser
from onbeat.recognition.recogniser import Expert, Prediction


def evaluate_command(
    model: Path,
    labels: Paths,
    /,
    *,
    output: Folder = None,
    span: int | None = None,
    cycle: int | None = None,
    flags: BeatFlags = NO_BEATS,
    json: Flag = False,
) -> None:
    """Measure a model on labelled segments that it has not learned from.

    Example: ``onbeat recognise evaluate model.npz other_labels.csv -o confusion``

    Parameters
    ----------
    model
        What ``onbeat recognise train`` wrote.
    labels
        Label files, as for ``onbeat recognise train``.
    output
        A folder for the confusion matrices as figures, ``task.png``, ``task.svg``, ``person.png`` and ``person.svg``.
    span
        Cut the stretches at their keyposes, as in training.
    cycle
        Beats after which the dance repeats, as in training.
    flags
        Where the beats of motion files come from that are cut.
    json
        Print the confusion matrices as JSON on stdout instead of tables.
    """
    recogniser = load_recogniser(model)
    with warnings_as_lines():
        probes, segments = read_segments(labels, flags, Cut(span, cycle=cycle))
        predictions = recogniser.predict(segments)
    if not any(probe.task or probe.person for probe in probes):
        raise OnbeatError(f"no task and no person in {', '.join(map(str, labels))}; label what is to be held against")
    document: dict[str, Any] = {"version": VERSION}
    for factor, expert in zip(FACTORS, (recogniser.task, recogniser.person), strict=True):
        if expert is None:
            continue
        document[factor] = scored = _scored(factor, expert, probes, predictions)
        if not json and scored["of"]:
            _print_confusion(factor, scored)
        if output and scored["of"]:
            with warnings_as_lines():  # not matplotlib's about letters that its font has not
                _draw(made_folder(output), factor, scored)
    if json:
        print_json(document)


def _scored(
    factor: Factor, expert: Expert, probes: Sequence[Probe], predictions: Sequence[Prediction]
) -> dict[str, Any]:
    pairs = [
        (getattr(probe, factor), one.said(factor) or "new")
        for probe, one in zip(probes, predictions, strict=True)
        if getattr(probe, factor)
    ]
    right = [found == (true if true in expert.names else "new") for true, found in pairs]
    return {"right": sum(right), "of": len(right), "confusion": _confusion(pairs)}


def _confusion(pairs: Sequence[tuple[str, str]]) -> dict[str, dict[str, int]]:
    """How often each true name was taken for which."""
    table: dict[str, dict[str, int]] = {}
    for true, found in sorted(pairs):
        row = table.setdefault(true, {})
        row[found] = row.get(found, 0) + 1
    return table


def _names(confusion: dict[str, dict[str, int]]) -> list[str]:
    """All names that something was taken for, "new" last."""
    return [*sorted({name for row in confusion.values() for name in row} - {"new"}), "new"]


def _title(factor: str, scored: dict[str, Any]) -> str:
    return f"{factor}: {scored['right']} of {scored['of']} right"


def _print_confusion(factor: str, scored: dict[str, Any]) -> None:
    confusion: dict[str, dict[str, int]] = scored["confusion"]
    names = _names(confusion)
    rows = [(true, *(str(row.get(name, "·")) for name in names)) for true, row in confusion.items()]
    print_table((_title(factor, scored), *names), rows, names)


def _draw(folder: Path, factor: str, scored: dict[str, Any]) -> None:
    from onbeat.viewer.plots.confusion import write_confusion

    for kind in ("png", "svg"):
        write_confusion(folder / f"{factor}.{kind}", scored["confusion"], _title(factor, scored))
