"""The sound card, by PortAudio: the module ``sounddevice`` of the extra ``[live]``, and the inputs it finds."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from onbeat.errors import AudioError, MissingExtraError


@lru_cache(maxsize=1)
def sound_card() -> Any:
    """The module ``sounddevice``.

    Raises
    ------
    MissingExtraError
        If it, or the PortAudio library under it, is not installed; the message is the line that installs it.
    """
    try:
        import sounddevice
    except ImportError:
        raise MissingExtraError('a sound card needs sounddevice: pip install "onbeat[live]"') from None
    except OSError:
        raise MissingExtraError(
            "a sound card needs PortAudio: sudo apt install libportaudio2 (or your system's package of it)"
        ) from None
    return sounddevice


@dataclass(frozen=True)
class Input:
    """An input of the sound card: its index, names of it and of the system it is of, channels, samples per second."""

    index: int
    name: str
    system: str
    channels: int
    rate: int


def find_input(device: str | int | None, card: Any) -> Input:
    """The input of that index or with that in its name; the default one where none is named.

    Raises
    ------
    AudioError
        If there is none, or more than one; the message names all there are.
    """
    chosen = int(device) if isinstance(device, str) and device.isdecimal() else device
    try:
        found = card.query_devices(chosen, "input")
        return _input(found, card)
    except (card.PortAudioError, ValueError) as error:
        there = inputs(card)
        named = "no default input" if chosen is None else f"no input {device!r}"
        if not there:
            raise AudioError(
                f"{named}: there is no sound input; plug one in, or play a file (--input song.wav)"
            ) from None
        reason = str(error).splitlines()[0] if str(error) else "not found"
        raise AudioError(f"{named} ({reason}); the inputs are: {'; '.join(there)}") from None


def find_again(known: Input, card: Any) -> Input:
    """The input of the same names, whose index may be another by now.

    Raises
    ------
    AudioError
        If it is not there.
    """
    for found in _all(card):
        if (found.name, found.system) == (known.name, known.system):
            return found
    raise AudioError(f"the input {known.name} is not there; plug it in again")


def inputs(card: Any = None) -> list[str]:
    """The inputs of the sound card, one line each, its index first; none where there is no card.

    Parameters
    ----------
    card : the module ``sounddevice``, or one like it.

    Raises
    ------
    MissingExtraError
        If sounddevice or PortAudio is not installed.
    """
    card = card or sound_card()
    found = _all(card)
    return [f"{one.index}: {one.name} ({one.system}, {one.channels} channels, {one.rate} Hz)" for one in found]


def look_again(card: Any) -> None:
    """Let PortAudio see devices that came or went, which it does only when it begins; all its streams end."""
    if hasattr(card, "_terminate") and hasattr(card, "_initialize"):
        with contextlib.suppress(card.PortAudioError):  # it may not have begun, at the last try
            card._terminate()
        card._initialize()


def _all(card: Any) -> list[Input]:
    try:
        return [_input(found, card) for found in card.query_devices() if found["max_input_channels"] > 0]
    except (card.PortAudioError, ValueError):
        return []


def _input(found: Any, card: Any) -> Input:
    system = str(card.query_hostapis(found["hostapi"])["name"])
    channels, rate = int(found["max_input_channels"]), round(found["default_samplerate"])
    return Input(int(found["index"]), str(found["name"]), system, channels, rate)
