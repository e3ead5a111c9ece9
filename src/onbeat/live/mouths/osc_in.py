"""OSC that comes in: what somebody wants, from a tablet, a mixing desk or a script."""

from __future__ import annotations

import math
import socket
import threading
from collections.abc import Callable
from typing import Any

from onbeat.errors import MissingExtraError, OnbeatError
from onbeat.live.protocol import Command

LONGEST = 4096
"""Bytes of a packet that are looked at."""
_LONGEST_NAME = 200
_LOOK_UP = 0.25  # [s] after which a thread that waits sees that it should end


class OscIn:
    """Hears ``/onbeat/next``, ``/onbeat/play NAME``, ``/onbeat/rest``, ``/onbeat/dance`` and ``/onbeat/tap`` over UDP.

    Parameters
    ----------
    heard : is called with each command, on a thread of this.
    note : is called with what people should know, each once: that something else came.
    host, port : where to listen; port 0 picks one.

    Raises
    ------
    MissingExtraError
        If python-osc is not installed.
    OnbeatError
        If the port is taken.
    """

    def __init__(
        self,
        heard: Callable[[Command], None],
        note: Callable[[str], None],
        host: str = "127.0.0.1",
        port: int = 9001,
    ) -> None:
        self._parse = _parser()
        self._heard, self._note = heard, note
        self._said: set[str] = set()
        self._socket = _bound(host, port)
        self.port: int = self._socket.getsockname()[1]
        self._open = True
        self._thread = threading.Thread(target=self._listen, name="onbeat OSC in", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening."""
        self._open = False
        self._thread.join(4 * _LOOK_UP)
        self._socket.close()

    def _listen(self) -> None:
        while self._open:
            try:
                packet, sender = self._socket.recvfrom(LONGEST)
            except TimeoutError:
                continue
            except OSError:  # Windows says so when what was sent before did not arrive
                continue
            self._take(packet, sender[0])

    def _take(self, packet: bytes, sender: str) -> None:
        try:
            messages = [(timed.message.address, timed.message.params) for timed in self._parse(packet).messages]
        except Exception:  # whatever a parser makes of garbage
            self._say_once("garbage", f"OSC from {sender}: {len(packet)} bytes that are no OSC are ignored")
            return
        for address, values in messages:
            try:
                command = command_of(address, values)
            except OnbeatError as error:
                self._say_once("unknown", f"OSC from {sender}: {error}")
            else:
                if command is not None:
                    self._heard(command)

    def _say_once(self, what: str, text: str) -> None:
        if what not in self._said:
            self._said.add(what)
            self._note(text)


def command_of(address: str, values: list[Any]) -> Command | None:
    """The command that an OSC message is; none of a button that is let go (its number is 0), or of others' addresses.

    Raises
    ------
    OnbeatError
        If it is an address below ``/onbeat`` that is not known, or has not what it needs.

    Examples
    --------
    >>> command_of("/onbeat/play", ["waltz"])
    Command(do='play', value='waltz')
    >>> command_of("/onbeat/tap", [0.0]), command_of("/other", [])
    (None, None)
    """
    if not address.startswith("/onbeat/"):
        return None
    do = address.removeprefix("/onbeat/")
    if do == "play":
        if not values or not isinstance(values[0], str) or not 0 < len(values[0]) <= _LONGEST_NAME:
            raise OnbeatError("/onbeat/play needs the name of what to dance, a string")
        return Command("play", values[0])
    if do == "next" or do == "rest" or do == "dance" or do == "tap":
        return None if values and _let_go(values[0]) else Command(do)
    raise OnbeatError(f"{address[:60]!r} is not known; expected /onbeat/ and next, play, rest, dance or tap")


def _let_go(value: Any) -> bool:
    return isinstance(value, int | float) and (value == 0 or math.isnan(value))


def _parser() -> Callable[[bytes], Any]:
    try:
        from pythonosc.osc_packet import OscPacket
    except ImportError:
        raise MissingExtraError('OSC that comes in needs python-osc: pip install "onbeat[live]"') from None
    return OscPacket


def _bound(host: str, port: int) -> socket.socket:
    ear = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_DGRAM)
    try:
        ear.bind((host, port))
    except (OSError, OverflowError, UnicodeError) as error:
        ear.close()
        raise OnbeatError(f"cannot listen for OSC on {host}:{port}: {error}; choose another port") from None
    ear.settimeout(_LOOK_UP)
    return ear
