"""Building a library from motion files, anew only where they changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onbeat._shapes import Ints
from onbeat.errors import BodyError, LibraryError
from onbeat.moves import manifest as documents
from onbeat.moves import store
from onbeat.moves.clips import Read, Stage, main_body, read_recording, renamed
from onbeat.moves.graph import MotionGraph
from onbeat.moves.library import REACH, Clip, MoveLibrary
from onbeat.moves.lock import building
from onbeat.moves.manifest import Manifest, Problem
from onbeat.moves.recordings import Recording, find_recordings
from onbeat.moves.similarity import clip_pairs
from onbeat.moves.store import Arrays, Pairs

# Two clips are one if they last as long to so many frames, their poses are so near and their changes so correlated.
SAME_LENGTH, SAME_POSES, ALIKE = 2, 0.25, 0.8
Step = Callable[[str, float], None]
READING, PLACING = 0.2, 0.55  # shares of a build's time by which files are read, and clips made of them


def build_library(
    paths: Sequence[Path],
    folder: Path,
    *,
    mirror: bool = True,
    fps: float | None = None,
    step: Step | None = None,
    workers: int = 2,
) -> MoveLibrary:
    """Build the library of motion files in ``folder``; what it already holds of unchanged files is used again.

    All clips are put on the skeleton that most of the motion is on. Files that are broken, too short or no body are
    told in ``MoveLibrary.problems``.

    Parameters
    ----------
    paths : motion files and folders of them.
    folder : where to keep it.
    mirror : follow each clip by its mirror image.
    fps : the rate of files that store none.
    step : called with what is done now and the share of all done, 0…1.
    workers : threads; the result does not depend on it.

    Raises
    ------
    LibraryError
        If no file is good, another builder is at work in the folder, or it cannot be written.
    """
    return build_recordings(find_recordings(paths, fps), folder, mirror=mirror, fps=fps, step=step, workers=workers)


def build_recordings(
    recordings: Sequence[Recording],
    folder: Path,
    *,
    mirror: bool = True,
    fps: float | None = None,
    step: Step | None = None,
    workers: int = 2,
) -> MoveLibrary:
    """As :func:`build_library`, of recordings that were found already."""
    if (ready := _current(folder, recordings, mirror=mirror, fps=fps)) is not None:
        return ready  # in a folder that only others may write, too
    with building(folder):
        if (ready := _current(folder, recordings, mirror=mirror, fps=fps)) is not None:
            return ready
        old = Old.of(folder, fps)
        found, arrays = Build(mirror, fps, workers, step or _silent, old).of(recordings)
        store.write_library(folder, found, arrays)
        return store.library_from(found, arrays)


def assemble(
    recordings: Sequence[Recording],
    *,
    mirror: bool = True,
    fps: float | None = None,
    step: Step | None = None,
    workers: int = 2,
) -> MoveLibrary:
    """The library of some recordings, in memory only."""
    return store.library_from(*Build(mirror, fps, workers, step or _silent, Old()).of(recordings))


def _current(folder: Path, recordings: Sequence[Recording], *, mirror: bool, fps: float | None) -> MoveLibrary | None:
    """The library of a folder if it is what a build of these recordings would give."""
    try:
        found, arrays = store.read_stored(folder)
        return store.library_from(found, arrays) if is_current(found, recordings, mirror=mirror, fps=fps) else None
    except LibraryError:
        return None


def is_current(found: Manifest, recordings: Sequence[Recording], *, mirror: bool, fps: float | None) -> bool:
    """Whether a manifest is what a build of these recordings would give."""
    options = (found.method, found.mirror, found.fps) == (documents.method_digest(), mirror, fps)
    out = {(problem.file, problem.sha256) for problem in found.problems}
    kept = [(row.file, row.sha256, row.name) for row in found.clips if not row.mirrored]
    files = [(r.file, r.digest, r.name) for r in recordings]
    left_out = {file[:2] for file in files if file not in kept}
    return options and left_out == out and kept == [file for file in files if file in kept]


def _silent(what: str, share: float) -> None:
    """No progress is shown."""


@dataclass(frozen=True)
class Old:
    """What a folder already holds.

    Parameters
    ----------
    found, arrays : manifest and arrays, if there is a good library made by the same method.
    clips : its clips by content and mirroring, with their place in it.
    """

    found: Manifest | None = None
    arrays: Arrays = field(default_factory=dict[str, np.ndarray])
    clips: Mapping[tuple[str, bool], tuple[int, Clip]] = field(default_factory=dict[tuple[str, bool], tuple[int, Clip]])

    @classmethod
    def of(cls, folder: Path, fps: float | None) -> Old:
        """Of a library's folder; nothing where it cannot be used."""
        try:
            found, arrays = store.read_stored(folder)
            clips = store.stored_clips(found, arrays)
        except LibraryError:
            return cls()
        known = found.method == documents.method_digest() and found.fps == fps
        if not known or store.content_name(arrays) != found.data:
            return cls()
        places = {(row.sha256, row.mirrored): (n, clips[n]) for n, row in enumerate(found.clips)}
        return cls(found, arrays, places)

    def read(self, recording: Recording) -> Read | None:
        """What is known of a recording whose content has not changed; it is read again only if it must be."""
        if self.found is None or (recording.digest, False) not in self.clips:
            return None
        row = self.found.clips[self.clips[recording.digest, False][0]]
        return Read(recording, row.body, row.seconds, tuple(row.notes), lambda: read_recording(recording).load())


