"""Ticks of sound for a session from a listener, and what people and machines tell it meanwhile."""

from __future__ import annotations

import threading

from onbeat._shapes import Float32
from onbeat.live.protocol import Clocked, Command
from onbeat.live.session import NOTHING_TOLD, Told
from onbeat.live.sound.ears import Ears
from onbeat.live.sound.listener import Listener

MOST = 100
"""Wishes that may wait."""


class Inbox:
    """What is told to a session, from any thread, until the next tick takes it.

    Examples
    --------
    >>> inbox = Inbox()
    >>> inbox.command(Command("next"))
    >>> inbox.told().commands, inbox.told().commands
    ((Command(do='next', value=''),), ())
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._commands = list[Command]()
        self._clocked = list[Clocked]()
        self._notes = list[str]()

    def command(self, command: Command) -> None:
        """A wish; too many at once are left out."""
        with self._lock:
            if len(self._commands) < MOST:
                self._commands.append(command)

    def clocked(self, clocked: Clocked) -> None:
        """A part of a beat of another machine's clock."""
        with self._lock:
            if len(self._clocked) < MOST:
                self._clocked.append(clocked)

    def note(self, text: str) -> None:
        """Something that people should know."""
        with self._lock:
            if len(self._notes) < MOST:
                self._notes.append(text)

    def notes(self) -> list[str]:
        """Notes since the last call."""
        if not self._notes:
            return []
        with self._lock:
            out, self._notes = self._notes, []
        return out

    def told(self) -> Told:
        """All that came since the last call."""
        if not self._commands and not self._clocked:
            return NOTHING_TOLD
        with self._lock:
            out = Told(tuple(self._commands), tuple(self._clocked))
            self._commands, self._clocked = [], []
        return out


class Hearing:
    """Ticks as a listener's sound comes.

    Parameters
    ----------
    listener : not begun yet: what hears it is made ready first.
    inbox : of those who tell the session something.
    """

    def __init__(self, listener: Listener, inbox: Inbox) -> None:
        self._listener, self._inbox = listener, inbox
        self._ears = Ears(tell_gaps=False)  # the listener itself says when it is lost

    def start(self) -> None:
        """Begin to listen; an ``OnbeatError`` says if there is nothing to hear."""
        self._listener.start()

    def tick(self) -> Float32 | None:
        """The next tick, or None where there is none yet."""
        samples = self._ears.tick()
        if samples is not None:
            return samples
        for block, rate in self._listener.read():
            self._ears.take(block, rate)
        return self._ears.tick()

    def told(self) -> Told:
        """What was told since the last call."""
        return self._inbox.told()

    def notes(self) -> list[str]:
        """What people should know about the sound."""
        return [*self._listener.notes(), *self._ears.problems(), *self._inbox.notes()]

    @property
    def given(self) -> bool:
        """A tick of sound is always one."""
        return False

    @property
    def lost(self) -> bool:
        """Whether no sound is to be waited for."""
        return self._listener.state != "sound"

    @property
    def over(self) -> bool:
        """Whether the sound has come to its end."""
        return self._listener.state == "ended"
