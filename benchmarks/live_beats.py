"""How well beats are heard while they happen, beside other trackers used live; and how changes of tempo are followed.

Usage: ``python benchmarks/live_beats.py FOLDER [--peers PYTHON] [--limit N]``. FOLDER holds ``NAME.ogg`` +
``NAME.beats`` (seconds TAB bar position); PYTHON is an interpreter that has aubio and librosa (``live_peers.py``).

All trackers hear the same files in the same run, ours in ticks of 10 ms. Beats are scored by when they were *said*
(window and all), F at ±70 ms, the first 8 s left out; ``listen`` hears the whole file and is scored by the times it
states. *Next* is the error of the next beat when the one before it is said, on steady pieces. The *pulse* is what is
danced on: the beats of the music folded to 70 to 140 BPM, foretold; its F is against every level (beats, every second
one, halves), the best taken.

Then songs of ours whose tempo steps or ramps: beats from the change until four danced beats in a row, as they were
foretold 0.2 s before, lie within 70 ms; the error of foretold beats once locked; and, as the null, the share of beats
at random phase within 60 ms.
"""

from __future__ import annotations

import argparse
import gc
import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import mir_eval
import numpy as np
import soundfile
import soxr

from onbeat.examples.arrangement import LEAD, Grid, form
from onbeat.examples.harmony import choose_progressions
from onbeat.examples.mixing import master
from onbeat.examples.score import write_score
from onbeat.examples.song import perform
from onbeat.live.beat.pulse import EAR_RATE, Heard, Pulse
from onbeat.music.causal import CausalTracker
from onbeat.music.listen import listen

SKIPPED = 8.0  # [s]
STEADY = 0.01  # variation of the beat intervals, up to which a piece is steady
BEFORE = 0.2  # [s] before its time, at which a foretold beat is taken
CHANGE = 16.0  # [s] from the first beat to a change of tempo
TICK = EAR_RATE // 100
Levels = list[np.ndarray]


def levels(beats: np.ndarray) -> Levels:
    """The beats, every second one of them, and halves."""
    halves = np.sort(np.append(beats, (beats[1:] + beats[:-1]) / 2.0))
    return [beats, beats[::2], beats[1::2], halves]


def agreement(true: np.ndarray, said: np.ndarray) -> float:
    """F at ±70 ms without the first seconds."""
    true, said = (times[times >= SKIPPED] for times in (true, np.sort(said)))
    return float(mir_eval.beat.f_measure(true, said))


def pulse_of(samples: np.ndarray) -> tuple[list[Heard], float, float]:
    """What the pulse says at each tick; CPU ms of a tick, mean and worst."""
    pulse, heard, cost = Pulse(), [], []
    gc.disable()  # what is kept here to be looked at would be looked through
    for begin in range(0, len(samples) - TICK + 1, TICK):
        began = time.thread_time()
        heard.append(pulse.hear(samples[begin : begin + TICK]))
        cost.append(1000.0 * (time.thread_time() - began))
    gc.enable()
    return heard, float(np.mean(cost)), float(np.max(cost[100:]))


def danced(heard: list[Heard]) -> np.ndarray:
    """(B, 2): each danced beat while music was heard, as foretold ``BEFORE`` seconds earlier, and when it then was."""
    foretold: dict[int, float] = {}
    at: dict[int, float] = {}
    for now in heard:
        at[now.first] = float(now.times[0])
        if now.hearing == "music" and now.times[1] - now.time <= BEFORE:
            foretold.setdefault(now.first + 1, float(now.times[1]))
    return np.array([(foretold[number], at[number]) for number in foretold if number in at]).reshape(-1, 2)


def wander(heard: list[Heard]) -> list[float]:
    """Of each danced beat, the root mean square of how far it was foretold, in its last 2 s, from it came [ms]."""
    at = {int(now.first): float(now.times[0]) for now in heard}
    apart: dict[int, list[float]] = {}
    for now in heard:
        for ahead in range(1, 5):
            due = at.get(now.first + ahead, np.inf)
            if now.time > SKIPPED and due - now.time <= 2.0:
                apart.setdefault(now.first + ahead, []).append(now.times[ahead] - due)
    return [1000.0 * float(np.sqrt(np.mean(np.square(row)))) for row in apart.values()]


