"""The rate of frames whose times are stored."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import FormatError

_EVEN = 1e-3
"""How far a time may be from an even rate, as a share of the step."""
_ROUNDED = 2e-6
"""Seconds by which a time may be off since it was rounded when it was written."""


def even_rate(times: Times, label: str, alone: float = 200.0) -> float:
    """Frames a second of times (F,) that are even; ``alone`` for a single one. Whole numbers are found again.

    Raises
    ------
    FormatError
        If they are not even, or do not rise; the first that is off is named.

    Examples
    --------
    >>> even_rate(np.array([0, 0.016667, 0.033333, 0.05]), "dance.pos")
    60.0
    """
    if len(times) == 1:
        return alone
    step = float(times[-1] - times[0]) / (len(times) - 1)
    off = np.abs(times - times[0] - step * np.arange(len(times)))
    if step <= _ROUNDED or off.max() > max(_EVEN * step, _ROUNDED):
        raise FormatError(
            f"{label}: frame {int(np.argmax(off > max(_EVEN * step, _ROUNDED)))}: its time is not even; "
            f"frames {step:g} s apart are expected"
        )
    whole = round(1 / step)
    return float(whole) if abs(1 / step - whole) < 1e-4 * whole else 1 / step
