"""Rehearsed takes of the embedded dances, and how well their keyposes are found inside the cycles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat.examples.choreography import LEAD
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import DANCES, perform_dance
from onbeat.examples.performer import Performance
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.troupe import SPEEDS
from onbeat.keyposes.candidates import Minima, Thresholds, candidates, minima
from onbeat.keyposes.effectors import effector_speed
from onbeat.keyposes.extract import Keyposes, Options, Reading, find_keyposes
from onbeat.keyposes.matching import Score, chance, score

PERFORMANCES, CYCLES = 5, 3
NEAR = 0.1
"""Seconds."""
SLOW, FAST = (0.5, 0.7, 1.0, 1.5, 9.0), (0.0, 0.3, 0.5, 0.7, 1.0)
"""Thresholds tried for the method of 2004, in units of the mean speed of hands or feet."""
VARIANTS: Mapping[str, tuple[str, Options]] = {
    "energy (default)": ("energy", Options()),
    "paper2009": ("paper2009", Options()),
    "shiratori2004": ("shiratori2004", Options()),
    "hands": ("hands", Options()),
}


@dataclass(frozen=True)
class Take:
    """A rehearsed clip, and which beats are inside of its cycles."""

    clip: Performance
    reading: Reading
    first: int
    end: int
    cycle: int

    @property
    def truth(self) -> np.ndarray:
        """The beats on which keyposes are; the clip's truth may be up to 0.45 of a beat from them."""
        beats = self.clip.beats
        return np.abs(self.clip.keyposes[:, None] - beats[None]).argmin(1)


class Found(NamedTuple):
    """Times of keyposes inside the cycles, and their beats."""

    times: np.ndarray
    beats: np.ndarray


def takes(dance: str, spread: str, seed: int = 0, performances: int = PERFORMANCES) -> list[Take]:
    """Every dancer at every speed, several times; each time danced anew, and rehearsed."""
    rng = np.random.default_rng(seed)
    made: list[Take] = []
    length = sum(figure.beats for figure in DANCES[dance])
    for dancer in DANCERS:
        for speed in SPEEDS:
            for _ in range(performances):
                clip = rehearse(perform_dance(dancer, dance, speed, CYCLES, rng), rng, 0.06, spread=spread)
                first = int(LEAD)
                made.append(Take(clip, Reading(clip.motion, clip.beats), first, first + CYCLES * length, length))
    return made


def inside(found: Keyposes, take: Take) -> Found:
    """Without what is found before the first cycle and after the last: there the dancer stands still."""
    kept = (found.beats >= take.first) & (found.beats < take.end)
    return Found(found.times[kept], found.beats[kept])


def variant(name: str, take: Take) -> Found:
    """What a method finds in a take; "every beat" takes all beats for keyposes."""
    if name == "every beat":
        beats = np.arange(take.first, take.end)
        return Found(take.clip.beats[beats], beats)
    method, options = VARIANTS[name]
    if method == "energy" and options == Options():
        return inside(take.reading.keyposes(), take)
    return inside(find_keyposes(take.clip.motion, take.clip.beats, method, options), take)


def best_of_2004(made: Sequence[Take]) -> tuple[str, list[Found]]:
    """What hands and feet give with the thresholds that, in hindsight, suit a dance best: more than fair to 2004."""
    rests = [[minima(curve / curve.mean()) for curve in effectors(take)] for take in made]
    best: tuple[float, str, list[Found]] = (-1.0, "", [])
    for slow in SLOW:
        for fast in FAST:
            found = [
                resting(pair, take, slow, fast) for pair, take in zip(rests, made, strict=True)
            ]  # fmt: skip
            f = np.mean([score(one.beats.astype(float), take.truth.astype(float), 0.1).f
                         for one, take in zip(found, made, strict=True)])  # fmt: skip
            if f > best[0]:
                best = (float(f), f"2004, best: < {slow:g}, > {fast:g}", found)
    return best[1:]


def effectors(take: Take) -> list[np.ndarray]:
    points = take.reading.points
    return [effector_speed(points, which) for which in (points.hands, points.feet)]


def resting(pair: Sequence[Minima], take: Take, slow: float, fast: float) -> Found:
    """Beats at which both hands and feet rest, as in ``effectors.shiratori2004``."""
    times = []
    for rests in pair:
        passes = (rests.values < slow) & (rests.values + rests.rises > fast)
        kept = Minima(*(column[passes] for column in rests))
        times.append(candidates(kept, take.reading.beats, Thresholds(np.inf, np.inf)))
    both = (times[0] + times[1]) / 2.0
    beats = np.flatnonzero(~np.isnan(both))
    beats = beats[(beats >= take.first) & (beats < take.end)]
    return Found(both[beats], beats)


class Row(NamedTuple):
    """Means over takes.

    Parameters
    ----------
    whole : share of the cycles with all their keyposes found.
    by_beat, near : scores by beat, and of times within ``NEAR``.
    beat_null, near_null : F at a random phase.
    late : seconds, the median time of a found keypose after the true one on its beat.
    """

    whole: float
    by_beat: Score
    beat_null: float
    near: Score
    near_null: float
    late: float


def judge(found: Iterable[Found], made: Sequence[Take], seed: int = 0, draws: int = 50) -> Row:
    """How right what was found in each take is."""
    rng = np.random.default_rng(seed)
    whole, by_beat, near, beat_null, near_null, late = [], [], [], [], [], []
    for one, take in zip(found, made, strict=True):
        truth, period = take.truth, float(take.clip.beats[1])
        span = ((take.first - 0.5) * period, (take.end - 0.5) * period)
        whole += whole_cycles(one, take)
        by_beat.append(score(one.beats.astype(float), truth.astype(float), 0.1))
        near.append(score(one.times, take.clip.keyposes, NEAR))
        late += lateness(one, take)
        beat_null.append(rolled(one, take))
        near_null.append(chance(one.times, take.clip.keyposes, span, rng, NEAR, draws)[0])
    null, near_chance, behind = float(np.mean(beat_null)), float(np.mean(near_null)), float(np.median(late))
    return Row(float(np.mean(whole)), mean(by_beat), null, mean(near), near_chance, behind)


def lateness(found: Found, take: Take) -> list[float]:
    """Seconds by which each found keypose is after the true one on its beat."""
    true = dict(zip(take.truth.tolist(), take.clip.keyposes.tolist(), strict=True))
    return [time - true[beat] for time, beat in zip(*map(np.ndarray.tolist, found), strict=True) if beat in true]


def mean(scores: Sequence[Score]) -> Score:
    return Score(*(float(value) for value in np.mean(scores, axis=0)))


def whole_cycles(found: Found, take: Take) -> list[bool]:
    """Of each cycle, whether all its keyposes are found."""
    truth, missed = take.truth, np.setdiff1d(take.truth, found.beats)
    ends = range(take.first, take.end, take.cycle)
    return [not ((missed >= at) & (missed < at + take.cycle)).any() for at in ends if len(truth)]


def rolled(found: Found, take: Take) -> float:
    """F by beat when what was found is shifted, round in the cycles, by every whole number of beats but none."""
    count = take.end - take.first
    ours, true = np.zeros(count), np.zeros(count)
    ours[found.beats - take.first], true[take.truth - take.first] = 1.0, 1.0
    right = np.array([np.dot(np.roll(ours, shift), true) for shift in range(1, count)])
    return float(np.mean(2.0 * right / (ours.sum() + true.sum())))
