"""MIDI clock out: other machines keep the beat that is heard."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress

from onbeat.errors import OnbeatError
from onbeat.live.mouths.midi_ports import Port, midi, open_output
from onbeat.live.mouths.pulses import Pulses, Signal
from onbeat.live.mouths.session_clock import SessionClock
from onbeat.live.protocol import Event, Pose, Status, Who

LOOK_UP = 0.5
"""Seconds after which a thread that waits for nothing looks up."""


class ClockOut:
    """A mouth that sends 24 pulses a beat, each at its time, and start, continue and stop.

    Parameters
    ----------
    port : its name; see :func:`onbeat.live.mouths.midi_ports.open_output`.
    opened : what opens a port by its name.
    """

    quick = True

    def __init__(self, port: str, opened: Callable[[str], Port] = open_output) -> None:
        self.name = f"MIDI clock to {port}"
        self._port_name = port
        self._opened = opened
        self._change = threading.Condition()
        self._thread: threading.Thread | None = None
        self._failed: Exception | None = None
        self._going = False

    def open(self, who: Who) -> None:
        """Open the port and begin to send.

        Raises
        ------
        OnbeatError
            If there is no such port, or nothing that plays MIDI.
        """
        self._message = midi().Message
        self._port = self._opened(self._port_name)
        self._pulses, self._clock, self._at_once = Pulses(), SessionClock(), list[Signal]()
        self._failed, self._going = None, True
        self._thread = threading.Thread(target=self._send_all, name="onbeat MIDI clock", daemon=True)
        self._thread.start()

    def pose(self, pose: Pose) -> None:
        """Learn from a pose when its second is; nothing is sent."""
        self._clock.seen(pose.time, time.monotonic())

    def say(self, event: Event) -> None:
        """Follow the beats that are foretold.

        Raises
        ------
        OnbeatError
            If the port could not be sent to.
        """
        if self._failed is not None:
            raise OnbeatError(f"{self._failed}")
        if isinstance(event, Status):
            with self._change:
                self._at_once += self._pulses.foretell(event)
                self._change.notify()

    def close(self) -> None:
        """Say stop and close the port."""
        if self._thread is None:
            return
        with self._change:
            self._going = False
            self._change.notify()
        self._thread.join(LOOK_UP)
        self._thread = None

    def _send_all(self) -> None:
        try:
            while self._going:
                for signal in self._due():
                    self._send(signal)
            if self._pulses.running:
                self._send(Signal("stop"))
        except Exception as error:  # each backend has errors of its own
            self._failed = error
        finally:
            with suppress(Exception):
                self._port.close()

    def _due(self) -> list[Signal]:
        """Wait until something is due or changes; what is due."""
        with self._change:
            at = self._pulses.next_at if self._clock.known else None
            wait = LOOK_UP if at is None else self._clock.when(at) - time.monotonic()
            if wait > 0 and not self._at_once and self._going:
                self._change.wait(min(wait, LOOK_UP))
                at = self._pulses.next_at if self._clock.known else None
            due, self._at_once = self._at_once, []
            if at is not None and self._clock.when(at) <= time.monotonic():
                due += self._pulses.take()
            return due

    def _send(self, signal: Signal) -> None:
        if signal.kind == "songpos":
            self._port.send(self._message("songpos", pos=signal.position))
        else:
            self._port.send(self._message(signal.kind))
