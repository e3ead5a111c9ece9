"""Poses and beats as OSC over UDP, as TouchDesigner, Unity, Blender, Max and others take it.

All addresses are in ``docs/live_protocol.md``. Sending never waits: what the network does not take is lost.
"""

from __future__ import annotations

import socket
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from onbeat.errors import OnbeatError
from onbeat.live.mouths.osc_packets import AT_ONCE, Template, bundles, message, safe_names, time_tag
from onbeat.live.protocol import RATE, VERSION, BeatSaid, Event, Pose, Status, Who

WHO_EVERY = 2 * RATE
"""Poses after which ``/onbeat/who`` is said again, for those who came later."""
_NONE = np.zeros(0)


class Osc:
    """A mouth that speaks OSC to one address.

    Parameters
    ----------
    host : to speak to, a name or an address; a broadcast address too.
    port : its UDP port.
    points : whether the places of joints are told as well.
    stamped : whether bundles carry the time that they are of. Some receivers hold back what comes "too early" by their
        own clock; for those, without.

    Examples
    --------
    >>> with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
    ...     ear.bind(("127.0.0.1", 0))
    ...     osc = Osc("127.0.0.1", ear.getsockname()[1])
    ...     osc.open(Who("arm", "robot", ("base",), (-1,), ("elbow",), ()))
    ...     osc.close()
    ...     ear.recv(2000)[20:31]
    b'/onbeat/who'
    """

    quick = True

    def __init__(self, host: str, port: int, points: bool = False, stamped: bool = True) -> None:
        self.name = f"OSC to {host}:{port}"
        self._host, self._port = host, port
        self._points = points
        self._stamped = stamped
        self._socket: socket.socket | None = None

    def open(self, who: Who) -> None:
        """Find the host and say who dances.

        Raises
        ------
        OnbeatError
            If there is no such host or port.
        """
        family, self._address = _found(self._host, self._port)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self._who = who
        messages = pose_messages(who, self._points)
        self._template = Template(messages)
        self._words = sum(len(types) for _, types in messages)
        self._turning = who.kind == "character"
        self._introduce()

    def pose(self, pose: Pose) -> None:
        """Send a pose, in as many packets as it needs."""
        words = np.empty((self._words, 4), np.uint8)
        words[0] = np.frombuffer(np.array(pose.number & 0x7FFFFFFF, ">i4").tobytes(), np.uint8)
        words[1:] = _words(pose, self._turning, self._points)
        self._send(self._template.filled(self._tag(pose.time), words))
        self._countdown -= 1
        if self._countdown <= 0:
            self._introduce()

    def say(self, event: Event) -> None:
        """Send an event."""
        self._send(bundles(self._tag(event.time), event_messages(event)))

    def close(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            self._socket.close()
        self._socket = None

    def _tag(self, time: float) -> bytes:
        return time_tag(self._who.started + time) if self._stamped else AT_ONCE

    def _introduce(self) -> None:
        self._countdown = WHO_EVERY
        who = self._who
        self._send(bundles(AT_ONCE, [message("/onbeat/who", who.name[:99], who.kind, VERSION, RATE, who.latency)]))

    def _send(self, packets: Sequence[bytes]) -> None:
        if self._socket is None:
            return
        with suppress(BlockingIOError):
            for packet in packets:
                self._socket.sendto(packet, self._address)


def pose_messages(who: Who, points: bool = False) -> list[tuple[str, str]]:
    """Addresses and types of the messages that tell a pose.

    Examples
    --------
    >>> pose_messages(Who("arm", "robot", ("base",), (-1,), ("elbow",), ()))[1:]
    [('/onbeat/root', 'fffffff'), ('/onbeat/hinge/elbow', 'f')]
    """
    joints = safe_names(who.joints) if who.kind == "character" else []
    return [
        ("/onbeat/pose", "if"),
        ("/onbeat/root", "fffffff"),
        *((f"/onbeat/joint/{name}", "ffff") for name in joints),
        *((f"/onbeat/hinge/{name}", "f") for name in safe_names(who.hinges)),
        *((f"/onbeat/point/{name}", "fff") for name in (safe_names(who.points) if points else [])),
    ]


def event_messages(event: Event) -> list[bytes]:
    r"""An event as messages.

    Examples
    --------
    >>> [one[:16] for one in event_messages(BeatSaid(1.0, 1, 0.9, 0.9))]
    [b'/onbeat/beat\x00\x00\x00\x00']
    """
    if isinstance(event, BeatSaid):
        return [message("/onbeat/beat", event.time, event.position, event.confidence)]
    if not isinstance(event, Status):
        return [message("/onbeat/note", event.text[:500])]
    ahead = [beat - event.time for beat in event.next_beats[:8]]
    return [
        message("/onbeat/tempo", event.tempo, event.confidence),
        message("/onbeat/hearing", event.hearing),
        message("/onbeat/ahead", event.next_position, event.meter, *ahead),
        message("/onbeat/level", max(event.level, default=0.0)),
        message("/onbeat/dancing", event.dancing[:99], event.clock),
    ]


def _words(pose: Pose, turning: bool, points: bool) -> NDArray[np.uint8]:
    """The floats of a pose (N, 4) as big-endian bytes, in the order of its messages."""
    turns = pose.rotations.ravel() if turning else _NONE
    places = pose.points.ravel() if points else _NONE
    floats = np.concatenate([[pose.time], pose.root, pose.rotations[0], turns, pose.angles, places])
    return floats.astype(">f4").view(np.uint8).reshape(-1, 4)


def _found(host: str, port: int) -> tuple[int, Any]:
    """Family and address of a host's UDP port."""
    if not 0 < port < 65536:
        raise OnbeatError(f"port {port}; expected 1 to 65535")
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
    except (OSError, UnicodeError) as error:
        raise OnbeatError(f"no host {host!r} to send OSC to: {error}; expected a name or an address") from None
    return found[0], found[4]
