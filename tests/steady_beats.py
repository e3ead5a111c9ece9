"""Stand-ins for tests of the conductor: a timeline that only keeps books, and beats that come as they are told."""

from __future__ import annotations

import numpy as np

from onbeat.live.beat.pulse import Heard


class Books:
    """A timeline without poses."""

    def __init__(self, margin: float = 0.4) -> None:
        self.moves: list[tuple[float, int, float, float, float]] = []  # at, clip, from, to, rate
        self.settled, self.margin = 0.0, margin

    @property
    def end(self) -> float:
        if not self.moves:
            return 0.0
        at, _, begin, end, rate = self.moves[-1]
        return at + (end - begin) / rate

    def settle(self, before: float) -> None:
        assert before <= self.end + 1e-9
        self.settled = max(self.settled, before)

    def add(self, clip: int, from_s: float, to_s: float, rate: float = 1.0) -> None:
        assert to_s > from_s >= 0
        self.moves.append((self.end, clip, from_s, to_s, rate))

    def cut(self, at: float) -> None:
        assert at >= self.settled + self.margin - 1e-9
        kept = [move for move in self.moves if move[0] < at - 1e-9]
        start, clip, begin, _, rate = kept[-1]
        kept[-1] = (start, clip, begin, begin + (at - start) * rate, rate)
        self.moves = kept

    def forget(self, before: float) -> None:
        assert before <= self.settled

    def showing(self, time: float) -> tuple[int, float]:
        start, clip, begin, _, rate = [move for move in self.moves if move[0] <= time + 1e-9][-1]
        return clip, begin + (time - start) * rate


def heard(time: float, period: float, hearing: str = "music", offset: float = 0.1, meter: int = 4) -> Heard:
    """Steady beats at ``offset + k · period``, as they are heard at a time; beat 0 begins a bar."""
    first = int(np.floor((time - offset) / period))
    numbers = first + np.arange(13)
    return Heard(
        time, (), hearing, 60 / period if hearing != "nothing" else 0.0, 0.9, meter, 0.5, 0.0,
        first, offset + numbers * period, numbers % meter + 1,
    )  # fmt: skip
