"""How well the causal tracker hears beats as they happen, with and without its learned activation.

Usage: ``python benchmarks/causal.py FOLDER [--each] [--limit N]``. FOLDER holds ``NAME.ogg`` + ``NAME.beats`` (seconds
TAB bar position); where its README.md has a table ``| NAME | set | category |``, scores are given per category too.

The sound is pushed in blocks of 10 ms at the file's own rate. Beats are scored twice: by the time they state, and by
the time at which they were said (``emitted_at``: the analysis window counts). F, CMLt, AMLt and downbeat F are
mir_eval's, the first 5 s left out; *meter* is the share of the beats after them at which the bar's length is right.
That hides the start, so *lock* is given apart, for the steady pieces: the time from the first true beat to the first of
four true beats in a row that are each said within 70 ms, with none said between; *lock** allows half, double and off-
beats. *Next* is the error of the beat foretold one beat ahead, at the moment a beat is said. *Re-lock* is the lock
after the tempo steps by 30 % at a downbeat.
"""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import mir_eval
import numpy as np
import soundfile

from onbeat.examples.song import demo_song
from onbeat.music.causal import CausalTracker

COLUMNS = (
    "F",
    "CMLt",
    "AMLt",
    "F said",
    "CMLt said",
    "AMLt said",
    "bar F",
    "lag",
    "lag said",
    "lock",
    "lock*",
    "next",
    "ms",
    "meter",
)
STEADY = 0.01  # variation of the beat intervals, up to which a piece is steady
PEERS = """Peers online on the same 44 pieces (F / CMLt / AMLt): madmom .824 / .715 / .816, BeatNet .633 / .424 / .516
and on 22 steady pieces (lock median / p90 s, never, re-lock s): madmom 0.5 / 1.8, 0, 3.0; BTrack 1.2 / 4.3, 1, 9.2;
aubio 1.9 / 6.2, 1, 8.3; BeatNet 4.2 / 91, 3, -  (measured elsewhere, MUSIC.md)"""


