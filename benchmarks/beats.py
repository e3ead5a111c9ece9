"""How well beats are heard: our methods and every peer that is installed, over a folder of annotated pieces.

Usage: ``python benchmarks/beats.py FOLDER [--peers [--python OTHER]] [--each] [--methods A,B] [--calibration PNG]``.
The folder holds ``NAME.ogg`` (wav, flac, mp3) and ``NAME.beats`` (seconds TAB bar position). A piece's category is that
of a table ``| piece | … | category | …`` in the folder's README.md, else its name up to the first underscore. Peers
(librosa, aubio, BTrack, madmom) run where they can be imported: here, or in the interpreter given with ``--python``.

Scores are mir_eval's with the first 5 s left out: F at ±70 ms; CMLt and AMLt (continuity at the right tempo, and at
half and double, off-beat too). *lag* is the median of estimated − true beats within 70 ms; *tempo* counts pieces whose
median interval is right to 4 %, *octave* those where it is a half, double, third or triple. In brackets: 95 % bootstrap
intervals over pieces. CPU is per second of sound, in one thread or more, after warming up.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mir_eval
import numpy as np

from beat_peers import PEERS
from onbeat.music.listen import METHODS, listen

AUDIO = (".ogg", ".wav", ".flac", ".mp3")
RATIOS = (0.5, 2.0, 1.0 / 3.0, 3.0)
RESAMPLES = 2000
FEW = 20  # beats, under which a share says nothing
BINS = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0 + 1e-9])  # of confidence


@dataclass(frozen=True)
class Piece:
    """A sound file and what is right."""

    path: Path
    category: str
    beats: np.ndarray
    places: np.ndarray

    @property
    def downbeats(self) -> np.ndarray:
        """Seconds."""
        return self.beats[self.places == 1]


@dataclass(frozen=True)
class Heard:
    """What a tracker heard in a piece; downbeats None where it hears none."""

    beats: np.ndarray
    downbeats: np.ndarray | None
    cpu: float
    meter: int = 0
    confidence: np.ndarray = field(default_factory=lambda: np.zeros(0))


def read_beats(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Beats in seconds, and their places in the bar."""
    table = np.loadtxt(path, ndmin=2)
    return table[:, 0], table[:, 1]


def read_categories(folder: Path) -> dict[str, str]:
    """From a Markdown table with columns ``piece`` and ``category``; empty without one."""
    readme = folder / "README.md"
    lines = readme.read_text(encoding="utf-8").splitlines() if readme.exists() else []
    rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines if line.startswith("|")]
    if not rows or not {"piece", "category"} <= set(rows[0]):
        return {}
    name, category = rows[0].index("piece"), rows[0].index("category")
    return {row[name]: row[category] for row in rows[2:] if len(row) == len(rows[0])}


def read_pieces(folder: Path) -> list[Piece]:
    """All annotated pieces of a folder, by name."""
    categories = read_categories(folder)
    found = sorted(path for path in folder.iterdir() if path.suffix in AUDIO and path.with_suffix(".beats").exists())
    return [
        Piece(path, categories.get(path.stem, path.stem.partition("_")[0]), *read_beats(path.with_suffix(".beats")))
        for path in found
    ]


def hear_ourselves(pieces: Sequence[Piece], method: str) -> list[Heard]:
    """By one of our methods."""
    listen(pieces[0].path, method=method, seconds=5.0)  # compiled before it is timed
    heard: list[Heard] = []
    for piece in pieces:
        started = time.process_time()
        song = listen(piece.path, method=method)
        cpu = (time.process_time() - started) / song.duration
        heard.append(Heard(song.beats, song.downbeats, cpu, song.meter, song.confidence))
    return heard


def hear_peer(pieces: Sequence[Piece], peer: str, python: str) -> list[Heard] | None:
    """By a peer in an interpreter of its own; None where it cannot be imported there."""
    worker = Path(__file__).with_name("beat_peers.py")
    run = subprocess.run(
        [python, str(worker), peer, *(str(piece.path) for piece in pieces)], capture_output=True, text=True
    )
    if run.returncode == 3:
        return None
    rows = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
    if len(rows) != len(pieces):
        print(f"{peer}: {(run.stderr.strip().splitlines() or ['ended early'])[-1]}", file=sys.stderr)
        return None
    heard: list[Heard] = []
    for piece, row in zip(pieces, rows, strict=True):
        downbeats = None if row["downbeats"] is None else np.array(row["downbeats"])
        heard.append(Heard(np.array(row["beats"]), downbeats, row["cpu"] / seconds_of(piece)))
    return heard


