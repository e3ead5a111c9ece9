"""Where the tasks of a build are done: in threads, in processes of this machine, or on a cluster (docs/cluster.md)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal, TypeVar

from onbeat.errors import OnbeatError
from onbeat.moves.engines.crew import Crew, EngineError, Parts
from onbeat.moves.engines.dask import DaskCrew
from onbeat.moves.engines.local import ThreadCrew
from onbeat.moves.engines.processes import ProcessCrew

Task = TypeVar("Task")
Result = TypeVar("Result")
MOST = 512
"""Workers on one machine at most."""


@dataclass(frozen=True)
class Engine:
    """An engine, not yet running.

    Parameters
    ----------
    kind : what the workers are.
    workers : how many, of threads and processes.
    address : of the scheduler of a cluster.
    """

    kind: Literal["threads", "processes", "cluster"] = "threads"
    workers: int = 2
    address: str = ""

    @classmethod
    def of(cls, where: str | int | None = None) -> Engine:
        """The engine that a user names: nothing for threads, a number of processes, or a scheduler's address.

        Raises
        ------
        EngineError
            If it is neither a number from 1 to 512 nor an address.

        Examples
        --------
        >>> Engine.of(), Engine.of(4).kind, Engine.of("tcp://host:8786").kind
        (Engine(kind='threads', workers=2, address=''), 'processes', 'cluster')
        """
        if where is None:
            return cls()
        if isinstance(where, int):
            if not 1 <= where <= MOST:
                raise EngineError(f"{where} workers cannot be; give a number from 1 to {MOST}")
            return cls("processes", where)
        if re.fullmatch(r"(tcp|tls)://([\w.-]+|\[[0-9a-fA-F:.]+\]):\d{1,5}", where) is None:
            raise EngineError(f"{where!r} is no address of a scheduler; give one such as tcp://host:8786")
        return cls("cluster", 0, where)

    def crew(self) -> Crew:
        """Its workers, for the runs of one build: ``with engine.crew() as crew: run(..., crew)``.

        Raises
        ------
        EngineError
            If there is no scheduler at the address, it has no workers, or they are of another version of onbeat.
        MissingExtraError
            If a cluster is asked for and the extra ``[scale]`` is not installed.
        """
        if self.kind == "cluster":
            return DaskCrew(self.address)
        return ThreadCrew(self.workers) if self.kind == "threads" else ProcessCrew(self.workers)


def run(
    tasks: Iterable[Task],
    work: Callable[..., Result],
    done: Callable[[Task, Result], None],
    engine: Engine | Crew | None = None,
    progress: Callable[[int], None] | None = None,
    *,
    failed: Callable[[Task, OnbeatError], None] | None = None,
    parts: Parts[Task] | None = None,
) -> None:
    """Do all tasks, in any order and, where a worker died, more than once; each is done with once.

    Only a few tasks for each worker are taken from ``tasks`` ahead of their outcomes, so there may be millions.

    Parameters
    ----------
    tasks : what is to be done; small, and for other engines than threads such that they can be sent. ``str`` of a task
        is its name in messages.
    work : a function of a module, pure: called with a task and, if ``parts`` are given, what it needs of them.
    done : called here, in this thread, with each task and its result, in no certain order.
    engine : where; two threads if nothing is said. A crew is used as it is and stays.
    progress : called with the number of tasks that are done.
    failed : called with a task and its ``OnbeatError``, such as that of a broken file; without it this is raised.
    parts : what tasks need beside themselves.

    Raises
    ------
    EngineError
        If there is no worker left, or a task ended its worker several times.
    Exception
        Of the first task that fails otherwise, with the task's name in its notes; nothing is left running.

    Examples
    --------
    >>> squares = {}
    >>> run([1, 2, 3], lambda n: n * n, squares.__setitem__)
    >>> sorted(squares.items())
    [(1, 1), (2, 4), (3, 9)]
    """
    if isinstance(engine, Crew):
        engine.run(tasks, work, done, progress, failed=failed, parts=parts)
        return
    with (engine or Engine()).crew() as crew:
        crew.run(tasks, work, done, progress, failed=failed, parts=parts)
