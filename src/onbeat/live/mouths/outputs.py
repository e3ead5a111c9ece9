"""Mouths: what a session says, handed to each who passes it on, so that none can hold up the session or another.

The session's side only appends to a queue and wakes a thread. Mouths that never wait (a datagram, a note to another
thread) share one thread, for every thread that is woken costs; each of the others has its own. A mouth that falls
behind loses its oldest poses, and events only when a thousand wait; one that fails is opened again later.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol

from onbeat.errors import OnbeatError
from onbeat.live.mouths.lateness import Lateness
from onbeat.live.protocol import Event, Pose, Who

POSES = 100
"""Poses that may wait for one thread of mouths: a second of them."""
EVENTS = 1000
"""Events that may wait."""
AGAIN = (1.0, 30.0)
"""Seconds until a mouth that failed is opened again, at first and at most: each time it fails they double."""
GRACE = 0.8
"""Seconds that all together have to end."""


class Mouth(Protocol):
    """Who passes on what a session says.

    All but the first ``open`` is called from one thread. ``open`` may be called again after ``close``. ``quick`` says
    that no call ever waits; what fails in it may raise anything.
    """

    name: str
    quick: bool

    def open(self, who: Who) -> None:
        """Begin; an ``OnbeatError`` says why not."""
        ...

    def pose(self, pose: Pose) -> None:
        """Pass on a pose."""
        ...

    def say(self, event: Event) -> None:
        """Pass on an event."""
        ...

    def close(self) -> None:
        """End."""
        ...


@dataclass(frozen=True)
class Passed:
    """How a mouth did.

    Parameters
    ----------
    name : of the mouth.
    sent, dropped : poses.
    median, p99, p999, worst : seconds from when a pose was due until it was passed on.
    punctual : share of the poses passed on within 10 ms.
    """

    name: str
    sent: int
    dropped: int
    median: float
    p99: float
    p999: float
    worst: float
    punctual: float


class Outputs:
    """All mouths of a session.

    Parameters
    ----------
    mouths : each with a name of its own.

    Examples
    --------
    >>> from onbeat.live.mouths.lines import Lines
    >>> import io, numpy as np
    >>> page = io.BytesIO()
    >>> outputs = Outputs([Lines(page)])
    >>> outputs.open(Who("arm", "robot", ("base",), (-1,), ("elbow",), ()))
    >>> outputs.pose(Pose(0, 0.0, np.zeros(3), np.eye(4)[:1], np.ones(1), np.zeros((0, 3), np.float32)))
    >>> outputs.close()
    >>> page.getvalue().splitlines()[-1]
    b'0.0000,0.00000,0.00000,0.00000,1.00000,0.00000,0.00000,0.00000,1.00000'
    >>> outputs.passed()[0].sent
    1
    """

    def __init__(self, mouths: Iterable[Mouth]) -> None:
        self._notes: deque[str] = deque(maxlen=100)
        tongues = [_Tongue(mouth, self._notes) for mouth in mouths]
        quick = [tongue for tongue in tongues if tongue.mouth.quick]
        own = [[tongue] for tongue in tongues if not tongue.mouth.quick]
        self._tongues = tongues
        self._lanes = [_Lane(some) for some in ([quick] if quick else []) + own]

    def open(self, who: Who) -> None:
        """Open all of them.

        Raises
        ------
        OnbeatError
            If one cannot be; those that were are closed again.
        """
        for number, tongue in enumerate(self._tongues):
            try:
                tongue.mouth.open(who)
            except OnbeatError:
                for opened in self._tongues[:number]:
                    opened.close()
                raise
        for lane in self._lanes:
            lane.start(who)

    def pose(self, pose: Pose, due: float | None = None) -> None:
        """Hand a pose to all; ``due`` is when, in seconds of ``time.perf_counter()``, now if it is not given."""
        at = time.perf_counter() if due is None else due
        for lane in self._lanes:
            lane.pose(pose, at)

    def say(self, event: Event) -> None:
        """Hand an event to all."""
        for lane in self._lanes:
            lane.say(event)

    def notes(self) -> list[str]:
        """What people should know, since this was last asked: who failed, and who is back."""
        taken: list[str] = []
        with suppress(IndexError):
            while True:
                taken.append(self._notes.popleft())
        return taken

    def passed(self) -> list[Passed]:
        """How each did so far."""
        return [tongue.passed() for tongue in self._tongues]

    def close(self) -> None:
        """End within a second; what waits is passed on first, by those who do not stall."""
        end = time.monotonic() + GRACE
        for lane in self._lanes:
            lane.stop()
        for lane in self._lanes:
            lane.join(max(end - time.monotonic(), 0.0))


class _Lane:
    """A thread with a queue, for one mouth or several quick ones."""

    def __init__(self, tongues: list[_Tongue]) -> None:
        self._tongues = tongues
        self._poses: deque[tuple[Pose, float]] = deque(maxlen=POSES)
        self._events: deque[Event] = deque(maxlen=EVENTS)
        self._wake = threading.Event()
        self._stopped = False
        self._thread: threading.Thread | None = None

    def start(self, who: Who) -> None:
        for tongue in self._tongues:
            tongue.who = who
        names = ", ".join(tongue.mouth.name for tongue in self._tongues)
        self._thread = threading.Thread(target=self._run, name=f"onbeat {names}", daemon=True)
        self._thread.start()

    def pose(self, pose: Pose, due: float) -> None:
        if len(self._poses) == POSES:
            for tongue in self._tongues:
                tongue.dropped += 1
        self._poses.append((pose, due))
        self._wake.set()

    def say(self, event: Event) -> None:
        self._events.append(event)
        self._wake.set()

    def stop(self) -> None:
        self._stopped = True
        self._wake.set()

    def join(self, seconds: float) -> None:
        if self._thread is not None:
            self._thread.join(seconds)

    def _run(self) -> None:
        while not self._stopped:
            self._wake.wait()
            self._wake.clear()
            self._pass_on()
        self._pass_on()
        for tongue in self._tongues:
            tongue.close()

    def _pass_on(self) -> None:
        """Everything that waits, what is said before poses."""
        while self._events or self._poses:
            if self._events:
                event = self._events.popleft()
                for tongue in self._tongues:
                    tongue.say(event)
            else:
                pose, due = self._poses.popleft()
                for tongue in self._tongues:
                    tongue.pose(pose, due)


class _Tongue:
    """A mouth, whether it works, and how it does."""

    def __init__(self, mouth: Mouth, notes: deque[str]) -> None:
        self.mouth = mouth
        self.dropped = 0
        self.who: Who | None = None
        self._notes = notes
        self._lateness = Lateness()
        self._patience = AGAIN[0]
        self._again_at: float | None = None  # when it is opened again; none while it is open
        self._failing = False  # since it last passed on anything

    def pose(self, pose: Pose, due: float) -> None:
        if self._ready() and self._tried(self.mouth.pose, pose):
            self._lateness.add(time.perf_counter() - due)
        else:
            self.dropped += 1

    def say(self, event: Event) -> None:
        if self._ready():
            self._tried(self.mouth.say, event)

    def close(self) -> None:
        with suppress(Exception):
            self.mouth.close()

    def passed(self) -> Passed:
        late = self._lateness
        median, p99, p999 = (late.quantile(share) for share in (0.5, 0.99, 0.999))
        return Passed(self.mouth.name, late.count, self.dropped, median, p99, p999, late.worst, late.within(0.01))

    def _ready(self) -> bool:
        """Whether it is open, after it was opened again if that was due."""
        if self._again_at is None:
            return True
        if time.monotonic() < self._again_at or self.who is None:
            return False
        self._again_at = None
        return self._tried(self.mouth.open, self.who, passed_on=False)

    def _tried(self, what: Callable[[Any], None], of: Any, passed_on: bool = True) -> bool:
        """Whether it did that; if not it is closed, to be opened again later."""
        try:
            what(of)
        except Exception as error:
            self._fail(error)
            return False
        if self._failing and passed_on:
            self._failing, self._patience = False, AGAIN[0]
            self._notes.append(f"{self.mouth.name} is back")
        return True

    def _fail(self, error: Exception) -> None:
        if not self._failing:
            self._notes.append(f"{self.mouth.name} failed and is tried again: {str(error) or type(error).__name__}")
        self._failing = True
        self.close()
        self._again_at = time.monotonic() + self._patience
        self._patience = min(2 * self._patience, AGAIN[1])