def heard(samples: np.ndarray, rate: int, learned: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """Beats (B, 5): stated time, time said, downbeat, foretold next beat, meter; and CPU ms per frame of 10 ms."""
    tracker = CausalTracker(rate, learned=learned)
    block = round(0.01 * rate)
    rows, began = [], time.process_time()
    for start in range(0, len(samples), block):
        for beat in tracker.push(samples[start : start + block]):
            foretold = tracker.next_beats(2)
            following = foretold[foretold > beat.time + 15.0 / tracker.tempo][0]
            rows.append((beat.time, beat.emitted_at, beat.downbeat, following, tracker.meter))
    return np.array(rows).reshape(-1, 5), 1000.0 * (time.process_time() - began) / (len(samples) / block)


def lock(reference: np.ndarray, said: np.ndarray, run: int = 4, within: float = 0.07) -> float:
    """Seconds from the first true beat to the first of ``run`` in a row that are said, one beat each; else infinite."""
    for first in range(len(reference) - run + 1):
        row = reference[first : first + run]
        inside = said[(said >= row[0] - within) & (said <= row[-1] + within)]
        if len(inside) == run and (np.abs(inside - row) <= within).all():
            return float(row[0] - reference[0])
    return float("inf")


def allowed_lock(reference: np.ndarray, said: np.ndarray) -> float:
    """The earliest lock onto the beats, their halves, every other one of them or between them."""
    between = (reference[1:] + reference[:-1]) / 2.0
    levels = (reference, between, np.sort(np.append(reference, between)), reference[::2], reference[1::2])
    return min(lock(level, said) + level[0] - reference[0] for level in levels)


def lag(reference: np.ndarray, said: np.ndarray) -> float:
    """Median of said − nearest true beat over those within 70 ms, in ms."""
    if not len(said):
        return float("nan")
    late = said - reference[np.abs(reference[None] - said[:, None]).argmin(axis=1)]
    late = late[np.abs(late) <= 0.07]
    return 1000.0 * float(np.median(late)) if len(late) else float("nan")


def agreement(reference: np.ndarray, said: np.ndarray) -> list[float]:
    """F, CMLt, AMLt without the first 5 s."""
    reference, said = mir_eval.beat.trim_beats(reference), mir_eval.beat.trim_beats(said)
    _, correct, _, allowed = mir_eval.beat.continuity(reference, said)
    return [mir_eval.beat.f_measure(reference, said), correct, allowed]


def meter_right(table: np.ndarray, beats: np.ndarray) -> float:
    """Share of the beats said after 5 s that are counted in the most frequent bar of the annotation."""
    bars = np.diff(np.flatnonzero(table[:, 1] == 1))
    meter = np.bincount(bars).argmax() if len(bars) else table[:, 1].max()
    late = beats[beats[:, 0] > 5.0, 4]
    return float(np.mean(late == meter)) if len(late) else 0.0


def scores(path: Path, learned: bool) -> list[float]:
    """One row of the table."""
    table = np.loadtxt(path.with_suffix(".beats"), ndmin=2)
    samples, rate = soundfile.read(path, dtype="float32", always_2d=True)
    beats, cost = heard(np.ascontiguousarray(samples.mean(axis=1)), rate, learned)
    true, stated, said = table[:, 0], beats[:, 0], np.maximum.accumulate(beats[:, 1])
    downbeats = mir_eval.beat.trim_beats(true[table[:, 1] == 1]), mir_eval.beat.trim_beats(stated[beats[:, 2] == 1])
    steady = np.std(np.diff(true)) <= STEADY * np.mean(np.diff(true))
    foretold = beats[(beats[:, 3] >= true[0]) & (beats[:, 3] <= true[-1]), 3]
    error = 1000.0 * np.median(np.abs(foretold[:, None] - true).min(axis=1)) if len(foretold) else np.nan
    locks = [lock(true, said), allowed_lock(true, said)] if steady else [np.nan, np.nan]
    return [
        *agreement(true, stated),
        *agreement(true, said),
        mir_eval.beat.f_measure(*downbeats),
        lag(true, stated),
        lag(true, said),
        *locks,
        error if steady else np.nan,
        cost,
        meter_right(table, beats),
    ]


def line(rows: np.ndarray) -> str:
    """Means, medians of lags, locks and errors."""
    steady = rows[~np.isnan(rows[:, 9])]
    parts = [f"{value:6.3f}" for value in rows[:, :7].mean(axis=0)]
    parts += [f"{value:6.1f}" for value in np.nanmedian(rows[:, 7:9], axis=0)] if len(rows) else []
    if len(steady):
        parts += [
            f"{np.median(steady[:, 9]):5.2f} {np.median(steady[:, 10]):5.2f}",
            f"{np.nanmedian(steady[:, 11]):5.1f}",
        ]
    else:
        parts += ["    –     –     –"]
    return "  ".join([*parts, f"{rows[:, 12].mean():.3f}", f"{rows[:, 13].mean():.2f}"])


def interval(values: np.ndarray) -> str:
    """The bootstrap's 95 % interval of a mean."""
    draws = np.random.default_rng(0).choice(values, (2000, len(values))).mean(axis=1)
    return "–".join(f"{value:.3f}" for value in np.percentile(draws, (2.5, 97.5)))


def categories(folder: Path) -> dict[str, str]:
    """Category of each piece, from the table of the folder's README.md."""
    readme = folder / "README.md"
    text = readme.read_text(encoding="utf-8") if readme.exists() else ""
    return dict(re.findall(r"^\| (\S+) \| \S+ \| ([^|]+?) \|", text, flags=re.MULTILINE))


def drum(kind: str, rng: np.random.Generator, rate: int) -> np.ndarray:
    """A kick, a snare or a hat."""
    t = np.arange(round(0.2 * rate)) / rate
    if kind == "kick":
        return np.sin(2 * np.pi * (50 * t + 6 * (1 - np.exp(-t / 0.03)))) * np.exp(-t / 0.09)
    noise = np.diff(rng.standard_normal(len(t)), prepend=0.0)
    return noise * (0.4 * np.exp(-t / 0.05) if kind == "snare" else 0.15 * np.exp(-t / 0.012))


def stepping_drums(before: float, after: float, rate: int = 44100) -> tuple[np.ndarray, np.ndarray, float]:
    """Kick, snare and hats in eighths whose tempo steps at 16 beats: samples, beats, time of the step."""
    rng = np.random.default_rng(0)
    beats = 0.3 + np.concatenate([[0.0], np.cumsum(np.r_[np.full(16, 60.0 / before), np.full(24, 60.0 / after)])])
    samples = np.zeros(round((beats[-1] + 1.0) * rate))
    for index, (beat, following) in enumerate(pairwise(beats)):
        hits = [(beat, "snare" if index % 2 else "kick"), (beat, "hat"), ((beat + following) / 2.0, "hat")]
        for at, kind in hits:
            sound = drum(kind, rng, rate)
            samples[round(at * rate) : round(at * rate) + len(sound)] += sound
    return (0.5 * samples / np.abs(samples).max()).astype(np.float32), beats, float(beats[16])


def stepping_song(before: float, after: float) -> tuple[np.ndarray, np.ndarray, float]:
    """The embedded song at one tempo, cut at a downbeat, and on from a downbeat at another."""
    first, second = demo_song(24.0, 3, before, drift=0.0), demo_song(24.0, 3, after, drift=0.0)
    leave, enter = first.downbeats[5], second.downbeats[2]
    rate = first.rate
    samples = np.concatenate(
        [first.samples[: round(leave * rate)].mean(axis=1), second.samples[round(enter * rate) :].mean(axis=1)]
    )
    beats = np.append(
        first.beats[first.beats < leave - 1e-6], second.beats[second.beats > enter - 1e-6] - enter + leave
    )
    return samples.astype(np.float32), beats, float(leave)


def relock(song: tuple[np.ndarray, np.ndarray, float], learned: bool) -> str:
    """Seconds from a step of the tempo to the first of four right beats in a row; right up to half or double."""
    samples, beats, step = song
    said = heard(samples, 44100, learned)[0][:, 1]
    after = beats[beats >= step - 1e-6]
    return f"{lock(after, said):5.2f} s (allowing levels {allowed_lock(after, said):5.2f} s)"


def report(pieces: list[Path], kinds: dict[str, str], learned: bool, each: bool) -> np.ndarray:
    """Print the table of one tracker."""
    print(f"\n{'with' if learned else 'without'} the learned activation\n{'':30}", "  ".join(COLUMNS))
    rows = np.array([scores(piece, learned) for piece in pieces])
    if each:
        for piece, row in zip(pieces, rows, strict=True):
            print(f"{piece.stem[:28]:30}", "  ".join(f"{value:6.3f}" for value in row))
    kind = np.array([kinds.get(piece.stem, piece.stem.partition("_")[0]) for piece in pieces])
    for name in dict.fromkeys(kind):
        print(f"{name[:24]:24} {(kind == name).sum():>4} ", line(rows[kind == name]))
    print(f"{'all':24} {len(rows):>4} ", line(rows))
    print("95 % intervals: ", ", ".join(f"{COLUMNS[index]} {interval(rows[:, index])}" for index in (0, 2, 3, 5)))
    for name, column in (("lock", 9), ("lock*", 10)):
        locks = np.sort(rows[~np.isnan(rows[:, column]), column])
        if len(locks):
            ninetieth = locks[int(0.9 * (len(locks) - 1))]
            print(
                f"{name} on {len(locks)} steady pieces: median {np.median(locks):.2f} s, p90 {ninetieth:.2f} s, "
                f"never {np.isinf(locks).sum()}"
            )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--each", action="store_true", help="a line per piece too")
    parser.add_argument("--only", choices=("with", "without"), help="one of the two trackers")
    parser.add_argument("--limit", type=int, help="the first N pieces only")
    arguments = parser.parse_args()
    pieces = sorted(path for path in arguments.folder.glob("*.ogg") if path.with_suffix(".beats").exists())
    pieces = pieces[: arguments.limit]
    if not pieces:
        parser.error(f"no NAME.ogg with a NAME.beats beside it in {arguments.folder}")
    heard(np.zeros(44100, np.float32), 44100, True)  # compiled before it is timed
    songs: dict[str, Callable[[], tuple[np.ndarray, np.ndarray, float]]] = {
        "drums 100 -> 130": lambda: stepping_drums(100.0, 130.0),
        "drums 130 -> 100": lambda: stepping_drums(130.0, 100.0),
        "song  100 -> 130": lambda: stepping_song(100.0, 130.0),
        "song  130 -> 100": lambda: stepping_song(130.0, 100.0),
    }
    for learned in {"with": (True,), "without": (False,)}.get(arguments.only or "", (True, False)):
        report(pieces, categories(arguments.folder), learned, arguments.each)
        for name, make in songs.items():
            print(f"re-lock, {name}: {relock(make(), learned)}")
    print("\n" + PEERS)


if __name__ == "__main__":
    main()
