"""Tempo: which tempi there are, how likely each is, what tempo a list of beats has, and a tempo to dance to."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Ints, Times
from onbeat.music.song import Song

SLOWEST, FASTEST = 40.0, 240.0  # [BPM]
USUAL = 115.0  # [BPM]
SPREAD = 0.45  # standard deviation of the natural logarithm of the tempo
DANCE_SLOWEST, DANCE_FASTEST = 70.0, 140.0  # [BPM]


@dataclass(frozen=True)
class BeatSpace:
    """The beat intervals that are considered, in frames (Krebs, Böck & Widmer 2015: a tempo lasts for whole beats).

    Parameters
    ----------
    rate : frames per second.
    intervals : (K,) frames between two beats.
    log_prior : (K,) how likely each tempo is before anything is heard.
    log_change : (K, K) how likely the tempo of the next beat is, from row to column.
    """

    rate: float
    intervals: Ints
    log_prior: Array
    log_change: Array


def log_tempo_prior(tempo: Array, usual: float = USUAL, spread: float = SPREAD) -> Array:
    """Log-normal prior on tempo, 0 at the usual one.

    >>> np.abs(log_tempo_prior(np.array([115.0]))).tolist()
    [0.0]
    """
    return -0.5 * (np.log(tempo / usual) / spread) ** 2


def beat_space(rate: float, steadiness: float) -> BeatSpace:
    """All intervals of whole frames from 240 to 40 BPM; a change to ratio r costs ``steadiness * |r − 1|``."""
    intervals = np.arange(int(np.ceil(60.0 * rate / FASTEST)), int(60.0 * rate / SLOWEST) + 1)
    ratio = intervals[None, :] / intervals[:, None]
    change = -steadiness * np.abs(ratio - 1.0)
    change -= np.log(np.exp(change).sum(axis=1, keepdims=True))
    return BeatSpace(rate, intervals, log_tempo_prior(60.0 * rate / intervals), change)


def tempo_of(beats: Times) -> float:
    """Beats per minute of the straight line through the beats; 0 for fewer than two.

    >>> round(tempo_of(np.array([0.5, 1.0, 1.5, 2.0])), 6)
    120.0
    """
    if len(beats) < 2:
        return 0.0
    index = np.arange(len(beats)) - (len(beats) - 1) / 2.0
    return float(60.0 * (index @ index) / (index @ beats))


def danceable_beats(song: Song, slowest: float = DANCE_SLOWEST, fastest: float = DANCE_FASTEST) -> Song:
    """The song with its beats folded to a tempo one dances to: halved above ``fastest``, doubled below ``slowest``.

    Halving keeps every downbeat of an even meter, which is halved too. An odd meter is kept, of its beats the half with
    more downbeats: a waltz at 180 is danced one step in two beats, across its bars.
    Doubling puts a beat without chord change between each two.

    >>> song = Song(4.0, 200.0, 4, np.arange(12) * 0.3, np.arange(0, 12, 4) * 0.3, np.ones(12), [0, 4], [1, 1])
    >>> danceable_beats(song).tempo
    100.0
    """
    while song.tempo > fastest and len(song.beats) > 3:
        song = _halved(song)
    while 0.0 < song.tempo < slowest and len(song.beats) > 1 and song.tempo * 2.0 <= fastest:
        song = _doubled(song)
    return song


def fold_of(heard: float, danced: float) -> str:
    """Which part of a tempo that is heard is danced to, in a word; none ("") where it is danced to as it is.

    >>> fold_of(180.0, 90.0), fold_of(20.0, 80.0), fold_of(100.0, 100.0)
    ('half', 'four times', '')
    """
    if math.isclose(heard, danced, rel_tol=1e-3):
        return ""
    words = {-3: "an eighth", -2: "a quarter", -1: "half", 1: "double", 2: "four times"}
    return words.get(round(math.log2(danced / heard)), f"{danced / heard:.2g} times") if min(heard, danced) > 0 else ""


def _every_other(song: Song) -> Ints:
    """Indices of half of the beats: in even meters counted anew from each downbeat, in odd ones right through.

    The last beat of a bar with one beat too many is left out, so that no two kept beats follow each other directly.
    """
    index = np.arange(len(song.beats))
    starts = np.flatnonzero(np.isin(song.beats, song.downbeats))
    if song.meter % 2 or not len(starts):
        weight = np.isin(index, starts) + 1e-3 * song.chord_change
        return index[int(weight[1::2].sum() > weight[0::2].sum()) :: 2]
    bar = np.searchsorted(starts, index, side="right") - 1
    even = (index - starts[np.maximum(bar, 0)]) % 2 == 0
    following = np.append(starts, len(index) + 1)[bar + 1]
    return index[even & (following - index >= 2)]


def _halved(song: Song) -> Song:
    kept = _every_other(song)
    ends = np.append(kept[1:], len(song.beats))
    change = np.array([song.chord_change[begin:end].max() for begin, end in zip(kept, ends, strict=True)])
    return replace(
        song,
        tempo=song.tempo / 2.0,
        meter=song.meter // 2 if song.meter % 2 == 0 else song.meter,
        beats=song.beats[kept],
        downbeats=song.downbeats[np.isin(song.downbeats, song.beats[kept])],
        chord_change=change,
        beat_strength=song.beat_strength[kept],
        confidence=song.confidence[kept] if len(song.confidence) else song.confidence,
        chord_root=[song.chord_root[beat] for beat in kept] if song.chord_root else (),
    )


def _doubled(song: Song) -> Song:
    beats = np.empty(2 * len(song.beats) - 1)
    beats[0::2] = song.beats
    beats[1::2] = (song.beats[1:] + song.beats[:-1]) / 2.0
    change, strength = np.zeros(len(beats)), np.empty(len(beats))
    change[0::2] = song.chord_change
    strength[0::2] = song.beat_strength
    strength[1::2] = 0.5 * np.minimum(song.beat_strength[1:], song.beat_strength[:-1])
    sure = np.repeat(song.confidence, 2)[:-1]
    if len(sure):
        sure[1::2] = np.minimum(song.confidence[1:], song.confidence[:-1])
    return replace(
        song,
        tempo=2.0 * song.tempo,
        meter=2 * song.meter,
        beats=beats,
        chord_change=change,
        beat_strength=strength,
        confidence=sure,
        chord_root=[root for root in song.chord_root for _ in (0, 1)][:-1] if song.chord_root else (),
    )
