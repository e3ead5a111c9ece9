"""What more workers bring: blocks of pairs by threads, processes and a cluster on this machine, and the cost of a task.

Usage: ``python benchmarks/workers.py [--groups 8] [--frames 4096] [--no-cluster]``. Poses are made: walks at random, in
groups of so many frames; a task is the block of two groups. Each engine is run with one and with two workers, twice,
and the better time is shown with the machine's load before it: on a busy machine the ratio says little. All must give
the same bytes. The cost of a task is that of a run of 2,000 which do nothing.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np

import workers  # this file under the name by which other processes can import it
from onbeat.moves.engine import Crew, Engine, Parts
from onbeat.moves.pairs.blocks import Group
from onbeat.moves.similarity import block_pairs

WIDTH, CLIPS = 60, 4
LIMIT = 4.5
BEGIN = "import sys; from distributed.cli.dask_{0} import main; sys.argv[0] = 'dask-{0}'; main()"


def made_group(key: tuple[int, int]) -> Group:
    """A group of random walks in a pose space, smooth as movement is."""
    seed, frames = key
    walk = np.random.default_rng(seed).standard_normal((frames, WIDTH)).astype(np.float32)
    walk = np.cumsum(walk * np.float32(0.05), axis=0, dtype=np.float32)
    clip_of = np.repeat(np.arange(CLIPS), -(-frames // CLIPS))[:frames]
    return Group(np.sin(walk).astype(np.float32), clip_of)


def search(task: tuple[tuple[int, int], tuple[int, int]], a: Group, b: Group) -> bytes:
    """A digest of the pairs of a block."""
    total = hashlib.sha256()
    for array in block_pairs(a, a if task[0] == task[1] else b, LIMIT):
        total.update(np.ascontiguousarray(array).tobytes())
    return total.digest()


def timed(crew: Crew, groups: int, frames: int) -> tuple[float, str]:
    """Seconds for all blocks, and a digest of what they gave."""
    keys = [(seed, frames) for seed in range(groups)]
    tasks = [(a, b) for n, a in enumerate(keys) for b in keys[n:]]
    found: dict[object, bytes] = {}
    begin = time.perf_counter()
    crew.run(tasks, workers.search, found.__setitem__, parts=Parts(lambda task: task, workers.made_group))
    took = time.perf_counter() - begin
    return took, hashlib.sha256(b"".join(found[task] for task in tasks)).hexdigest()[:12]


def cost(crew: Crew, tasks: int = 2000) -> float:
    """Seconds for each of many tasks that do nothing."""
    crew.run(range(20), abs, lambda *_: None)
    begin = time.perf_counter()
    crew.run(range(tasks), abs, lambda *_: None)
    return (time.perf_counter() - begin) / tasks


@contextmanager
def started(kind: str, *options: str) -> Iterator[None]:
    """A scheduler or a worker of a cluster, in a process of its own."""
    command = [sys.executable, "-c", BEGIN.format(kind), *options, "--host", "127.0.0.1", "--no-dashboard"]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent), "OPENBLAS_NUM_THREADS": "1"}
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    try:
        yield
    finally:
        process.terminate()
        process.wait()


@contextmanager
def cluster(count: int) -> Iterator[Engine]:
    """A scheduler and some workers on this machine."""
    from distributed import Client

    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        card = Path(folder, "scheduler.json")
        stack.enter_context(started("scheduler", "--port", "0", "--scheduler-file", str(card)))
        while not (card.exists() and card.stat().st_size):
            time.sleep(0.05)
        address = json.loads(card.read_text())["address"]
        for _ in range(count):
            stack.enter_context(
                started("worker", address, "--nthreads", "1", "--no-nanny", "--local-directory", folder)
            )
        with Client(address, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=60)
        yield Engine.of(address)


@contextmanager
def local(engine: Engine) -> Iterator[Engine]:
    """An engine that needs nothing started."""
    yield engine


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", type=int, default=8)
    parser.add_argument("--frames", type=int, default=4096)
    parser.add_argument("--no-cluster", action="store_true")
    given = parser.parse_args()
    kinds = {
        "threads": lambda count: local(Engine(workers=count)),
        "processes": lambda count: local(Engine("processes", count)),
        "cluster": cluster,
    }
    pairs = (given.groups * given.frames) ** 2 / 2
    print(f"{given.groups} groups of {given.frames} frames, {os.cpu_count()} cores")
    print("| engine | workers | s | load before | ns a pair | against 1 | ms a task | bytes |")
    print("|---|---|---|---|---|---|---|---|")
    for kind, begin in kinds.items():
        if kind == "cluster" and given.no_cluster:
            continue
        one = 0.0
        for count in (1, 2):
            with begin(count) as engine, engine.crew() as crew:
                timed(crew, 2, 256)  # compiled and imported
                load = os.getloadavg()[0]
                took, digest = min(timed(crew, given.groups, given.frames) for _ in range(2))
                one = one or took
                each = 1e3 * cost(crew)
            row = f"{took:.2f} | {load:.1f} | {1e9 * took / pairs:.1f} | {one / took:.2f} × | {each:.3f}"
            print(f"| {kind} | {count} | {row} | {digest} |", flush=True)


if __name__ == "__main__":
    main()
