"""What goes over a WebSocket between a session and its page: text for what is said, bytes for poses.

The page's own view of it (``viewer-js/src/live/contract.ts``) is written from these classes and those of
:mod:`onbeat.live.protocol`: ``python -m onbeat.live.page.wire > viewer-js/src/live/contract.ts``; a test keeps the two
equal. Described for others in ``docs/live_protocol.md``.
"""

from __future__ import annotations

import struct
import sys
from typing import Any, Literal

import msgspec
import numpy as np

from onbeat._shapes import Float32
from onbeat.errors import OnbeatError
from onbeat.live.protocol import VERSION, BeatSaid, Command, Event, Note, Pose, Status
from onbeat.viewer.contract import CapsuleData
from onbeat.viewer.typescript import declarations

LONGEST = 4096
"""Bytes of the longest message that is taken from a page."""
_HEAD = struct.Struct("<dI")
_COMMANDS = msgspec.json.Decoder(Command)


class HelloData(msgspec.Struct, frozen=True, tag="hello"):
    """Who dances and how to draw it: the first message on each connection.

    Parameters
    ----------
    version : of what is spoken here.
    title : of the page.
    name, kind, latency, started : see :class:`onbeat.live.protocol.Who`.
    points : (P,) names of the joints whose places the poses tell.
    capsules : the body's shape between those points.
    spine : places, among the points, from the waist up to the neck; the camera follows the first.
    facing, floor : yaw at which the dance begins, 0 along +Y, and height of the ground.
    now : seconds on the session's clock when this was sent.
    choreographies : names of what can be asked for with "play"; none where the dance is made up as it goes.
    sound : whether ``GET /sound`` gives what is heard.
    sound_at : second of the session at which that sound's second 0 is (first) heard.
    sound_seconds : its length; 0 without one.
    loops : whether it begins again at its end.
    """

    version: int
    title: str
    name: str
    kind: Literal["character", "robot"]
    points: list[str]
    capsules: list[CapsuleData]
    spine: list[int]
    facing: float
    floor: float
    latency: float
    started: float
    now: float
    choreographies: list[str] = []
    sound: bool = False
    sound_at: float = 0.0
    sound_seconds: float = 0.0
    loops: bool = False


STRUCTS = (CapsuleData, HelloData, BeatSaid, Status, Note, Command)
"""All classes that go over the wire, parts before the whole."""


def text(said: HelloData | Event | Command) -> str:
    """What is said as one line of JSON whose ``type`` tells what it is.

    Examples
    --------
    >>> text(Note(1.5, "the input is back"))
    '{"type":"note","time":1.5,"text":"the input is back"}'
    """
    return msgspec.json.encode(said).decode()


def read_command(message: str | bytes) -> Command:
    """The command that a page sent.

    Raises
    ------
    OnbeatError
        If it is none.

    Examples
    --------
    >>> read_command('{"type":"command","do":"play","value":"waltz"}')
    Command(do='play', value='waltz')
    """
    try:
        return _COMMANDS.decode(message)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise OnbeatError(
            f'not a command: {error}; expected {{"type":"command","do":"next"|"play"|"rest"|"dance"|"tap","value":""}}'
        ) from None


def packed(pose: Pose) -> bytes:
    """A pose as little-endian bytes: float64 time [s], uint32 number, float32 points (P, 3) [m]."""
    return _HEAD.pack(pose.time, pose.number & 0xFFFFFFFF) + np.ascontiguousarray(pose.points, "<f4").tobytes()


def unpacked(message: bytes) -> tuple[float, int, Float32]:
    """Time, number and points (P, 3) of a packed pose.

    Raises
    ------
    OnbeatError
        If it is none.

    Examples
    --------
    >>> unpacked(struct.pack("<dI3f", 0.25, 25, 1.0, 2.0, 3.0))
    (0.25, 25, array([[1., 2., 3.]], dtype=float32))
    """
    if len(message) < _HEAD.size or (len(message) - _HEAD.size) % 12:
        raise OnbeatError(f"a pose of {len(message)} bytes; expected {_HEAD.size} and 12 for each point")
    time, number = _HEAD.unpack_from(message)
    points: Any = np.frombuffer(message, "<f4", offset=_HEAD.size).reshape(-1, 3)
    return time, number, points


def typescript() -> str:
    """The page's view of all this."""
    told = "/** What comes as text. */\nexport type Told = HelloData | BeatSaid | Status | Note;\n"
    return declarations(STRUCTS, VERSION, "python -m onbeat.live.page.wire", "wire.py and protocol.py") + "\n" + told


if __name__ == "__main__":
    sys.stdout.write(typescript())
