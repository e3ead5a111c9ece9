"""The most likely beats: Viterbi over (time, tempo), exact for the bar-pointer model, whole songs at once.

In the bar-pointer model the tempo may change only at a beat, so between two beats nothing is decided: the path is a
chain of whole beat intervals. Scoring chains (a semi-Markov model) needs one back-pointer byte per frame and tempo
instead of one per state, so that hours fit in memory and a frame costs microseconds.
"""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.music.tempo import BeatSpace

UNLIKELY = -18.0  # changes of tempo less likely than this (log) are not looked at


@numba.njit(cache=True)
def _viterbi(log_odds: Array, intervals: Ints, cost: Array, change: Array, reach: Ints) -> tuple[np.ndarray, Array]:
    """Best chains of intervals.

    Gives ``came[t, k]``, the kind of interval that ended where one of kind k begins at t; and ``final[back, k]``, the
    score of a song that ends ``back`` frames into an interval of kind k. ``reach[k]`` bounds the kinds before k.
    """
    frames, kinds, longest = len(log_odds), len(intervals), intervals[-1]
    came = np.zeros((frames, kinds), np.uint8)
    entry = np.full((longest + 1, kinds), -np.inf)  # ring over time: best chain whose interval of kind k begins at t
    ended = np.empty(kinds)
    for t in range(frames):
        for k in range(kinds):
            start = t - intervals[k]
            # The song begins anywhere in a beat: its first interval may start before the first frame.
            ended[k] = cost[k] + (0.0 if start < 0 else entry[start % (longest + 1), k])
        for k in range(kinds):
            best, chosen = -np.inf, 0
            for j in range(reach[k, 0], reach[k, 1]):
                value = ended[j] + change[j, k]
                if value > best:
                    best, chosen = value, j
            entry[t % (longest + 1), k] = best + log_odds[t]
            came[t, k] = chosen
    final = np.full((longest, kinds), -np.inf)
    for k in range(kinds):
        for back in range(min(intervals[k], frames)):
            final[back, k] = entry[(frames - 1 - back) % (longest + 1), k] + cost[k] * back / intervals[k]
    return came, final


def decode_beats(log_odds: Array, space: BeatSpace, prior_weight: float) -> Ints:
    """Frames of the most likely beats, increasing; arguments as of :func:`decode`.

    >>> from onbeat.music.tempo import beat_space
    >>> heard = np.full(400, -1.0)
    >>> heard[20::50] = 5.0
    >>> decode_beats(heard, beat_space(100.0, 60.0), 1.0)[:4].tolist()
    [20, 70, 120, 170]
    """
    return decode(log_odds, space, prior_weight)[0]


def decode(log_odds: Array, space: BeatSpace, prior_weight: float) -> tuple[Ints, float]:
    """Frames of the most likely beats, increasing, and their score: how much likelier than no beats (log).

    Parameters
    ----------
    log_odds : (N,) that a beat lies at each frame.
    space : the intervals and how they may follow each other.
    prior_weight : how much a second at an unusual tempo costs, per unit of the log prior.
    """
    kinds = len(space.intervals)
    likely = space.log_change > UNLIKELY
    reach = np.stack([likely.argmax(axis=0), kinds - likely[::-1].argmax(axis=0)], axis=1)
    cost = prior_weight * space.log_prior * space.intervals / space.rate
    came, final = _viterbi(log_odds, space.intervals, cost, space.log_change, reach)
    back, kind = (int(index) for index in np.unravel_index(int(final.argmax()), final.shape))
    t = len(log_odds) - 1 - back
    beats: list[int] = []
    while t >= 0:
        beats.append(t)
        kind = int(came[t, kind])
        t -= int(space.intervals[kind])
    return np.array(beats[::-1], dtype=np.int64), float(final.max())
