"""``onbeat lowdim``: dances in a few dimensions, by their keyposes and by uniform sampling, and which people prefer."""

from __future__ import annotations

import itertools
import os
import sys
from pathlib import Path
from typing import Annotated, NamedTuple

import cyclopts
import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text
from threadpoolctl import threadpool_limits

from onbeat._shapes import Times
from onbeat.cli.keypose_input import MARKS, NO_BEATS, BeatFlags, read_dance
from onbeat.cli.lowdim_pulses import tell_unlike_pulses
from onbeat.cli.observe_input import beside
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.errors import MetricError
from onbeat.files import make_folder, write_atomically
from onbeat.formats import read_motion, write_motion
from onbeat.formats.read import fitted
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.judging import SPACES, AnswersDocument, trials, verdict_of
from onbeat.keyposes.lowdim import LowDimensional, low_dimensional, people_told
from onbeat.keyposes.lowdim_document import ErrorDocument, LowdimDocument, document
from onbeat.motion import Markers, Motion
from onbeat.music.beat_files import read_beats

MOST_REPEATS = 10
"""Trials of each motion on a page; more would be a large file, and tire people."""
Files = Annotated[list[Path] | None, cyclopts.Parameter(negative=(), json_list=False)]


def lowdim_command(
    motions: Files = None,
    /,
    *,
    dims: int = 3,
    rho: float | None = None,
    in_cycle: int | None = None,
    flags: BeatFlags = NO_BEATS,
    output: Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])] = None,
    judged: Annotated[list[Path] | None, cyclopts.Parameter(negative=(), consume_multiple=True)] = None,
    seed: int = 0,
    repeats: int = 1,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Rebuild dances in a few dimensions, those of their keyposes, and compare with uniform sampling.

    Example: ``onbeat lowdim aiko.bvh bruno.bvh carla.bvh --in-cycle 8 --music song.mp3 -o lowdim``

    Parameters
    ----------
    motions
        Motion files of the same dance, one of each person. Where ``NAME.keyposes.csv`` (a second a line) lies beside
        ``NAME.bvh`` these are its keyposes; else they are found.
    dims
        Dimensions of the motions that are written.
    rho
        As many dimensions as hold this share of the keyposes' variance, instead.
    in_cycle
        Keyposes in a cycle of the dance: the cycle in the middle teaches, the others test. Without it, half of them do.
    flags
        Where the beats come from, if all have the same; without it from ``NAME.beats`` or a song beside each, else from
        the motions themselves.
    output
        A folder for the motions in both spaces, ``lowdim.json``, the figures, and the page ``judge.html`` on which
        people choose.
    judged
        Answers that were saved from ``judge.html``: says how people chose, and whether that is chance.
    seed
        Draws the order of the trials on the page, and which is A.
    repeats
        How often each person's motion is asked for, each time another stretch of it.
    json
        Print ``lowdim.json``, or what was ``judged``, on stdout instead of a table.
    """
    if judged:
        if motions:
            raise MetricError(f"--judged reads answers alone; leave out {motions[0]}, or --judged")
        if output is not None:
            raise MetricError(f"--judged writes nothing to {output}; leave out -o, and keep what is printed")
        _print_verdict(judged, json)
        return
    if not motions:
        raise MetricError("no motions; give files of one dance, one of each person, or --judged with saved answers")
    if seed < 0:
        raise MetricError(f"--seed {seed} cannot be; give 0 or more")
    if not 1 <= repeats <= MOST_REPEATS:
        raise MetricError(f"--repeats {repeats} cannot be; give 1 to {MOST_REPEATS}")
    _refuse_twice(motions)
    with warnings_as_lines(), threadpool_limits(1, "blas"), Stages() as stages:  # bits do not depend on threads
        read = [_read(path, flags, stages, done / len(motions)) for done, path in enumerate(motions)]
        tell_unlike_pulses([path.name for path in motions], [one.own for one in read])
        stages("spaces", 0.0)
        found = low_dimensional(
            [one.motion for one in read], [one.keyposes for one in read], _names(motions), dims=dims, rho=rho,
            cycle=in_cycle,
        )  # fmt: skip
        told = document(found)
        if output is not None:
            _write(make_folder(output), found, told, stages, (seed, repeats))
    if json:
        sys.stdout.write(told.to_json().decode())
    else:
        _print(found, told)


def _refuse_twice(paths: list[Path]) -> None:
    seen: set[str] = set()
    for path in paths:
        if (file := os.path.realpath(path)) in seen:
            raise MetricError(f"{path} is given twice; give one motion of each person")
        seen.add(file)


def _names(paths: list[Path]) -> list[str]:
    """A name for each motion: of its file, with its folder's where several have it, numbered where that is one, too."""
    stems = [path.stem for path in paths]
    names: list[str] = []
    for path in paths:
        name = path.stem if stems.count(path.stem) == 1 else f"{path.resolve().parent.name}_{path.stem}"
        numbered = (name if n == 1 else f"{name} ({n})" for n in itertools.count(1))
        names.append(next(one for one in numbered if one not in names))
    return names


