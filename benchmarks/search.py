"""How good the searches are on one objective: each method's score beside the best there is, on the same graph.

    python benchmarks/search.py --moves my_clips song1.ogg song2.json

Songs are audio files or ``song.json`` documents; with none, the embedded song. Scores are those of ``optimal``'s
objective, and their shares those of its unconstrained optimum, which may repeat itself; ``repeated`` are seconds of a
clip that are shown again; F50 is of the stops as planned, before they are danced. ``search`` are CPU seconds of the
search alone, after a first search that compiles; the problem (frames, joins, what joins do to stops) is made once.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from onbeat.dance.frames import BLOCK, RATES
from onbeat.dance.greedy import greedy_path
from onbeat.dance.optimal import Path as DancePath
from onbeat.dance.optimal import Problem, ValueToGo, best_path
from onbeat.dance.score import FINE
from onbeat.dance.search import make_problem
from onbeat.dance.shiratori2006 import shiratori2006_path
from onbeat.dance.variety import beam_path
from onbeat.dance.walk import random_walk
from onbeat.metrics.beats import f_measure
from onbeat.moves.cache import build_or_open
from onbeat.moves.embedded import embedded_library
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.listen import listen
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats

COLUMNS = ("search s", "objective", "of optimum", "repeated s", "joins", "F50 planned")


def methods(problem: Problem, library: MoveLibrary, song: Song, seed: int) -> dict[str, Callable[[], DancePath]]:
    """The searches by name."""
    return {
        "optimal, may repeat": lambda: best_path(ValueToGo(problem)),
        "optimal (beam, no repeats)": lambda: beam_path(problem, ValueToGo(problem)),
        "greedy 3 s, same objective": lambda: greedy_path(problem),
        "shiratori2006": lambda: shiratori2006_path(problem, library, song),
        "shiratori2006, rhythm only": lambda: shiratori2006_path(problem, library, song, rhythm_only=True),
        "random walk": lambda: random_walk(problem, np.random.default_rng(seed)),
    }


def shown(problem: Problem, path: DancePath) -> list[np.ndarray]:
    """Virtual frames that each move shows."""
    ends = [*path.times[1:].tolist(), problem.music.frames]
    return [f + np.arange(e - t) for t, f, e in zip(path.times.tolist(), path.entries.tolist(), ends, strict=True)]


def repeated(problem: Problem, path: DancePath) -> float:
    """Seconds of stretches of source that are shown again."""
    blocks = np.concatenate([np.unique(problem.frames.block[run]) for run in shown(problem, path)])
    return BLOCK * (len(blocks) - len(np.unique(blocks)))


def planned_stops(problem: Problem, path: DancePath) -> np.ndarray:
    """Seconds of the stops that the search counts on: those of the clips, and those that joins make and unmake."""
    laid, stops = problem.frames, set[int]()
    for t, run in zip(path.times.tolist(), shown(problem, path), strict=True):
        at = np.flatnonzero(laid.stop_worth[run] > 0)
        stops |= set(((t + at) * FINE + laid.stop_shift[run[at]]).tolist())
    indptr, when, sign = problem.changes
    for k in range(1, len(path.times)):
        t, leave = int(path.times[k]), int(path.entries[k - 1] + path.times[k] - path.times[k - 1])
        node, target = int(laid.base[leave]), int(laid.base[path.entries[k]])
        row = np.arange(problem.graph.indptr[node], problem.graph.indptr[node + 1])
        join = row[np.argmin(np.abs(problem.graph.targets[row] - target))]
        for c in range(int(indptr[join]), int(indptr[join + 1])):
            instant = t * FINE + int(when[c])
            if sign[c] > 0:
                stops.add(instant)
            elif stops:
                stops.discard(min(stops, key=lambda other: abs(other - instant)))
    return np.array(sorted(stops)) / (GRID * FINE)


def hear(path: str | None, start: float, seconds: float) -> Song:
    """A song as it is danced to."""
    if path is None:
        from onbeat.examples import embedded_song

        song = embedded_song(seconds=seconds)[0]
    elif path.endswith(".json"):
        song = Song.from_json(Path(path).read_bytes(), path).cut(start, seconds)
    else:
        song = listen(path, start=start, seconds=seconds)
    return danceable_beats(song)


def measure(library: MoveLibrary, song: Song, rates: tuple[float, ...], seed: int) -> dict[str, list[float]]:
    """The rows of one song."""
    problem = make_problem(library, song, rates=rates)
    rows: dict[str, list[float]] = {}
    optimum = ValueToGo(problem).optimum
    for name, search in methods(problem, library, song, seed).items():
        begun = time.process_time()
        path = search()
        seconds = time.process_time() - begun
        planned = f_measure(planned_stops(problem, path), song.beats, 0.05)
        score = path.score
        rows[name] = [seconds, score, score / optimum, repeated(problem, path), len(path.times) - 1.0, planned]
    return rows


def print_rows(rows: dict[str, list[float]]) -> None:
    """One table."""
    print(f"{'':28}" + "".join(f"{column:>13}" for column in COLUMNS))
    for name, row in rows.items():
        print(f"{name:28}" + "".join(f"{value:13.2f}" for value in row))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("songs", nargs="*")
    parser.add_argument("--moves", help="a library or a folder of motion; the embedded troupe by default")
    parser.add_argument("--start", type=float, default=0.0)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=0, help="of the random walk")
    parser.add_argument("--rates", type=float, nargs="+", default=list(RATES))
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    library = build_or_open(Path(options.moves)) if options.moves else embedded_library()
    graph = library.graph
    print(f"{library.seconds:.0f} s of motion, {len(graph)} frames, {graph.join_count} joins, rates {options.rates}")
    measured: list[dict[str, list[float]]] = []
    for name in options.songs or [None]:
        song = hear(name, options.start, options.seconds)
        if not measured:
            measure(library, song.cut(0.0, 10.0), tuple(options.rates), options.seed)  # compiles
        measured.append(measure(library, song, tuple(options.rates), options.seed))
        print(f"\n{name or 'embedded song'}: {song.duration:.0f} s, {len(song.beats)} beats at {song.tempo:.0f}/min")
        print_rows(measured[-1])
    if len(measured) > 1:
        print("\nmedian of all songs")
        print_rows({name: np.median([rows[name] for rows in measured], axis=0).tolist() for name in measured[0]})


if __name__ == "__main__":
    main()
