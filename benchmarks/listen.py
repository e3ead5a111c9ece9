"""How well the methods hear beats: a table over a folder of ``NAME.ogg`` + ``NAME.beats`` (seconds TAB bar position).

Usage: ``python benchmarks/listen.py FOLDER [--each] [--methods barpointer,shiratori2006]``. Scores are mir_eval's, with
the first 5 s left out; F at ±70 ms.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import mir_eval
import numpy as np

from onbeat.music.listen import METHODS, listen

AUDIO = (".ogg", ".wav", ".flac", ".mp3")
COLUMNS = ("F", "CMLt", "AMLt", "downbeat F", "lag ms", "right tempo", "right meter", "CPU s / s")


def read_beats(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Beats and downbeats in seconds."""
    table = np.loadtxt(path, ndmin=2)
    return table[:, 0], table[table[:, 1] == 1, 0]


def median_lag(reference: np.ndarray, estimated: np.ndarray) -> float:
    """Median of estimated − nearest reference over matches within 70 ms, in ms; not a number without matches."""
    if not len(reference) or not len(estimated):
        return float("nan")
    nearest = reference[np.abs(reference[None, :] - estimated[:, None]).argmin(axis=1)]
    difference = estimated - nearest
    matched = difference[np.abs(difference) <= 0.07]
    return float(1000.0 * np.median(matched)) if len(matched) else float("nan")


def right_tempo(reference: np.ndarray, estimated: np.ndarray) -> bool:
    """Whether the median beat intervals agree within 4 %."""
    if len(estimated) < 2:
        return False
    return bool(abs(np.median(np.diff(estimated)) / np.median(np.diff(reference)) - 1.0) < 0.04)


def scores(audio: Path, method: str) -> list[float]:
    """One row of the table."""
    beats, downbeats = read_beats(audio.with_suffix(".beats"))
    started = time.process_time()
    song = listen(audio, method=method)
    cpu = (time.process_time() - started) / song.duration
    trim = mir_eval.beat.trim_beats
    reference, estimated = trim(beats), trim(song.beats)
    _, correct, _, allowed = mir_eval.beat.continuity(reference, estimated)
    places = np.loadtxt(audio.with_suffix(".beats"), ndmin=2)[:, 1]
    return [
        mir_eval.beat.f_measure(reference, estimated),
        correct,
        allowed,
        mir_eval.beat.f_measure(trim(downbeats), trim(song.downbeats)),
        median_lag(reference, estimated),
        float(right_tempo(reference, estimated)),
        float(song.meter == places.max()),
        cpu,
    ]


def summary(rows: np.ndarray) -> str:
    """Means; the median lag; the number of right tempi and meters."""
    return "  ".join(
        [f"{rows[:, column].mean():>6.3f}" for column in range(4)]
        + [f"{np.nanmedian(rows[:, 4]):>6.1f}"]
        + [f"{int(rows[:, column].sum()):>3d}/{len(rows)}" for column in (5, 6)]
        + [f"{rows[:, 7].mean():.4f}"]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--each", action="store_true", help="a line per piece too")
    arguments = parser.parse_args()
    pieces = sorted(
        path for path in arguments.folder.iterdir() if path.suffix in AUDIO and path.with_suffix(".beats").exists()
    )
    if not pieces:
        parser.error(f"no NAME.ogg with a NAME.beats beside it in {arguments.folder}")
    print("method          ", "  ".join(COLUMNS))
    for method in arguments.methods.split(","):
        listen(pieces[0], method=method, seconds=5.0)  # compiled before it is timed
        rows = [scores(piece, method) for piece in pieces]
        if arguments.each:
            for piece, row in zip(pieces, rows, strict=True):
                print(f"{piece.stem[:28]:<30}", "  ".join(f"{value:>6.3f}" for value in row[:6]))
        print(f"{method:<16}", summary(np.array(rows)))


if __name__ == "__main__":
    main()
