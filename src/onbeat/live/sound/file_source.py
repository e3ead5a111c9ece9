"""A song in a file, played to the ears at its own pace."""

from __future__ import annotations

import itertools
import os
import queue
import threading
import time
from collections.abc import Iterator

import numpy as np

from onbeat._shapes import Float32
from onbeat.errors import AudioError, OnbeatError
from onbeat.live.sound.listener import Block
from onbeat.live.sound.played import Clock, Played
from onbeat.music.audio import audio_duration, native_blocks

SHORT = 0.98  # of its length by the header, below which a song ends early
CHECKED = 2  # blocks of a file that are read before it begins: short files are known to be whole


class FileSource(Played):
    """A song in a file, decoded ahead by a thread of its own.

    Parameters
    ----------
    path : any file that :func:`onbeat.music.audio.read_audio` reads.
    speed_up : seconds of song per second of the clock.
    loop : whether it begins again at its end.
    clock : seconds that rise.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        speed_up: float = 1.0,
        loop: bool = False,
        clock: Clock = time.monotonic,
    ) -> None:
        super().__init__(speed_up, loop, clock)
        self._path = path
        self._ahead: queue.Queue[Float32 | None] = queue.Queue(maxsize=2)
        self._block = np.zeros((0, 1), np.float32)
        self._stop = threading.Event()
        self._finished = False

    def start(self) -> None:
        """Read the beginning, and begin.

        Raises
        ------
        AudioError
            If the file is missing, a folder, empty, not sound, holds none, or is damaged within its first second.
        MissingExtraError
            If it needs PyAV and that is not installed.
        """
        blocks = native_blocks(self._path)
        first = list(itertools.islice(blocks, CHECKED))
        if not first:
            raise AudioError(f"{self._path}: holds no sound (0 samples); expected a song")
        self._rate = first[0][1]
        self.seconds = audio_duration(self._path)
        rounds = itertools.chain(first, blocks)
        threading.Thread(target=self._decode, args=(rounds,), name="decoding", daemon=True).start()
        block = self._ahead.get()  # the clock does not run before there is something to hear
        self._finished = block is None
        self._block = self._block if block is None else block
        self._begin()

    def close(self) -> None:
        """End, and let go of the file."""
        self._stop.set()
        super().close()

    def _decode(self, blocks: Iterator[Block]) -> None:
        """Fill the queue until the song is over or nobody listens any more."""
        try:
            for block, _ in self._rounds(blocks):
                if not self._put(block):
                    return
        except (OnbeatError, UserWarning) as error:  # a warning, where warnings are made errors
            self._way.say(str(error))
        self._put(None)

    def _rounds(self, blocks: Iterator[Block]) -> Iterator[Block]:
        while True:
            read, rate = 0, 1
            for block, rate in blocks:
                read += len(block)
                yield block, rate
            if read / rate < SHORT * self.seconds - 1.0:
                self._way.say(f"the song ends early: {read / rate:.1f} s of {self.seconds:.1f} s can be read")
            if not self._loop:
                return
            self.seconds = read / rate  # what a header says is a guess, of some formats
            blocks = native_blocks(self._path)

    def _put(self, block: Float32 | None) -> bool:
        while not self._stop.is_set():
            try:
                self._ahead.put(block, timeout=0.2)
            except queue.Full:
                continue
            return True
        return False

    def _next(self, count: int) -> Float32:
        parts = [self._block[:count]]
        self._block = self._block[count:]
        left = count - len(parts[0])
        while left and not self._finished:
            try:
                block = self._ahead.get_nowait()
            except queue.Empty:
                break
            self._finished = block is None
            if block is not None:
                parts.append(block[:left])
                self._block = block[left:]
                left -= len(parts[-1])
        some = [part for part in parts if len(part)]
        return np.concatenate(some) if some else np.zeros((0, 1), np.float32)

    def _over(self) -> bool:
        if not len(self._block) and not self._finished and not self._ahead.empty():
            self._finished = self._ahead.queue[0] is None
        return self._finished and not len(self._block)
