"""Where in the bar the danced beats stand; an opinion has to last before the counting changes."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Ints, frozen
from onbeat.live.beat.fold import Danced

PATIENCE = 2  # beats for which another count has to be heard


class Bar:
    """Counts the danced beats in their bars.

    Examples
    --------
    >>> bar = Bar()
    >>> bar.hear(Danced(1.0, 0.5, 2, 4), 7, sure=True)
    >>> bar.positions(5, 4).tolist()
    [1, 2, 3, 4]
    """

    def __init__(self) -> None:
        self.meter = 4
        self._origin = 0  # the number of some downbeat, below the meter
        self._other: tuple[int, int] | None = None
        self._until = 0

    def hear(self, danced: Danced, number: int, sure: bool = False) -> None:
        """The beat of that number stands where ``danced`` says; ``sure``: believe it at once."""
        said = (danced.meter, (number - danced.position) % danced.meter)
        if said == (self.meter, self._origin):
            self._other = None
        elif sure or (said == self._other and number >= self._until):
            (self.meter, self._origin), self._other = said, None
        elif said != self._other:
            self._other, self._until = said, number + PATIENCE

    def positions(self, first: int, count: int) -> Ints:
        """Places in the bar, from 1, of so many beats from that number on."""
        return frozen((np.arange(first, first + count) - self._origin) % self.meter + 1, np.int64)
