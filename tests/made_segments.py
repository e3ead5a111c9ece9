"""Segments with known tasks and people, which the tests of recognition share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import Performance, perform
from onbeat.examples.troupe import FIGURES
from onbeat.recognition.segments import Segments, links_of, segments_of

POINTS = ("hips", "chest", "left_wrist", "right_wrist", "left_ankle", "right_ankle")


def made(
    people: int = 3,
    tasks: int = 4,
    takes: int = 2,
    noise: float = 0.02,
    seed: int = 0,
    without: Iterable[tuple[int, int]] = (),
    style: float = 0.5,
) -> Segments:
    """What is each task's plus what is each person's plus noise; ``without`` some cells (person, task)."""
    rng = np.random.default_rng(seed)
    shape = (8, len(POINTS), 3)
    task, person = rng.normal(size=(tasks, *shape)), style * rng.normal(size=(people, *shape))
    gone = set(without)
    at = [(p, k, c) for c in range(takes) for p in range(people) for k in range(tasks) if (p, k) not in gone]
    positions = np.array([task[k] + person[p] for p, k, _ in at]) + noise * rng.normal(size=(len(at), *shape))
    return Segments(
        positions,
        np.ones(len(at)),
        tuple(f"task {k}" for _, k, _ in at),
        tuple(f"person {p}" for p, _, _ in at),
        np.array([c for _, _, c in at]),
        POINTS,
        links_of(POINTS),
    )


def renamed(segments: Segments, tasks: dict[str, str], persons: dict[str, str]) -> Segments:
    """The same segments under other names."""
    return replace(
        segments,
        task=tuple(tasks.get(name, name) for name in segments.task),
        person=tuple(persons.get(name, name) for name in segments.person),
    )


@cache
def danced(fps: float = 60.0) -> tuple[Performance, ...]:
    """Three dancers, three figures, two cycles each."""
    rng = np.random.default_rng(0)
    return tuple(perform(dancer, [figure], 1.0, 2, rng, fps) for figure in FIGURES[1:4] for dancer in DANCERS[:3])


def cycles_of(clips: Iterable[Performance], frame: str = "start") -> Segments:
    """Each cycle of the clips, a segment."""
    beats = {figure.name: figure.beats for figure in FIGURES}
    found = [(clip, float(clip.beats[1 + c * beats[clip.task]]), c) for clip in clips for c in range(clip.cycles)]
    return segments_of(
        [clip.motion for clip, _, _ in found],
        [(start, start + beats[clip.task] * float(clip.beats[1])) for clip, start, _ in found],
        [clip.task for clip, _, _ in found],
        [clip.person for clip, _, _ in found],
        [cycle for _, _, cycle in found],
        frame=frame,
    )
