"""Making a library, step by step: read, place, sort out, find pairs, join; each step skips what is in stock."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field

from onbeat.errors import LibraryError
from onbeat.moves.disk.bodies import skeleton_text
from onbeat.moves.engine import Engine, run
from onbeat.moves.engines.crew import Crew
from onbeat.moves.graph import MotionGraph
from onbeat.moves.making.clips import main_body
from onbeat.moves.making.generations import Entry, Options
from onbeat.moves.making.placing import Place, Placed, Reading, batches, look, place, stage_of
from onbeat.moves.making.publish import Draft, Step, publish, rising
from onbeat.moves.making.stock import Row, Stock, is_whole
from onbeat.moves.making.taken import twin_recordings
from onbeat.moves.methods import method_digest, reading_method
from onbeat.moves.recordings import Recording

READING, PLACING, COMPARING = 0.1, 0.5, 0.52  # shares of a build's time at which each is done


def silent(what: str, share: float) -> None:
    """No progress is shown."""


@dataclass
class Making:
    """One build of a library.

    Parameters
    ----------
    stock : what there is, and where what is made goes.
    recordings : what it is made of, in order.
    options : of the build.
    engine, readers : where pairs are found, and where files are read.
    step : called with what is done now and the share of all done, 0…1.
    problems : number of a recording, and why it is left out.
    changed : numbers of recordings whose files were written to while they were read.
    """

    stock: Stock
    recordings: Sequence[Recording]
    options: Options
    engine: Engine
    readers: Engine
    step: Step = silent
    problems: dict[int, str] = field(default_factory=dict[int, str])
    changed: set[int] = field(default_factory=set[int])

    def make(self) -> MotionGraph | None:
        """Make the library and put it in the place of the one there is; the graph, if it is kept in memory."""
        self.step = rising(self.step)
        self._refuse_copies()
        with self.readers.crew() as crew:
            model = self._model(self._read(crew))
            stage = stage_of(model)
            name = hashlib.sha256(f"{self._method} {stage.reference}".encode()).hexdigest()[:32]
            self._place(model, name, crew)
        rows = self._sort_out({n: self._rows(self.recordings[n], name) for n in self._good()})
        members = [(n, row) for n, found in rows.items() for row in found]
        skeleton = skeleton_text(stage.skeleton)
        draft = Draft(method_digest(), self.options, self._method, name, skeleton, self._entries(), members)
        return publish(self.stock, draft, self.engine, self._then)

    @property
    def _method(self) -> str:
        """What the reading of a file depends on besides its content."""
        return f"{reading_method()} {self.options.fps}"

    def _good(self) -> list[int]:
        """Numbers of the recordings that are not left out; a ``LibraryError`` if there is none."""
        if len(self.problems) < len(self.recordings):
            return [n for n in range(len(self.recordings)) if n not in self.problems]
        file, reason = self.recordings[0].file, self.problems[0]
        if len(self.recordings) == 1:
            raise LibraryError(f"the only file cannot be used; {file}: {reason}")
        raise LibraryError(f"none of {len(self.recordings)} files can be used; {file}: {reason}")

    def _refuse_copies(self) -> None:
        seen: dict[str, str] = {}
        for number, recording in enumerate(self.recordings):
            if recording.digest in seen:
                self.problems[number] = f"the same as {seen[recording.digest]}"
            elif recording.digest:
                seen[recording.digest] = recording.file

    def _read(self, crew: Crew) -> dict[int, Reading]:
        """What reading each file gave, now or before."""
        numbers = {self.recordings[n].file: n for n in self._good()}
        known = {n: self.stock.reading(self.recordings[n].content, self._method) for n in numbers.values()}
        readings = {n: reading for n, reading in known.items() if reading is not None}
        missing = [self.recordings[n] for n, reading in known.items() if reading is None]

        def done(task: tuple[Recording, ...], found: tuple[Reading, ...]) -> None:
            self.stock.put_readings(found, self._method)
            readings.update((numbers[r.file], reading) for r, reading in zip(task, found, strict=True))
            self.step(f"reading {task[-1].name}", READING * len(readings) / len(numbers))

        self.step("reading", 0.0)
        run(batches(missing), look, done, crew)
        for number, reading in readings.items():
            self._note(number, reading.content, reading.problem)
        return {n: readings[n] for n in self._good()}

    def _note(self, number: int, content: str, problem: str | None) -> None:
        """Remember why a recording is left out."""
        if problem is not None:
            self.problems[number] = problem
            if content != self.recordings[number].content:
                self.changed.add(number)

    def _model(self, readings: dict[int, Reading]) -> Recording:
        """The first recording on the body that most of the motion is on."""
        body = main_body([(reading.body, reading.seconds) for reading in readings.values()])
        return next(self.recordings[n] for n, reading in readings.items() if reading.body == body)

    def _place(self, model: Recording, stage: str, crew: Crew) -> None:
        """Make the clips that are not in stock, or not as they were put there."""
        good = self._good()
        kinds = {False, True} if self.options.mirror else {False}
        rows = {n: self.stock.clips_of(self.recordings[n].content, stage) for n in good}
        damaged = self.stock.drop_damaged(row for found in rows.values() for row in found)
        missing: dict[str, int] = {}
        for n, found in rows.items():
            content = self.recordings[n].content
            if (known := self.stock.reading(content, stage)) is not None:
                self._note(n, content, known.problem)
            elif damaged & {row.content for row in found} or not is_whole(found, kinds):
                missing[content] = n
        count = 0

        def done(task: Place, placed: Placed) -> None:
            nonlocal count
            count += 1
            self.stock.put_clips(placed, stage)
            self._note(missing[task.recording.content], placed.content, placed.problem)
            self.step(f"placing {task.recording.name}", READING + (PLACING - READING) * count / len(missing))

        self.step("placing", READING)
        tasks = (Place(self.recordings[n], model, self.options.mirror) for n in missing.values())
        run(tasks, place, done, crew)

    def _rows(self, recording: Recording, stage: str) -> list[Row]:
        found = self.stock.clips_of(recording.content, stage)
        return [row for row in found if self.options.mirror or not row.shape.mirrored]

    def _sort_out(self, rows: dict[int, list[Row]]) -> dict[int, list[Row]]:
        """Leave out takes that are there already."""

        def step(share: float) -> None:
            self.step("comparing takes", PLACING + (COMPARING - PLACING) * share)

        step(0.0)
        for later, earlier in twin_recordings(self.stock, rows, step).items():
            self.problems[later] = f"moves as {self.recordings[earlier].name} does, all along"
        return {n: rows[n] for n in self._good()}

    def _entries(self) -> list[Entry]:
        return [
            Entry(r.file, r.name, "" if n in self.changed else r.content, *r.about, self.problems.get(n))
            for n, r in enumerate(self.recordings)
        ]

    def _then(self, what: str, share: float) -> None:
        """Progress of what follows."""
        self.step(what, COMPARING + (1 - COMPARING) * share)
