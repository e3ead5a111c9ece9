"""A microphone, or any input of a sound card, that may go and come back.

The device's thread only copies its blocks to a queue. A thread of its own looks ten times a second whether the input is
alive, and tries to open it again every second while it is not; nobody who reads ever waits for either.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from onbeat._shapes import Float32
from onbeat.errors import AudioError
from onbeat.live.sound.listener import Block, Handover, State
from onbeat.live.sound.sound_card import Input, find_again, find_input, inputs, look_again, sound_card

__all__ = ["Microphone", "inputs"]

BLOCK = 0.01  # [s] that the device gives at once
BUFFER = 0.03  # [s] asked of PortAudio: less is lost sooner on a busy machine
CHANNELS = 2  # that are opened of an input that has more, unless told otherwise
LOST = 0.5  # [s] without a block, after which an input is lost
SLOW = 3.0  # [s] that an input may take to begin
AGAIN = 1.0  # [s] between two tries to open it
LOOK = 0.1  # [s] between two looks
MUTE = 10.0  # [s] of nothing but zeros, after which an input is said to be mute
SMOOTH = 0.02  # share of a new latency in the one that is told


class Microphone:
    """An input of the sound card.

    Parameters
    ----------
    device : its index or a part of its name; the default input where None.
    channels : how many to open, from the first; two, where there are so many, by default.
    card : the module ``sounddevice``, or one like it.
    clock : seconds that rise.
    """

    def __init__(
        self,
        device: str | int | None = None,
        channels: int | None = None,
        card: Any = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._device, self._channels, self._clock = device, channels, clock
        self._card: Any = card
        self._stream: Any = None
        self._known: Input | None = None
        self._way = Handover()
        self._closed = threading.Event()
        self._watcher: threading.Thread | None = None
        self._state: State = "waiting"
        self._lost: str | None = None  # name of the input that was lost
        self._number = 0  # of the stream that is heard: what an older one still gives is not
        self._last, self._tried = 0.0, 0.0  # seconds of the clock: of the last block, and of the last try
        self._latency = 0.0
        self._overflowed = False
        self._zeros: float | None = 0.0  # [s] of nothing but zeros; None once anything else was heard, or it was said

    @property
    def state(self) -> State:
        """How it is: it waits for its first block, gives sound, is lost, or closed."""
        return self._state

    @property
    def latency(self) -> float:
        """Seconds since the newest sample sounded, when its block came, as PortAudio tells it."""
        return self._latency

    def start(self, watch: bool = True) -> None:
        """Open the input.

        Parameters
        ----------
        watch : whether a thread looks after it; else :meth:`look` is to be called.

        Raises
        ------
        MissingExtraError
            If sounddevice or PortAudio is not installed.
        AudioError
            If there is no such input, or it cannot be opened.
        """
        self._card = self._card or sound_card()
        self._known = find_input(self._device, self._card)
        try:
            self._open(self._known)
        except (self._card.PortAudioError, ValueError) as error:
            self._let_go()
            raise AudioError(
                f"the input {self._known.name} cannot be opened ({error}); is another program using it? "
                f"The inputs are: {'; '.join(inputs(self._card))}"
            ) from None
        if watch:
            self._watcher = threading.Thread(target=self._watch, name="watching the input", daemon=True)
            self._watcher.start()

    def read(self) -> list[Block]:
        """All blocks (n, channels) since the last call, of the last two seconds at the most."""
        blocks = self._way.take()
        if self._zeros is not None:
            self._listen_for_zeros(blocks)
        return blocks

    def notes(self) -> list[str]:
        """What people should know, since the last call."""
        return self._way.notes()

    def close(self) -> None:
        """Give the input back."""
        self._closed.set()
        if self._watcher is None:
            self._let_go()
        elif self._watcher is not threading.current_thread():
            self._watcher.join(timeout=2.0)  # a device that is gone may not let go; its thread is left behind
        self._state = "ended"

    def look(self) -> None:
        """See whether the input is alive; try to open it again where it is not and a second has passed."""
        now = self._clock()
        if self._stream is None:
            if now - self._tried >= AGAIN:
                self._try_again(now)
        elif reason := self._dead(now):
            self._tried, self._number = now, self._number + 1
            if self._state != "lost":  # else it was opened again, and still gives nothing
                self._state, self._lost = "lost", self._name
                self._way.say(f"the input {self._name} is lost ({reason}); it is tried again every second")
            self._let_go()  # last: a device that is gone may take its time

    @property
    def _name(self) -> str:
        return self._known.name if self._known else "of the sound card"

    def _watch(self) -> None:
        while not self._closed.wait(LOOK):
            self.look()
        self._let_go()

    def _dead(self, now: float) -> str | None:
        """Why the input is to be given up, if it is."""
        try:
            if not self._stream.active:
                return "it has stopped"
        except self._card.PortAudioError as error:
            return str(error)
        patience = LOST if self._state == "sound" else SLOW
        return "no sound comes from it" if now - self._last > patience else None

    def _try_again(self, now: float) -> None:
        self._tried = now
        try:
            look_again(self._card)
            known = self._known if self._device is not None else None  # else whichever is the default by now
            self._open(find_again(known, self._card) if known else find_input(None, self._card))
        except (self._card.PortAudioError, AudioError, ValueError, OSError):
            self._let_go()

    def _open(self, found: Input) -> None:
        asked = CHANNELS if self._channels is None else self._channels
        if asked < 1 or (self._channels or 1) > found.channels:
            raise ValueError(f"{self._channels} channels; it has {found.channels}")
        self._known, self._last, self._number = found, self._clock(), self._number + 1
        self._stream = self._card.InputStream(
            device=found.index,
            samplerate=found.rate,
            blocksize=round(BLOCK * found.rate),
            channels=min(asked, found.channels),
            dtype="float32",
            latency=BUFFER,
            callback=self._hear(found.rate, self._number),
        )
        self._latency = max(float(self._stream.latency) - BLOCK, 0.0)
        self._stream.start()

    def _let_go(self) -> None:
        stream, self._stream = self._stream, None
        if stream is not None:
            try:
                stream.abort()
                stream.close()
            except (self._card.PortAudioError, OSError):
                pass  # it is gone already

    def _hear(self, rate: int, number: int) -> Callable[[Float32, int, Any, Any], None]:
        """What the device's thread calls with each block: it copies, and notes when."""

        def heard(block: Float32, frames: int, when: Any, status: Any) -> None:
            if number != self._number:
                return
            self._way.put(block.copy(), rate)
            self._last = self._clock()
            age = when.currentTime - when.inputBufferAdcTime - frames / rate
            if when.inputBufferAdcTime > 0.0 and 0.0 <= age < 1.0:
                self._latency += SMOOTH * (age - self._latency)
            if self._state != "sound" and not self._closed.is_set():
                self._begin()
            if status.input_overflow and not self._overflowed:
                self._overflowed = True
                self._way.say("the machine is too busy: some sound of the input is lost")

        return heard

    def _begin(self) -> None:
        self._state = "sound"
        if self._lost == self._name:
            self._way.say(f"the input {self._name} is back")
        elif self._lost is not None:
            self._way.say(f"the input {self._name} is heard now, instead of {self._lost}")

    def _listen_for_zeros(self, blocks: list[Block]) -> None:
        for block, rate in blocks:
            if np.count_nonzero(block):
                self._zeros = None
                return
            self._zeros = (self._zeros or 0.0) + len(block) / rate
        if self._zeros is not None and self._zeros > MUTE:
            self._way.say(f"the input {self._name} gives only zeros: is it muted, or may this program not hear it?")
            self._zeros = None