@dataclass
class Build:
    """One build: options, what there was before, and what went wrong."""

    mirror: bool
    fps: float | None
    workers: int
    step: Step
    old: Old
    problems: list[Problem] = field(default_factory=list[Problem])

    def of(self, recordings: Sequence[Recording]) -> tuple[Manifest, Arrays]:
        """Manifest and arrays of the library."""
        reads = self.read(recordings)
        body = main_body(reads)
        stage = Stage(next(read for read in reads if read.body == body))
        rows, clips, places = self.place(reads, stage)
        pairs = self.join(clips, places)
        graph = MotionGraph.of(_clip_of(clips), *pairs)
        arrays = store.arrays_of(clips, pairs, graph)
        found = Manifest(
            documents.method_digest(),
            self.mirror,
            self.fps,
            stage.reference,
            documents.Body.of(stage.skeleton),
            rows,
            self.problems,
            store.content_name(arrays),
        )
        self.step("done", 1.0)
        return found, arrays

    def read(self, recordings: Sequence[Recording]) -> list[Read]:
        """All that can be read."""
        reads: list[Read] = []
        for n, recording in enumerate(recordings):
            self.step(f"reading {recording.name}", READING * n / len(recordings))
            try:
                self._refuse_twin(recording, reads)
                reads.append(self.old.read(recording) or read_recording(recording))
            except LibraryError as error:
                self.problems.append(Problem(recording.file, recording.digest, str(error)))
        if not reads:
            worst = self.problems[0]
            count = "the only file" if len(recordings) == 1 else f"none of {len(recordings)} files"
            verb = "cannot be used" if len(recordings) == 1 else "can be used"
            raise LibraryError(f"{count} {verb}; {worst.file}: {worst.reason}")
        return reads

    def _refuse_twin(self, recording: Recording, reads: Sequence[Read]) -> None:
        for read in reads:
            if read.recording.digest == recording.digest:
                raise LibraryError(f"the same as {read.recording.file}")

    def place(self, reads: Sequence[Read], stage: Stage) -> tuple[list[documents.Clips], list[Clip], list[int]]:
        """Rows, clips and the place of each clip in the old library (-1 where it is new)."""
        rows: list[documents.Clips] = []
        clips: list[Clip] = []
        places: list[int] = []
        for source, read in enumerate(reads):
            self.step(f"placing {read.recording.name}", READING + (PLACING - READING) * source / len(reads))
            try:
                made, old = self._clips(read, source, stage)
                _refuse_take(made[0], clips)
            except (BodyError, LibraryError) as error:
                self.problems.append(Problem(read.recording.file, read.recording.digest, str(error)))
                continue
            rows += [_row(clip, read) for clip in made]
            clips += made
            places += old
        return rows, clips, places

    def _clips(self, read: Read, source: int, stage: Stage) -> tuple[list[Clip], list[int]]:
        kinds = (False, True) if self.mirror else (False,)
        old = [self.old.clips.get((read.recording.digest, mirrored)) for mirrored in kinds]
        if self.old.found is not None and self.old.found.reference == stage.reference and None not in old:
            kept = [pair for pair in old if pair is not None]
            return [renamed(clip, read.recording.name, source) for _, clip in kept], [place for place, _ in kept]
        made = stage.clips(read, source, mirror=self.mirror)
        return made, [-1] * len(made)

    def join(self, clips: Sequence[Clip], places: Sequence[int]) -> Pairs:
        """Close pairs of all clips: those between two old ones as they are, the others found now."""
        wanted = clip_pairs(
            [clip.poses for clip in clips],
            REACH,
            lambda a, b: not 0 <= places[a] <= places[b],
            workers=self.workers,
            step=lambda share: self.step("finding joins", PLACING + (1 - PLACING) * share),
        )
        kept = self._kept_pairs(clips, places)
        first, second = np.concatenate((kept[0], wanted[0])), np.concatenate((kept[1], wanted[1]))
        distance = np.concatenate((kept[2], wanted[2]))
        order = np.lexsort((second, first))
        return first[order], second[order], distance[order]

    def _kept_pairs(self, clips: Sequence[Clip], places: Sequence[int]) -> Pairs:
        """Pairs of the old library whose clips are both in this one, in the same order."""
        if self.old.found is None:
            return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0, np.float32)
        now = np.full(sum(row.poses for row in self.old.found.clips), -1, np.int64)
        old_starts = np.cumsum([0, *(row.poses for row in self.old.found.clips)])
        start = 0
        for clip, place in zip(clips, places, strict=True):
            if place >= 0:
                now[old_starts[place] : old_starts[place + 1]] = np.arange(start, start + len(clip.poses))
            start += len(clip.poses)
        first, second = now[self.old.arrays["first"]], now[self.old.arrays["second"]]
        keep = (first >= 0) & (second >= 0) & (first < second)
        return first[keep], second[keep], self.old.arrays["distance"][keep]


def _refuse_take(clip: Clip, clips: Sequence[Clip]) -> None:
    """Refuse a clip that moves as one already there, such as the same take in two formats: it would be seen twice."""
    for other in clips:
        size = min(len(clip.poses), len(other.poses))
        if other.mirrored or max(len(clip.poses), len(other.poses)) - size > SAME_LENGTH:
            continue
        one, two = clip.poses[:size], other.poses[:size]
        apart = float(np.median(np.linalg.norm(one - two, axis=1)))
        if apart < SAME_POSES and np.corrcoef(np.diff(one, axis=0).ravel(), np.diff(two, axis=0).ravel())[0, 1] > ALIKE:
            raise LibraryError(f"moves as {other.name} does, all along")


def _clip_of(clips: Sequence[Clip]) -> Ints:
    return np.repeat(np.arange(len(clips)), [len(clip.poses) for clip in clips])


def _row(clip: Clip, read: Read) -> documents.Clips:
    return documents.Clips(
        clip.name,
        clip.source,
        clip.mirrored,
        read.recording.file,
        read.recording.digest,
        read.body,
        read.seconds,
        list(read.notes),
        clip.motion.fps,
        len(clip.motion),
        len(clip.poses),
        len(clip.stops),
        len(clip.keyposes),
    )
