"""What ``onbeat recognise`` reads: labelled stretches of motion files, and motion files whole or cut at keyposes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from onbeat.cli.keypose_input import BeatFlags, read_dance
from onbeat.cli.progress import Stages
from onbeat.errors import MetricError
from onbeat.formats.read import fitted, read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.segments import segments
from onbeat.motion import Markers, Motion
from onbeat.recognition.labels import Label, read_labels
from onbeat.recognition.segments import Segments, segments_of


class Probe(NamedTuple):
    """A segment by its file and seconds, with what is said of it."""

    file: str
    start: float
    end: float
    task: str = ""
    person: str = ""


def read_segments(paths: Sequence[Path], flags: BeatFlags, span: int | None) -> tuple[list[Probe], Segments]:
    """All segments of label files (``.csv``) and motion files.

    Parameters
    ----------
    paths : label files, and motion files.
    flags : where the beats of motion files come from, if they are cut at keyposes.
    span : keyposes that a segment of a motion file has; None takes each file as one segment.

    Raises
    ------
    MetricError
        If there is none, or a motion is too short to be cut.
    """
    probes: list[Probe] = []
    motions: list[Motion] = []
    cycles: list[int] = []
    read: dict[Path, Motion] = {}
    with Stages() as stages:
        for done, path in enumerate(paths):
            rows = read_labels(path) if path.suffix.lower() == ".csv" else None
            found = _cut(path, flags, span, read) if rows is None else [_labelled(label) for label in rows]
            for number, probe in enumerate(found):
                stages("reading", (done + number / len(found)) / len(paths), Path(probe.file).name)
                file = Path(probe.file)
                if file not in read:
                    read[file] = read_motion(file, fps=flags.fps)
                motions.append(read[file])
            probes += found
            cycles += [0] * len(found) if rows is None else [label.cycle for label in rows]
    if not probes:
        raise MetricError("nothing to recognise: give label files (.csv) or motion files")
    spans = [(probe.start, probe.end) for probe in probes]
    tasks, persons = [probe.task for probe in probes], [probe.person for probe in probes]
    return probes, segments_of(motions, spans, tasks, persons, cycles)


def _labelled(label: Label) -> Probe:
    return Probe(str(label.file), label.start, label.end, label.task, label.person)


def _cut(path: Path, flags: BeatFlags, span: int | None, read: dict[Path, Motion]) -> list[Probe]:
    """A motion file as one segment, or from keypose to keypose."""
    if span is None:
        read[path] = read_motion(path, fps=flags.fps)
        return [Probe(str(path), 0.0, (len(read[path]) - 1) / read[path].fps)]
    source, beats, _ = read_dance(path, flags)
    read[path] = fitted(source, path, None).motion if isinstance(source, Markers) else source
    parts = segments(find_keyposes(source, beats), span)
    if not parts:
        raise MetricError(f"{path} has no {span + 1} keyposes in a row; take it whole (without --span)")
    return [Probe(str(path), part.start, part.end) for part in parts]