def seconds_of(piece: Piece) -> float:
    """Length of a piece's sound."""
    from onbeat.music.audio import audio_duration

    return audio_duration(piece.path)


def median_lag(reference: np.ndarray, estimated: np.ndarray) -> float:
    """Median of estimated − nearest reference over matches within 70 ms, in ms; not a number without matches."""
    if not len(reference) or not len(estimated):
        return float("nan")
    difference = estimated - reference[np.abs(reference[None, :] - estimated[:, None]).argmin(axis=1)]
    matched = difference[np.abs(difference) <= 0.07]
    return float(1000.0 * np.median(matched)) if len(matched) else float("nan")


def tempo_ratio(reference: np.ndarray, estimated: np.ndarray) -> float:
    """Median estimated interval over the median true one; not a number where there are fewer than two beats."""
    if len(estimated) < 2 or len(reference) < 2:
        return float("nan")
    return float(np.median(np.diff(estimated)) / np.median(np.diff(reference)))


def near(ratio: float, to: float) -> bool:
    """Within 4 %."""
    return bool(abs(ratio / to - 1.0) < 0.04)


COLUMNS = ("F", "CMLt", "AMLt", "downbeat F", "lag ms", "tempo", "octave", "meter", "CPU s/s")


def scores(piece: Piece, heard: Heard) -> list[float]:
    """One row of the table, by ``COLUMNS``; what a tracker does not say is not a number."""
    trim = mir_eval.beat.trim_beats
    reference, estimated = trim(piece.beats), trim(heard.beats)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a list is empty
        _, correct, _, allowed = mir_eval.beat.continuity(reference, estimated)
        f = mir_eval.beat.f_measure(reference, estimated)
        down = float("nan")
        if heard.downbeats is not None:
            down = mir_eval.beat.f_measure(trim(piece.downbeats), trim(heard.downbeats))
    ratio = tempo_ratio(reference, estimated)
    octave = float(any(near(ratio, other) for other in RATIOS))
    meter = float(heard.meter == piece.places.max()) if heard.meter else float("nan")
    return [
        f,
        correct,
        allowed,
        down,
        median_lag(reference, estimated),
        float(near(ratio, 1.0)),
        octave,
        meter,
        heard.cpu,
    ]


def interval(values: np.ndarray) -> str:
    """Mean and the 95 % bootstrap interval over pieces."""
    known = values[np.isfinite(values)]
    if not len(known):
        return f"{'–':^17}"
    rng = np.random.default_rng(0)
    means = known[rng.integers(0, len(known), (RESAMPLES, len(known)))].mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return f"{known.mean():.3f} [{low:.2f}–{high:.2f}]"


def summary(rows: np.ndarray) -> str:
    """A line of the table: means with their intervals, the median lag, counts, CPU."""
    lags = rows[np.isfinite(rows[:, 4]), 4]
    counts = [
        f"{int(np.nansum(rows[:, c])):>3d}/{len(rows)}" if np.isfinite(rows[:, c]).any() else "     –"
        for c in (5, 6, 7)
    ]
    lag = f"{np.median(lags):>6.1f}" if len(lags) else "     –"
    return "  ".join([*(interval(rows[:, c]) for c in range(4)), lag, *counts, f"{rows[:, 8].mean():.4f}"])


def print_tables(pieces: Sequence[Piece], tables: dict[str, np.ndarray]) -> None:
    """All pieces, a line a tracker; then, for each category, the same means without intervals."""
    print(f"{len(pieces)} pieces")
    print(f"{'':<16}" + "".join(f"{name:^19}" for name in COLUMNS[:4]) + "lag ms   tempo  octave   meter  CPU s/s")
    for name, rows in tables.items():
        print(f"{name:<16}{summary(rows)}")
    print(f"\n{'F / CMLt / AMLt / downbeat F':<30}" + "".join(f"{name:^25}" for name in tables))
    categories = np.array([piece.category for piece in pieces])
    for category in sorted(set(categories.tolist())):
        chosen = categories == category
        cells = [" ".join(_short(rows[chosen, c]) for c in range(4)) for rows in tables.values()]
        print(f"{category[:24]:<24}{chosen.sum():>4}  " + "".join(f"{cell:^25}" for cell in cells))


