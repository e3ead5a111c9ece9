"""A cluster as workers: a scheduler of dask.distributed that somebody started (docs/cluster.md).

Nothing large goes through the scheduler: workers that see the library's folder map their parts themselves, others are
sent each part once, straight from here; outcomes come straight from the workers. What a worker that died had in hand or
had not delivered is done again elsewhere, by the scheduler; parts that were lost with it are sent again, by us.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections import deque
from collections.abc import Hashable
from itertools import count
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from onbeat.moves.engines.cluster import CONNECT, PATIENCE, alone, connected, marked, words
from onbeat.moves.engines.crew import IN_FLIGHT, Crew, EngineError, Job, Outcome, attempt, name_of
from onbeat.moves.engines.orders import Answer, Order, do_order, identity

TRIES = 10
"""How often a task is given out again for lost parts or a lost scheduler."""
SHORT, LONG = 0.2, 1.0
"""Seconds of work in an order: shorter ones are given more tasks, longer ones fewer."""
MOST = 64
"""Tasks in an order at most."""
FETCH = 20.0
"""Seconds after which an outcome that does not come from its worker is waited for anew."""
LOOK = 2.0  # s between looks at what has become of the cluster

_NONE: tuple[Any, tuple[int, ...]] = (None, ())


class DaskCrew(Crew):
    """The workers of a scheduler, as many as there are at each moment.

    Parameters
    ----------
    address : of the scheduler.
    """

    def __init__(self, address: str) -> None:
        self._address = address
        self._client = connected(address)
        self._job, self._mark, self._sending = Job(attempt), "", False
        self._names = count()
        self._tasks: dict[int, tuple[Any, tuple[Hashable, ...]]] = {}
        self._tries: dict[int, int] = {}
        self._waiting: list[int] = []
        self._out: dict[str, tuple[Any, tuple[int, ...]]] = {}
        self._sent: dict[Hashable, Any] = {}
        self._back: SimpleQueue[Any] = SimpleQueue()
        self._ready: deque[tuple[int, Outcome]] = deque()
        self._size = 1
        self._threads, self._looked, self._last_seen = 1, -LOOK, time.monotonic()

    @property
    def window(self) -> int:
        """A few orders for each thread of a worker that is there now."""
        if time.monotonic() - self._looked > LOOK:
            self._look()
        return IN_FLIGHT * max(self._threads, 2) * self._size

    def _look(self) -> None:
        """See which workers there are; an ``EngineError`` if there have been none for long."""
        with contextlib.suppress(OSError, TimeoutError, AttributeError, ValueError):  # while it connects again
            self._threads = sum(self._client.nthreads().values()) if self._client.status == "running" else 0
        self._looked = now = time.monotonic()
        if self._client.status in ("closed", "closing"):
            raise EngineError(f"the scheduler at {self._address} has gone; start it again (what is done is kept)")
        if self._threads:
            self._last_seen = now
        elif now - self._last_seen > PATIENCE:
            raise alone(self._address)

    def begin(self, job: Job, folder: Path | None) -> None:
        """Make ready for a run."""
        self._end()
        self._job, self._size, self._last_seen = job, 1, time.monotonic()
        self._mark = marked(folder) if folder is not None else ""
        self._sending = job.get is not None and not self._mark

    def send(self, number: int, task: Any, keys: tuple[Hashable, ...]) -> None:
        """Give out a task, together with some others."""
        self._tasks[number] = task, keys
        self._waiting.append(number)
        if len(self._waiting) >= self._size:
            self._flush()

    def _flush(self) -> None:
        numbers, self._waiting = self._waiting, []
        if numbers:
            self._submit(tuple(numbers))

    def _submit(self, numbers: tuple[int, ...]) -> None:
        tasks = tuple(self._tasks[number] for number in numbers)
        keys = tuple(dict.fromkeys(key for _, keys in tasks for key in keys)) if self._sending else ()
        job = Job(self._job.work) if self._sending else self._job
        order = Order(job, tasks, identity(), self._mark, keys, self._sending)
        name = f"onbeat-{os.getpid()}-{self._client.id}-{next(self._names)}"
        future = self._client.submit(do_order, order, [self._part(key) for key in keys], key=name, pure=False)
        self._await(future, numbers)

    def _await(self, future: Any, numbers: tuple[int, ...]) -> None:
        self._out[future.key] = future, numbers
        future.add_done_callback(self._back.put)  # called in a thread of dask

    def _part(self, key: Hashable) -> Any:
        """The name of a part that is on some worker, sent there now if need be."""
        known = self._sent.get(key)
        if known is None or known.status != "finished":
            assert self._job.get is not None
            known = self._sent[key] = self._scattered(self._job.get(key))
        return known

    def _scattered(self, part: Any) -> Any:
        """Send a part to a worker; tried again, for the worker may go just now."""
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                return self._client.scatter([part], hash=False)[0]
            except (OSError, TimeoutError):
                self._look()
                if time.monotonic() > deadline:
                    raise alone(self._address) from None
                time.sleep(0.2)

    def receive(self) -> tuple[int, Outcome]:
        """Wait for an outcome; what was lost on the way is given out again."""
        while not self._ready:
            if len(self._out) < IN_FLIGHT * self._threads:
                self._flush()
            try:
                future = self._back.get(timeout=LOOK)
            except Empty:
                self._look()
                continue
            known, numbers = self._out.pop(future.key, _NONE)
            if known is future:
                self._open(future, numbers)
        number, outcome = self._ready.popleft()
        del self._tasks[number]
        self._tries.pop(number, None)
        return number, outcome

    def _open(self, future: Any, numbers: tuple[int, ...]) -> None:
        """Take what a future holds, or give its tasks out again."""
        if future.status == "error":
            self._failed(numbers, future.exception())
            return
        try:
            answer: Answer = future.result(timeout=FETCH)
        except TimeoutError:  # its worker died before it was delivered: it is done again elsewhere
            self._look()
            self._await(future, numbers)
            return
        except Exception:  # it was lost: cancelled with its parts, or with the scheduler
            self._again(numbers, pause=0.2)
            return
        if answer.unseen:
            self._sending = True
            self._again(numbers)
            return
        self._ready.extend(zip(numbers, answer.outcomes, strict=True))
        if answer.seconds < SHORT and len(numbers) == self._size:
            self._size = min(2 * self._size, MOST)
        elif answer.seconds > LONG:
            self._size = max(self._size // 2, 1)

    def _again(self, numbers: tuple[int, ...], pause: float = 0.0) -> None:
        for number in numbers:
            self._tries[number] = self._tries.get(number, 0) + 1
        if max(self._tries[number] for number in numbers) > TRIES:
            self._failed(numbers[:1], RuntimeError(f"lost {TRIES} times"))
            numbers = numbers[1:]
        time.sleep(pause)
        deadline = time.monotonic() + PATIENCE
        while self._client.status == "connecting" and time.monotonic() < deadline:
            time.sleep(0.2)
        self._look()
        if numbers:
            self._submit(numbers)

    def _failed(self, numbers: tuple[int, ...], error: BaseException) -> None:
        """A task that the workers cannot do; of several each is tried for itself, to know which it is."""
        if len(numbers) != 1:
            for number in numbers:
                self._submit((number,))
            return
        task = name_of(self._tasks[numbers[0]][0])
        failure = EngineError(
            f"the workers at {self._address} could not do {task} ({type(error).__name__}: {words(error)}); if they "
            "ran out of memory use fewer on each machine"
        )
        self._ready.append((numbers[0], Outcome(error=failure)))

    def drop(self) -> None:
        """Give up all that is out; what workers have begun they end, and nobody hears of it."""
        with contextlib.suppress(Exception):
            self._client.cancel([future for future, _ in self._out.values()], force=True)
        self._end()

    def _end(self) -> None:
        for things in (self._tasks, self._tries, self._waiting, self._out, self._ready, self._sent):
            things.clear()
        if self._mark:
            with contextlib.suppress(OSError):
                os.unlink(self._mark)
            self._mark = ""

    def close(self) -> None:
        """Let go of the cluster; its workers stay for others."""
        self._end()
        with contextlib.suppress(Exception):
            self._client.close(timeout=CONNECT)
