"""Pulses of motions that cannot be one dance's: told, for keyposes found by them are not the same poses."""

from __future__ import annotations

import sys
from collections.abc import Sequence

APART = 1.15
"""How many times as fast as another's a person's pulse may be and still be that of the same dance."""


def tell_unlike_pulses(names: Sequence[str], tempi: Sequence[float | None]) -> None:
    """A line on stderr where the motions' own pulses are far apart.

    Parameters
    ----------
    names : of the motions.
    tempi : beats a minute of each, where they are the motion's own; None where the beats were told, or the keyposes.
    """
    own = {name: tempo for name, tempo in zip(names, tempi, strict=True) if tempo is not None}
    if not own or max(own.values()) <= APART * min(own.values()):
        return
    told = ", ".join(f"{name} {tempo:.0f}" for name, tempo in own.items())
    print(  # noqa: T201
        f"onbeat: the motions' own pulses are not one dance's ({told} a minute): keyposes found by them are other "
        "poses in each, and so is what is compared; give --music or --beats, NAME.beats beside each, or its keyposes, "
        "NAME.keyposes.csv",
        file=sys.stderr,
    )
