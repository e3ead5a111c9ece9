"""When a second of the session is, by this machine's clock, learnt from when poses come."""

from __future__ import annotations

CREEP = 1e-5
"""Seconds a pose by which what is believed may fall behind: 1 ms a second, more than clocks differ."""
JUMP = 0.5
"""Seconds beyond which a pose is not late but the session has stood still."""


class SessionClock:
    """The session's clock and the machine's, held together by poses, that may come late but never early.

    The least late of them counts, slowly forgotten: threads that wait for each other do not move the clock.

    Examples
    --------
    >>> clock = SessionClock()
    >>> for time, late in ((0.0, 0.004), (0.01, 0.0), (0.02, 0.007)):
    ...     clock.seen(time, 100.0 + time + late)
    >>> round(clock.when(1.0), 3)
    101.0
    """

    def __init__(self) -> None:
        self._offset: float | None = None

    @property
    def known(self) -> bool:
        """Whether a pose was seen yet."""
        return self._offset is not None

    def seen(self, time: float, now: float) -> None:
        """A pose of a second of the session came at a second of the machine's clock."""
        offset = now - time
        if self._offset is None or offset < self._offset or offset > self._offset + JUMP:
            self._offset = offset
        else:
            self._offset += min(offset - self._offset, CREEP)

    def when(self, time: float) -> float:
        """The machine's second at which a second of the session is; the same before any pose was seen."""
        return time + (self._offset or 0.0)
