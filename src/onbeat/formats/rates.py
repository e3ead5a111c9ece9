"""Rates of frames: what a printed frame time means, and what is assumed where a file stores none."""

from __future__ import annotations

import warnings
from decimal import Decimal, InvalidOperation

from onbeat.formats.notes import tell

ASK = "say it with --source-fps"
_WHOLE_TOLERANCE = 2.5e-3


class RateWarning(UserWarning):
    """The rate of a file is not stored, or contradicted, and was assumed."""


def assumed(fps: float, files: str, why: str = "") -> float:
    """The rate, with a :class:`RateWarning` that such files store none; ``why`` says where it is from."""
    because = f", {why}" if why else ""
    warnings.warn(
        f"{files} no frame rate: {fps:g} frames a second are assumed{because}; {ASK}", RateWarning, stacklevel=4
    )
    tell("fps", f"{fps:g}", f"none is stored{because}")
    return fps


def printed_rate(frame_time: str) -> float | None:
    """Frames a second by a printed frame time; None where it is none.

    Printing rounds: a time that is ``1/n`` or film's ``1001/(1000 n)`` to its last digit counts as that exactly.

    Examples
    --------
    >>> [printed_rate(text) for text in ("0.0083333", "8.333e-03", "0.04", "0.016")]
    [120.0, 120.0, 25.0, 62.5]
    >>> round(printed_rate("0.033367"), 6)
    29.97003
    """
    try:
        exact = Decimal(frame_time)
        seconds, place = float(exact), exact.as_tuple().exponent
    except (InvalidOperation, ValueError, OverflowError):
        return None
    if not isinstance(place, int) or not 1e-6 <= seconds <= 1e6:
        return None
    rounding = min(0.51 * 10.0 ** min(place, 6), _WHOLE_TOLERANCE * seconds)
    for ratio in (1.0, 1000 / 1001):
        rate = max(round(1 / seconds / ratio), 1) * ratio
        if abs(1 / rate - seconds) <= rounding:
            tell("fps", f"{rate:.6g}", f"the frame time {frame_time} is 1/{rate:.6g} s, as printed")
            return rate
    tell("fps", f"{1 / seconds:.6g}", f"the frame time is {frame_time} s")
    return 1 / seconds
