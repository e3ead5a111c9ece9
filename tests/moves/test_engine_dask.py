"""A cluster gives what threads give, byte for byte, whoever dies and whatever its workers can see."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import made_tasks as made
from onbeat.errors import LibraryError, OnbeatError
from onbeat.moves.engine import Engine, EngineError, Parts, run
from onbeat.moves.engines import cluster as engine_cluster
from onbeat.moves.engines import dask as engine_dask

pytest.importorskip("distributed", reason="a cluster needs the extra [scale]")
psutil = pytest.importorskip("psutil")  # which distributed needs

if not hasattr(os, "fork"):
    pytest.skip("needs processes that are forked", allow_module_level=True)

# Schedulers and workers, each a process of its own, forked from one that has imported what they import.
NURSERY = """
import json, os, signal, sys
from distributed.cli import dask_scheduler, dask_worker
import made_tasks, onbeat.moves.engines.orders

children = []
for line in sys.stdin:
    kind, options = json.loads(line)
    pid = os.fork()
    if pid == 0:
        nowhere = os.open(os.devnull, os.O_RDWR)
        for handle in range(3):
            os.dup2(nowhere, handle)
        sys.argv = [f"dask-{kind}", *options]
        {"scheduler": dask_scheduler, "worker": dask_worker}[kind].main()
        os._exit(0)
    children.append(pid)
    print(pid, flush=True)
for pid in children:  # only now, so that their numbers are given to nobody else before
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
"""


@pytest.fixture(scope="module")
def nursery() -> Iterator[subprocess.Popen[str]]:
    """The process that schedulers and workers are forked from."""
    here = os.pathsep.join([str(Path(made.__file__).parent), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    environment = {**os.environ, "PYTHONPATH": here, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-c", NURSERY]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        yield process


@contextmanager
def started(nursery: subprocess.Popen[str], kind: str, *options: str) -> Iterator[int]:
    """A scheduler or a worker, by the number of its process."""
    assert nursery.stdin
    assert nursery.stdout
    print(json.dumps([kind, [*options, "--host", "127.0.0.1", "--no-dashboard"]]), file=nursery.stdin, flush=True)
    process = int(nursery.stdout.readline())
    try:
        yield process
    finally:
        kill(process)


def kill(process: int) -> None:
    """End a process at once; once more does nothing."""
    os.kill(process, signal.SIGKILL)


class Cluster:
    """A scheduler and its workers."""

    def __init__(self, nursery: subprocess.Popen[str], address: str, folder: Path) -> None:
        self.nursery, self.address, self.folder = nursery, address, folder
        self.engine = Engine.of(address)

    def worker(self) -> Any:
        """One more worker."""
        options = ["--nthreads", "1", "--no-nanny", "--local-directory", str(self.folder)]
        return started(self.nursery, "worker", self.address, *options)


@contextmanager
def scheduled(nursery: subprocess.Popen[str], folder: Path) -> Iterator[Cluster]:
    """A scheduler without workers."""
    card = folder / "scheduler.json"
    with started(nursery, "scheduler", "--port", "0", "--scheduler-file", str(card)) as scheduler:
        while not (card.exists() and card.stat().st_size):
            assert psutil.Process(scheduler).status() != psutil.STATUS_ZOMBIE, "the scheduler did not start"
            time.sleep(0.05)
        yield Cluster(nursery, json.loads(card.read_text())["address"], folder)


@pytest.fixture(scope="module")
def cluster(nursery: subprocess.Popen[str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A scheduler and two workers."""
    with scheduled(nursery, tmp_path_factory.mktemp("cluster")) as found, found.worker(), found.worker():
        yield found


def results(engine: Engine, groups: int = 6, parts: Parts[Any] = made.PARTS) -> dict[Any, bytes]:
    found: dict[Any, bytes] = {}
    run(
        made.blocks(groups), made.product, lambda block, it: found.__setitem__(block, it.tobytes()), engine, parts=parts
    )
    return found


def test_a_cluster_gives_the_bytes_of_threads_and_parts_go_to_workers_once(cluster: Cluster):
    calls: list[int] = []

    def get(number: int) -> np.ndarray:
        calls.append(number)
        return made.group(number)

    # no folder: nothing can be read over there, and a function of a function is not even sent
    assert results(cluster.engine, parts=Parts(lambda block: block, get)) == results(Engine())
    assert sorted(calls) == list(range(6))


