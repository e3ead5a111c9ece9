"""How good the improviser is: made music, steady and drifting, danced as it is heard, beside searches that know it all.

    python benchmarks/improvise.py --moves my_library --seconds 300

The improviser chooses when the dance comes within 2.6 s of what it has chosen: beats up to then are heard, later ones
are foretold at the tempo of the last four, and a beat that was danced on stays at its second of the dance, for the time
map moves that one onto the beat as it comes. All others are given the true beats of the whole music. ``F100`` and
``F50`` are of the stops and the beats in the dance's own seconds, before any stop is moved. ``of optimum`` is the score
beside the best of all at playback rate 1, which may repeat itself. ``unique s`` are seconds of clips that were shown,
``again 30`` seconds that were shown again within 30 s, ``ms/s`` CPU milliseconds per second of dance.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints, Times
from onbeat.dance.greedy import greedy_path
from onbeat.dance.optimal import Path as DancePath
from onbeat.dance.optimal import Problem, ValueToGo, best_path, score_path
from onbeat.dance.score import INTENSITY, score_music
from onbeat.dance.search import make_problem
from onbeat.dance.variety import beam_path
from onbeat.dance.walk import random_walk
from onbeat.live.choice.improviser import Improviser
from onbeat.metrics.beats import f_measure
from onbeat.moves.cache import build_or_open
from onbeat.moves.embedded import embedded_library
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song
from search import planned_stops

KNOWN, CHOSEN = 2.6, 2.0
COLUMNS = ("F100", "F50", "of optimum", "stops/beats", "unique s", "again 30", "joins/min", "ms/s")


class Danced(NamedTuple):
    """A dance: its path, its stops and beats as they were chosen, and CPU seconds."""

    path: DancePath
    stops: Times
    beats: Times
    seconds: float


def made_song(kind: str, seconds: float, tempo: float) -> Song:
    """Beats at a steady tempo, or at one that swings by ±8 % in 40 s; intensity in waves of 30 s."""
    at = np.arange(0.0, seconds + 2.0, 0.01)
    swing = 0.08 * np.sin(2 * np.pi * at / 40.0) * (kind == "drifting")
    phase = np.cumsum(tempo / 60.0 * (1.0 + swing)) * 0.01 - 0.3
    beats = np.interp(np.arange(0, int(phase[-1])), phase, at)
    beats = beats[beats < seconds]
    wave = 0.5 + 0.5 * np.sin(2 * np.pi * at / 30.0)
    return Song(seconds, tempo, 4, beats, beats[::4], np.ones(len(beats)), at, wave)


def foretold(beats: Times, now: float) -> Times:
    """Beats heard up to ``now``, and those foretold from them."""
    heard = beats[beats <= now]
    if len(heard) < 5:
        return beats[beats < now + 12.0]
    gap = (heard[-1] - heard[-5]) / 4
    return np.concatenate((heard, heard[-1] + gap * np.arange(1, 30)))


class Line:
    """Where beats lie on the dance's own seconds: once danced on, there they stay, and the time map does the rest."""

    def __init__(self, beats: Times) -> None:
        more = np.arange(1, 40) * (beats[-1] - beats[-2])  # the dance may be a little behind the music
        self.beats, self.known = np.concatenate((beats, beats[-1] + more)), [float(beats[0])]

    def expected(self, end: float) -> Times:
        """Where the beats are expected when all up to ``end`` is chosen, those before from memory."""
        last = len(self.known) - 1
        told = foretold(self.beats, self.beats[last] + end - self.known[-1] - KNOWN)
        return np.concatenate((self.known, self.known[-1] + told[last + 1 :] - told[last]))

    def danced(self, expected: Times, end: float) -> None:
        """All beats up to ``end`` are danced on."""
        self.known += expected[len(self.known) :][expected[len(self.known) :] < end].tolist()


