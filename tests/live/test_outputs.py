"""What a session says reaches every mouth that works, and none of them can hold it up."""

from __future__ import annotations

import threading
import time

import pytest

from live_poses import ROBOT, pose
from onbeat.errors import OnbeatError
from onbeat.live.mouths import outputs as module
from onbeat.live.mouths.lateness import Lateness
from onbeat.live.mouths.outputs import Outputs
from onbeat.live.protocol import Note


class Listening:
    """Keeps what it is given; stalls while its gate is shut, fails while it is broken."""

    def __init__(self, name: str, quick: bool = False) -> None:
        self.name, self.quick = name, quick
        self.gate = threading.Event()
        self.gate.set()
        self.broken = False
        self.numbers: list[int] = []
        self.texts: list[str] = []
        self.opened = self.closed = 0
        self.threads: set[int] = set()

    def open(self, who) -> None:
        self.opened += 1

    def pose(self, pose) -> None:
        self.gate.wait(20)
        if self.broken:
            raise ValueError("it is broken")
        self.numbers.append(pose.number)
        self.threads.add(threading.get_ident())

    def say(self, event) -> None:
        self.texts.append(event.text)

    def close(self) -> None:
        self.closed += 1


def until(condition, seconds: float = 10.0) -> bool:
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.005)
    return bool(condition())


def test_a_mouth_that_stalls_holds_up_neither_the_session_nor_others_nor_the_end():
    good, stalled = Listening("good"), Listening("stalled")
    outputs = Outputs([good, stalled])
    outputs.open(ROBOT)
    stalled.gate.clear()
    spent = 0.0
    for number in range(300):
        begun = time.thread_time()
        outputs.pose(pose(number))
        spent += time.thread_time() - begun
        if number % 50 == 0:
            assert until(lambda n=number: n in good.numbers)
    assert until(lambda: len(good.numbers) == 300)
    begun = time.monotonic()
    outputs.close()
    assert time.monotonic() - begun < 3.0
    assert good.closed == 1
    assert spent / 300 < 2e-4
    passed = outputs.passed()
    assert (passed[0].sent, passed[0].dropped, passed[1].sent) == (300, 0, 0)
    assert passed[1].dropped >= 300 - module.POSES - 2
    stalled.gate.set()


def test_who_was_behind_goes_on_with_the_newest_poses_and_with_all_that_was_said():
    slow = Listening("slow")
    outputs = Outputs([slow])
    outputs.open(ROBOT)
    slow.gate.clear()
    for number in range(400):
        outputs.pose(pose(number))
        outputs.say(Note(0.0, str(number)))
    slow.gate.set()
    outputs.close()
    assert slow.numbers[-module.POSES :] == list(range(400 - module.POSES, 400))
    assert slow.texts == [str(number) for number in range(400)]


def test_a_mouth_that_fails_is_said_once_and_comes_back_while_its_neighbour_hears_all(monkeypatch):
    monkeypatch.setattr(module, "AGAIN", (0.01, 0.02))
    good, bad = Listening("good", quick=True), Listening("bad", quick=True)
    bad.broken = True
    outputs = Outputs([bad, good])
    outputs.open(ROBOT)
    for number in range(10):
        outputs.pose(pose(number))
        time.sleep(0.01)
    assert until(lambda: bad.opened > 2 and len(good.numbers) == 10)
    assert outputs.notes() == ["bad failed and is tried again: it is broken"]
    bad.broken = False
    time.sleep(0.05)
    outputs.pose(pose(10))
    assert until(lambda: bad.numbers)
    outputs.close()
    assert outputs.notes() == ["bad is back"]
    assert good.numbers == list(range(11))
    assert bad.opened == bad.closed
    assert good.threads == bad.threads, "those that never wait share a thread"


def test_where_one_cannot_be_opened_none_stays_open():
    class Shut(Listening):
        def open(self, who) -> None:
            raise OnbeatError("port 1 is taken")

    good = Listening("good")
    with pytest.raises(OnbeatError, match="port 1 is taken"):
        Outputs([good, Shut("shut")]).open(ROBOT)
    assert good.closed == 1


def test_lateness_is_counted_from_when_a_pose_was_due():
    listening = Listening("late")
    outputs = Outputs([listening])
    outputs.open(ROBOT)
    for number in range(3):
        outputs.pose(pose(number), due=time.perf_counter() - 0.3)
    outputs.close()
    passed = outputs.passed()[0]
    assert 0.3 <= passed.median <= passed.worst + 1e-4
    assert passed.punctual == 0.0


def test_what_is_later_than_a_second_counts_as_that():
    late = Lateness()
    late.add(5.0)
    late.add(-1.0)
    assert late.quantile(1.0) == pytest.approx(1.0)
    assert late.worst == 5.0
    assert late.within(0.001) == 0.5
