"""Tasks are all done, each once, wherever; errors come back with their task, and nothing is left running."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import made_tasks as made
from onbeat.errors import LibraryError, OnbeatError
from onbeat.moves.engine import Crew, Engine, EngineError, run

TESTS = Path(made.__file__).parent


@pytest.fixture(scope="module", params=[Engine(), Engine("processes", 2)], ids=["threads", "processes"])
def crew(request: pytest.FixtureRequest) -> Iterator[Crew]:
    with request.param.crew() as crew:
        yield crew


def children() -> set[int]:
    """The worker processes of this one that live."""
    return {process.pid or 0 for process in multiprocessing.active_children()}


def test_each_task_is_done_once_with_its_parts(crew: Crew):
    found: list[tuple[made.Block, np.ndarray]] = []
    counts: list[int] = []
    crew.run(made.blocks(5), made.product, lambda *pair: found.append(pair), counts.append, parts=made.PARTS)
    assert sorted(block for block, _ in found) == made.blocks(5)
    assert counts == list(range(1, 16))
    for block, result in found:
        expected = made.product(block, made.group(block.first), made.group(block.second))
        assert result.tobytes() == expected.tobytes()


def test_a_broken_file_is_a_result_where_asked_for(crew: Crew):
    good: dict[int, int] = {}
    bad: dict[int, OnbeatError] = {}
    crew.run(range(6), made.broken_or_not, good.__setitem__, failed=bad.__setitem__)
    assert sorted(good) == [0, 1, 2, 4, 5]
    assert {task: str(error) for task, error in bad.items()} == {3: "file 3 is broken"}
    with pytest.raises(LibraryError, match="file 3"):
        crew.run(range(6), made.broken_or_not, good.__setitem__)


def test_other_errors_stop_the_run_and_name_the_task(crew: Crew):
    with pytest.raises(KeyError, match="seven") as caught:
        crew.run([7], made.broken_or_not, lambda *_: None)
    assert "in the task 7" in caught.value.__notes__[0]
    assert "broken_or_not" in caught.value.__notes__[0], "where it was raised is told"
    found: dict[int, int] = {}
    crew.run(range(3), made.broken_or_not, found.__setitem__)
    assert found == {0: 0, 1: 1, 2: 2}, "the crew works on"


def test_few_tasks_are_taken_ahead(crew: Crew):
    taken = done = 0
    most = 0

    def tasks() -> Iterator[int]:
        nonlocal taken, most
        for task in range(200):
            taken += 1
            most = max(most, taken - done)
            yield task

    def finish(task: int, result: int) -> None:
        nonlocal done
        done += 1

    crew.run(tasks(), abs, finish)
    assert done == 200
    assert most <= crew.window + 1


def test_an_error_of_done_leaves_nothing_behind(crew: Crew):
    def refuse(task: int, result: int) -> None:
        raise LibraryError("the disk is full")

    with pytest.raises(LibraryError, match="disk"):
        crew.run(range(50), made.who, refuse)
    assert not children(), "what was out is not waited for"


def test_processes_are_others_and_start_once_and_end():
    found: list[int] = []
    with Engine.of(2).crew() as crew:
        assert not children(), "a process starts when there is work for it"
        for _ in range(2):
            crew.run(range(20), made.who, lambda _, pid: found.append(pid))
        assert set(found) <= children()
    assert os.getpid() not in found
    assert 1 <= len(set(found)) <= 2
    assert not children()


def test_a_task_whose_process_dies_is_done_again(tmp_path: Path):
    found: dict[str, str] = {}
    run([str(tmp_path / "flag")], made.dies_once, found.__setitem__, Engine.of(1))
    assert list(found.values()) == ["done"]


def test_a_task_that_kills_every_process_is_given_up():
    with pytest.raises(EngineError, match=r"that did 5 ended 3 times \(signal 9\)"):
        run(range(6), made.last_one_dies, lambda *_: None, Engine.of(1))


def test_a_result_that_cannot_be_sent_is_an_error_and_not_a_hang():
    with pytest.raises(Exception, match=r"(?i)pickle|lambda"):
        run([1], made.unsendable, lambda *_: None, Engine.of(1))


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_nothing_is_left_running_when_it_is_stopped(how: signal.Signals, tmp_path: Path):
    script = tmp_path / "long_run.py"
    script.write_text(
        "import made_tasks as made\n"
        "from onbeat.moves.engine import Engine, run\n"
        "if __name__ == '__main__':\n"
        "    run(range(100000), made.who, lambda _, pid: print(pid, flush=True), Engine.of(2))\n"
    )
    command = [sys.executable, str(script)]
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment, text=True
    ) as main:
        assert main.stdout is not None
        workers = {int(next(main.stdout)) for _ in range(20)}
        main.send_signal(how)
        assert main.wait(120) != 0
    deadline = time.monotonic() + 120
    while any(map(_lives, workers)):
        assert time.monotonic() < deadline, "a worker outlives the run"
        time.sleep(0.05)


def _lives(pid: int) -> bool:
    try:
        stat = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"


@pytest.mark.parametrize("where", [0, -1, 100000, "host:8786", "http://host:1", "tcp://host", "tcp://a b:1", ""])
def test_what_is_no_engine_is_refused(where: int | str):
    with pytest.raises(EngineError, match="give"):
        Engine.of(where)
