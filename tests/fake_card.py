"""A module that behaves as sounddevice does: inputs that come and go, streams whose blocks a test gives."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np


class PortAudioError(Exception):
    pass


class FakeStream:
    """An input stream; ``give`` calls its callback as PortAudio's thread does."""

    def __init__(self, card: FakeCard, **asked: Any) -> None:
        if asked["device"] >= len(card.plugged):
            raise PortAudioError("Error opening InputStream: Invalid device [PaErrorCode -9996]")
        if card.busy:
            raise PortAudioError("Error opening InputStream: Device unavailable [PaErrorCode -9985]")
        self.asked, self.card = asked, card
        self.latency, self.active, self.closed = 0.03, False, False
        card.streams.append(self)

    def start(self) -> None:
        self.active = True

    def abort(self) -> None:
        if self.card.rude:
            raise PortAudioError("Error aborting stream")
        self.active = False

    def close(self) -> None:
        self.active, self.closed = False, True

    def give(self, value: float = 0.25, age: float = 0.025, overflow: bool = False) -> None:
        frames = self.asked["blocksize"]
        block = np.full((frames, self.asked["channels"]), value, np.float32)
        when = SimpleNamespace(currentTime=100.0 + age, inputBufferAdcTime=100.0)
        self.asked["callback"](block, frames, when, SimpleNamespace(input_overflow=overflow))
        block[:] = np.nan  # PortAudio's memory is used again


class FakeCard:
    """Inputs are (name, channels, rate); they are looked for when it is first initialised only, as by PortAudio."""

    PortAudioError = PortAudioError

    def __init__(self, *plugged: tuple[str, int, int]) -> None:
        self.plugged = list(plugged)
        self.known = list(plugged)
        self.streams: list[FakeStream] = []
        self.busy = self.rude = self.down = False
        self.begun = 1  # as often as it was initialised and not terminated

    def _terminate(self) -> None:
        if not self.begun:
            raise PortAudioError("Error terminating PortAudio")
        self.begun -= 1

    def _initialize(self) -> None:
        if self.down:
            raise PortAudioError("Error initializing PortAudio")
        self.known = self.known if self.begun else list(self.plugged)
        self.begun += 1

    def query_devices(self, device: int | str | None = None, kind: str | None = None) -> Any:
        if device is None and kind is None:
            return [self._info(index) for index in range(len(self.known))]
        if isinstance(device, str):
            found = [index for index, (name, _, _) in enumerate(self.known) if device.lower() in name.lower()]
            if len(found) != 1:
                raise ValueError(f"{'Multiple' if found else 'No'} input device matching {device!r}")
            device = found[0]
        index = 0 if device is None else device
        if not 0 <= index < len(self.known):
            raise PortAudioError("Error querying device -1")
        if self.known[index][1] < 1:
            raise ValueError(f"Not an input device: {self.known[index][0]!r}")
        return self._info(index)

    def query_hostapis(self, index: int) -> dict[str, Any]:
        return {"name": ["ALSA"][index]}

    def InputStream(self, **asked: Any) -> FakeStream:
        return FakeStream(self, **asked)

    def _info(self, index: int) -> dict[str, Any]:
        name, channels, rate = self.known[index]
        about = {"name": name, "index": index, "hostapi": 0, "default_samplerate": float(rate)}
        return about | {"max_input_channels": channels}
