"""``onbeat recognise``: which step is danced, and who dances it, or that it is something or somebody new."""

from __future__ import annotations

from pathlib import Path

import cyclopts

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, read_segments
from onbeat.cli.recognise_output import VERSION, Flag, Paths, print_json, print_table, row_of, told
from onbeat.errors import OnbeatError
from onbeat.recognition.model_file import load_recogniser

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
    """Recognise motions, or labelled stretches of them.

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
        found, segments = read_segments(probes, flags, cut)
        predictions = recogniser.predict(segments)
    pairs = list(zip(found, predictions, strict=True))
    if json:
        print_json({"version": VERSION, "segments": [row_of(probe, one) for probe, one in pairs]})
        return
    rows = [
        (Path(probe.file).name, f"{probe.start:.2f}", f"{probe.end:.2f}",
         told(one.task_scores, one.task_known), told(one.person_scores, one.person_known))
        for probe, one in pairs
    ]  # fmt: skip
    print_table(("file", "from", "to", "task", "person"), rows, ("from", "to"))


# Named by path, so that each is imported when it is called; their help stands here, so that a list needs none.
_COMMANDS = {
    "train": ("train_command", "Learn tasks and persons from labelled stretches of motion files."),
    "evaluate": ("evaluate_command", "Measure a model on labelled segments that it has not learned from."),
    "pupil": ("pupil_command", "Measure how far a pupil is from a master, by parts of the body."),
    "style": ("style_command", "Make a motion of a step as another person dances it, or would."),
}
for _order, (_name, (_function, _help)) in enumerate(_COMMANDS.items()):
    recognise_app.command(f"onbeat.cli.recognise_{_name}:{_function}", name=_name, help=_help, sort_key=_order)
