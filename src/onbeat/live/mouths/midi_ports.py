"""MIDI ports by their names, through mido and whatever it plays on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from onbeat.errors import MissingExtraError, OnbeatError

NEW = "new:"
"""Before a name: a port that others connect to is made, where the system can."""


class Port(Protocol):
    """What is needed of a port."""

    def send(self, message: Any) -> None:
        """Send a message."""
        ...

    def close(self) -> None:
        """Close the port."""
        ...


def open_output(name: str) -> Port:
    """Open the port to send to that has this name, or the one that has it in its name; "new:NAME" makes one.

    Raises
    ------
    MissingExtraError
        If mido, or what it plays on, is not installed.
    OnbeatError
        If there is no such port; the message names those there are.
    """
    mido = midi()
    if name.startswith(NEW):
        return _tried(lambda: mido.open_output(name.removeprefix(NEW) or "onbeat", virtual=True), name)
    return _tried(lambda: mido.open_output(chosen(name, mido.get_output_names())), name)


def open_input(name: str, heard: Callable[[Any], None]) -> Port:
    """Open the port to hear, found as :func:`open_output` does; ``heard`` is called with each message."""
    mido = midi()
    if name.startswith(NEW):
        return _tried(lambda: mido.open_input(name.removeprefix(NEW) or "onbeat", virtual=True, callback=heard), name)
    return _tried(lambda: mido.open_input(chosen(name, mido.get_input_names()), callback=heard), name)


def chosen(name: str, names: list[str]) -> str:
    """The name that is meant: the same, or else the only one that has it in it, large or small letters alike.

    Examples
    --------
    >>> chosen("drum", ["TR-8 Drums 20:0", "Keys 24:0"])
    'TR-8 Drums 20:0'
    """
    if name in names:
        return name
    like = [other for other in names if name and name.lower() in other.lower()]
    if len(set(like)) == 1:
        return like[0]
    there = ", ".join(repr(other) for other in names) or "none"
    raise OnbeatError(f"{'more than one' if like else 'no'} MIDI port is called {name!r}; there are: {there}")


def midi() -> Any:
    """The module ``mido``.

    Raises
    ------
    MissingExtraError
        If it is not installed.
    """
    try:
        import mido
    except ImportError:
        raise MissingExtraError('MIDI needs mido: pip install "onbeat[live]"') from None
    return mido


def _tried(opening: Callable[[], Port], name: str) -> Port:
    try:
        return opening()
    except OnbeatError:
        raise
    except ImportError as error:
        raise MissingExtraError(
            f"mido has nothing to play MIDI on ({error}): pip install python-rtmidi, or set MIDO_BACKEND"
        ) from None
    except Exception as error:  # each backend has errors of its own
        raise OnbeatError(
            f"the MIDI port {name!r} cannot be opened: {error}; is it plugged in, and not in use?"
        ) from None
