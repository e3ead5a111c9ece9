"""Threads of this process as workers: nothing to start and nothing to send, the right engine for small builds."""

from __future__ import annotations

from collections.abc import Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from threadpoolctl import threadpool_limits

from onbeat.moves.engines.crew import IN_FLIGHT, Crew, Job, Outcome, attempt, part_of


class ThreadCrew(Crew):
    """Some threads, each with a single-threaded BLAS.

    Parameters
    ----------
    workers : how many.
    """

    def __init__(self, workers: int) -> None:
        self._workers = workers
        self._pool = ThreadPoolExecutor(workers, "onbeat")
        self._limits: threadpool_limits | None = None
        self._job = Job(attempt)
        self._out: list[Future[None]] = []
        self._back: SimpleQueue[tuple[int, Outcome]] = SimpleQueue()

    @property
    def window(self) -> int:
        """A few tasks for each thread."""
        return IN_FLIGHT * self._workers

    def begin(self, job: Job, folder: Path | None) -> None:
        """Make ready; the libraries that ``work`` uses are loaded by now."""
        self._release()
        self._limits = threadpool_limits(1, "blas")
        self._job, self._back = job, SimpleQueue()

    def send(self, number: int, task: Any, keys: tuple[Hashable, ...]) -> None:
        """Give out a task."""
        self._out = [future for future in self._out if not future.done()]
        self._out.append(self._pool.submit(self._do, number, task, keys))

    def _do(self, number: int, task: Any, keys: tuple[Hashable, ...]) -> None:
        self._back.put((number, attempt(self._job.work, task, self._job.get, keys)))

    def receive(self) -> tuple[int, Outcome]:
        """Wait for an outcome."""
        return self._back.get()

    def drop(self) -> None:
        """Cancel what has not begun, and wait for what has: a thread cannot be stopped."""
        for future in self._out:
            future.cancel()
        self._pool.shutdown(cancel_futures=True)
        self._pool = ThreadPoolExecutor(self._workers, "onbeat")

    def close(self) -> None:
        """End the threads, and give BLAS its own back."""
        self._pool.shutdown(cancel_futures=True)
        part_of.cache_clear()
        self._release()

    def _release(self) -> None:
        if self._limits is not None:
            self._limits.restore_original_limits()
            self._limits = None
