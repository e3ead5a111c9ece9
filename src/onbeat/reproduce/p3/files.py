"""Motion files of one's own for the experiments of 2009: who dances what, and where the keyposes are.

Files named ``task_person_take.bvh`` say who dances what; other names are people's. Keyposes are those that are marked
(``NAME.keyposes.csv``), else they are found: on the beats beside the file, on the motion's own, or, where it has no
pulse, wherever the body rests.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import OnbeatError, PlanError
from onbeat.keyposes.candidates import minima
from onbeat.keyposes.energy import energy_of
from onbeat.keyposes.extract import DEFAULT, find_keyposes
from onbeat.keyposes.marks import read_marks
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.points import body_points
from onbeat.motion import Motion
from onbeat.recognition.segments import Segments, segments_of
from onbeat.reproduce.data import Data
from onbeat.reproduce.p3.dances import MARKS, beats_beside

MOST_PEOPLE = 8
"""As many as the paper has; of more, the first."""


@dataclass(frozen=True, eq=False)
class Take:
    """A motion file: who dances what in it, and which time it is."""

    path: Path
    motion: Motion
    task: str
    person: str
    number: int


def takes_of(data: Data) -> list[Take]:
    """The given files, by name; a name that does not say it all is a person's, and the task "dance"."""
    found: list[Take] = []
    for path in data.motion_files():
        parts = path.stem.rsplit("_", 2)
        named = len(parts) == 3 and parts[2].isdigit() and int(parts[2]) < 1 << 31
        task, person, number = (parts[0], parts[1], int(parts[2])) if named else ("dance", path.stem, 0)
        found.append(Take(path, data.motion(path), task, person, number))
    return found


class UntoldWarning(UserWarning):
    """Nobody told on which beats files are danced, nor where their keyposes are."""


def untold(takes: list[Take]) -> str:
    """Why the keyposes of some takes are not the paper's, for there are neither beats nor marks; else empty."""
    without = [
        take.path.name
        for take in takes
        if beats_beside(take.path) is None and not take.path.with_name(take.path.stem + MARKS).is_file()
    ]
    if not without:
        return ""
    named = without[0] + (f" and {len(without) - 1} more" if len(without) > 1 else "")
    return (
        f"no beats beside {named} (NAME.beats, a second a line, or the song, NAME.wav), and no marked keyposes "
        f"(NAME{MARKS}): keyposes are where the body rests, and what is said of keyposes cannot be told"
    )


def one_dance(takes: list[Take]) -> list[Take]:
    """The first take of each person of the task that most people dance, eight of them at most."""
    first = {(take.task, take.person): take for take in reversed(takes)}
    task = Counter(task for task, _ in first).most_common(1)[0][0]
    return [take for take in takes if take.task == task and first[task, take.person] is take][:MOST_PEOPLE]


def keyposes_of(take: Take) -> Times:
    """Seconds (K,) of a take's keyposes: marked, on its beats, or where it rests.

    Raises
    ------
    OnbeatError
        If there are fewer than two.
    """
    marks, beats = take.path.with_name(take.path.stem + MARKS), beats_beside(take.path)
    if marks.is_file():
        return read_marks(marks, (len(take.motion) - 1) / take.motion.fps)
    try:
        times = find_keyposes(take.motion, motion_beats(take.motion) if beats is None else beats).times
    except PlanError:
        times = _rests(take.motion)
    if len(times) < 2:
        raise OnbeatError(
            f"{take.path} has {len(times)} keyposes; two at least are needed: give a longer motion, or mark them in "
            f"{marks.name}, a second a line"
        )
    return times


def _rests(motion: Motion) -> Times:
    """Rests of the body, its first pose and its last."""
    found = minima(energy_of(body_points(motion)).local)
    last = (len(motion) - 1) / motion.fps
    deep = ((found.values < DEFAULT.t1) | (found.rises > DEFAULT.t2)) & (found.times > 0.1) & (found.times < last - 0.1)
    return np.concatenate(([0.0], found.times[deep], [last]))


def segments_in(takes: list[Take]) -> Segments | None:
    """Whole files as segments of tasks by people; None unless two tasks by two people are there more than once."""
    counts = Counter((take.task, take.person) for take in takes)
    some = [take for take in takes if counts[take.task, take.person] > 1]
    if min(len({take.task for take in some}), len({take.person for take in some})) < 2:
        return None
    seen: Counter[tuple[str, str]] = Counter()
    cycles: list[int] = []
    for take in some:
        cycles.append(seen[take.task, take.person])
        seen[take.task, take.person] += 1
    return segments_of(
        [take.motion for take in some],
        [(0.0, (len(take.motion) - 1) / take.motion.fps) for take in some],
        [take.task for take in some],
        [take.person for take in some],
        cycles,
        frame="body",
    )