class _Read(NamedTuple):
    """A motion, its keyposes, and the tempo of its own pulse where they were found by that."""

    motion: Motion
    keyposes: Times
    own: float | None = None


def _read(path: Path, flags: BeatFlags, stages: Stages, share: float) -> _Read:
    """A motion and its keyposes, marked or found."""
    stages("reading", share, path.name)
    marks = path.with_name(path.stem + MARKS)
    if marks.is_file():
        return _Read(read_motion(path, flags.fps), read_beats(marks).times)
    used = flags if flags.music or flags.beats else beside(path, flags)
    source, beats, _ = read_dance(path, used)
    own = None if used.music or used.beats else 60.0 / float(np.median(np.diff(beats)))
    motion = fitted(source, path).motion if isinstance(source, Markers) else source
    return _Read(motion, find_keyposes(source, beats).times, own)


def _write(folder: Path, found: LowDimensional, told: LowdimDocument, stages: Stages, drawn: tuple[int, int]) -> None:
    from onbeat.viewer.pages.judge import write_judge_page
    from onbeat.viewer.plots.lowdim import write_lowdim_figures
    from onbeat.viewer.plots.lowdim_pictures import write_lowdim_pictures

    count = len(found.motions) * len(SPACES) * found.dims
    done = 0
    for which in range(len(found.motions)):
        for space in SPACES:
            for dims in range(1, found.dims + 1):
                motion = found.motion(which, space, dims)
                stages("motions", done / count, motion.name)
                write_motion(motion, folder / f"{motion.name}.bvh")
                done += 1
    stages("figures", 0.0)
    write_atomically(folder / "lowdim.json", told.to_json())
    write_lowdim_figures(folder, found)
    stages("figures", 0.5, "pictures")
    write_lowdim_pictures(folder, found)
    people, (seed, repeats) = [one.person for one in found.taught], drawn
    write_judge_page(folder / "judge.html", found, trials(people, np.random.default_rng(seed), repeats))


def _print(found: LowDimensional, told: LowdimDocument) -> None:
    table = Table("", "keyposes", "uniform", "ratio", box=None, pad_edge=False)
    for column in table.columns[1:]:
        column.justify = "right"
    shares = [space.cumulative[found.dims - 1] for space in told.spaces]
    table.add_row("variance of its own poses", f"{shares[0]:.1%}", f"{shares[1]:.1%}", "")
    for row in told.errors:
        table.add_row(*_error_row(row, found.dims))
    kinds = {"through": "bone through bone", "beyond": "joint beyond its range", "stretched": "bone length off by 10 %"}
    for kind, title in kinds.items():
        table.add_row(f"as points: {title}", *(f"{getattr(space, kind):.1%}" for space in told.spaces), "")
    most = len(found.spaces["keyposes"])
    screen = Console()
    screen.print(Text(f"{people_told(len(found.motions))}, {told.poses} poses, {found.dims} of {most} dimensions"))
    screen.print(table)
    fewest = min(len(row.keyposes) for row in told.errors)
    if fewest < found.dims:
        less = f"{fewest} dimension{'s' * (fewest != 1)}"
        screen.print(Text(f"–: without the person who is tested the others' poses span but {less}"))


def _error_row(row: ErrorDocument, dims: int) -> tuple[str, str, str, str]:
    """An error's title, both spaces' and their ratio; dashes where the space of the other people has fewer dimensions.

    A space without the person who is tested is of fewer poses, so that it may not have as many.
    """
    tested = {"frames": "unseen frames", "between": "between taught poses", "people": "unseen people"}[row.unseen]
    poses = {"all": "all frames", "rest": "frames at rest", "keyposes": "keyposes"}[row.of]
    title = f"error, {tested}: {poses}"
    if len(row.keyposes) < dims:
        return title, "–", "–", ""
    ours, theirs = 1000 * row.keyposes[dims - 1], 1000 * row.uniform[dims - 1]
    return title, f"{ours:.1f} mm", f"{theirs:.1f} mm", f"{ours / theirs:.2f}" if theirs > 0 else ""


def _print_verdict(paths: list[Path], json: bool) -> None:
    documents: dict[Path, AnswersDocument] = {}
    for path in paths:
        try:
            answers = AnswersDocument.from_json(path.read_bytes(), str(path))
        except OSError as error:
            raise MetricError(f"cannot read {path}: {error.strerror or error}; save it from judge.html") from None
        for other, known in documents.items():
            if known == answers:
                raise MetricError(f"{path} holds the same answers as {other}; give the answers of each person once")
        documents[path] = answers
    found = verdict_of(documents.values())
    if json:
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(found._asdict()), indent=1).decode() + "\n")
        return
    print(  # noqa: T201
        f"{found.chosen} of {found.trials} chose keyposes ({found.chosen / found.trials:.0%}; 95 % confidence interval "
        f"of the true share: {found.low:.0%} to {found.high:.0%}); by chance p = {found.p:.2g} (exact binomial test, "
        "two-sided)"
    )
