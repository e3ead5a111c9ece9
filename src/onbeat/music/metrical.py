"""Which metrical level is the beat: half or double, a third or three times, off the beat; chosen by what makes bars.

Onsets and the learned activation alone often hear the right pulse at the wrong level. Bars tell: at the right level
downbeats come every two to seven beats, and harmony, bass and the learned downbeats agree with them. So the likeliest
beats of each level are decoded, and the one is taken whose beats and bars together are the likeliest.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.music.decode import decode_beats
from onbeat.music.tempo import FASTEST, SLOWEST, BeatSpace

RATIOS = ((0.28, 0.38), (0.4, 0.62), (0.62, 0.72), (1.38, 1.6), (1.6, 2.5), (2.6, 3.5))  # of the tempo heard first
OFF_BEAT = (0.8, 1.25)  # likewise, for beats between those heard first
NARROWEST = 1.1  # ratio of fastest to slowest tempo, below which a range holds no level
BESIDE = 0.2  # of a beat, around the beats heard first, where none is looked for off the beat
FORBIDDEN = 20.0  # log odds taken off there
# What a level's score weighs, fitted with songs of the pattern generator in ``training/``: frames are far from
# independent, so the log odds of beats count a tenth, those of bars for the most part.
BEAT_SHARE, TEMPO_SHARE, BAR_SHARE = 0.11, 0.05, 0.9
# Pulses at two thirds of one another go across each other's bars, and the one heard first is seldom so wrong: a few
# seconds of a song do not say enough to believe it. Any number from .5 on chooses alike where it was tried.
ACROSS, AGAINST = ((0.62, 0.72), (1.38, 1.6)), 1.0  # ratios to the tempo heard first, and the score taken off there


def in_range(space: BeatSpace, slowest: float, fastest: float) -> BeatSpace:
    """The tempi [BPM] of a space that lie in a range.

    >>> from onbeat.music.tempo import beat_space
    >>> in_range(beat_space(100.0, 60.0), 100.0, 120.0).intervals.tolist()
    [50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60]
    """
    tempo = 60.0 * space.rate / space.intervals
    kept = (tempo >= slowest) & (tempo <= fastest)
    return BeatSpace(space.rate, space.intervals[kept], space.log_prior[kept], space.log_change[np.ix_(kept, kept)])


def metrical_levels(log_odds: Array, space: BeatSpace, prior_weight: float) -> list[Ints]:
    """Frames of the likeliest beats, then of those at other levels, as many as fit in 40 to 240 BPM."""
    first = decode_beats(log_odds, space, prior_weight)
    if len(first) < 3:
        return [first]
    beat = float(np.median(np.diff(first)))
    tempo = 60.0 * space.rate / beat
    found = [first]
    for low, high in RATIOS:
        slowest, fastest = max(tempo * low, SLOWEST), min(tempo * high, FASTEST)
        if fastest > NARROWEST * slowest:
            found.append(decode_beats(log_odds, in_range(space, slowest, fastest), prior_weight))
    near = np.arange(-int(BESIDE * beat), int(BESIDE * beat) + 1)
    masked = log_odds.copy()
    masked[np.unique(np.clip(first[:, None] + near, 0, len(masked) - 1))] -= FORBIDDEN
    slowest, fastest = max(tempo * OFF_BEAT[0], SLOWEST), min(tempo * OFF_BEAT[1], FASTEST)
    found.append(decode_beats(masked, in_range(space, slowest, fastest), prior_weight))
    return [beats for beats in found if len(beats) > 1]


def likeliest_level(levels: list[Ints], log_odds: Array, space: BeatSpace, bar_score: Callable[[Ints], float]) -> Ints:
    """The level of the likeliest beats and bars; the one heard first leads ``levels``.

    ``bar_score`` says how much likelier the bars of some beats are than none.
    """
    if len(levels) < 2:
        return levels[0] if levels else np.zeros(0, np.int64)

    def score(beats: Ints) -> float:
        steps = np.diff(beats)
        kind = np.clip(steps - space.intervals[0], 0, len(space.intervals) - 1)
        usual = float((space.log_prior[kind] * steps).sum()) / space.rate
        against = AGAINST if any(low <= first / np.median(steps) <= high for low, high in ACROSS) else 0.0
        return BEAT_SHARE * float(log_odds[beats].sum()) + TEMPO_SHARE * usual + BAR_SHARE * bar_score(beats) - against

    first = np.median(np.diff(levels[0]))
    return levels[int(np.argmax([score(beats) for beats in levels]))]
