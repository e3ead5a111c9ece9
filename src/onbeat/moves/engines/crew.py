"""What every engine has in common: tasks go out, a few for each worker at a time, and outcomes come back.

``done`` is called in the thread that called :meth:`Crew.run`, one outcome after the other as they come, so it may write
to an index; what it makes of them must not depend on their order.
"""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any, Generic, Self, TypeVar

from onbeat.errors import OnbeatError

Task = TypeVar("Task")
Result = TypeVar("Result")
IN_FLIGHT = 3
"""Tasks that are out for each worker: one in hand, the next at hand, one coming back."""
KEPT = 16
"""Parts that a worker keeps, the last it used; some MB each."""

_PIPE: Any = ForkingPickler  # what pipes between processes send with


class EngineError(OnbeatError):
    """Tasks that cannot be done where they were to be: no scheduler, no worker, workers of another version."""


@dataclass(frozen=True)
class Parts(Generic[Task]):
    """What tasks need beside themselves, such as the poses of two groups, and where workers find it.

    Parameters
    ----------
    needs : the keys of what a task needs; ``work`` is called with the task and these parts. Equal keys, equal parts.
    get : makes or maps the part of a key. It is called in the workers where they see ``folder``, else here, and what
        it gives is sent to them once.
    folder : the folder that ``get`` reads; without one a worker elsewhere is always sent its parts.
    """

    needs: Callable[[Task], Sequence[Hashable]]
    get: Callable[[Any], Any]
    folder: Path | None = None


@dataclass(frozen=True)
class Job:
    """What is told to a worker once: what to do with tasks, and how to get their parts."""

    work: Callable[..., Any]
    get: Callable[[Any], Any] | None = None


@dataclass(frozen=True)
class Outcome:
    """What came of a task: a value, or an error and where it was raised."""

    value: Any = None
    error: Exception | None = None
    trace: str = ""


@lru_cache(maxsize=1)
def part_of(get: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """``get``, which remembers the last parts it gave."""
    return lru_cache(maxsize=KEPT)(get)


def attempt(work: Callable[..., Any], task: Any, get: Callable[[Any], Any] | None, keys: Sequence[Hashable]) -> Outcome:
    """Do one task; its error is an outcome, too, in a form that can be sent."""
    try:
        return Outcome(work(task, *(part_of(get)(key) for key in keys)) if get else work(task))
    except Exception as error:
        return Outcome(error=portable(error), trace=traceback.format_exc())


def portable(error: Exception) -> Exception:
    """An error that another process can read: itself, or its words."""
    try:
        _PIPE.loads(_PIPE.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def name_of(task: object) -> str:
    """A task in few words, for messages.

    Examples
    --------
    >>> name_of("block 1, 2")
    'block 1, 2'
    """
    text = str(task)
    return text if len(text) <= 80 else text[:77] + "..."


class Crew(ABC):
    """Workers that are there for several runs, until the ``with`` statement ends."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def run(
        self,
        tasks: Iterable[Task],
        work: Callable[..., Result],
        done: Callable[[Task, Result], None],
        progress: Callable[[int], None] | None = None,
        *,
        failed: Callable[[Task, OnbeatError], None] | None = None,
        parts: Parts[Task] | None = None,
    ) -> None:
        """Do all tasks; see :func:`onbeat.moves.engine.run`."""
        self.begin(Job(work, parts.get if parts else None), parts.folder if parts else None)
        flight: dict[int, Task] = {}
        finish = partial(_finish, done=done, failed=failed)
        finished = 0
        needs = parts.needs if parts else _nothing
        try:
            for number, task in enumerate(tasks):
                while len(flight) >= self.window:
                    finished = self._take(flight, finish, finished, progress)
                flight[number] = task
                self.send(number, task, tuple(needs(task)))
            while flight:
                finished = self._take(flight, finish, finished, progress)
        except BaseException:
            self.drop()
            raise

    def _take(
        self,
        flight: dict[int, Any],
        finish: Callable[[Any, Outcome], None],
        finished: int,
        progress: Callable[[int], None] | None,
    ) -> int:
        number, outcome = self.receive()
        finish(flight.pop(number), outcome)
        if progress is not None:
            progress(finished + 1)
        return finished + 1

    @property
    @abstractmethod
    def window(self) -> int:
        """How many tasks may be out at once."""

    @abstractmethod
    def begin(self, job: Job, folder: Path | None) -> None:
        """Make ready for a run."""

    @abstractmethod
    def send(self, number: int, task: Any, keys: tuple[Hashable, ...]) -> None:
        """Give out a task."""

    @abstractmethod
    def receive(self) -> tuple[int, Outcome]:
        """Wait for an outcome."""

    @abstractmethod
    def drop(self) -> None:
        """Give up all that is out."""

    @abstractmethod
    def close(self) -> None:
        """Let the workers go, at once."""


def _nothing(_: object) -> Sequence[Hashable]:
    return ()


def _finish(
    task: Task,
    outcome: Outcome,
    done: Callable[[Task, Any], None],
    failed: Callable[[Task, OnbeatError], None] | None,
) -> None:
    """Hand an outcome on, or raise its error."""
    error = outcome.error
    if error is None:
        done(task, outcome.value)
    elif failed is not None and isinstance(error, OnbeatError) and not isinstance(error, EngineError):
        failed(task, error)
    else:
        if not isinstance(error, OnbeatError):
            error.add_note(f"in the task {name_of(task)}\n{outcome.trace}".rstrip())
        raise error
