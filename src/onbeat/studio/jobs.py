"""The queue of jobs: kept in the project, so many at a time, each in a process of its own that can be ended.

What waits is still waiting when the studio begins again, and what ran is run again: a job's process writes into a
folder of its own, and what it made is kept together with the news that it is done, or not at all.
"""

from __future__ import annotations

import asyncio
import contextlib
import shutil
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from msgspec.structs import replace

from onbeat.errors import OnbeatError
from onbeat.studio.crew import COMMAND, Worker
from onbeat.studio.events import Events
from onbeat.studio.outcomes import finish, give_up
from onbeat.studio.project import Project
from onbeat.studio.records import EMBEDDED_SONG, OVER, TROUPE, JobRecord
from onbeat.studio.tasks import Done, Progress, Task
from onbeat.studio.wire import JobItem, JobKind

OFTEN = 0.2
"""Seconds between two words about one job."""
KNOWN = 0.03
"""Share of a job from which on the time left is told."""
LATER = 5.0
"""Seconds after which a job is begun again that could not be kept, as on a full disk."""
TRIES = 3
"""Times that a job is begun which ends its studio each time."""
Orders = Callable[[JobItem, Path], Task]


class Jobs:
    """The jobs of a project.

    Parameters
    ----------
    project, events : see there.
    orders : says what the process of a job is to do, and where it is to write.
    workers : how many jobs run at once.
    command : what a job's process runs.
    """

    def __init__(
        self,
        project: Project,
        events: Events,
        orders: Orders,
        workers: int = 2,
        command: Sequence[str] = COMMAND,
    ) -> None:
        self._project, self._events, self._orders = project, events, orders
        self._workers, self._command = workers, command
        self._running: dict[str, asyncio.Task[None]] = {}
        self._crew: dict[str, Worker] = {}
        self._shown: dict[str, JobItem] = {}
        self._stopping = False

    def begin(self) -> None:
        """Go on with what is in the project; what ran when its studio ended waits again."""
        running = [r for r in self._project.document.jobs.values() if r.item.state == "running"]
        if running:
            with self._project.change() as document:
                for record in running:
                    document.jobs[record.item.id] = _again(record)
        for record in running:
            if record.begun >= TRIES:
                self._over(record.item.id, f"it was begun {record.begun} times, and each time the studio ended with it")
        self.look()

    def item(self, id: str) -> JobItem:
        """A job as it is now."""
        return self._shown.get(id, self._project.document.jobs[id].item)

    def all(self) -> list[JobItem]:
        """All jobs as they are now, in their order."""
        return [self.item(id) for id in self._project.document.jobs]

    def look(self) -> None:
        """Begin what can be begun."""
        records = self._project.document.jobs.values()
        for record in sorted(records, key=lambda record: record.item.of in (EMBEDDED_SONG, TROUPE)):  # the user's first
            if self._stopping or len(self._running) >= self._workers:
                return
            item = record.item
            if item.state == "waiting" and item.id not in self._running and self._is_ready(record):
                self._running[item.id] = asyncio.create_task(self._run(item.id))

    def cancel(self, id: str) -> JobItem:
        """End a job, whether it runs or waits; one that is over stays as it is."""
        item = self._project.document.jobs[id].item
        if item.state not in OVER:
            with self._project.change() as document:
                give_up(document, id, "cancelled", None)
            self._stop(id)
            self._say(self._project.document.jobs[id].item)
            self.look()
        return self.item(id)

    async def end(self) -> None:
        """End all processes; what they did is done again when the studio begins the next time."""
        self._stopping = True
        for task in list(self._running.values()):
            task.cancel()
        await asyncio.gather(*self._running.values(), return_exceptions=True)
        running = [r for r in self._project.document.jobs.values() if r.item.state == "running"]
        if running:
            with self._project.change() as document:
                for record in running:
                    document.jobs[record.item.id] = replace(_again(record), begun=0)  # it is not the job's fault

    def _is_ready(self, record: JobRecord) -> bool:
        """Whether all it needs is there; if that never will be, it fails."""
        document = self._project.document
        for need in record.needs:
            found = document.found(need)
            if found is None or found[1].state in ("failed", "cancelled"):
                what = "is gone" if found is None else f"could not be made: {found[1].error or 'it was cancelled'}"
                name = need if found is None else getattr(found[1], "name", need)
                self._over(record.item.id, f"{name!r}, which it needs, {what}")
                return False
            if found[1].state != "ready":
                return False
        return True

    async def _run(self, id: str) -> None:
        """Do one job, from its beginning to what comes of it."""
        scratch: Path | None = None
        if self._project.document.jobs[id].item.state != "waiting":  # it was cancelled before it began
            self._running.pop(id, None)
            return
        try:
            with self._project.change() as document:
                record = document.jobs[id]
                item = replace(record.item, state="running", share=0.0, message="beginning")
                document.jobs[id] = JobRecord(item, record.needs, record.begun + 1)
            self._say(item)
            scratch = self._project.scratch()
            done = await self._made(item, self._orders(item, scratch))
            if self._project.document.jobs[id].item.state == "running":
                finish(self._project, id, done, scratch)
                self._say(self._project.document.jobs[id].item)
        except OnbeatError as error:
            self._over(id, str(error))
        except Exception as error:  # a bug must not stop the queue
            self._over(id, f"the studio could not go on with it ({type(error).__name__}: {error})")
        finally:
            if scratch is not None:
                shutil.rmtree(scratch, ignore_errors=True)
            self._running.pop(id, None)
            self._shown.pop(id, None)
            if not self._stopping:
                asyncio.get_running_loop().call_later(self._pause(id), self.look)

    def _pause(self, id: str) -> float:
        """Seconds until the next job: none, but where not even the end of this one could be kept."""
        record = self._project.document.jobs.get(id)
        return 0.0 if record is None or record.item.state in OVER else LATER

    async def _made(self, item: JobItem, task: Task) -> Done:
        worker = self._crew[item.id] = Worker(task, self._command)
        began = told = time.monotonic()
        what = ""
        try:
            async with contextlib.aclosing(worker.work()) as words:
                async for said in words:
                    if isinstance(said, Done):
                        return said
                    now = time.monotonic()
                    if now - told >= OFTEN or said.message != what:
                        told, what = now, said.message
                        self._say(self._on_its_way(item, said, now - began))
        finally:
            del self._crew[item.id]
        raise AssertionError("a worker ends with a word")

    def _on_its_way(self, item: JobItem, said: Progress, seconds: float) -> JobItem:
        left = round(seconds * (1 - said.share) / said.share, 1) if KNOWN <= said.share < 1 else None
        return replace(item, share=round(said.share, 4), left_s=left, message=said.message)

    def _say(self, item: JobItem) -> None:
        self._shown[item.id] = item
        if item.state != "running":
            self._shown.pop(item.id)
        self._events.went_on(item)

    def _over(self, id: str, error: str) -> None:
        """A job has failed, if it was not ended otherwise meanwhile."""
        record = self._project.document.jobs.get(id)
        if record is None or record.item.state in OVER:
            return
        with contextlib.suppress(OnbeatError), self._project.change() as document:
            give_up(document, id, "failed", error)
        self._say(self._project.document.jobs[id].item)

    def _stop(self, id: str) -> None:
        if (worker := self._crew.get(id)) is not None:
            worker.kill()

    def add(self, kind: JobKind, of: str, title: str, needs: list[str]) -> JobItem:
        """A new job at the end of the queue, inside a change of the project; ``look`` begins it after that."""
        document = self._project.document
        item = JobItem(document.new_id("job"), kind, of, title, "waiting")
        document.jobs[item.id] = JobRecord(item, needs)
        return item


def _again(record: JobRecord) -> JobRecord:
    """A job as it waits again."""
    return JobRecord(
        replace(record.item, state="waiting", share=0.0, left_s=None, message=""), record.needs, record.begun
    )
