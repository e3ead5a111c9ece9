"""Keyposes found in a dance that was authored as key poses: HRP-4C's "Turn to the Future".

Usage: ``python benchmarks/hrp4c_dance.py FOLDER [--passing rest,choreonoid] [--window SHARE]``. The folder holds
``HRP4C.body``, ``TurnToTheFuture.pseq`` and ``TurnToTheFuture.ogg``, which are Choreonoid's and no part of onbeat.

The truth is the 72 key poses that give the upper body its angles, as they are listed. Some stand at one moment (an arm
each) and the first three leave it as it is: *moments* counts those that move it, once each. Thresholds are learned on
one half of the dance and tested on the other, both ways; the mean is shown. A keypose is found within ±50 ms. Chance is
what was found, shifted by a random phase round the half it was found in. Beats are heard by ``onbeat.music.listen``, or
are the true ones of 150 BPM. Nothing else is fitted; what is *chosen* beside the thresholds (window; kind and order) is
chosen on the learning half, too.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hrp4c_body import LEG
from hrp4c_poses import PASSING, SONG_AT, TEMPO, Dance, read_dance
from onbeat.keyposes.candidates import WINDOW, Thresholds
from onbeat.keyposes.energy import KINDS
from onbeat.keyposes.extract import ORDERS, Options, Reading, beats_inside, find_keyposes
from onbeat.keyposes.matching import chance, score
from onbeat.keyposes.thresholds import GRID, Sweep
from onbeat.music.listen import listen

LOWER = (*LEG, "TOE_P")
TOGETHER = 0.02  # [s] within which key poses are of one moment
BOX = (np.linspace(0.6, 4.0, 18), np.linspace(0.0, 0.75, 16))  # T1 and T2 over which F has to be steady
SHOWN = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)
WINDOWS = (0.25, 1 / 3, 0.4, 0.5, 0.6)


@dataclass(frozen=True)
class Half:
    """One half of the dance: from when to when, and the key poses in it; seconds."""

    span: tuple[float, float]
    truth: np.ndarray

    def of(self, times: np.ndarray) -> np.ndarray:
        return times[(times >= self.span[0]) & (times < self.span[1])]


@dataclass(frozen=True)
class Row:
    """Means over the two tests: precision, recall and F, chance, how many were found, and the thresholds."""

    scores: np.ndarray
    chance: float
    found: int
    thresholds: Sequence[Thresholds] = ()


def moments(dance: Dance, times: np.ndarray) -> np.ndarray:
    """Of the key poses those before which the upper body moved, one a moment."""
    upper = [k for k, name in enumerate(dance.body.names) if name.removeprefix("L_").removeprefix("R_") not in LOWER]
    found = [times[0]]
    for time in times[1:]:
        before, now = (dance.angles[min(round(t * dance.motion.fps), len(dance.angles) - 1)] for t in (found[-1], time))
        if time - found[-1] > TOGETHER and np.abs(now - before)[upper].max() > 1e-3:
            found.append(time)
    return np.array(found[1:])


def halves(truth: np.ndarray, duration: float) -> tuple[Half, Half]:
    """The dance parted where as many key poses are before as after."""
    middle = float(np.median(truth))
    spans = ((0.0, middle), (middle, duration + 1.0))
    return tuple(Half(span, truth[(truth >= span[0]) & (truth < span[1])]) for span in spans)


def trial(found: Sequence[np.ndarray], parts: Sequence[Half], thresholds: Sequence[Thresholds] = ()) -> Row:
    """What was found for each half against its truth."""
    rng, own = np.random.default_rng(0), [part.of(times) for times, part in zip(found, parts, strict=True)]
    scores = np.mean([score(times, part.truth) for times, part in zip(own, parts, strict=True)], axis=0)
    null = np.mean([chance(times, part.truth, part.span, rng)[0] for times, part in zip(own, parts, strict=True)])
    return Row(scores, float(null), sum(map(len, own)), thresholds)


def swept(reading: Reading, parts: Sequence[Half]) -> list[Sweep]:
    """Scores over all thresholds, a sweep for each half."""
    found = [[reading.keyposes(Thresholds(a, b)).times for b in GRID] for a in GRID]
    grid = np.array(GRID)
    return [
        Sweep(grid, grid, np.array([[[score(p.of(times), p.truth) for times in row] for row in found]])) for p in parts
    ]


def learned(readings: Sequence[Reading], parts: Sequence[Half]) -> Row:
    """Of several readings, for each half the one and its thresholds that are best on the other half."""
    sweeps = [swept(reading, parts) for reading in readings]
    found, used = [], []
    for test in range(2):
        best = max(range(len(readings)), key=lambda k: float(sweeps[k][1 - test].f.max()))
        used.append(sweeps[best][1 - test].best())
        found.append(readings[best].keyposes(used[-1]).times)
    return trial(found, parts, used)


def rows(dance: Dance, beats: np.ndarray, truth: np.ndarray, window: float) -> dict[str, Row]:
    """All methods."""
    motion, parts = dance.motion, halves(truth, dance.motion.duration)
    readings = {
        (kind, order): Reading(motion, beats, Options(kind=kind, order=order, window=window))
        for kind in KINDS
        for order in ORDERS
    }
    found = {f"energy {' '.join(key)}": learned([reading], parts) for key, reading in readings.items()}
    usual = Options()
    table = {"default": found[f"energy {usual.kind} {usual.order}"]}
    as_it_is = readings[usual.kind, usual.order].keyposes(usual.thresholds).times
    table["default, not learned"] = trial([as_it_is] * 2, parts, [usual.thresholds])
    windows = [Reading(motion, beats, Options(window=share)) for share in WINDOWS]
    table["default, window chosen"] = learned(windows, parts)
    table |= found | {"energy, chosen": learned(list(readings.values()), parts)}
    for name, method in (("paper 2009", "paper2009"), ("shiratori 2004", "shiratori2004"), ("hands only", "hands")):
        table[name] = trial([find_keyposes(motion, beats, method, Options(window=window)).times] * 2, parts)
    return table | {"beats only": trial([beats_inside(beats, motion)] * 2, parts)}


def print_rows(titles: Sequence[str], tables: Sequence[dict[str, Row]]) -> None:
    """The tables side by side, a line a method."""
    print(f"{'':28}" + "".join(f"{title:<40}" for title in titles))
    print(f"{'':28}" + f"{'P':>5}{'R':>6}{'F':>7}{'chance':>7}{'found':>6}{'':9}" * len(titles))
    for name in tables[0]:
        cells = [
            "{:>5.2f}{:>6.2f}{:>7.3f}".format(*t[name].scores) + f"{t[name].chance:>7.2f}{t[name].found:>6}{'':9}"
            for t in tables
        ]
        used = "  ".join(f"T1 {t.t1:g} T2 {t.t2:g}" for t in tables[0][name].thresholds)
        print(f"{name:28}" + "".join(cells) + used)


def print_sweep(reading: Reading, truth: np.ndarray) -> None:
    """F over both thresholds on the whole dance, and where it is steady."""

    def f(t1: float, t2: float) -> float:
        return score(reading.keyposes(Thresholds(t1, t2)).times, truth).f

    print(f"\nF over T1 (down) and T2 (across), {reading.options.kind} {reading.options.order}, whole dance")
    print(f"{'':6}" + "".join(f"{t2:>6g}" for t2 in SHOWN) + f"{'none':>7}")
    for t1 in SHOWN:
        print(f"{t1:>6g}" + "".join(f"{f(t1, t2):>6.2f}" for t2 in (*SHOWN, np.inf)))
    inside = np.array([[f(t1, t2) for t2 in BOX[1]] for t1 in BOX[0]])
    print(f"T1 0.6…4, T2 0…0.75: F {inside.min():.3f}…{inside.max():.3f}, spread {np.ptp(inside):.3f}")
    alone = {"T1": [f(t, np.inf) for t in BOX[0]], "T2": [f(0.0, t) for t in BOX[1]]}
    print("; ".join(f"{name} alone: {min(v):.3f}…{max(v):.3f}" for name, v in alone.items()))


def print_windows(dance: Dance, beats: np.ndarray, truths: Sequence[np.ndarray]) -> None:
    """How much depends on how far from its beat a minimum may lie."""
    print("\nwindow (share of a beat), default options, thresholds learned; ceiling: key poses that near to a beat")
    for window in WINDOWS:
        reading = Reading(dance.motion, beats, Options(window=window))
        cells = [learned([reading], halves(truth, dance.motion.duration)).scores[2] for truth in truths]
        near = [np.abs(reading.beats[None] - truth[:, None]).min(1) <= window * 60 / TEMPO for truth in truths]
        print(
            f"{window:>6.2f}"
            + "".join(f"   F {f:.3f} (ceiling {n.mean():.2f})" for f, n in zip(cells, near, strict=True))
        )


def report(dance: Dance, passing: str, beats: dict[str, np.ndarray], window: float) -> None:
    """All tables of one way of passing the keys."""
    truths = {"72 key poses": dance.key_poses, "moments": moments(dance, dance.key_poses)}
    print(f"\n### keys passed by {passing!r}; {len(truths['moments'])} moments; window {window:.2f} of a beat\n")
    pairs = [(b, t) for t in truths for b in beats]
    made = [rows(dance, beats[b], truths[t], window) for b, t in pairs]
    print_rows([f"{b} beats, {t}" for b, t in pairs], made)
    for options in (Options(window=window), Options(kind="sum", order="local", window=window)):
        print_sweep(Reading(dance.motion, beats["heard"], options), dance.key_poses)
    print_windows(dance, beats["heard"], list(truths.values()))


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--passing", default=",".join(PASSING))
    parser.add_argument("--window", type=float, default=WINDOW)
    given = parser.parse_args()
    song = listen(given.folder / "TurnToTheFuture.ogg")
    beats = {"heard": song.beats + SONG_AT, "true": SONG_AT + np.arange(0.0, song.duration, 60.0 / TEMPO)}
    off = np.abs(beats["heard"][:, None] - beats["true"]).min(axis=1)
    print(f"{song.title}: {len(song.beats)} beats heard, {1000 * np.median(off):.1f} ms from the true ones")
    for passing in given.passing.split(","):
        report(read_dance(given.folder, passing), passing, beats, given.window)


if __name__ == "__main__":
    main()
