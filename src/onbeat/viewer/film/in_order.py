"""Things made one by one by several threads, and handed out in order: what comes out is the same with any number."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Made = TypeVar("Made")

MOST = 8
"""Threads at most: more would only wait for the one that takes what they make."""


def usable_cores() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_order(count: int, make: Callable[[int], Made], threads: int | None = None) -> Generator[Made]:
    """What ``make`` makes of 0, 1, … ``count`` - 1, in that order, a few made ahead by threads.

    Worth it where ``make`` lets other threads run, as compiled code does. Memory holds two for each thread.

    Parameters
    ----------
    count : how many.
    make : called in any order; what it raises is raised where its turn comes.
    threads : how many; as many as there are processors, and no more than ``MOST``, without it.

    Examples
    --------
    >>> list(in_order(4, lambda number: number * number, threads=3))
    [0, 1, 4, 9]
    """
    many = max(1, min(usable_cores(), MOST) if threads is None else threads)
    pool = ThreadPoolExecutor(many, "film")
    ahead: deque[Future[Made]] = deque()
    try:
        for number in range(count + 2 * many):
            if number < count:
                ahead.append(pool.submit(make, number))
            if ahead and number >= 2 * many - 1:
                yield ahead.popleft().result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
