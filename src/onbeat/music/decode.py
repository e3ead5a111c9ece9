"""The most likely beats: Viterbi over (time, tempo), exact for the bar-pointer model, whole songs at once.

In the bar-pointer model the tempo may change only at a beat, so between two beats nothing is decided: the path is a
chain of whole beat intervals. Scoring chains (a semi-Markov model) needs one back-pointer byte per frame and tempo
instead of one per state, so that hours fit in memory and a frame costs microseconds.
"""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.music.observation import ZONE, Observation
from onbeat.music.tempo import BeatSpace


@numba.njit(cache=True, fastmath=False)
def _viterbi(
    beat: Array, other: Array, intervals: Ints, bias: Array, change: Array, reach: Ints, zone: int
) -> tuple[np.ndarray, Array]:
    """Best chains: ``came[t, k]``, the interval (index) that ended where one of kind k begins, and the final scores."""
    frames, kinds = len(beat) - 1, len(intervals)
    longest = intervals[-1]
    came = np.zeros((frames + 1, kinds), np.uint8)
    entry = np.full((longest + 1, kinds), -np.inf)  # ring over time: score of a chain that begins kind k at t
    ended = np.empty(kinds)
    for t in range(frames + 1):
        row = t % (longest + 1)
        for k in range(kinds):
            start = t - intervals[k]
            # The song begins anywhere in a beat: a chain may start before the first frame.
            inside = max(start, 0)
            zone_end = min(max(start + max(intervals[k] // zone, 1), 0), frames)
            score = 0.0 if start < 0 else entry[inside % (longest + 1), k]
            ended[k] = (
                score + beat[zone_end] - beat[min(inside, zone_end)] + other[t] - other[max(inside, zone_end)] + bias[k]
            )
        for k in range(kinds):
            best, chosen = -np.inf, 0
            for j in range(reach[k, 0], reach[k, 1]):
                value = ended[j] + change[j, k]
                if value > best:
                    best, chosen = value, j
            entry[row, k] = best
            came[t, k] = chosen
    # The song ends anywhere in a beat: score the beginnings of the last interval.
    final = np.full((longest, kinds), -np.inf)
    for k in range(kinds):
        for back in range(min(intervals[k], frames + 1)):
            start = frames - back
            zone_end = min(start + max(intervals[k] // zone, 1), frames)
            final[back, k] = (
                entry[start % (longest + 1), k] + beat[zone_end] - beat[start] + other[frames] - other[zone_end]
            )
    return came, final


def decode_beats(observation: Observation, space: BeatSpace, prior_weight: float) -> Ints:
    """Frames of the most likely beats, increasing.

    Parameters
    ----------
    prior_weight : how much a second at an unusual tempo costs, per unit of the log prior.
    """
    kinds = np.arange(len(space.intervals))
    likely = space.log_change > -18.0
    reach = np.stack([likely.argmax(axis=0), len(kinds) - likely[::-1].argmax(axis=0)], axis=1)
    bias = prior_weight * space.log_prior * space.intervals / space.rate
    came, final = _viterbi(observation.beat, observation.other, space.intervals, bias, space.log_change, reach, ZONE)
    back, kind = (int(i) for i in np.unravel_index(int(final.argmax()), final.shape))
    t = len(observation.beat) - 1 - back
    beats: list[int] = []
    while t >= 0:
        beats.append(t)
        kind = int(came[t, kind])
        t -= int(space.intervals[kind])
    return np.array(beats[::-1], dtype=np.int64)
