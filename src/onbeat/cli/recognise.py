"""``onbeat recognise``: which step is danced, and who dances it, or that it is something or somebody new."""

from __future__ import annotations

import sys
from pathlib import Path

import cyclopts

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, Probe, problem_of, read_usable
from onbeat.cli.recognise_output import (
    FACTORS,
    VERSION,
    Flag,
    Paths,
    print_json,
    print_table,
    row_of,
    tell_guesses,
    told,
)
from onbeat.cli.swapped import refuse_swapped_model
from onbeat.errors import OnbeatError
from onbeat.recognition.model_file import load_recogniser
from onbeat.recognition.recogniser import Prediction, Recogniser

recognise_app = cyclopts.App(name="recognise", help="Say which step is danced, and by whom, or that it is new.")


@recognise_app.default
def predict_command(
    model: Path,
    probes: Paths,
    /,
    *,
    span: int | None = None,
    flags: BeatFlags = NO_BEATS,
    stream: Flag = False,
    json: Flag = False,
) -> None:
    """Recognise motions, or labelled stretches of them; files that cannot be used are told and left out.

    Example: ``onbeat recognise model.npz unknown.bvh``

    Parameters
    ----------
    model
        What ``onbeat recognise train`` wrote.
    probes
        Motion files, or label files (.csv: file,from,to).
    span
        Cut motion files and stretches at their keyposes: so many keyposes a segment. Without it each is one segment.
    flags
        Where the beats of motion files come from that are cut.
    stream
        Go through one motion file as if it were danced now: a line of JSON on stdout as each segment ends.
    json
        Print all matches as JSON on stdout instead of a table.
    """
    refuse_swapped_model(model, probes)
    cut = Cut(span).checked()
    recogniser = load_recogniser(model)
    if stream:
        from onbeat.cli.recognise_stream import stream_probe

        if len(probes) != 1 or probes[0].suffix.lower() == ".csv" or span is None:
            raise OnbeatError("--stream goes through one motion file, cut at its keyposes: give one, and --span")
        if json:
            raise OnbeatError("--stream prints lines of JSON already; leave --json out")
        stream_probe(recogniser, probes[0], flags, span)
        return
    with warnings_as_lines():
        pairs, problems = _answers(recogniser, probes, flags, cut)
    for line in problems:
        print(f"onbeat: left out {line}", file=sys.stderr)  # noqa: T201
    if json:
        rows = [row_of(probe, one) for probe, one in pairs]
        print_json({"version": VERSION, "segments": rows, "problems": problems})
        return
    cells = [
        (Path(probe.file).name, f"{probe.start:.2f}", f"{probe.end:.2f}",
         *(told(one, factor) for factor in FACTORS))
        for probe, one in pairs
    ]  # fmt: skip
    print_table(("file", "from", "to", "task", "person"), cells, ("from", "to"))
    tell_guesses(recogniser, [one for _, one in pairs])


def _answers(
    recogniser: Recogniser, paths: list[Path], flags: BeatFlags, cut: Cut
) -> tuple[list[tuple[Probe, Prediction]], list[str]]:
    """What each segment is taken for, and a line for each file that cannot be used; raises if none can."""
    usable = read_usable(paths, flags, cut)
    problems = list(usable.problems)
    taken_for: dict[Probe, Prediction] = {}
    for read in usable.reads:  # each file by itself: bodies may lack other points
        try:
            taken_for |= zip(read.probes, recogniser.predict(read.segments()), strict=True)
        except OnbeatError as error:
            problems.append(problem_of(Path(read.probes[0].file), error))
    if taken_for or not problems:
        return [(probe, taken_for[probe]) for probe in usable.probes if probe in taken_for], problems
    if len(problems) == 1:
        raise OnbeatError(problems[0])
    raise OnbeatError(f"none of {len(problems)} files can be recognised; {problems[0]}")


# Named by path, so that each is imported when it is called; their help stands here, so that a list needs none.
_COMMANDS = {
    "train": (
        "train_command",
        "Learn tasks and persons from labelled stretches of motion files.",
        "onbeat recognise train labels.csv -o model.npz",
    ),
    "evaluate": (
        "evaluate_command",
        "Measure a model on labelled segments that it has not learned from.",
        "onbeat recognise evaluate model.npz other_labels.csv -o confusion",
    ),
    "pupil": (
        "pupil_command",
        "Measure how far a pupil is from a master, by parts of the body.",
        "onbeat recognise pupil master.bvh pupil.bvh -o lesson",
    ),
    "style": (
        "style_command",
        "Make a motion of a step as another person dances it, or would.",
        "onbeat recognise style labels.csv --task bow --person Aiko -o bow_by_aiko.bvh",
    ),
}
for _order, (_name, (_function, _sentence, _example)) in enumerate(_COMMANDS.items()):
    _help = f"{_sentence}\n\nExample: ``{_example}``"
    recognise_app.command(f"onbeat.cli.recognise_{_name}:{_function}", name=_name, help=_help, sort_key=_order)
