"""``onbeat recognise style``: a step as another person dances it, or would, as a motion that plays."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import cyclopts
import numpy as np
from rich.text import Text

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, Read, read_probes
from onbeat.cli.recognise_output import Paths, screen
from onbeat.errors import MetricError, OnbeatError
from onbeat.formats import write_motion
from onbeat.formats.read import read_motion
from onbeat.motion import Motion
from onbeat.recognition.styles import danced_by, style_model
from onbeat.recognition.tensor import TensorModel

PAGE = ".html"


def style_command(
    labels: Paths,
    /,
    *,
    task: str,
    person: str,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    base: Path | None = None,
    seconds: float | None = None,
    span: int | None = None,
    cycle: int | None = None,
    flags: BeatFlags = NO_BEATS,
) -> None:
    """Make a motion of a step as another person dances it, or would.

    Example: ``onbeat recognise style labels.csv --task bow --person Aiko -o bow_by_aiko.bvh``

    Parameters
    ----------
    labels
        Label files, as for ``onbeat recognise train``: several steps by several people.
    task
        The step.
    person
        Whose style it is to have; whether or not the labels have this step by this person.
    output
        A motion file, or a page (.html).
    base
        The motion whose body is to dance; without it a take of the same step, by whoever is nearest in style.
    seconds
        How long it is to be; without it as long as this person's steps and this step's takes tell.
    span
        Cut the stretches at their keyposes, as in training.
    cycle
        Beats after which the dance repeats, as in training.
    flags
        Where the beats of motion files come from that are cut.
    """
    strange = [str(path) for path in labels if path.suffix.lower() != ".csv"]
    if strange:
        raise OnbeatError(
            f"{', '.join(strange)}: a style is learned from label files (.csv); a model for recognising keeps what "
            "tells steps apart, not how they are danced"
        )
    with warnings_as_lines():
        read = read_probes(labels, flags, Cut(span, cycle=cycle, usual=True))
        known = _labelled(read)
        segments = known.segments()
        _check_names(known, task, person)
        model = style_model(segments)
        seen = bool(model.seen[model.index("person", person), model.index("task", task)])
        body = read_motion(base, fps=flags.fps) if base else _base(known, model, task, person)
        made = danced_by(model, task, person, body, seconds=seconds)
        _write(made, output)
    so = "the mean of what the labels have" if seen else f"{person} never danced {task} in the labels"
    screen().print(Text(f"{output}: {made.name}, {made.duration:.2f} s, {so}; on the body of {body.name}"))


def _labelled(read: Read) -> Read:
    """The stretches of which both task and person are known."""
    kept = [i for i, probe in enumerate(read.probes) if probe.task and probe.person]
    if not kept:
        raise MetricError(f"of {len(read.probes)} stretches none has both a task and a person; label some")
    return Read([read.probes[i] for i in kept], [read.motions[i] for i in kept])


def _check_names(read: Read, task: str, person: str) -> None:
    tasks, people = ({getattr(probe, factor) for probe in read.probes} for factor in ("task", "person"))
    for name, word, names in ((task, "task", tasks), (person, "person", people)):
        if name not in names:
            raise MetricError(f"no {word} {name!r} in the labels; there are {', '.join(sorted(names))}")


def _base(read: Read, model: TensorModel, task: str, person: str) -> Motion:
    """A take of the step by the person, else by whoever is nearest in style."""
    rows = model.parts.factors[1 + model.modes.index("person")]
    people = model.categories("person")
    away = np.linalg.norm(rows - rows[people.index(person)], axis=1)
    at = min(
        (i for i, probe in enumerate(read.probes) if probe.task == task),
        key=lambda i: (float(away[people.index(read.probes[i].person)]), i),
    )
    probe, motion = read.probes[at], read.motions[at]
    times = np.arange(probe.start, probe.end + 1e-9, 1.0 / motion.fps)
    return motion.at(times)


def _write(motion: Motion, path: Path) -> None:
    if path.suffix.lower() != PAGE:
        write_motion(motion, path)
        return
    from onbeat.viewer.pages.page import write_page

    write_page(path, motion)
