"""What somebody who keeps time says of it: where a beat is, how fast they go, and where in the bar it stands."""

from __future__ import annotations

from typing import NamedTuple


class Reading(NamedTuple):
    """Beats of the music, as a tracker, a machine's clock or a tapping person has them.

    Parameters
    ----------
    time : seconds of one beat, near now.
    period : seconds between two beats.
    position : of that beat in the bar, 0 at the downbeat.
    meter : beats in a bar.
    """

    time: float
    period: float
    position: int
    meter: int

    def beats_at(self, time: float) -> float:
        """Beats from the downbeat before the one known to a time, a fraction.

        >>> Reading(10.0, 0.5, 1, 4).beats_at(11.25)
        3.5
        """
        return self.position + (time - self.time) / self.period
