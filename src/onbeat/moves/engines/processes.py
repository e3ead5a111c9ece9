"""Processes of this machine as workers, for work that holds Python's lock, such as reading files.

Each worker is a process and a thread here that talks with it over a pipe. A process is started when there is a task for
it; it ends when its pipe does, so nothing is left running whatever happens to this process.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
from collections.abc import Hashable
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any, NamedTuple

from threadpoolctl import threadpool_limits

from onbeat.moves.engines.crew import IN_FLIGHT, Crew, EngineError, Job, Outcome, attempt, name_of, portable

TRIES = 3
"""How many processes a task may take down with it before it is given up."""


class _Order(NamedTuple):
    job: Job
    number: int
    task: Any
    keys: tuple[Hashable, ...]


def serve(pipe: Connection) -> None:
    """Do tasks until the pipe ends; what a worker process runs."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    job: Job | None = None
    while True:
        try:
            told, task, keys = pipe.recv()
        except (EOFError, OSError):
            return
        except Exception as error:  # such as work that this process cannot import
            pipe.send(Outcome(error=portable(error)))
            continue
        if told is not None:
            job = told
            threadpool_limits(1)
        assert job is not None
        with contextlib.suppress(BrokenPipeError):  # nobody waits for it any more
            _answer(pipe, attempt(job.work, task, job.get, keys))


def _answer(pipe: Connection, outcome: Outcome) -> None:
    try:
        pipe.send(outcome)
    except OSError:
        raise
    except Exception as error:  # a result that cannot be sent
        pipe.send(Outcome(error=portable(error)))


class _Hand(Thread):
    """One worker's process, and the thread that talks with it."""

    def __init__(self, orders: SimpleQueue[_Order | None], back: SimpleQueue[tuple[int, Outcome]]) -> None:
        super().__init__(name="onbeat", daemon=True)
        self._orders, self._back = orders, back
        self._lock, self._stopped = Lock(), False
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._told: Job | None = None

    def run(self) -> None:
        """Take orders until there are no more."""
        if hasattr(signal, "pthread_sigmask"):  # a process that is being started is not to hear Ctrl-C
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        while (order := self._orders.get()) is not None:
            self._back.put((order.number, self._do(order)))

    def _do(self, order: _Order) -> Outcome:
        ended = "stopped"
        for _ in range(TRIES):
            try:
                return self._ask(order)
            except (EOFError, OSError) as error:
                ended = self._bury() or str(error)
            except Exception as error:  # such as a task that cannot be sent
                return Outcome(error=portable(error))
            if self._stopped:
                break
        return Outcome(error=_given_up(order.task, ended))

    def _ask(self, order: _Order) -> Outcome:
        pipe = self._ready()
        pipe.send((order.job if order.job is not self._told else None, order.task, order.keys))
        outcome = pipe.recv()
        self._told = order.job
        return outcome

    def _ready(self) -> Connection:
        """The pipe of a process that is there, started now if need be."""
        with self._lock:
            if self._stopped:
                raise EOFError
            if self._process is None or self._pipe is None:
                context = multiprocessing.get_context(
                    "spawn"
                )  # not forked: threads of BLAS and numba do not survive it
                self._pipe, far = context.Pipe()
                self._process = process = context.Process(target=serve, args=(far,), name="onbeat", daemon=True)
                process.start()
                far.close()
            return self._pipe

    def _bury(self) -> str:
        """Forget a process that ended; how it did."""
        with self._lock:
            process, self._process, self._told = self._process, None, None
            if self._pipe is not None:
                self._pipe.close()
                self._pipe = None
        if process is None or process.pid is None:
            return ""
        process.kill()
        process.join()
        code = process.exitcode or 0
        return f"signal {-code}" if code < 0 else f"exit code {code}"

    def stop(self) -> None:
        """Kill the process: a task has no effect but its outcome."""
        with self._lock:
            self._stopped = True
            if self._process is not None and self._process.pid is not None:
                self._process.kill()

    def gone(self) -> None:
        """Wait until nothing is left of it."""
        self.join()
        self._bury()


def _given_up(task: object, ended: str) -> EngineError:
    return EngineError(
        f"the worker process that did {name_of(task)} ended {TRIES} times ({ended}); if memory is short use fewer "
        "--workers, and let a script of your own begin with `if __name__ == '__main__':`"
    )


class ProcessCrew(Crew):
    """Some processes, each with a single-threaded BLAS.

    Parameters
    ----------
    workers : how many at most.
    """

    def __init__(self, workers: int) -> None:
        self._workers = workers
        self._hands: list[_Hand] = []
        self._orders: SimpleQueue[_Order | None] = SimpleQueue()
        self._back: SimpleQueue[tuple[int, Outcome]] = SimpleQueue()
        self._job = Job(attempt)

    @property
    def window(self) -> int:
        """A few tasks for each process."""
        return IN_FLIGHT * self._workers

    def begin(self, job: Job, folder: Path | None) -> None:
        """Make ready; processes that are there stay."""
        self._job = job
        while len(self._hands) < self._workers:
            self._hands.append(_Hand(self._orders, self._back))
            self._hands[-1].start()

    def send(self, number: int, task: Any, keys: tuple[Hashable, ...]) -> None:
        """Give out a task."""
        self._orders.put(_Order(self._job, number, task, keys))

    def receive(self) -> tuple[int, Outcome]:
        """Wait for an outcome."""
        return self._back.get()

    def drop(self) -> None:
        """Kill the processes; the next run starts others."""
        for hand in self._hands:
            hand.stop()
        while not self._orders.empty():
            self._orders.get()
        for _ in self._hands:
            self._orders.put(None)
        for hand in self._hands:
            hand.gone()
        self._hands, self._orders, self._back = [], SimpleQueue(), SimpleQueue()

    def close(self) -> None:
        """Kill the processes."""
        self.drop()