def improvise(improviser: Improviser, library: MoveLibrary, problem: Problem, song: Song, ahead: float) -> Danced:
    """Dance to a song as it is heard."""
    end, since, at = 0.0, 0.0, None
    times, entries, stops, line = list[int](), list[int](), list[Array](), Line(song.beats)
    begun = time.process_time()
    while end < song.duration:
        expected = line.expected(end)
        z = float(problem.music.intensity[min(round(end * GRID), problem.music.frames - 1)]) * GRID / INTENSITY
        chosen = improviser.choose(at, since, expected - end, None, z, CHOSEN, ahead)
        stops.append(end + chosen.stops)
        for part in chosen.stretches:
            goes_on = at is not None and at[0] == part.clip and abs(at[1] - part.from_s) < 1e-6
            if not goes_on:
                times.append(round(end * GRID))
                entries.append(int(library.starts[part.clip]) + round(part.from_s * GRID))
            since = part.to_s - part.from_s + (since if goes_on else 0.0)
            at, end = (part.clip, part.to_s), end + part.to_s - part.from_s
        line.danced(expected, end)
    seconds = time.process_time() - begun
    keep = np.array(times) < problem.music.frames
    times, entries, beats = (
        np.array(times)[keep],
        np.array(entries)[keep],
        np.array([b for b in line.known if b < song.duration]),
    )
    music = score_music(
        replace(
            song, beats=beats, downbeats=beats[::4], chord_change=np.ones(len(beats)), beat_strength=np.ones(len(beats))
        )
    )
    score = score_path(replace(problem, music=music), times, entries)
    found = np.concatenate(stops)
    return Danced(DancePath(times, entries, score), found[found < song.duration], beats, seconds)


def shown(problem: Problem, path: DancePath) -> Ints:
    """The frame that is shown at each frame of the song."""
    ends = [*path.times[1:].tolist(), problem.music.frames]
    runs = [f + np.arange(e - t) for t, f, e in zip(path.times.tolist(), path.entries.tolist(), ends, strict=True)]
    return problem.frames.base[np.concatenate(runs)]


def again(frames: Ints, within: float) -> float:
    """Seconds that were shown already up to so many seconds before."""
    last: dict[int, int] = {}
    count = 0
    for t, frame in enumerate(frames.tolist()):
        count += frame in last and t - last[frame] <= within * GRID
        last[frame] = t
    return count / GRID


def row_of(problem: Problem, song: Song, optimum: float, danced: Danced) -> list[float]:
    """The figures of one dance."""
    frames = shown(problem, danced.path)
    return [
        f_measure(danced.stops, danced.beats, 0.1),
        f_measure(danced.stops, danced.beats, 0.05),
        danced.path.score / optimum,
        len(danced.stops) / len(danced.beats),
        len(np.unique(frames)) / GRID,
        again(frames, 30.0),
        60 * (len(danced.path.times) - 1) / song.duration,
        1e3 * danced.seconds / song.duration,
    ]


def offline(search: Callable[[], DancePath], problem: Problem, song: Song) -> Danced:
    """A dance by a search that knows the song."""
    begun = time.process_time()
    path = search()
    return Danced(path, planned_stops(problem, path), song.beats, time.process_time() - begun)


def measure(
    library: MoveLibrary, improvisers: dict[str, Improviser], song: Song, ahead: float, seed: int, greedy: bool
) -> None:
    """Print the table of one song."""
    problem = make_problem(library, song, rates=(1.0,))
    best = offline(lambda: best_path(ValueToGo(problem)), problem, song)
    rows = {name: improvise(who, library, problem, song, ahead) for name, who in improvisers.items()}
    rows["optimum, may repeat"] = best
    rows["beam, no repeats"] = offline(lambda: beam_path(problem, ValueToGo(problem)), problem, song)
    if greedy:
        rows["greedy 3 s"] = offline(lambda: greedy_path(problem), problem, song)
    walk = random_walk(problem, np.random.default_rng(seed))
    rows["random walk"] = offline(lambda: walk, problem, song)
    print(f"{'':24}" + "".join(f"{column:>13}" for column in COLUMNS))
    for name, danced in rows.items():
        figures = row_of(problem, song, best.path.score, danced)
        print(f"{name:24}" + "".join(f"{value:13.2f}" for value in figures))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", help="a library or a folder of motion; the embedded troupe by default")
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--tempos", type=float, nargs="+", default=[100.0, 122.0])
    parser.add_argument("--ahead", type=float, default=6.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--greedy", action="store_true", help="the slow greedy search too")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    library = build_or_open(Path(options.moves)) if options.moves else embedded_library()
    print(f"{library.seconds:.0f} s of motion, {len(library.graph)} frames, {library.graph.join_count} joins")
    for tempo in options.tempos:
        for kind in ("steady", "drifting"):
            print(f"\n{options.seconds:.0f} s, {kind}, {tempo:.0f} beats/min")
            song = made_song(kind, options.seconds, tempo)
            improvisers = {
                "improviser": Improviser(library, options.seed),
                "improviser, may loop": Improviser(library, options.seed, price=0.0),
            }
            measure(library, improvisers, song, options.ahead, options.seed, options.greedy)


if __name__ == "__main__":
    main()