def tracked(samples: np.ndarray, rate: int) -> np.ndarray:
    """Beats (B, 3) of the causal tracker: stated, said, foretold next."""
    tracker, rows, block = CausalTracker(rate), [], round(0.01 * rate)
    for begin in range(0, len(samples), block):
        for beat in tracker.push(samples[begin : begin + block]):
            following = tracker.next_beats(2)
            rows.append((beat.time, beat.emitted_at, following[following > beat.time + 15.0 / tracker.tempo][0]))
    return np.array(rows).reshape(-1, 3)


def scores(path: Path) -> dict[str, float]:
    """Of one piece: F of each of ours, error of the next beat, wander and cost of the pulse."""
    true = np.loadtxt(path.with_suffix(".beats"), ndmin=2)[:, 0]
    samples, rate = soundfile.read(path, dtype="float32", always_2d=True)
    mono = np.ascontiguousarray(samples.mean(axis=1))
    beats = tracked(mono, rate)
    heard, cost, worst = pulse_of(mono if rate == EAR_RATE else soxr.resample(mono, rate, EAR_RATE))
    steady = np.std(np.diff(true)) <= STEADY * np.mean(np.diff(true))
    ahead = beats[(beats[:, 2] >= SKIPPED) & (beats[:, 2] <= true[-1]), 2]
    error = np.median(np.abs(ahead[:, None] - true).min(axis=1)) if steady and len(ahead) else np.nan
    told = danced(heard)
    return {
        "causal": agreement(true, beats[:, 1]),
        "offline": agreement(true, listen(path).beats),
        "pulse": max(agreement(level, told[:, 0]) for level in levels(true)),
        "next": 1000.0 * float(error),
        "wander": float(np.median(wander(heard))) if steady else np.nan,
        "cost": cost,
        "worst": worst,
    }


def peer_scores(peer: str, python: str, pieces: list[Path]) -> np.ndarray:
    """F of a peer by piece; none where it cannot be run."""
    worker = Path(__file__).with_name("live_peers.py")
    run = subprocess.run([python, str(worker), peer, *map(str, pieces)], capture_output=True, text=True, check=False)
    if run.returncode:
        return np.zeros(0)
    lines = [json.loads(line) for line in run.stdout.splitlines()]
    truth = [np.loadtxt(piece.with_suffix(".beats"), ndmin=2)[:, 0] for piece in pieces]
    return np.array([agreement(true, np.array(line["said"])) for true, line in zip(truth, lines, strict=True)])


def interval(values: np.ndarray) -> str:
    """Mean and the bootstrap's 95 % interval."""
    draws = np.random.default_rng(0).choice(values, (2000, len(values))).mean(axis=1)
    return f"{values.mean():.3f} ({'–'.join(f'{value:.3f}' for value in np.percentile(draws, (2.5, 97.5)))})"


def middle(values: np.ndarray) -> float:
    """Median of those that are numbers."""
    known = values[~np.isnan(values)]
    return float(np.median(known)) if len(known) else float("nan")


def report_pieces(pieces: list[Path], python: str | None) -> None:
    rows = [scores(piece) for piece in pieces]
    ours = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    print(f"{len(pieces)} pieces, F at ±70 ms by when beats were said, first {SKIPPED:g} s left out")
    for name in ("causal", "offline", "pulse"):
        print(f"{name:10} {interval(ours[name])}")
    for peer in ("aubio", "librosa") if python else ():
        found = peer_scores(peer, python or "", pieces)
        better = "" if not len(found) else f"   ours is {ours['causal'].mean() - found.mean():+.3f}"
        print(f"{peer:10} {interval(found) if len(found) else 'cannot be run there'}{better}")
    print(f"offline − causal: {ours['offline'].mean() - ours['causal'].mean():+.3f} (target: at most 0.08)")
    print(f"next beat, median over steady pieces: {middle(ours['next']):.1f} ms (target: at most 25 ms)")
    print(f"wander of foretold beats over 2 s, median over steady pieces: {middle(ours['wander']):.1f} ms")
    print(f"pulse: CPU {ours['cost'].mean():.3f} ms a tick, worst tick {ours['worst'].max():.1f} ms")


