"""OSC 1.0 messages and bundles as bytes; what is said a hundred times a second is prepared once.

A packet of floats is laid out when the dancer is known; a pose then only writes its numbers into their places. Packets
stay below what any network carries in one piece.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

LARGEST = 1400
"""Bytes of a packet."""
SINCE_1900 = 2_208_988_800
"""Seconds from 1900, where NTP's time begins, to 1970."""
AT_ONCE = struct.pack(">II", 0, 1)
"""The time tag of what is not timed."""
_LONGEST_NAME = 60


def time_tag(seconds: float) -> bytes:
    """The 64 bits of NTP for seconds since 1970.

    Examples
    --------
    >>> time_tag(0.5).hex()
    '83aa7e8080000000'
    """
    whole, part = divmod(round((seconds + SINCE_1900) * 2**32), 2**32)
    return struct.pack(">II", whole & 0xFFFFFFFF, part)


def message(address: str, *values: float | str) -> bytes:
    r"""An OSC message with arguments of int32, float32 and strings, as the values are.

    Examples
    --------
    >>> message("/a", 1, 0.5, "b")
    b'/a\x00\x00,ifs\x00\x00\x00\x00\x00\x00\x00\x01?\x00\x00\x00b\x00\x00\x00'
    """
    kinds = "".join("s" if isinstance(v, str) else "i" if isinstance(v, int) else "f" for v in values)
    parts = [v if isinstance(v, str) else struct.pack(">i" if isinstance(v, int) else ">f", v) for v in values]
    return _text(address) + _text("," + kinds) + b"".join(_text(v) if isinstance(v, str) else v for v in parts)


def bundles(tag: bytes, messages: Iterable[bytes]) -> list[bytes]:
    """Messages in as few packets as they fit in, all of one time."""
    packets = [b"#bundle\0" + tag]
    for one in messages:
        if len(packets[-1]) + 4 + len(one) > LARGEST and len(packets[-1]) > 16:
            packets.append(b"#bundle\0" + tag)
        packets[-1] += struct.pack(">i", len(one)) + one
    return packets


def safe_names(names: Sequence[str]) -> list[str]:
    """Names as parts of addresses: what OSC reserves or does not know becomes ``_``, equal ones get numbers.

    Examples
    --------
    >>> safe_names(["left arm", "left/arm", "Köpf"])
    ['left_arm', 'left_arm_2', 'K_pf']
    """
    safe: list[str] = []
    for name in names:
        plain = "".join(letter if "!" <= letter <= "~" and letter not in "#*,/?[]{}" else "_" for letter in name)
        plain = plain[:_LONGEST_NAME] or "_"
        number = 2
        unique = plain
        while unique in safe:
            unique, number = f"{plain}_{number}", number + 1
        safe.append(unique)
    return safe


class Template:
    """Bundles of messages that differ from time to time in their numbers alone.

    Parameters
    ----------
    messages : address and types of each: of ``i`` (int32) and ``f`` (float32), of four bytes both.

    Examples
    --------
    >>> template = Template([("/a", "ff")])
    >>> words = np.array([1.0, -2.0], ">f4").view(np.uint8).reshape(-1, 4)
    >>> template.filled(AT_ONCE, words) == bundles(AT_ONCE, [message("/a", 1.0, -2.0)])
    True
    """

    def __init__(self, messages: Sequence[tuple[str, str]]) -> None:
        counts = iter([len(types) for _, types in messages])
        empty = [_text(address) + _text("," + types) + bytes(4 * len(types)) for address, types in messages]
        self._packets = [bytearray(packet) for packet in bundles(AT_ONCE, empty)]
        self._places = [np.array(_word_places(packet, counts)).reshape(-1, 4) for packet in self._packets]

    def filled(self, tag: bytes, words: NDArray[np.uint8]) -> list[bytes]:
        """The packets with a time tag and the bytes (N, 4) of their numbers, big-endian, in order."""
        done = 0
        for packet, places in zip(self._packets, self._places, strict=True):
            packet[8:16] = tag
            np.frombuffer(packet, np.uint8)[places] = words[done : done + len(places)]
            done += len(places)
        return [bytes(packet) for packet in self._packets]


def _word_places(packet: bytes | bytearray, counts: Iterator[int]) -> list[int]:
    """Where the bytes of a bundle's numbers are; they are the last of each message."""
    places: list[int] = []
    at = 16
    while at < len(packet):
        at += 4 + struct.unpack_from(">i", packet, at)[0]
        places += range(at - 4 * next(counts), at)
    return places


def _text(text: str) -> bytes:
    """A string with at least one zero behind it, up to a multiple of four."""
    data = text.replace("\0", " ").encode(errors="replace")
    return data + b"\0" * (4 - len(data) % 4)
