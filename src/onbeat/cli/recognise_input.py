"""What ``onbeat recognise`` reads: labelled stretches of motion files, and motion files whole or cut at keyposes."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from onbeat.cli.keypose_input import SOUNDS, BeatFlags, read_dance
from onbeat.cli.progress import Stages
from onbeat.errors import BodyError, MetricError, OnbeatError
from onbeat.formats.read import fitted, read_motion
from onbeat.keyposes.extract import Keyposes, find_keyposes
from onbeat.motion import Markers, Motion
from onbeat.recognition.labels import Label, read_labels
from onbeat.recognition.segments import MOMENTS, Segments, segments_of
from onbeat.recognition.steps import steps, usual

_EDGE = 1e-6  # seconds


class Probe(NamedTuple):
    """A segment by its file and seconds, with what is said of it."""

    file: str
    start: float
    end: float
    task: str = ""
    person: str = ""
    cycle: int = 0


class Cut(NamedTuple):
    """How stretches are cut into segments.

    Parameters
    ----------
    span : keyposes a segment; None takes each stretch as one segment.
    every : whether segments begin at every keypose, else each where the one before ends.
    cycle : beats after which a labelled dance repeats, if it does.
    usual : whether only those segments are kept that last as others of their name do: to learn from, not to measure by.
    """

    span: int | None = None
    every: bool = True
    cycle: int | None = None
    usual: bool = False

    def checked(self) -> Cut:
        """Itself, if its numbers can be."""
        if self.span is not None and self.span < 1:
            raise OnbeatError(f"--span {self.span}: give 1 or more keyposes")
        if self.cycle is not None and self.cycle < 1:
            raise OnbeatError(f"--cycle {self.cycle}: give 1 or more beats")
        if self.cycle is not None and self.span is None:
            raise OnbeatError(f"--cycle {self.cycle}: it counts the keyposes of --span; give both or neither")
        return self


WHOLE = Cut()
"""Each stretch is a segment."""


class Read(NamedTuple):
    """Probes, and the motion of each."""

    probes: list[Probe]
    motions: list[Motion]

    def segments(self, frame: str = "start", moments: int = MOMENTS) -> Segments:
        """The probes as segments."""
        probes = self.probes
        spans = [(probe.start, probe.end) for probe in probes]
        tasks, persons = [probe.task for probe in probes], [probe.person for probe in probes]
        cycles = [probe.cycle for probe in probes]
        return segments_of(self.motions, spans, tasks, persons, cycles, frame=frame, moments=moments)


def read_probes(paths: Sequence[Path], flags: BeatFlags, cut: Cut = WHOLE) -> Read:
    """All segments of label files (``.csv``) and motion files.

    Parameters
    ----------
    paths : label files, and motion files.
    flags : where the beats of motion files come from that are cut at keyposes; if none are given, from ``NAME.beats``
        or a song beside each, else from the motion itself.
    cut : how stretches are cut; those of label files are cut only where they have a task or a person.

    Raises
    ------
    MetricError
        If there is none, or a motion is too short to be cut.
    """
    cut.checked()
    shelf = _Shelf(flags)
    found: list[Probe] = []
    with Stages() as stages:
        for row in _rows(paths, stages):
            found += shelf.probes(row, cut)
    if not found:
        raise MetricError("nothing to recognise: give label files (.csv) or motion files")
    if cut.usual and cut.span is not None:
        found = _usual(found)
    return Read(found, [shelf.motion(Path(probe.file)) for probe in found])


class Usable(NamedTuple):
    """All probes in their order, the same by motion files, and a line for each file that cannot be used."""

    probes: list[Probe]
    reads: list[Read]
    problems: list[str]


def read_usable(paths: Sequence[Path], flags: BeatFlags, cut: Cut = WHOLE) -> Usable:
    """The segments as :func:`read_probes` reads them, of the files that can be read."""
    cut.checked()
    shelf = _Shelf(flags)
    probes: list[Probe] = []
    problems: list[str] = []
    with Stages() as stages:
        for row in _rows(paths, stages, problems):
            try:
                probes += shelf.probes(row, cut)
            except OnbeatError as error:
                problems.append(problem_of(row.file, error))
    found: dict[str, list[Probe]] = {}
    for probe in probes:
        found.setdefault(probe.file, []).append(probe)
    reads = [Read(some, [shelf.motion(Path(file))] * len(some)) for file, some in found.items()]
    return Usable(probes, reads, list(dict.fromkeys(problems)))


def problem_of(file: Path, error: OnbeatError) -> str:
    """What is wrong with a file, with its name before it where the error does not begin with it.

    >>> problem_of(Path("a/b.bvh"), OnbeatError("no head")), problem_of(Path("a/b.bvh"), OnbeatError("b: no head"))
    ('a/b.bvh: no head', 'b: no head')
    """
    said = str(error)
    named = said.startswith((str(file), file.name, f"{file.stem}:")) or str(file) in said
    return said if named else f"{file}: {said}"


def _rows(paths: Sequence[Path], stages: Stages, problems: list[str] | None = None) -> Iterator[Label]:
    """All that is to be read, one after the other; a label file that cannot be is told in ``problems``, if given."""
    for done, path in enumerate(paths):
        try:
            rows = read_labels(path) if path.suffix.lower() == ".csv" else [Label(path, 0.0, float("inf"))]
        except OnbeatError as error:
            if problems is None:
                raise
            problems.append(problem_of(path, error))
            continue
        for number, row in enumerate(rows):
            stages("reading", (done + number / len(rows)) / len(paths), row.file.name)
            yield row


def _usual(found: Sequence[Probe]) -> list[Probe]:
    """The segments that last as others of their name do; how many do not is told."""
    kept = usual([probe.task for probe in found], [probe.end - probe.start for probe in found])
    if gone := len(found) - len(kept):
        said = f"{gone} of {len(found)} segments are left out: they last longer or shorter than others of that name"
        print(said, file=sys.stderr)  # noqa: T201
    return [found[i] for i in kept]


class _Shelf:
    """Motions and their keyposes, each read once."""

    def __init__(self, flags: BeatFlags) -> None:
        self._flags = flags
        self._motions: dict[Path, Motion] = {}
        self._keyposes: dict[Path, Keyposes] = {}

    def motion(self, path: Path) -> Motion:
        if path not in self._motions:
            try:
                self._motions[path] = read_motion(path, fps=self._flags.fps)
            except BodyError as error:
                raise BodyError(f"{error}; or leave the file out: whole bodies are recognised") from None
        return self._motions[path]

    def keyposes(self, path: Path) -> Keyposes:
        if path not in self._keyposes:
            source, beats, _ = read_dance(path, beats_beside(path, self._flags))
            if path not in self._motions:
                self._motions[path] = fitted(source, path, None).motion if isinstance(source, Markers) else source
            self._keyposes[path] = find_keyposes(source, beats)
        return self._keyposes[path]

    def probes(self, row: Label, cut: Cut) -> list[Probe]:
        """A stretch as one segment, or from keypose to keypose."""
        if cut.span is None:
            motion = self.motion(row.file)
            end = min(row.end, (len(motion) - 1) / motion.fps) if row.end == float("inf") else row.end
            return [Probe(str(row.file), row.start, end, row.task, row.person, row.cycle)]
        keyposes, motion = self.keyposes(row.file), self.motion(row.file)
        if not 0.0 <= row.start <= motion.duration or motion.duration + _EDGE < row.end < float("inf"):
            raise MetricError(
                f"{row.file} from {row.start:g} to {row.end:g} s: the motion lasts {motion.duration:g} s; give seconds "
                "inside of it, or none"
            )
        found = steps(keyposes, row.start, row.end, cut.span, cycle=cut.cycle, every=cut.every)
        if not found:
            where = f"{row.file}" + (f" from {row.start:g} to {row.end:g} s" if row.line else "")
            raise MetricError(f"{where} has no {cut.span + 1} keyposes in a row; take it whole (without --span)")
        return [
            Probe(str(row.file), one.start, one.end, f"{row.task}/{one.number}" if row.task else "", row.person,
                  row.cycle + one.repetition)
            for one in found
        ]  # fmt: skip


def beats_beside(path: Path, flags: BeatFlags) -> BeatFlags:
    """Where a motion's beats come from: what is given, else ``NAME.beats`` or a song beside it, else itself."""
    if flags.music or flags.beats:
        return flags
    beats = path.with_suffix(".beats")
    if beats.is_file():
        return replace(flags, beats=beats)
    song = next((found for ending in SOUNDS if (found := path.with_suffix(ending)).is_file()), None)
    return replace(flags, music=song)


def read_segments(paths: Sequence[Path], flags: BeatFlags, cut: Cut = WHOLE) -> tuple[list[Probe], Segments]:
    """The probes and their segments; errors as :func:`read_probes`."""
    read = read_probes(paths, flags, cut)
    return read.probes, read.segments()
