"""Which beat of the dance is on which beat of the music."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import PlanError
from onbeat.music.song import Song
from onbeat.retime.lock import TimeMap, lock


class Meeting(NamedTuple):
    """``warp``, the music's seconds to the dance's; ``fold``, beats of the music that a beat of the dance lasts.

    ``music`` and ``dance`` (K,) are the seconds of the beats that meet.
    """

    warp: TimeMap
    fold: float
    music: Times
    dance: Times


def meet(dance: Times, music: Times, first: int = 0) -> Meeting:
    """The dance's beat k on the music's beat ``first`` + k, or on every second or half one where that is nearer.

    Parameters
    ----------
    dance, music : seconds of beats on their own clocks.
    first : the beat of the music on which the dance's first is.

    Raises
    ------
    PlanError
        If fewer than two beats meet.

    Examples
    --------
    >>> slow, fast = np.arange(16) * 0.8, np.arange(64) * 0.3
    >>> met = meet(slow, fast)
    >>> met.fold, met.warp(np.array([0.6, 1.2])).round(6).tolist()
    (2.0, [0.8, 1.6])
    """
    if not 0 <= first < max(len(music), 1):
        raise PlanError(f"beat {first} of the music is to be the first; it has {len(music)}, counted from 0")
    beats = music[first:]
    if len(dance) < 2 or len(beats) < 2:
        raise PlanError(f"{len(dance)} beats of the dance and {len(beats)} of the music; two of each are needed")
    speed = float(np.median(np.diff(dance)) / np.median(np.diff(beats)))
    fold = 2.0 ** np.clip(np.round(np.log2(speed)), -2, 2)
    if fold > 1:
        beats = beats[:: int(fold)]
    elif fold < 1:
        parts = round(1 / fold)
        beats = np.interp(np.arange((len(beats) - 1) * parts + 1) / parts, np.arange(len(beats)), beats)
    count = min(len(dance), len(beats))
    if count < 2:
        raise PlanError(f"only {count} beat of the dance meets one of the music; two are needed")
    return Meeting(lock(beats[:count], dance[:count]), float(fold), beats[:count], dance[:count])


class Wanted(NamedTuple):
    """``warp``, the music's seconds to the dance's; ``until``, the music's second at which it ends at the latest."""

    warp: TimeMap
    until: float


def wanted_time(beats: Times, speed: float | None = None, song: Song | None = None) -> Wanted:
    """The time that a dance is to be in: so much faster, or on the beats of a song, from its first downbeat on.

    Parameters
    ----------
    beats : (B,) of the dance, in its own seconds.
    speed : 1.2 is a fifth faster; 1 without it and a song.
    song : to be danced to instead.

    Raises
    ------
    PlanError
        If both are given, the speed is not above 0, or fewer than two beats of both meet.

    Examples
    --------
    >>> wanted_time(np.arange(8) * 0.5, speed=1.2).warp(np.array([1.0])).round(6).tolist()
    [1.2]
    """
    if song is None:
        return Wanted(TimeMap.steady(1.0 if speed is None else speed), np.inf)
    if speed is not None:
        raise PlanError(f"a speed of {speed:g} and a song: give one of them")
    down = np.flatnonzero(np.isin(song.beats, song.downbeats))
    return Wanted(meet(beats, song.beats, int(down[0]) if len(down) else 0).warp, song.duration)
