"""Where ``onbeat live`` speaks to, and who may tell it something."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Generator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from onbeat.cli.live_flags import SendFlags
from onbeat.live.page.wire import HelloData
from onbeat.live.protocol import VERSION, Who

if TYPE_CHECKING:
    from onbeat.cli.live_sound import Played
    from onbeat.live.cast import Cast
    from onbeat.live.hearing import Inbox
    from onbeat.live.mouths.lines import Lines
    from onbeat.live.mouths.outputs import Mouth, Outputs
    from onbeat.live.page.server import Server
    from onbeat.live.run import Runner
    from onbeat.live.session import Session


@dataclass
class Mouths:
    """All mouths of a session, and who dances."""

    who: Who
    all: list[Mouth] = field(default_factory=list["Mouth"])
    server: Server | None = None
    lines: Lines | None = None

    def open(self, outputs: Outputs) -> None:
        """Open all; second 0 is now."""
        self.who = replace(self.who, started=time.time())
        outputs.open(self.who)

    @property
    def ended(self) -> bool:
        """Whether whoever read the lines has gone."""
        return self.lines is not None and self.lines.ended

    @property
    def address(self) -> str:
        """Of the page, if there is one."""
        return self.server.address if self.server is not None else ""

    @property
    def notes(self) -> list[str]:
        """What people should know from the start."""
        return [self.server.note] if self.server is not None and self.server.note else []


def mouths_of(send: SendFlags, cast: Cast, played: Played, session: Session, inbox: Inbox) -> Mouths:
    """The mouths that are asked for, not yet open."""
    out = Mouths(replace(cast.who, latency=session.latency))
    address = send.osc_address
    if send.page:
        out.server = _server(send, cast, played, session, inbox, out)
        out.all.append(out.server)
    if address is not None:
        from onbeat.live.mouths.osc import Osc

        out.all.append(Osc(*address))
    if send.midi_out is not None:
        from onbeat.live.mouths.midi import ClockOut

        out.all.append(ClockOut(send.midi_out))
    if send.lines is not None:
        from onbeat.live.mouths.lines import Lines

        out.lines = Lines(sys.stdout, send.lines)
        out.all.append(out.lines)
    return out


def _server(send: SendFlags, cast: Cast, played: Played, session: Session, inbox: Inbox, mouths: Mouths) -> Server:
    from onbeat.live.page.server import Server
    from onbeat.viewer.pages.live import live_page

    def hello() -> HelloData:
        who, drawn, picker = mouths.who, cast.drawn, cast.conductor.picker
        return HelloData(
            version=VERSION,
            title=played.name,
            name=who.name,
            kind=who.kind,
            points=list(who.points),
            capsules=list(drawn.capsules),
            spine=list(drawn.spine),
            facing=drawn.facing,
            floor=drawn.floor,
            latency=who.latency,
            started=who.started,
            now=session.time,
            choreographies=list(picker.names) if len(picker.names) > 1 else [],
            sound=played.sound is not None,
            sound_at=0.0,
            sound_seconds=played.seconds,
            loops=played.loops,
        )

    return Server(live_page(), hello, inbox.command, played.sound, send.host, send.port)


@contextlib.contextmanager
def listening(send: SendFlags, midi_in: str | None, inbox: Inbox, runner: Runner) -> Generator[None]:
    """Hear commands over OSC and a clock over MIDI, where these are asked for."""
    with contextlib.ExitStack() as stack:
        if send.osc_in is not None:
            from onbeat.live.mouths.osc_in import OscIn

            stack.enter_context(contextlib.closing(OscIn(inbox.command, inbox.note, send.host, send.osc_in)))
        if midi_in is not None:
            from onbeat.live.mouths.midi_in import ClockIn

            stack.enter_context(contextlib.closing(ClockIn(midi_in, inbox.clocked, lambda: runner.now)))
        yield
