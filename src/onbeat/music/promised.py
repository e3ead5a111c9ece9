"""How much sound a file's header promises against what is there: cut-off WAV and AIFF files open as if all was well."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO, Literal

# Sizes from here on say that the writer did not know them: ffmpeg writes 2^32 - 1 to a pipe, SoX 2^31 - 4096.
UNKNOWN = 0x7FFFF000
MOST_CHUNKS = 10_000  # that are looked at before the sound
_KINDS: dict[bytes, Literal["little", "big"]] = {b"RIFF": "little", b"RIFX": "big", b"FORM": "big"}
_SOUND = (b"data", b"SSND")


def promised_share(path: str | os.PathLike[str]) -> float:
    """How many times the sound that is there a WAV or AIFF file promises; 1 where nothing is missing, or not known.

    Examples
    --------
    >>> import tempfile
    >>> head = b"RIFF" + (2036).to_bytes(4, "little") + b"WAVEdata" + (2000).to_bytes(4, "little")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (path := Path(folder) / "cut_off.wav").write_bytes(head + bytes(500))
    ...     promised_share(path)
    4.0
    """
    try:
        with Path(path).open("rb") as file:
            return _share(file, os.fstat(file.fileno()).st_size)
    except OSError:
        return 1.0


def _share(file: BinaryIO, size: int) -> float:
    order = _KINDS.get(file.read(12)[:4])
    if order is None:
        return 1.0
    for _ in range(MOST_CHUNKS):
        head = file.read(8)
        if len(head) < 8:
            return 1.0
        length = int.from_bytes(head[4:], order)
        if head[:4] in _SOUND:
            there = size - file.tell()
            return length / there if 0 < there < length < UNKNOWN else 1.0
        file.seek(length + length % 2, os.SEEK_CUR)
    return 1.0
