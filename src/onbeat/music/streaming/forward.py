"""Forward filter of the bar-pointer model: how likely each place in the beat and each tempo is, as the sound comes in.

The states are (beats' interval k, frames since the last beat); between two beats nothing is decided, so a state only
grows older: ``entry[t mod L, k]``, the weight of all chains whose interval of kind k began at frame t, is written once
and read until that interval ends. A frame costs one product with the tempo changes and one sum over the states.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.music.tempo import BeatSpace, beat_space

STEADINESS = 25.0  # cost of a change of tempo, per unit of its ratio
PRIOR_WEIGHT = 4.5  # per second
LEAP = 1e-3  # chance, at each beat, of any other tempo
RESTART = 1e-4  # chance, at each frame, that the music starts anew there
PHASES = 24  # parts of a beat
TEMPO_STEP = 1.08  # ratio of neighbouring classes of tempo
SPAN_PHASE, SPAN_TEMPO = 3, 2  # parts and classes that make one guess
CLOSE_TEMPO, CLOSE_PHASE = 0.07, 0.10  # of a beat, within which chains agree
SMALLEST, LARGEST = 1e-100, 1e100


@dataclass
class Guess:
    """One reading of the music: a period and the next beat, in frames from the last one heard.

    Parameters
    ----------
    period : frames between beats.
    ahead : frames from the frame last heard to the next beat.
    share : of all chains, those that agree with it.
    """

    period: float
    ahead: float
    share: float


@dataclass(frozen=True)
class _Tables:
    intervals: Ints
    start: Array  # (K,) chance of each tempo before anything is heard
    change: Array  # (K, K) chance, from row to column
    cost: Array  # (longest, K) prior of an interval that has come so far
    cell: np.ndarray  # (longest, K) int32 tempo class * PHASES + part of the beat


def _tables(space: BeatSpace, prior_weight: float) -> _Tables:
    prior = np.exp(space.log_prior)
    change = (1.0 - LEAP) * np.exp(space.log_change) + LEAP * prior / prior.sum()
    age = np.arange(space.intervals[-1])[:, None]
    cost = np.exp(prior_weight * space.log_prior * age / space.rate)
    classes = np.floor(np.log(space.intervals / space.intervals[0]) / np.log(TEMPO_STEP)).astype(np.int32)
    part = np.minimum(age * PHASES // space.intervals, PHASES - 1).astype(np.int32)
    return _Tables(space.intervals, prior / prior.sum(), change, cost, classes * PHASES + part)


class ForwardFilter:
    """How likely each tempo and phase is, frame after frame.

    Parameters
    ----------
    frame_rate : frames per second.
    steadiness, prior_weight : as in the default method.

    Examples
    --------
    >>> heard = np.full(400, -1.0)
    >>> heard[20::50] = 5.0
    >>> filter = ForwardFilter(100.0)
    >>> for value in heard:
    ...     _ = filter.step(value, 1.0)
    >>> best = filter.best()
    >>> guess = filter.near(best.period, best.ahead)
    >>> round(guess.period), round(guess.ahead)
    (50, 21)
    """

    def __init__(self, frame_rate: float, steadiness: float = STEADINESS, prior_weight: float = PRIOR_WEIGHT) -> None:
        self.space = beat_space(frame_rate, steadiness)
        self._tables = _tables(self.space, prior_weight)
        self._histogram = np.zeros((int(self._tables.cell.max()) // PHASES + 1, PHASES))
        longest = int(self.space.intervals[-1])
        self._entry = np.tile(self._tables.start / (self._tables.start @ self.space.intervals), (longest + 1, 1))
        self._total = 1.0
        self.frames = 0

    def step(self, log_odds: float, sounding: float) -> float:
        """Take one frame: the log odds that a beat lies there, and whether there is sound (else tempi rest).

        Gives the logarithm of how much more likely the frame is with beats than without.
        """
        tables = self._tables
        before = self._total
        _step(
            self.frames,
            log_odds,
            sounding,
            before,
            self._entry,
            tables.intervals,
            tables.change,
            tables.cost,
            tables.start,
        )
        self._total = _weight(self.frames, self._entry, tables.intervals, tables.cost)
        gained = float(np.log(self._total / before))
        if not SMALLEST < self._total < LARGEST:
            self._entry /= self._total
            self._total = 1.0
        self.frames += 1
        return gained

    def best(self) -> Guess:
        """The guess that most chains agree with."""
        step = np.log(TEMPO_STEP)
        tables = self._tables
        _spread(self.frames - 1, self._entry, tables.intervals, tables.cost, tables.cell, self._histogram)
        row, part, share = _fullest(self._histogram)
        period = float(self.space.intervals[0] * np.exp((row + SPAN_TEMPO / 2) * step))
        ahead = (1.0 - (part + SPAN_PHASE / 2) / PHASES) % 1.0 * period
        return Guess(period, ahead, share / self._total)

    def begun(self, frames: int) -> float:
        """Share of the chains of which a beat lies within the last ``frames`` frames."""
        rows = (self.frames - 1 - np.arange(frames)) % len(self._entry)
        return float(self._entry[rows].sum()) / self._total

    def near(self, period: float, ahead: float) -> Guess:
        """The mean of the chains close to a guess, and their share."""
        found = _near(self.frames - 1, self._entry, self._tables.intervals, self._tables.cost, period, ahead)
        mass, mean_period, mean_ahead = found
        return Guess(mean_period, mean_ahead, mass / self._total)


@numba.njit(cache=True)
def _step(
    time: int,
    log_odds: float,
    sounding: float,
    total: float,
    entry: Array,
    intervals: Ints,
    change: Array,
    cost: Array,
    start: Array,
) -> None:
    """Let the intervals that end now be followed by others: the row of chains whose interval begins at ``time``."""
    ring, kinds = entry.shape
    ended = np.empty(kinds)
    for k in range(kinds):
        ended[k] = entry[(time - intervals[k]) % ring, k]
    row = entry[time % ring]
    if sounding <= 0.0:
        row[:] = ended
        return
    for k in range(kinds):
        ended[k] *= cost[intervals[k] - 1, k]
        row[k] = RESTART * total * start[k]
    least = 1e-12 * ended.sum()
    for j in range(kinds):
        if ended[j] > least:
            for k in range(kinds):
                row[k] += ended[j] * change[j, k]
    row *= np.exp(log_odds)


@numba.njit(cache=True)
def _weight(time: int, entry: Array, intervals: Ints, cost: Array) -> float:
    """The weight of all chains."""
    ring, kinds = entry.shape
    sums = np.zeros(kinds)
    for age in range(ring - 1):
        row, factor = entry[(time - age) % ring], cost[age]
        for k in range(max(0, age + 1 - intervals[0]), kinds):
            sums[k] += row[k] * factor[k]
    return sums.sum()


@numba.njit(cache=True)
def _spread(time: int, entry: Array, intervals: Ints, cost: Array, cell: np.ndarray, histogram: Array) -> None:
    """The weight of the chains over tempo class and part of the beat."""
    ring, kinds = entry.shape
    flat = histogram.ravel()
    flat[:] = 0.0
    for age in range(ring - 1):
        row = entry[(time - age) % ring]
        for k in range(max(0, age + 1 - intervals[0]), kinds):
            flat[cell[age, k]] += row[k] * cost[age, k]


@numba.njit(cache=True)
def _fullest(histogram: Array) -> tuple[int, int, float]:
    """Where a window of the histogram, round in its phases, holds most; and how much."""
    classes, phases = histogram.shape
    best, at_row, at_part = -1.0, 0, 0
    for row in range(classes - SPAN_TEMPO + 1):
        for part in range(phases):
            share = 0.0
            for i in range(SPAN_TEMPO):
                for j in range(SPAN_PHASE):
                    share += histogram[row + i, (part + j) % phases]
            if share > best:
                best, at_row, at_part = share, row, part
    return at_row, at_part, best


@numba.njit(cache=True)
def _near(
    time: int, entry: Array, intervals: Ints, cost: Array, period: float, ahead: float
) -> tuple[float, float, float]:
    """Weight, mean period and mean time to the next beat of the chains close to these."""
    ring, kinds = entry.shape
    close, slack = CLOSE_TEMPO * period + 1.0, CLOSE_PHASE * period + 1.0
    mass, periods, aheads = 1e-300, 0.0, 0.0
    for k in range(kinds):
        interval = intervals[k]
        if abs(interval - period) > close:
            continue
        for age in range(interval):
            late = interval - age - ahead
            late -= interval * np.floor(late / interval + 0.5)
            if abs(late) <= slack:
                weight = entry[(time - age) % ring, k] * cost[age, k]
                mass += weight
                periods += weight * (interval - period)
                aheads += weight * late
    return mass, period + periods / mass, ahead + aheads / mass
