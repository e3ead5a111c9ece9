"""Who chooses what is danced next, behind one small contract."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from onbeat.live.choice.timeline import Ahead


@dataclass(frozen=True)
class Piece:
    """A stretch of a clip, and how fast it is played."""

    clip: int
    from_s: float
    to_s: float
    rate: float = 1.0

    @property
    def lasts(self) -> float:
        """Seconds of the dance."""
        return (self.to_s - self.from_s) / self.rate


@dataclass(frozen=True)
class Choice:
    """What is danced next.

    Parameters
    ----------
    pieces : in order.
    beats : numbers of beats, and the seconds after the pieces' begin that are to be on them.
    name : of what is danced.
    """

    pieces: tuple[Piece, ...]
    beats: tuple[tuple[int, float], ...]
    name: str


class Picker(Protocol):
    """Chooses what is danced next; knows nothing of poses."""

    @property
    def names(self) -> tuple[str, ...]:
        """What can be asked for by name."""
        ...

    def ask(self, name: str) -> bool:
        """Dance this, or the next one where the name is empty, from the next beginning on; false if it is not known."""
        ...

    def begin(self, at: float, ahead: Ahead) -> Choice:
        """What to begin with at a second of the timeline, coming from rest or from something else."""
        ...

    def go_on(self, at: float, ahead: Ahead, seconds: float) -> Choice:
        """What to go on with for so many seconds or more."""
        ...
