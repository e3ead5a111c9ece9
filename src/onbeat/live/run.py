"""A live session in real time: sound is taken as it comes, poses are handed out when they are due.

One thread hears and dances; another, the pacer, sleeps until the next pose is due and hands it to the outputs. The
session's clock is that of the sound. Where sound fails to come, the clock goes on by itself, with ticks of nothing, and
the two are brought together again slowly, for no two clocks go equally fast.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from onbeat._shapes import Float32
from onbeat.live.mouths.outputs import Outputs
from onbeat.live.protocol import RATE, Event, Note, Pose
from onbeat.live.session import Session, Told

STARVED = 8
"""Ticks that sound may be late before a tick of nothing takes its place."""
DRAWN = 0.01
"""Share by which the clock is drawn towards the sound with each tick."""
CAUGHT_UP = 20
"""Ticks that are made up for at once, at most, after a stall."""


class Ticks(Protocol):
    """Where ticks of sound come from; nothing of it waits."""

    def start(self) -> None:
        """Begin."""
        ...

    def tick(self) -> Float32 | None:
        """The next tick (441,), or None where there is none yet."""
        ...

    def told(self) -> Told:
        """What came in beside sound since this was last asked."""
        ...

    def notes(self) -> list[str]:
        """What people should know about the sound, since this was last asked."""
        ...

    @property
    def given(self) -> bool:
        """Whether what ``tick`` gave last is a tick, though it be None: one that had no sound when it was kept."""
        ...

    @property
    def lost(self) -> bool:
        """Whether no sound is to be waited for."""
        ...

    @property
    def over(self) -> bool:
        """Whether all is over."""
        ...


class Recorder(Protocol):
    """Whoever keeps what came in and went out."""

    def add(self, samples: Float32 | None, told: Told, poses: Sequence[Pose]) -> None:
        """One tick."""
        ...


@dataclass(frozen=True)
class Ran:
    """How it went: ``ticks``, those of them without sound, CPU seconds, and seconds of the clock."""

    ticks: int
    silent: int
    cpu: float
    seconds: float


class Pacer:
    """Hands out poses and events when they are due.

    Parameters
    ----------
    outputs : to whom.
    clock, sleep : of the machine; seconds that rise, those of ``time.perf_counter`` by default.
    """

    def __init__(
        self,
        outputs: Outputs,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.epoch = clock()
        self._outputs, self._clock, self._sleep = outputs, clock, sleep
        self._poses: deque[Pose] = deque(maxlen=10 * RATE)
        self._more = threading.Event()
        self._ended = False
        self._thread = threading.Thread(target=self._run, name="onbeat pacer", daemon=True)

    def start(self) -> None:
        """Begin; the clock's second 0 is now."""
        self.epoch = self._clock()
        self._thread.start()

    def put(self, poses: Sequence[Pose]) -> None:
        """Poses to come."""
        self._poses.extend(poses)
        self._more.set()

    def end(self) -> None:
        """Hand out nothing more."""
        self._ended = True
        self._more.set()
        self._thread.join(1.0)

    def _run(self) -> None:
        while not self._ended:
            if not self._poses:
                self._more.wait()
                self._more.clear()
                continue
            pose = self._poses[0]
            due = self.epoch + pose.time
            wait = due - self._clock()
            if wait > 0:
                self._sleep(min(wait, 0.05))
                continue
            self._poses.popleft()
            self._outputs.pose(pose, due)


class Runner:
    """Runs a session until it is over or stopped.

    Parameters
    ----------
    session : what hears and dances.
    ticks : where sound comes from.
    outputs : who passes on what comes of it.
    recorder : who keeps it.
    clock, sleep : of the machine.
    """

    def __init__(
        self,
        session: Session,
        ticks: Ticks,
        outputs: Outputs,
        recorder: Recorder | None = None,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.session, self.ticks, self.outputs, self.recorder = session, ticks, outputs, recorder
        self.pacer = Pacer(outputs, clock, sleep)
        self._clock, self._sleep = clock, sleep
        self._silent = 0
        self._stopped = False

    def stop(self) -> None:
        """End after the present tick; may be called from any thread."""
        self._stopped = True

    @property
    def now(self) -> float:
        """Second of the session by the machine's clock: between ticks, too."""
        return self._clock() - self.pacer.epoch

    def run(self, seconds: float = float("inf"), each: Callable[[Sequence[Event]], None] | None = None) -> Ran:
        """Run for so many seconds at most; ``each`` gets the events of every tick."""
        cpu, begun = time.process_time(), self._clock()
        self.pacer.start()
        try:
            while not (self._stopped or self.ticks.over or self.session.time >= seconds):
                events = self._tick()
                if events is None:
                    self._sleep(0.002)
                elif each is not None and events:
                    each(events)
        finally:
            self.pacer.end()
        return Ran(self.session.ticks, self._silent, time.process_time() - cpu, self._clock() - begun)

    def _tick(self) -> Sequence[Event] | None:
        """One tick, if its time has come; what is to be said of it."""
        late = (self._clock() - self.pacer.epoch) * RATE - self.session.ticks
        samples = self.ticks.tick()
        if samples is None:
            if not self.ticks.given and late < (1 if self.ticks.lost else STARVED):
                return None
            self._silent += 1
            if late > STARVED + CAUGHT_UP:  # the machine slept, or we did: time that nobody danced through
                self.pacer.epoch += (late - STARVED) / RATE
        else:
            self.pacer.epoch += DRAWN * (late - STARVED / 2) / RATE
        told = self.ticks.told()
        step = self.session.step(samples, told)
        if self.recorder is not None:
            self.recorder.add(samples, told, step.poses)
        self.pacer.put(step.poses)
        notes = [Note(self.session.time, text) for text in (*self.ticks.notes(), *self.outputs.notes())]
        events = (*step.events, *notes)
        for event in events:
            self.outputs.say(event)
        return events
