"""Repeatability: the keyposes of two takes of one figure, against those of two figures through the same warp.

Takes are laid onto each other by dynamic time warping of their poses in the body's centre. The warp itself makes
keyposes agree, as it pairs slow moments with slow ones; so two *different* figures go through it, too, and chance is
what was found at a random phase.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

from keypose_troupe import CYCLES, NEAR
from onbeat.errors import PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import perform
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.troupe import FIGURES, cycles_of
from onbeat.formats import read_motion
from onbeat.keyposes.candidates import Thresholds, minima
from onbeat.keyposes.energy import energy_of
from onbeat.keyposes.extract import DEFAULT, METHODS, find_keyposes
from onbeat.keyposes.matching import chance, score
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.points import body_points
from onbeat.motion import Motion

RATE = 30.0
"""Hz at which poses are compared."""
CMU = (("09", "10"), ("14", "15"), ("18", "19", "20"))
"""Repeated takes of subject 05, as they are listed; by its poses 05_20 is as far from 05_18 and 05_19 as others are."""
ALIKE = 0.15
"""Metres; repeated takes whose poses are farther apart than this after the warp are shown, and told apart."""
ALL = Thresholds(1000.0, 1000.0)


class Dance(NamedTuple):
    """A take: its poses (F, 3N) at ``RATE``, its length, and its keyposes by each method."""

    name: str
    poses: np.ndarray
    seconds: float
    keyposes: Mapping[str, np.ndarray]


class Agreement(NamedTuple):
    """F of the keyposes of one take, warped onto another, and F at a random phase; how far the poses are apart, m."""

    f: float
    null: float
    apart: float


def dance(name: str, motion: Motion, beats: np.ndarray | None = None) -> Dance:
    """A take made ready, with its own pulse where no beats are given."""
    points = body_points(motion.resampled(RATE))
    beats = motion_beats(motion) if beats is None else beats
    found = {method: find_keyposes(motion, beats, method).times for method in METHODS}
    found["rests, without beats"] = rests(motion, DEFAULT)
    found["all rests"] = rests(motion, ALL)
    found["every beat"] = beats
    return Dance(name, points.local().reshape(len(points.positions), -1), motion.duration, found)


def rests(motion: Motion, thresholds: Thresholds) -> np.ndarray:
    """The minima of the local energy that pass, on a beat or not."""
    found = minima(energy_of(body_points(motion)).local)
    return found.times[(found.values < thresholds.t1) | (found.rises > thresholds.t2)]


def agreement(a: Dance, b: Dance, rng: np.random.Generator) -> dict[str, Agreement]:
    """Both ways, the mean, by each method."""
    path = warp_path(distances(a.poses, b.poses))
    apart = float(np.mean([np.linalg.norm(a.poses[i] - b.poses[j]) for i, j in path]))
    apart /= np.sqrt(a.poses.shape[1] / 3)
    rows: dict[str, Agreement] = {}
    for method in a.keyposes:
        both = [
            one_way(one.keyposes[method], other.keyposes[method], pairs, other.seconds, rng)
            for one, other, pairs in ((a, b, path), (b, a, path[:, ::-1]))
        ]
        rows[method] = Agreement(mean([f for f, _ in both]), mean([null for _, null in both]), apart)
    return rows


def one_way(
    ours: np.ndarray, theirs: np.ndarray, path: np.ndarray, seconds: float, rng: np.random.Generator
) -> tuple[float, float]:
    """F and chance of the keyposes of one take on the other's clock; a take without keyposes agrees with nothing."""
    if not len(ours) or not len(theirs):
        return 0.0, 0.0
    moved = warped(ours, path)
    return score(moved, theirs, NEAR).f, chance(moved, theirs, (0.0, seconds), rng, NEAR, 100)[0]


def mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if len(values) else float("nan")


def distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(F, G) between all poses of two takes."""
    squared = (a**2).sum(1)[:, None] + (b**2).sum(1)[None] - 2.0 * a @ b.T
    return np.sqrt(np.maximum(squared, 0.0))


@numba.njit(cache=True)
def warp_path(cost: np.ndarray) -> np.ndarray:
    """The cheapest way (K, 2) from the first to the last pair, by steps of one on either side or both."""
    rows, columns = cost.shape
    total = np.full((rows + 1, columns + 1), np.inf)
    total[0, 0] = 0.0
    for i in range(rows):
        for j in range(columns):
            total[i + 1, j + 1] = cost[i, j] + min(total[i, j], total[i, j + 1], total[i + 1, j])
    path = np.empty((rows + columns, 2), np.int64)
    count, i, j = 0, rows, columns
    while i > 0 and j > 0:
        path[count, 0], path[count, 1] = i - 1, j - 1
        count += 1
        if total[i - 1, j - 1] <= total[i - 1, j] and total[i - 1, j - 1] <= total[i, j - 1]:
            i, j = i - 1, j - 1
        elif total[i - 1, j] <= total[i, j - 1]:
            i -= 1
        else:
            j -= 1
    return path[:count][::-1].copy()


def warped(times: np.ndarray, path: np.ndarray) -> np.ndarray:
    """Times of one take on the other's clock: the middle of all that each pose is paired with."""
    at = np.unique(path[:, 0])
    middle = np.bincount(path[:, 0], path[:, 1])[at] / np.bincount(path[:, 0])[at]
    return np.interp(times * RATE, at, middle) / RATE


def cmu(folder: Path) -> list[list[Dance]]:
    """Groups of repeated takes."""
    groups: list[list[Dance]] = []
    for numbers in CMU:
        groups.append([])
        for number in numbers:
            motion = read_motion(folder / f"05_{number}.amc", 120.0)
            try:
                groups[-1].append(dance(f"05_{number}", motion))
            except PlanError as problem:
                print(f"05_{number} left out: {problem}")
    return groups


def troupe(*, heard: bool) -> list[list[Dance]]:
    """Two rehearsed takes of each figure by one dancer, with the song's beats or on their own pulse."""
    rng = np.random.default_rng(0)
    groups: list[list[Dance]] = []
    for number, figure in enumerate(FIGURES):
        groups.append([])
        for take in range(2):
            clip = perform(DANCERS[number % len(DANCERS)], [figure], 1.0, min(cycles_of(figure), CYCLES), rng)
            clip = rehearse(clip, rng, spread="normal")
            groups[-1].append(dance(f"{figure.name} {take + 1}", clip.motion, clip.beats if heard else None))
    return groups


def compare(title: str, groups: Sequence[Sequence[Dance]], *, each: bool = False) -> None:
    """A table: repeated takes, and the first takes of different figures."""
    rng = np.random.default_rng(0)
    repeated = [(a, b, agreement(a, b, rng)) for group in groups for a, b in combinations(group, 2)]
    firsts = [group[0] for group in groups if group]
    others = groups if each else [[one] for one in firsts]
    mismatched = [
        (a, b, agreement(a, b, rng)) for x, y in combinations(others, 2) for a in x for b in y
    ]  # fmt: skip
    if each:
        for a, b, rows in repeated:
            told = [f"{one.seconds:.1f} s, {60 / np.median(np.diff(one.keyposes['every beat'])):.0f} BPM, "
                    f"{len(one.keyposes['energy'])} keyposes" for one in (a, b)]  # fmt: skip
            row, free = rows["energy"], rows["all rests"]
            print(f"  {a.name} ({told[0]}) and {b.name} ({told[1]}), {100 * row.apart:.1f} cm: F {row.f:.3f}, null "
                  f"{row.null:.3f}; all rests {free.f:.3f}, null {free.null:.3f}")  # fmt: skip
    alike = [one for one in repeated if one[2]["energy"].apart < ALIKE]
    parts = (repeated, alike, mismatched)
    poses = ", ".join(f"{len(p)} {100 * mean([rows['energy'].apart for *_, rows in p]):.1f} cm" for p in parts)
    print(f"{title}: pairs and how far their poses are apart: {poses}")
    for method in repeated[0][2]:
        cells = [mean([getattr(rows[method], which) for *_, rows in part]) for part in parts for which in ("f", "null")]
        print(f"  {method:24s}" + "".join(f"{cell:12.3f}" for cell in cells), flush=True)


def repeatability(folder: Path | None) -> None:
    print(
        f"\nrepeatability: F within ± {NEAR:g} s of the keyposes of two takes, one warped onto the other by its poses"
    )
    print(f"  {'':24s}{'repeated':>12s}{'null':>12s}{'and alike':>12s}{'null':>12s}{'mismatched':>12s}{'null':>12s}")
    compare("troupe, the song's beats", troupe(heard=True))
    compare("troupe, its own pulse", troupe(heard=False))
    if folder is not None:
        compare("CMU 05, its own pulse", cmu(folder), each=True)