def _short(values: np.ndarray) -> str:
    known = values[np.isfinite(values)]
    return f"{known.mean():.2f}" if len(known) else "  – "


def print_each(pieces: Sequence[Piece], name: str, rows: np.ndarray) -> None:
    """A line a piece."""
    for piece, row in zip(pieces, rows, strict=True):
        print(f"{name:<14}{piece.path.stem[:28]:<30}", "  ".join(f"{value:>6.2f}" for value in row[:7]))


def hits(piece: Piece, heard: Heard) -> np.ndarray:
    """Whether a true beat lies within 70 ms of each beat heard; each true beat counts once."""
    hit = np.zeros(len(heard.beats), np.bool_)
    matched = mir_eval.util.match_events(piece.beats, heard.beats, 0.07)
    hit[[estimated for _, estimated in matched]] = True
    return hit


def calibration(pieces: Sequence[Piece], heard: Sequence[Heard]) -> np.ndarray:
    """For each bin of confidence: how many beats, their mean confidence, and the share that is right; (bins, 3)."""
    known = [(piece, one) for piece, one in zip(pieces, heard, strict=True) if len(one.confidence)]
    if not known:
        return np.zeros((0, 3))
    sure = np.concatenate([one.confidence for _, one in known])
    right = np.concatenate([hits(piece, one) for piece, one in known]).astype(float)
    index = np.clip(np.searchsorted(BINS, sure, side="right") - 1, 0, len(BINS) - 2)
    rows = [(int((index == b).sum()), sure[index == b].mean(), right[index == b].mean()) for b in np.unique(index)]
    return np.array(rows, dtype=float)


def draw_calibration(path: Path, curves: dict[str, np.ndarray]) -> None:
    """Confidence against hit rate, a curve a method, and below how many beats each bin has."""
    from matplotlib.figure import Figure

    figure: Any = Figure(figsize=(6.4, 7.2), dpi=110, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": [3, 1]})
    above.plot([0, 1], [0, 1], color="#8593a6", linewidth=1, linestyle=":", label="as sure as right")
    for name, rows in curves.items():
        many = rows[rows[:, 0] >= FEW]
        above.plot(many[:, 1], many[:, 2], marker="o", label=name)
        below.bar(rows[:, 1], rows[:, 0], 0.05, alpha=0.6)
    above.set_ylabel("share of beats that are right (±70 ms)")
    above.set_ylim(0, 1.02)
    above.legend(frameon=False, loc="lower right")
    below.set_ylabel("beats")
    below.set_xlabel("confidence")
    below.set_xlim(0, 1)
    for axes in (above, below):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--methods", default=",".join(METHODS), help="ours, parted by commas")
    parser.add_argument("--peers", action="store_true", help="peers, too, as far as they are installed")
    parser.add_argument("--python", default=sys.executable, help="the interpreter in which the peers are installed")
    parser.add_argument("--each", action="store_true", help="a line a piece, too")
    parser.add_argument("--calibration", type=Path, help="draw confidence against hit rate to this PNG file")
    arguments = parser.parse_args()
    pieces = read_pieces(arguments.folder)
    if not pieces:
        parser.error(f"no NAME.ogg with a NAME.beats beside it in {arguments.folder}")
    heard = {method: hear_ourselves(pieces, method) for method in filter(None, arguments.methods.split(","))}
    for peer in PEERS if arguments.peers else ():
        found = hear_peer(pieces, peer, arguments.python)
        if found is None:
            print(f"{peer}: not installed", file=sys.stderr)
        else:
            heard[peer] = found
    tables = {
        name: np.array([scores(*pair) for pair in zip(pieces, all_heard, strict=True)])
        for name, all_heard in heard.items()
    }
    if arguments.each:
        for name, rows in tables.items():
            print_each(pieces, name, rows)
    print_tables(pieces, tables)
    if arguments.calibration:
        curves = {name: calibration(pieces, all_heard) for name, all_heard in heard.items()}
        curves = {name: rows for name, rows in curves.items() if len(rows)}
        for name, rows in curves.items():
            print(f"\n{name}: confidence → share right (beats)")
            print("\n".join(f"  {sure:.2f} → {right:.2f}  ({int(count)})" for count, sure, right in rows))
        if curves:
            draw_calibration(arguments.calibration, curves)
        else:
            print("no method says how sure it is: nothing to draw", file=sys.stderr)


if __name__ == "__main__":
    main()
