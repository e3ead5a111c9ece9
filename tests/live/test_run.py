"""Real time: the session's clock goes with the sound, and by itself where there is none."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence

import numpy as np
import pytest

from onbeat.live.mouths.outputs import Outputs
from onbeat.live.protocol import Note, Pose, Step, Who
from onbeat.live.run import STARVED, Pacer, Runner
from onbeat.live.session import NOTHING_TOLD, Told

WHO = Who("arm", "robot", ("base",), (-1,), ("elbow",), ())


def pose(number: int) -> Pose:
    return Pose(number, number / 100, np.zeros(3), np.eye(4)[:1], np.zeros(1), np.zeros((0, 3), np.float32))


class Machine:
    """A clock that goes on when somebody sleeps."""

    def __init__(self) -> None:
        self.now = 100.0

    def clock(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


class Made:
    """Ticks that come as a function of time says."""

    def __init__(self, machine: Machine, there, seconds: float = 3.0) -> None:
        self._machine, self._there, self._seconds = machine, there, seconds
        self.count, self.lost, self.said = 0, False, []

    def start(self) -> None: ...

    def tick(self):
        elapsed = self._machine.now - 100.0
        if self.count >= self._there(elapsed):
            return None
        self.count += 1
        return np.zeros(441, np.float32)

    def told(self) -> Told:
        return NOTHING_TOLD

    def notes(self) -> list[str]:
        out, self.said = self.said, []
        return out

    @property
    def given(self) -> bool:
        return False

    @property
    def over(self) -> bool:
        return self._machine.now - 100.0 >= self._seconds


class Counting:
    """A session that only counts."""

    def __init__(self) -> None:
        self.ticks, self.heard = 0, []

    @property
    def time(self) -> float:
        return self.ticks / 100

    def step(self, samples, told) -> Step:
        self.ticks += 1
        self.heard.append(samples is not None)
        return Step()


def run(there, seconds: float = 3.0, lost: bool = False) -> Counting:
    machine = Machine()
    ticks, session = Made(machine, there, seconds), Counting()
    ticks.lost = lost
    Runner(session, ticks, Outputs([]), None, machine.clock, machine.sleep).run()
    return session


def test_every_tick_of_sound_is_heard_once_and_in_its_time():
    session = run(lambda elapsed: elapsed * 100)
    assert session.ticks == pytest.approx(300, abs=3)
    assert all(session.heard)


@pytest.mark.parametrize("rate", [99.7, 100.3])
def test_a_source_whose_clock_goes_otherwise_is_followed(rate):
    session = run(lambda elapsed: elapsed * rate, 60.0)
    assert session.ticks == pytest.approx(60 * rate, abs=10)
    assert all(session.heard)


def test_blocks_that_come_in_bursts_are_waited_for():
    session = run(lambda elapsed: np.floor(elapsed / 0.05) * 5)
    assert all(session.heard)


def test_time_goes_on_without_sound():
    session = run(lambda elapsed: min(elapsed, 1.0) * 100)
    assert session.ticks == pytest.approx(300, abs=STARVED + 3)
    assert session.heard.count(True) == 100


def test_a_source_that_is_lost_is_not_waited_for():
    session = run(lambda elapsed: 0, 1.0, lost=True)
    assert session.ticks == pytest.approx(100, abs=2)


def test_ticks_of_a_recording_that_had_no_sound_are_ticks_all_the_same():
    machine, session = Machine(), Counting()

    class Silent(Made):
        def tick(self):
            self.due = super().tick() is not None
            return

        @property
        def given(self) -> bool:
            return self.due

    Runner(session, Silent(machine, lambda e: e * 100, 1.0), Outputs([]), None, machine.clock, machine.sleep).run()
    assert session.ticks == pytest.approx(100, abs=2)
    assert not any(session.heard)


def test_it_ends_when_it_is_told_to():
    machine, session = Machine(), Counting()
    ticks = Made(machine, lambda e: e * 100)
    ran = Runner(session, ticks, Outputs([]), None, machine.clock, machine.sleep).run(seconds=0.5)
    assert ran.ticks == session.ticks == 50
    other = Runner(session, ticks, Outputs([]), None, machine.clock, machine.sleep)
    other.stop()
    assert other.run().ticks == 50


def test_notes_of_the_source_are_said():
    machine, session, said = Machine(), Counting(), []
    ticks = Made(machine, lambda e: e * 100, 0.2)
    ticks.said = ["the input is lost"]
    Runner(session, ticks, Outputs([]), None, machine.clock, machine.sleep).run(each=said.extend)
    assert [note.text for note in said if isinstance(note, Note)] == ["the input is lost"]


class Ear:
    """A mouth that keeps when poses came."""

    name, quick = "ear", True

    def __init__(self) -> None:
        self.came: list[tuple[int, float]] = []

    def open(self, who: Who) -> None: ...

    def pose(self, pose: Pose) -> None:
        self.came.append((pose.number, time.perf_counter()))

    def say(self, event: object) -> None: ...

    def close(self) -> None: ...


def test_the_pacer_hands_out_poses_in_order_and_none_early():
    ear = Ear()
    outputs = Outputs([ear])
    outputs.open(WHO)
    pacer = Pacer(outputs)
    pacer.start()
    lumps: Sequence[Sequence[Pose]] = [[pose(k) for k in range(n, n + 10)] for n in range(0, 40, 10)]
    for lump in lumps:
        pacer.put(lump)
    end = time.monotonic() + 10
    while len(ear.came) < 40 and time.monotonic() < end:
        time.sleep(0.01)
    pacer.end()
    outputs.close()
    assert [number for number, _ in ear.came] == list(range(40))
    assert all(at - pacer.epoch >= number / 100 for number, at in ear.came)
    assert not any(thread.name == "onbeat pacer" for thread in threading.enumerate())
