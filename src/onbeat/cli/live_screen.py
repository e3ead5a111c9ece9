"""What a live session shows on the terminal: a line that is kept up to date, notes above it, and how it went."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.status import Status as Spinner
from rich.text import Text

from onbeat.live.protocol import RATE, BeatSaid, Event, Note, Status

if TYPE_CHECKING:
    from onbeat.cli.live_mouths import Mouths
    from onbeat.live.mouths.outputs import Passed
    from onbeat.live.run import Ran


class Screen:
    """The terminal, or nothing.

    Parameters
    ----------
    silent : no line that is kept up to date.
    """

    def __init__(self, silent: bool) -> None:
        self._console = Console(stderr=True, highlight=False)
        self._line: Spinner | None = None
        self._silent = silent
        self._beat = 0

    @staticmethod
    def say(text: str) -> None:
        """A line on stderr."""
        print(text, file=sys.stderr)  # noqa: T201

    def begin(self, dancer: str, source: str, mouths: Mouths) -> None:
        """Say what there is to be seen, and where."""
        where = f" on {mouths.address}" if mouths.address else ""
        self.say(f"{dancer} dances to {source}{where}; Ctrl-C ends it")
        for note in mouths.notes:
            self.say(note)
        if self._console.is_terminal and not self._silent:
            self._line = self._console.status("listening")
            self._line.start()

    def each(self, events: Sequence[Event]) -> None:
        """Keep the line up to date; say notes."""
        for event in events:
            if isinstance(event, Note):
                self._console.print(Text(f"{event.time:.1f} s: {event.text}"), soft_wrap=True)
            elif isinstance(event, BeatSaid):
                self._beat = event.position
            elif self._line is not None:
                self._line.update(_line(event, self._beat))

    def end(self) -> None:
        """Leave the line."""
        if self._line is not None:
            self._line.stop()


def _line(status: Status, beat: int) -> Text:
    lights = " ".join(str(k) if k == beat else "·" for k in range(1, status.meter + 1))
    heard = {"music": f"{status.tempo:5.1f} BPM", "held": f"{status.tempo:5.1f} BPM, held", "nothing": "no music"}
    return Text(f"{heard[status.hearing]}  {lights}  {status.dancing}  × {status.clock:.2f}")


def summary(ran: Ran, passed: Sequence[Passed], poses: int, speed_up: float) -> dict[str, Any]:
    """How it went, for people and programs: shares are 0…1, seconds are of the machine's clock."""
    mouths = [
        {"name": one.name, "sent": one.sent, "dropped": one.dropped}
        | ({"punctual": round(one.punctual, 5), "p999_ms": round(1000 * one.p999, 2)} if speed_up == 1 else {})
        for one in passed
    ]
    return {
        "ticks": ran.ticks,
        "without_sound": ran.silent,
        "poses": poses,
        "cpu": round(ran.cpu / max(ran.ticks / RATE, 0.5), 4),
        "seconds": round(ran.seconds, 2),
        "mouths": mouths,
    }


def words(told: dict[str, Any]) -> str:
    """The same in a line."""
    silent = f", {told['without_sound'] / 100:.1f} s of it without sound" if told["without_sound"] else ""
    mouths = "".join(f"; {one['name']}: {one['sent']} poses{_punctual(one)}" for one in told["mouths"])
    return f"{told['ticks'] / 100:.1f} s heard{silent}, {told['cpu']:.0%} of one processor{mouths}"


PUNCTUAL = 0.95
"""The share of poses in time under which a dance is seen to stutter."""


def _punctual(mouth: dict[str, Any]) -> str:
    """How many poses were sent when they were due, and what it means if they were few."""
    if not (mouth["sent"] and "punctual" in mouth):
        return ""
    told = f", {mouth['punctual']:.1%} of them sent within 10 ms of when they were due"
    if mouth["punctual"] >= PUNCTUAL:
        return told
    return f"{told}: too few (95% are needed), so that it stutters; this computer had too much else to do"
