"""Papers done at the same time, each in a process of its own: what comes out is the same as one after the other."""

from __future__ import annotations

import multiprocessing
import signal
import traceback
import warnings
from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnContext
from multiprocessing.process import BaseProcess
from typing import NamedTuple

from onbeat.errors import OnbeatError
from onbeat.reproduce.paper import Step
from onbeat.reproduce.result import PaperResult

Job = Callable[[Step], PaperResult]
"""What is done in a process; it and what it holds are sent there."""


class _Said(NamedTuple):
    share: float
    what: str


class _Done(NamedTuple):
    result: PaperResult | None
    error: Exception | None
    noted: list[UserWarning]


def side_by_side(
    jobs: Mapping[str, Job], say: Callable[[str, float, str], None], workers: int
) -> dict[str, PaperResult]:
    """Do jobs by ``workers`` processes, in their order, and give their results by their names.

    What a job warns of is warned of here; its error ends all of them and is raised here.

    Raises
    ------
    OnbeatError
        If a process ends before its job does.
    """
    context = multiprocessing.get_context("spawn")
    waiting, running, results = list(jobs), dict[Connection, tuple[str, BaseProcess]](), dict[str, PaperResult]()
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                name = waiting.pop(0)
                pipe, process = _started(context, jobs[name])
                running[pipe] = name, process
            for pipe in wait(list(running)):
                assert isinstance(pipe, Connection)
                _hear(pipe, running, results, say)
    finally:
        for pipe, (_, process) in running.items():
            process.terminate()
            process.join()
            pipe.close()
    return results


def _started(context: SpawnContext, job: Job) -> tuple[Connection, BaseProcess]:
    ours, theirs = context.Pipe()
    process = context.Process(target=work, args=(job, theirs))
    process.start()
    theirs.close()
    return ours, process


def _hear(
    pipe: Connection,
    running: dict[Connection, tuple[str, BaseProcess]],
    results: dict[str, PaperResult],
    say: Callable[[str, float, str], None],
) -> None:
    """Take what a process says next; a result ends it."""
    name, process = running[pipe]
    try:
        told: _Said | _Done = pipe.recv()
    except (EOFError, OSError):
        raise OnbeatError(
            f"{name}: its process ended before it was done; perhaps memory was short: do one paper at a time"
        ) from None
    if isinstance(told, _Said):
        say(name, *told)
        return
    for warning in told.noted:
        warnings.warn(warning, stacklevel=2)
    if told.error is not None:
        raise told.error
    assert told.result is not None
    results[name] = told.result
    del running[pipe]
    process.join()
    pipe.close()


def work(job: Job, pipe: Connection) -> None:
    """Do a job and say over a pipe how far it is and what comes out; what a process runs."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", UserWarning)
        result, error = None, None
        try:
            result = job(lambda share, what: pipe.send(_Said(share, what)))
        except BrokenPipeError:  # nobody waits for it any more
            return
        except OnbeatError as raised:
            error = raised
        except Exception as raised:
            raised.add_note(traceback.format_exc())  # where it was is known in this process alone
            error = raised
    ours = [one.message for one in noted if one.category.__module__.split(".")[0] == "onbeat"]
    pipe.send(_Done(result, error, [one for one in ours if isinstance(one, UserWarning)]))
