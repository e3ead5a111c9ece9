"""Sessions without a clock, for measurements: who dances, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from onbeat.examples.troupe import dance_library
from onbeat.live.beat.pulse import Pulse
from onbeat.live.cast import Cast, Known, following, improvising
from onbeat.live.protocol import Command, Note, Pose, Status
from onbeat.live.session import NOTHING_TOLD, Session, Told
from onbeat.moves.embedded import embedded_library
from onbeat.retime.bspline import Spline

TICK = 441
KILOHERTZ = np.arange(100) / 1000


@dataclass
class Checked:
    """What limits were past, looked at a thousand times a second, and what jumped."""

    position: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.0
    last: np.ndarray | None = None
    jump: float = 0.0
    lumps: int = 0

    def look(self, session: Session) -> None:
        """At the tenth of a second that was danced last."""
        body = session.follower.body
        low, high, speed, acceleration, _ = body.bounds
        times = body.knots.start + KILOHERTZ
        curve = Spline(body.knots, body.controls)
        values, rates = curve(times), curve(times, 1)
        over = np.maximum(low - values, values - high)
        self.position = max(self.position, float(over.max()))
        self.speed = max(self.speed, float((np.abs(rates) / speed).max()))
        self.acceleration = max(self.acceleration, float((np.abs(curve(times, 2)) / acceleration).max()))
        if self.last is not None:
            self.jump = max(self.jump, float((np.abs(values[0] - self.last) / speed).max()))
        self.last = curve(times[-1:] + 0.001)[0]
        self.lumps += 1


@dataclass
class Came:
    """What came of a session."""

    poses: list[Pose] = field(default_factory=list)
    statuses: list[Status] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)
    checked: Checked = field(default_factory=Checked)
    clock: list[tuple[float, float]] = field(default_factory=list)  # music's second, the line's


def run(
    session: Session,
    sound: np.ndarray,
    commands: Callable[[int], Sequence[Command]] | None = None,
    keep: bool = True,
    each: Callable[[int], None] | None = None,
) -> Came:
    """Let a session hear all of a sound."""
    came = Came()
    for k in range(len(sound) // TICK):
        told = NOTHING_TOLD if commands is None else Told(tuple(commands(k)))
        step = session.step(sound[k * TICK : (k + 1) * TICK], told)
        if step.poses:
            came.checked.look(session)
        if keep and step.poses:
            start = session.follower.body.knots.start
            at = np.array([start, start + 0.05])
            came.clock += list(zip(at.tolist(), session.follower.own(at).tolist(), strict=True))
            came.poses += step.poses
        if keep:
            came.statuses += [event for event in step.events if isinstance(event, Status)]
        came.notes += [event for event in step.events if isinstance(event, Note)]
        if each is not None:
            each(k)
    return came


def troupe(count: int = 4) -> list[Known]:
    """Choreographies of the embedded troupe, with what is true of them."""
    return [Known(one.motion, np.asarray(one.beats), np.asarray(one.keyposes)) for one in dance_library()[:count]]


def cast_named(name: str) -> Cast:
    """improvised, choreography, or a robot's name."""
    if name == "improvised":
        return improvising(embedded_library())
    if name == "choreography":
        return following(troupe())
    from onbeat.live.robot.cast import on_robot
    from onbeat.robots.model import robot_named

    return on_robot(troupe(3), robot_named(name))


def session_named(name: str) -> Session:
    """A session of it, at no latency."""
    cast = cast_named(name)
    return Session(Pulse(), cast.conductor, cast.dancer)
