"""How much of the library a dance shows, and how often it shows the same again.

An optimal dance without a rule against it loops the few seconds that fit the music best. People see a repeat of
half a second, also when it is mirrored.

Conventions
-----------
A dance is a list of moves (clip, from_s, to_s): a clip's index and the seconds of the clip that are shown. Seconds
here are library seconds, whatever the rate at which they were danced. ``sources`` gives each clip's source, the same
for a clip and its mirror image, for the strict variant, in which a mirrored repeat is a repeat.

Metrics
-------
* :func:`distinct_seconds` : seconds of the library shown at least once.
* :func:`repeated_seconds` : seconds shown again, each showing beyond the first; exact, and in whole half-seconds of
  the library (:func:`repeated_cells`, a cell counting as shown by a move that shows at least half of it).
* :func:`longest_repeat` : seconds of the longest stretch shown again in one go.
* joins per minute of the dance.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from onbeat.errors import MetricError

CELL = 0.5
"""Seconds of the library that people recognise when they are shown again."""

Span = tuple[int, float, float]
"""A clip's index, and the seconds of it from where to where it is shown."""


def validate(moves: Sequence[Span], duration: float, sources: Sequence[int] | None = None) -> None:
    """Raise a ``MetricError`` that names the first move that is not one, or a duration that is none."""
    for index, (clip, start, end) in enumerate(moves):
        if not (np.isfinite(start) and np.isfinite(end) and end >= start):
            raise MetricError(f"move {index} shows clip {clip} from {start} s to {end} s; it must not end before")
        if clip < 0 or (sources is not None and clip >= len(sources)):
            known = "0 or more" if sources is None else f"0…{len(sources) - 1}"
            raise MetricError(f"move {index} shows clip {clip}; {known} is needed")
    if not (np.isfinite(duration) and duration > 0):
        raise MetricError(f"the duration is {duration} s; a positive number of seconds is needed")


def distinct_seconds(moves: Sequence[Span]) -> float:
    """Seconds of the library shown at least once.

    Examples
    --------
    >>> distinct_seconds([(0, 0.0, 2.0), (0, 1.0, 3.0), (1, 0.0, 1.0)])
    4.0
    """
    total, reached = 0.0, (-1, 0.0)
    for clip, start, end in sorted(moves):
        begin = max(start, reached[1]) if clip == reached[0] else start
        total += max(end - begin, 0.0)
        reached = (clip, max(end, reached[1]) if clip == reached[0] else end)
    return total


def repeated_seconds(moves: Sequence[Span]) -> float:
    """Seconds of the library shown again: all that is shown, less what is distinct.

    Examples
    --------
    >>> repeated_seconds([(0, 0.0, 2.0), (0, 1.0, 3.0), (0, 1.5, 1.75)])
    1.25
    """
    return max(sum(end - start for _, start, end in moves) - distinct_seconds(moves), 0.0)


def repeated_cells(moves: Sequence[Span], cell: float = CELL) -> float:
    """Seconds of whole cells of the library shown again, each showing beyond the first."""
    shown = Counter(key for move in moves for key in _cells(*move, cell))
    return sum(count - 1 for count in shown.values()) * cell


def _cells(clip: int, start: float, end: float, cell: float) -> Iterator[tuple[int, int]]:
    """The cells of which a move shows at least half."""
    for index in range(int(start // cell), int(end // cell) + 1):
        if min(end, (index + 1) * cell) - max(start, index * cell) >= cell / 2 - 1e-9:
            yield clip, index


def longest_repeat(moves: Sequence[Span]) -> float:
    """Seconds of the longest stretch of the library that two moves share.

    Examples
    --------
    >>> longest_repeat([(0, 0.0, 2.0), (1, 0.0, 2.0), (0, 1.25, 3.0)])
    0.75
    """
    shared = (min(a[2], b[2]) - max(a[1], b[1]) for a, b in combinations(moves, 2) if a[0] == b[0])
    return max((0.0, *shared))


def evaluate(moves: Sequence[Span], duration: float, sources: Sequence[int] | None = None) -> dict[str, float]:
    """Variety of a dance of ``duration`` seconds.

    Returns
    -------
    ``distinct_s``, ``repeated_s``, ``repeated_cells_s``, ``longest_repeat_s`` and ``joins_per_minute``; with
    ``sources`` the first four also as ``…_strict``, counted on the sources.

    Raises
    ------
    MetricError
        If a move ends before it begins or names no clip, or the duration is not positive.
    """
    validate(moves, duration, sources)
    result = _repeats(moves)
    if sources is not None:
        strict = _repeats([(sources[clip], start, end) for clip, start, end in moves])
        result |= {f"{name}_strict": value for name, value in strict.items()}
    return result | {"joins_per_minute": max(len(moves) - 1, 0) * 60 / duration}


def _repeats(moves: Sequence[Span]) -> dict[str, float]:
    return {
        "distinct_s": distinct_seconds(moves),
        "repeated_s": repeated_seconds(moves),
        "repeated_cells_s": repeated_cells(moves),
        "longest_repeat_s": longest_repeat(moves),
    }