def test_workers_that_see_the_folder_read_it_themselves(cluster: Cluster, tmp_path: Path):
    path = tmp_path / "groups.npy"
    np.save(path, np.array([made.group(number) for number in range(6)]))
    places = Parts[made.Block](
        lambda block: [(str(path), number) for number in block], made.stored_group, folder=tmp_path
    )
    assert results(cluster.engine, parts=places) == results(Engine())
    readers = path.with_suffix(".readers").read_text().split()
    assert str(os.getpid()) not in readers
    assert len(readers) <= 2 * 6, "each reads a part once"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["groups.npy", "groups.readers"]


def test_workers_that_do_not_see_the_folder_are_sent_parts(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    elsewhere = str(tmp_path / "on another machine" / ".run-1")
    monkeypatch.setattr(engine_dask, "marked", lambda folder: elsewhere)
    path = tmp_path / "groups.npy"
    np.save(path, np.array([made.group(number) for number in range(6)]))
    places = Parts[made.Block](lambda block: [(str(path), n) for n in block], made.stored_group, folder=tmp_path)
    assert results(cluster.engine, parts=places) == results(Engine())
    assert path.with_suffix(".readers").read_text().split() == 6 * [str(os.getpid())]


def test_a_worker_killed_midway_loses_nothing(cluster: Cluster):
    found: dict[Any, bytes] = {}
    with cluster.worker() as third, cluster.engine.crew() as crew:

        def done(block: made.Block, result: np.ndarray) -> None:
            assert block not in found
            found[block] = result.tobytes()
            if len(found) == 15:
                kill(third)

        crew.run(made.blocks(9), made.slow_product, done, parts=made.PARTS)
    assert found == results(Engine(), 9)


def test_errors_come_back_from_a_cluster(cluster: Cluster):
    good: dict[int, int] = {}
    bad: dict[int, OnbeatError] = {}
    with cluster.engine.crew() as crew:
        crew.run(range(6), made.broken_or_not, good.__setitem__, failed=bad.__setitem__)
        assert sorted(good) == [0, 1, 2, 4, 5]
        assert isinstance(bad[3], LibraryError)
        with pytest.raises(KeyError, match="seven") as caught:
            crew.run([7], made.broken_or_not, good.__setitem__)
    assert "in the task 7" in caught.value.__notes__[0]


def test_many_small_tasks_go_together(cluster: Cluster, monkeypatch: pytest.MonkeyPatch):
    orders: list[int] = []
    submit = engine_dask.DaskCrew._submit

    def counted(self: engine_dask.DaskCrew, numbers: tuple[int, ...]) -> None:
        orders.append(len(numbers))
        submit(self, numbers)

    monkeypatch.setattr(engine_dask.DaskCrew, "_submit", counted)
    found: dict[int, int] = {}
    with cluster.engine.crew() as crew:
        crew.run(range(-2000, 0), abs, found.__setitem__)
    assert found == {task: -task for task in range(-2000, 0)}
    assert sum(orders) >= 2000
    assert len(orders) < 400, "the first go alone, then ever more together"


def test_workers_of_another_version_are_refused(cluster: Cluster, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(engine_cluster, "_ours", lambda: "onbeat 9.9 (0123) with numpy 2")
    with pytest.raises(EngineError, match=r"^the worker tcp://.* has onbeat .*, this machine onbeat 9\.9 .* install"):
        cluster.engine.crew()


def test_a_worker_of_another_version_that_comes_later_is_refused(cluster: Cluster, monkeypatch: pytest.MonkeyPatch):
    with cluster.engine.crew() as crew:
        monkeypatch.setattr(engine_dask, "identity", lambda: "onbeat 9.9 (0123) with numpy 2")
        with pytest.raises(EngineError, match=r"a worker has onbeat .*, this machine onbeat 9\.9"):
            crew.run([1], abs, lambda *_: None)


def test_no_scheduler_is_told_in_a_line(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(engine_cluster, "CONNECT", 0.5)
    with pytest.raises(EngineError, match=r"^no scheduler answers at tcp://127\.0\.0\.1:1 .* start one .*$") as caught:
        Engine.of("tcp://127.0.0.1:1").crew()
    assert "\n" not in str(caught.value)


def test_a_cluster_that_loses_everything_is_told_and_does_not_hang(
    nursery: subprocess.Popen[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(engine_cluster, "PATIENCE", 1.0)
    monkeypatch.setattr(engine_dask, "PATIENCE", 1.0)
    monkeypatch.setattr(engine_dask, "LOOK", 0.3)
    monkeypatch.setattr(engine_dask, "FETCH", 1.0)
    with scheduled(nursery, tmp_path) as lonely:
        with pytest.raises(EngineError, match="no worker"):
            lonely.engine.crew()
        monkeypatch.setattr(engine_cluster, "PATIENCE", 120.0)
        with lonely.worker() as worker, pytest.raises(EngineError, match="no worker"):
            run(range(500), made.who, lambda *_: kill(worker), lonely.engine)
