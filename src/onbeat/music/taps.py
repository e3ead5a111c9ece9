"""Tapping along: which beats somebody means who taps unevenly, late or only for a while."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.signal import savgol_filter

from onbeat._shapes import Times
from onbeat.music.tempo_curve import tempo_curve

RATIOS = ((1, 1), (2, 2), (2, 1), (1, 2), (3, 1), (1, 3), (3, 2), (2, 3), (4, 1), (1, 4))  # taps for so many beats
AGREES = 0.12  # of a beat: scatter of the taps around beats that are meant
TEMPO_AGREES = 0.1  # share by which the number of beats may differ from that of intervals tapped
FEWEST = 4
ONWARD = 32  # taps at either end, whose tempo is gone on with
AROUND = 9  # taps, through which a line is laid to even them: odd


class Meant(NamedTuple):
    """Beats (B,) over the whole song; ``ratio`` of their tempo to that heard, None where the taps alone are taken."""

    times: Times
    ratio: float | None


def beats_meant(taps: Times, heard: Times, duration: float) -> Meant:
    """The beats that taps mean: those heard, at the tempo and phase of the taps; else the taps themselves, evened.

    The beats heard are made denser and sparser (twice, a half, thrice, …, and each phase of these); of those with as
    many beats as taps, the ones that the taps scatter least around are meant. Where the taps lie as far from all of
    these as chance would, they are taken by themselves: each on the line through the eight around it.

    >>> heard = np.arange(0.0, 20.0, 0.5)
    >>> rng = np.random.default_rng(0)
    >>> meant = beats_meant(np.arange(4.0, 12.0, 1.0) + 0.03 * rng.standard_normal(8), heard, 20.0)
    >>> meant.ratio, meant.times[:3].tolist()
    (0.5, [0.0, 1.0, 2.0])
    """
    best: tuple[float, Meant] | None = None
    for many, few in RATIOS if len(heard) > 1 else ():
        dense = denser(heard, many)
        for phase in range(few):
            grid = dense[phase::few]
            scatter = _scatter(taps, grid)
            if scatter < AGREES and (best is None or scatter < best[0]):
                best = scatter, Meant(grid, many / few)
    return best[1] if best else Meant(evened(taps, duration), None)


def denser(beats: Times, times: int) -> Times:
    """The beats with others between them, so that each interval is split into so many.

    >>> denser(np.array([0.0, 1.0, 3.0]), 2).tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    """
    if len(beats) < 2:
        return beats
    place = np.arange((len(beats) - 1) * times + 1) / times
    return np.interp(place, np.arange(len(beats)), beats)


def _scatter(taps: Times, grid: Times) -> float:
    """Root mean square distance of taps from the grid, as a share of its interval; 1 where their tempi differ.

    A steady lead or lag of the hand is taken off first, as far as a sixth of an interval: people tap ahead.
    """
    if len(grid) < 2:
        return 1.0
    place = np.interp(taps, grid, np.arange(len(grid)))
    inside = (taps >= grid[0]) & (taps <= grid[-1])
    if inside.sum() < min(FEWEST, len(taps)):
        return 1.0
    place = place[inside]
    steps = np.diff(place)
    typical = float(np.median(steps)) if len(steps) else 1.0
    if abs(typical - 1.0) > 2.5 * TEMPO_AGREES:
        return 1.0
    off = place - np.round(place)
    hand = np.clip(np.median(off), -1.0 / 6.0, 1.0 / 6.0)
    return float(np.sqrt(np.mean((off - hand) ** 2))) + 0.25 * abs(float(hand))


def evened(taps: Times, duration: float) -> Times:
    """Taps on the line through those around each, gaps of whole beats filled, and gone on with to both ends."""
    gaps = np.diff(taps)
    usual = float(np.median(gaps))
    place = np.concatenate([[0], np.cumsum(np.maximum(np.round(gaps / usual), 1))])
    every = np.interp(np.arange(place[-1] + 1), place, taps)
    size = min(AROUND, len(every) - 1 + len(every) % 2)
    beats = np.array(savgol_filter(every, size, 1) if size > 2 else every, dtype=np.float64)
    curve = tempo_curve(beats, ONWARD)
    first, last = 60.0 / curve.bpm[0], 60.0 / curve.bpm[-1]
    before = np.arange(beats[0] - first, 0.0, -first)[::-1]
    after = np.arange(beats[-1] + last, duration, last)
    return np.concatenate([before, np.clip(beats, 0.0, duration), after])
