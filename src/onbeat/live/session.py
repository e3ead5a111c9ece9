"""A live session without a clock: sound goes in tick by tick, poses come out; the same sound gives the same poses.

A tick is a hundredth of a second. Every tenth of a second the next ten poses are made, ``LEAD`` before the first of
them is due, so that whoever sends them has time. Poses are of the second of the music that is heard ``latency`` after
they are due: that is how long it takes until they are seen, and how old a sound is when it comes in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Float32, Times
from onbeat.live.beat.pulse import Heard, Pulse
from onbeat.live.bodies.dancers import Dancer
from onbeat.live.conductor import Conductor
from onbeat.live.protocol import RATE, Clocked, Command, Event, Note, Pose, Status, Step
from onbeat.retime.stream import Follower

LUMP = 10
"""Ticks whose poses are made at once."""
LEAD = 30
"""Ticks before they are due at which poses are made."""
STATUS = 5
"""Ticks from one status to the next."""
FORETOLD = 8
"""Beats that a status tells."""


@dataclass(frozen=True)
class Told:
    """What came in beside sound in one tick: wishes, and another machine's clock."""

    commands: tuple[Command, ...] = ()
    clocked: tuple[Clocked, ...] = ()


NOTHING_TOLD = Told()
Tried = Callable[[Sequence[Pose]], Step]
"""A body that is told poses and does what it can."""


class Session:
    """Hears, and dances.

    Parameters
    ----------
    pulse : hears the beats.
    conductor : chooses what is danced.
    dancer : whose body it is.
    latency : seconds from a sound to the pose that is on it being seen.
    tried : what becomes of poses where a body is simulated: those that it really takes, and what is to be said.
    """

    def __init__(
        self, pulse: Pulse, conductor: Conductor, dancer: Dancer, latency: float = 0.0, tried: Tried | None = None
    ) -> None:
        self.pulse, self.conductor, self.dancer, self.latency = pulse, conductor, dancer, latency
        self._tried = tried
        self.follower = Follower(dancer.followed, dancer.bounds, dancer.start(0.0), since=latency)
        self.ticks = 0
        self._due = 0
        self._level = list[float]()
        self._clock = 1.0

    @property
    def time(self) -> float:
        """Seconds of sound so far."""
        return self.ticks / RATE

    def step(self, samples: Float32 | None, told: Told = NOTHING_TOLD) -> Step:
        """Take one tick of sound (441,), or None where there is none; what is ready now."""
        for clocked in told.clocked:
            self.pulse.clocked(clocked)
        events: list[Event] = [*self._obey(told.commands)]
        heard = self.pulse.hear(samples)
        self.ticks += 1
        self._level.append(heard.level)
        events.extend(heard.said)
        poses = self._dance(heard) if self.ticks % LUMP == 0 or self.ticks == 1 else ()
        if self._tried is not None and poses:
            really = self._tried(poses)
            poses = really.poses
            events.extend(really.events)
        if self.ticks % STATUS == 0:
            events.append(self._status(heard))
        return Step(poses, tuple(events))

    def _obey(self, commands: Sequence[Command]) -> list[Note]:
        notes = list[Note]()
        for command in commands:
            if command.do == "tap":
                self.pulse.tap(self.time)
                continue
            wrong = self.conductor.command(command.do, command.value)
            if wrong:
                notes.append(Note(self.time, wrong))
        return notes

    def _dance(self, heard: Heard) -> Sequence[Pose]:
        """The poses that are due up to ``LEAD`` from now on, in lumps."""
        poses = list[Pose]()
        while self._due < self.ticks + LEAD:
            numbers = np.arange(self._due, self._due + LUMP)
            poses += self._lump(heard, numbers / RATE + self.latency)
            self._due += LUMP
        return poses

    def _lump(self, heard: Heard, times: Times) -> list[Pose]:
        follower = self.follower
        music = follower.planned
        own = float(follower.own(np.array([music]))[0])
        self.conductor.conduct(heard, music, own)
        follower.push(*self.conductor.expected(heard, music, own))
        if self.conductor.changed:
            follower.renew()
        values = follower.pull(times)
        seconds = follower.own(times)
        self._clock = float((seconds[-1] - seconds[0]) / (times[-1] - times[0]))
        return self.dancer.poses(self._due, values, seconds)

    def _status(self, heard: Heard) -> Status:
        level, self._level = self._level, []
        coming = np.flatnonzero(heard.times > heard.time)[:FORETOLD]
        music = heard.hearing != "nothing"
        return Status(
            time=round(heard.time, 4),
            hearing=heard.hearing,
            tempo=round(heard.tempo, 2) if music else 0.0,
            confidence=round(heard.confidence, 3),
            meter=heard.meter,
            next_position=int(heard.positions[coming[0]]) if len(coming) else 0,
            next_beats=[round(float(heard.times[k]), 4) for k in coming] if music else [],
            level=[round(value, 3) for value in level],
            dancing=self.conductor.dancing,
            clock=round(self._clock, 3),
            simulated=self._tried is not None,
        )


def warm_up(session: Session) -> None:
    """Load what is compiled, so that the first ticks are in time: hears half a second of clicks, aside."""
    pulse, clicks = Pulse(), np.zeros(441, np.float32)
    clicks[:4] = 0.5
    for _ in range(50):
        pulse.hear(clicks)
    session.follower.dance.values(np.arange(0, 0.2, 0.01), session.follower.body.controls[1])
