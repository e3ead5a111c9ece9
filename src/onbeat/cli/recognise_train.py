"""``onbeat recognise train``: learn tasks and persons from labelled motion."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import cyclopts
import numpy as np
from rich.console import Console
from rich.text import Text

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.recognise_input import Cut, read_segments
from onbeat.cli.recognise_output import Flag, Paths, screen
from onbeat.errors import OnbeatError
from onbeat.recognition.joined_sides import JoinedSides
from onbeat.recognition.model_file import save_recogniser
from onbeat.recognition.recogniser import Recogniser


def train_command(
    labels: Paths,
    /,
    *,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])],
    across: Flag = False,
    mirrored: Literal["apart", "joined"] = "apart",
    span: int | None = None,
    cycle: int | None = None,
    flags: BeatFlags = NO_BEATS,
    seed: int = 0,
) -> None:
    """Learn tasks and persons from labelled stretches of motion files.

    Example: ``onbeat recognise train labels.csv -o model.npz``

    Parameters
    ----------
    labels
        Label files: CSV with the columns file, from, to, task, person, cycle; no seconds for the whole file.
    output
        The model's file.
    across
        Call known what is as near as a known task by a new person, or a known person in a new task. Without it known
        is what is as near as another repetition by the same; what is farther, yet as near as with this flag, is told as
        "perhaps".
    mirrored
        ``apart`` (the default): a step and its mirror image are two. ``joined``: they are one; the model then turns
        all that it is shown to lead with the right side. Names stay as they are: label both sides alike.
    span
        Cut the stretches at their keyposes: so many keyposes a segment. Their tasks are named TASK/1, TASK/2, … by
        the beat on which they begin.
    cycle
        Beats after which the dance repeats: the same beat of each cycle has one name.
    flags
        Where the beats of motion files come from that are cut.
    seed
        Of the choice among many segments.
    """
    if seed < 0:
        raise OnbeatError(f"--seed {seed}: give 0 or more")
    with warnings_as_lines():
        _, segments = read_segments(labels, flags, Cut(span, cycle=cycle, usual=True))
    with Console(stderr=True).status(Text(f"learning from {len(segments)} segments")):
        kind = JoinedSides if mirrored == "joined" else Recogniser
        recogniser = kind.train(segments, np.random.default_rng(seed), across=across, newcomers=True)
    save_recogniser(recogniser, output)
    counts = [len(expert.names) if expert else 0 for expert in (recogniser.task, recogniser.person)]
    told = [f"{n} {name}{'' if n == 1 else 's'}" for n, name in zip(counts, ("task", "person"), strict=True)]
    of = f"{len(segments)} segment{'' if len(segments) == 1 else 's'}"
    sides = ", left and right joined" if mirrored == "joined" else ""
    screen().print(Text(f"{output}: {told[0]} and {told[1]} from {of}{sides}; {_newcomers(recogniser, across)}"))


def _newcomers(recogniser: Recogniser, across: bool) -> str:
    """What the model will say of a known task by somebody new."""
    if not recogniser.task:
        return "without tasks only persons are told"
    if across:
        return "a known task by somebody new is called known, and many a new one, too"
    if not recogniser.across.task:
        return "a known task by somebody new is called new (to have it told teach 3 tasks or more, by several people)"
    right = recogniser.across.task.choice.accuracy
    return f"a known task by somebody new is called perhaps known ({right:.0%} of them by the right name, tried here)"
