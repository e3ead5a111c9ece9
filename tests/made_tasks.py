"""Tasks for tests of engines: a module of its own, so that other processes can import it."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat.errors import LibraryError
from onbeat.moves.engine import Parts


class Block(NamedTuple):
    """Two groups by their numbers."""

    first: int
    second: int


def blocks(groups: int) -> list[Block]:
    return [Block(a, b) for a in range(groups) for b in range(a, groups)]


def product(block: Block, one: np.ndarray, two: np.ndarray) -> np.ndarray:
    return (one @ two.T).min(axis=0)


def slow_product(block: Block, one: np.ndarray, two: np.ndarray) -> np.ndarray:
    time.sleep(0.05)
    return product(block, one, two)


def group(number: int) -> np.ndarray:
    return np.random.default_rng(number).standard_normal((400, 60)).astype(np.float32)


PARTS = Parts[Block](lambda block: block, group)


def stored_group(place: tuple[str, int]) -> np.ndarray:
    """A group from a file; it is told beside it who read it."""
    path = Path(place[0])
    with path.with_suffix(".readers").open("a") as readers:
        print(os.getpid(), file=readers)
    return np.load(path)[place[1]]


def who(task: int) -> int:
    time.sleep(0.02)
    return os.getpid()


def broken_or_not(task: int) -> int:
    if task == 3:
        raise LibraryError("file 3 is broken")
    if task == 7:
        raise KeyError("seven")
    return task


def last_one_dies(task: int) -> int:
    if task == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    return task


def dies_once(flag: str) -> str:
    """Kill this worker, unless the file is there: then it was killed before."""
    path = Path(flag)
    if not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


def unsendable(task: int) -> object:
    return lambda: task
