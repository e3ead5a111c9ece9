"""What a cluster's worker is told and what it answers: some tasks at once, so that small ones do not wait for messages.

This runs on the workers, whose onbeat may be another and who may not see the library's folder: both are told.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from onbeat.errors import OnbeatError
from onbeat.moves.engines.crew import EngineError, Job, Outcome, attempt, part_of
from onbeat.moves.methods import method_digest


@dataclass(frozen=True)
class Order:
    """Some tasks for one worker; no tuple, for dask looks into those.

    Parameters
    ----------
    job : what to do with them.
    tasks : each with the keys of its parts.
    code : ``identity`` of the machine that gives it out.
    mark : a file of this run in the library's folder; "" without one.
    keys : of the parts that are sent with it.
    sending : whether they are.
    """

    job: Job
    tasks: tuple[tuple[Any, tuple[Hashable, ...]], ...]
    code: str
    mark: str = ""
    keys: tuple[Hashable, ...] = ()
    sending: bool = False


@dataclass(frozen=True)
class Answer:
    """The outcomes of an order's tasks, and how long they took, s; or that its parts are not to be had there."""

    outcomes: tuple[Outcome, ...]
    seconds: float = 0.0
    unseen: bool = False


@dataclass(frozen=True)
class _Getter:
    """``get`` of one run, equal however often it was sent: what it gave is remembered from order to order."""

    mark: str
    get: Callable[[Any], Any] = field(compare=False)

    def __call__(self, key: Any) -> Any:
        return self.get(key)


@lru_cache(maxsize=1)
def identity() -> str:
    """What must be equal on all machines for equal bytes: versions and digest of the code that makes libraries."""
    return f"onbeat {version('onbeat')} ({method_digest()}) with numpy {np.__version__}"


def refusal(who: str, theirs: str, ours: str) -> EngineError:
    """The error that code differs."""
    return EngineError(
        f"{who} has {theirs}, this machine {ours}; install the same on all of them and start the workers again"
    )


def do_order(order: Order, sent: list[Any]) -> Answer:
    """Do some tasks."""
    if order.code != identity():
        error = refusal("a worker", identity(), order.code)
        return Answer(tuple(Outcome(error=error) for _ in order.tasks))
    _one_thread(order.job.work)
    get = _way(order, sent)
    if get is not None and not _can(get, order):
        return Answer((), unseen=True)
    begin = time.monotonic()
    outcomes = tuple(attempt(order.job.work, task, get, keys) for task, keys in order.tasks)
    return Answer(outcomes, time.monotonic() - begin)


def _way(order: Order, sent: list[Any]) -> Callable[[Any], Any] | None:
    """How to get parts: those that were sent, or as the job says."""
    if order.sending:
        return dict(zip(order.keys, sent, strict=True)).__getitem__
    return None if order.job.get is None else _Getter(order.mark, order.job.get)


def _can(get: Callable[[Any], Any], order: Order) -> bool:
    """Whether all parts can be had here."""
    if order.sending:
        return True
    if not _sees(order.mark):
        return False
    try:
        for _, keys in order.tasks:
            for key in keys:
                part_of(get)(key)
    except (OSError, OnbeatError):  # a folder that lags behind
        return False
    return True


@lru_cache(maxsize=16)
def _one_thread(work: Callable[..., Any]) -> None:
    """One thread for BLAS once for all, after ``work`` was imported and with it the libraries it uses."""
    threadpool_limits(1, "blas")


@lru_cache(maxsize=16)
def _sees(mark: str) -> bool:
    """Whether the file that marks this run is there, and with it the library's folder."""
    return bool(mark) and Path(mark).is_file()
