"""What is said where a library cannot fill a song: how long it can dance."""

from __future__ import annotations

import math

from onbeat.moves.graph import GRID

SHORTEST = 2.0
"""Seconds of song that are heard at least: less is not advised."""


def too_long(longest: int, total: int) -> str:
    """That a library cannot fill a song of ``total`` frames, since its longest dance has ``longest``; what to do.

    >>> too_long(285, 600)[-55:]
    'in common; add clips, or dance to 9.5 --seconds at most'
    """
    seconds = math.floor(10 * longest / GRID) / 10
    fewer = f", or dance to {seconds:g} --seconds at most" if seconds >= SHORTEST else ""
    return (
        f"the longest dance over the joins of this library lasts {seconds:.1f} s, and the song {total / GRID:.1f} s: "
        f"its clips have too few poses in common; add clips{fewer}"
    )
