"""Which beat of the dance is on which beat of the music."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import PlanError
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