def song(tempo: Callable[[float], float], seconds: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A song of ours at a tempo over time: samples at 44.1 kHz, beats."""
    lengths, at = [], 0.0
    while at < seconds:
        lengths.append(60.0 / tempo(at + 0.25))
        at += lengths[-1]
    lengths = lengths[: len(lengths) // 4 * 4]
    grid = Grid(LEAD + np.append(0.0, np.cumsum(lengths)), 4)
    rng = np.random.default_rng([seed, 0])
    score = write_score(grid, form(grid.bars), choose_progressions(rng), rng)
    desk = perform(score, float(grid.beats[-1]) + 2.0, seed)
    return master(desk.mix(rng), fade=1.6).mean(axis=1).astype(np.float32), grid.beats


def stepping(base: float, ratio: float) -> Callable[[float], float]:
    return lambda at: base * (ratio if at >= CHANGE else 1.0)


def ramping(base: float, ratio: float) -> Callable[[float], float]:
    return lambda at: base * (1.0 + (ratio - 1.0) * float(np.clip((at - CHANGE) / 20.0, 0.0, 1.0)))


def locked_after(true: np.ndarray, told: np.ndarray, run: int = 4) -> float:
    """Beats until ``run`` in a row are told within 70 ms, one each."""
    for first in range(len(true) - run + 1):
        row = true[first : first + run]
        inside = told[(told >= row[0] - 0.07) & (told <= row[-1] + 0.07)]
        if len(inside) == run and (np.abs(inside - row) <= 0.07).all():
            return first
    return float("inf")


def changes() -> dict[str, tuple[Callable[[float], float], float]]:
    """Tempo over time, and the length of the song in seconds."""
    cases = {}
    for base in (96.0, 112.0, 124.0):
        for ratio in (1.08, 1 / 1.08, 1.3, 1 / 1.3):
            cases[f"{base:g} BPM steps by {100 * ratio - 100:+.0f} %"] = stepping(base, ratio), 34.0
        for ratio in (1.2, 0.8):
            cases[f"{base:g} BPM ramps by {100 * ratio - 100:+.0f} % in 20 s"] = ramping(base, ratio), 44.0
    return cases


def report_changes() -> None:
    print(f"\n{'change':28} locked after   |error| med, p90 ms   within 60 ms once locked")
    everything = []
    for seed, (name, (tempo, seconds)) in enumerate(changes().items()):
        samples, beats = song(tempo, seconds, 40 + seed)
        told = danced(pulse_of(samples)[0])[:, 0]
        told, beats = told[(told > 8.0) & (told < beats[-2])], beats[beats < beats[-2]]
        # Beats at the level that is danced now.
        level = max(levels(beats), key=lambda level: mir_eval.beat.f_measure(level[level > 25], told[told > 25]))
        changed = beats[np.searchsorted(beats, CHANGE - 0.25 + LEAD - 1e-6)]  # the last beat in its old place
        after = level[level > changed + 1e-6]
        locked = locked_after(after, told)
        error = np.abs(after[int(min(locked, len(after) - 1)) :, None] - told).min(axis=1)
        everything.append(error)
        print(
            f"{name:28} {locked:6g} beats   {1000 * np.median(error):6.0f} {1000 * np.percentile(error, 90):6.0f}"
            f"            {(error <= 0.06).mean():8.2f}"
        )
    error = np.concatenate(everything)
    null = np.random.default_rng(0).uniform(0.0, 0.5, 100000)
    chance = (np.minimum(null, 0.5 - null) <= 0.06).mean()
    print(f"within 60 ms once locked: {(error <= 0.06).mean():.3f}; at random phase (120 BPM) {chance:.3f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--peers", metavar="PYTHON", help="an interpreter that has aubio and librosa")
    parser.add_argument("--limit", type=int, help="the first N pieces only")
    arguments = parser.parse_args()
    pieces = sorted(path for path in arguments.folder.glob("*.ogg") if path.with_suffix(".beats").exists())
    pieces = pieces[: arguments.limit]
    if not pieces:
        parser.error(f"no NAME.ogg with a NAME.beats beside it in {arguments.folder}")
    pulse_of(np.zeros(EAR_RATE * 2, np.float32))  # compiled before it is timed
    report_pieces(pieces, arguments.peers)
    report_changes()


if __name__ == "__main__":
    sys.exit(main())
