"""Which part of a dance teaches a space, and which is left unseen to test it."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import MetricError
from onbeat.keyposes.held_out import Taught, Unseen
from onbeat.keyposes.vectors import PoseVectors


def lesson(person: str, vectors: PoseVectors, keyposes: Times, cycle: int | None = None) -> tuple[Taught, Unseen]:
    """The cycle in the middle of a dance teaches, what lies before and after it is unseen.

    In the middle, for a dance begins and ends with poses that are not of it: standing and waiting. A dance of one cycle
    has nothing else: then the poses ``between`` those that are taken are what is tested.

    Parameters
    ----------
    person : the name.
    vectors : the motion's poses.
    keyposes : (K,) seconds of all keyposes.
    cycle : how many keyposes a cycle of the dance has; without it half of them is taken for one.

    Raises
    ------
    MetricError
        If there are fewer than two keyposes, or fewer than a cycle has.

    Examples
    --------
    >>> still = PoseVectors(np.zeros((300, 3)), ("hips",), np.zeros(1), 1.8, np.zeros((300, 4)), np.zeros((300, 3)), 30)
    >>> taught, tested = lesson("Aiko", still, np.arange(1.0, 9.0), cycle=4)
    >>> taught.keyposes.tolist(), taught.end, tested.spans, tested.keyposes.tolist()
    ([3.0, 4.0, 5.0, 6.0], 7.0, ((1.0, 3.0), (7.0, 8.0)), [1.0, 2.0, 7.0, 8.0])
    """
    times = np.asarray(keyposes, np.float64)
    count = cycle if cycle is not None else len(times) // 2 if len(times) > 3 else len(times)
    told = "" if cycle is None else f", of which a cycle has {cycle}"
    if len(times) < 2 or not 2 <= count <= len(times):
        raise MetricError(
            f"{person}: {len(times)} keypose{'s' * (len(times) != 1)}{told}; two of "
            "each at least are needed: give a longer motion, its beats, or another --in-cycle"
        )
    if (
        not np.isfinite(times).all()
        or (np.diff(times) <= 0).any()
        or times[0] < 0
        or times[-1] > vectors.duration + 0.5
    ):
        raise MetricError(
            f"{person}: keyposes from {times[0]:.2f} to {times[-1]:.2f} s are not increasing seconds of a motion of "
            f"{vectors.duration:.2f} s; are they of another motion?"
        )
    first = (len(times) - count) // 2
    taken, more = times[first : first + count], np.delete(times, np.arange(first, first + count))
    end = float(times[first + count]) if first + count < len(times) else float(taken[-1] + np.diff(taken).mean())
    taught = Taught(person, vectors, taken, float(taken[0]), end)
    spans = tuple((a, b) for a, b in ((float(times[0]), float(taken[0])), (end, float(times[-1]))) if b > a)
    whole = ((float(taken[0]), min(end, vectors.duration)),)
    return taught, Unseen(person, vectors, spans or whole, more if spans else np.zeros(0), not spans)
