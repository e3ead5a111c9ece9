"""Libraries of hundreds of hours: what a build, its transitions and a dance cost, each beside what is wanted.

    python benchmarks/scale.py --only transitions,recall,growth    # pose vectors of the synthetic archive
    python benchmarks/scale.py --only build,dance --hours 1        # its files, built with ``onbeat moves build``
    python benchmarks/scale.py --only faults                       # benchmarks/scale_faults.py

Two cores are wanted; the machine's load is told beside the figures. Where it is busy the seconds of the processor say
what the clock would on an idle machine: tasks are independent, so the clock takes half of them. Of archives too great
for the time there is, ``--share`` of the blocks, drawn at random, are searched and the sum is estimated.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from archive import FPS, Archive, Poses
from onbeat.moves.library import REACH
from onbeat.moves.pairs.blocks import Group, Span, group_spans
from onbeat.moves.similarity import Search, block_pairs, search_for
from process_tree import Peak, run_measured

CORES = 2
WINDOW_PAIR = 0.019
"""Seconds that fairmotion needs for a pair of windows, by its own published figures (1,198 s for a clip of 23 s)."""


def line(name: str, found: str, wanted: str = "") -> None:
    """A row of the report."""
    print(f"  {name:<58}{found:>26}   {wanted}", flush=True)


def load() -> str:
    """How busy the machine is."""
    return f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"


# ---- transitions


@dataclass
class Cost:
    """What searching some blocks took.

    Parameters
    ----------
    blocks, of : how many were searched, of how many.
    cpu : seconds of the processor in the search.
    gemm : seconds of the processor for the same products alone, measured in between.
    flops : of these products.
    pairs : found.
    cells : pairs of frames that were searched.
    """

    blocks: int = 0
    of: int = 0
    cpu: float = 0.0
    gemm: float = 0.0
    flops: float = 0.0
    pairs: int = 0
    cells: float = 0.0
    clock: float = 0.0

    @property
    def whole(self) -> float:
        """Seconds of the processor for all blocks."""
        return self.cpu * self.of / max(self.blocks, 1)


def groups_of(poses: Poses) -> list[Span]:
    """The groups of an archive."""
    return group_spans(np.diff(poses.starts).tolist())


def group(poses: Poses, span: Span) -> Group:
    """One of them, read now."""
    return Group(np.array(poses.rows[span.start : span.stop]), poses.clip_of[span.start : span.stop])


def blocks_of(count: int, share: float, seed: int) -> list[tuple[int, int]]:
    """Blocks a ≤ b, all or some; of those on the diagonal the same share."""
    rng = np.random.default_rng(seed)
    every = [(a, b) for a in range(count) for b in range(a, count)]
    if share >= 1:
        return every
    keep = rng.random(len(every)) < share
    keep[int(rng.integers(len(every)))] = True
    return [block for block, kept in zip(every, keep, strict=True) if kept]


def search_all(poses: Poses, search: Search, share: float, seed: int = 0, threads: int = CORES) -> Cost:
    """Search blocks in threads, each block timed for itself."""
    spans = groups_of(poses)
    blocks = blocks_of(len(spans), share, seed)
    cost = Cost(len(blocks), len(spans) * (len(spans) + 1) // 2)
    one = group(poses, spans[0])
    block_pairs(one, one, REACH, search)  # compiled before the clock runs

    def work(block: tuple[int, int]) -> tuple[float, float, float, int, float]:
        a = group(poses, spans[block[0]])
        b = a if block[0] == block[1] else group(poses, spans[block[1]])
        begun = time.thread_time()
        pairs = block_pairs(a, b, REACH, search)
        cpu = time.thread_time() - begun
        share = 0.5 if a is b else 1.0
        gemm, flops = product_seconds(a.poses, b.poses)
        return cpu, share * gemm, share * flops, len(pairs.first), share * len(a) * len(b)

    begun = time.perf_counter()
    with threadpool_limits(1, "blas"), ThreadPoolExecutor(threads) as pool:
        for cpu, gemm, flops, pairs, cells in pool.map(work, blocks):
            cost.cpu += cpu
            cost.gemm += gemm
            cost.flops += flops
            cost.pairs += pairs
            cost.cells += cells
    cost.clock = time.perf_counter() - begun
    return cost


def product_seconds(a: np.ndarray, b: np.ndarray, tile: int = 512) -> tuple[float, float]:
    """Seconds of the processor for the product of two groups alone, in the tiles that it is best in; operations."""
    room = np.empty((tile, tile), np.float32)
    begun = time.thread_time()
    for i in range(0, len(a), tile):
        rows = a[i : i + tile]
        for j in range(0, len(b), tile):
            columns = b[j : j + tile]
            np.dot(rows, columns.T, out=room.ravel()[: len(rows) * len(columns)].reshape(len(rows), len(columns)))
    return time.thread_time() - begun, 2.0 * len(a) * len(b) * a.shape[1]


def transitions(chosen: argparse.Namespace) -> None:
    """The pairs of 1 h: exactly, and from coarse to fine."""
    poses = Poses.of(chosen.hours, chosen.seed, chosen.cache)
    frames = len(poses.clip_of)
    wanted = {"exact": 40.0, "coarse": 6.0}
    for method in chosen.search or ["exact", "coarse"]:
        search = search_for(frames, method)
        cost = search_all(poses, search, chosen.share)
        scale = (frames / 108_000) ** 2
        target = f"<= {wanted[method] * scale:.0f} s" if method in wanted else ""
        line(f"{method}: {frames} frames, {cost.blocks} of {cost.of} blocks", f"{cost.whole:.1f} s processor", load())
        line("  on two idle cores", f"{cost.whole / CORES:.1f} s", target)
        line("  pairs found", f"{cost.pairs * cost.of / cost.blocks:.3g}", f"{cost.pairs / cost.cells * 1e6:.0f} ppm")
        if method == "exact":
            line("  share of the product alone", f"{cost.gemm / cost.cpu:.0%}", ">= 60 %")
            line("  rate of the product, a core", f"{cost.flops / cost.gemm / 1e9:.0f} GFLOP/s", "measured in this run")
        rate = cost.cells / cost.cpu * CORES
        line("  pairs of frames a second, two cores", f"{rate:.3g}", f"fairmotion: {1 / WINDOW_PAIR:.0f} a second")
        line("  times fairmotion's rate", f"{rate * WINDOW_PAIR:.2g}")


def recall(chosen: argparse.Namespace) -> None:
    """How many of the exact pairs the other searches find, block by block."""
    for hours, method, wanted in [(chosen.hours, "coarse", 0.999), (chosen.great, "approximate", 0.99)]:
        if chosen.search and method not in chosen.search:
            continue
        poses = Poses.of(hours, chosen.seed, chosen.cache)
        spans = groups_of(poses)
        blocks = blocks_of(len(spans), min(1.0, chosen.audit / (len(spans) * (len(spans) + 1) / 2)), chosen.seed + 1)
        found, true, hits, one_by_one = 0, 0, 0, []
        search = search_for(len(poses.clip_of), method)
        exact = replace(search, method="exact")
        for a, b in blocks:
            one = group(poses, spans[a])
            two = one if a == b else group(poses, spans[b])
            right, some = (keys(block_pairs(one, two, REACH, how)) for how in (exact, search))
            hit = len(np.intersect1d(right, some, assume_unique=True))
            found, true, hits = found + len(some), true + len(right), hits + hit
            one_by_one.append(hit / max(len(right), 1))
        line(f"{method}: recall at {hours:g} h, {len(blocks)} blocks", f"{hits / max(true, 1):.5f}", f">= {wanted}")
        line("  worst block; precision", f"{min(one_by_one):.4f}; {hits / max(found, 1):.5f}")


def keys(pairs: Any) -> np.ndarray:
    """Pairs as single numbers."""
    return np.asarray(pairs.first, np.int64) * 1_000_000 + pairs.second


def growth(chosen: argparse.Namespace) -> None:
    """How the time grows with the archive, and what 45 h would take, by a model of three sizes."""
    n = np.array([float(size) for size in chosen.sizes.split(",")])
    chosen_costs, costs = [], []
    for hours in n:
        poses = Poses.of(float(hours), chosen.seed, chosen.cache)
        search, great = (search_for(len(poses.clip_of), method) for method in (None, "approximate"))
        costs.append(sampled(poses, great, chosen.most))
        chosen_costs.append(costs[-1] if search == great else sampled(poses, search, chosen.most))
    for first, last in [*pairwise(range(len(n))), (0, len(n) - 1)]:
        exponent = np.log(chosen_costs[last] / chosen_costs[first]) / np.log(n[last] / n[first])
        line(f"exponent from {n[first]:g} to {n[last]:g} h", f"{exponent:.2f}", "<= 1.3" if last - first > 1 else "")
    linear, square = model(n[:-1], costs[:-1])
    foretold = linear * n[-1] + square * n[-1] ** 2
    line(f"approximate: model of the first sizes at {n[-1]:g} h", f"{foretold:.1f} s", f"measured {costs[-1]:.1f} s")
    linear, square = model(n, costs)
    line("  model of all sizes at 45 h", f"{(linear * 45 + square * 45**2) / 60:.1f} minutes", "<= 60 minutes")


def sampled(poses: Poses, search: Search, most: float) -> float:
    """Seconds on two idle cores for all blocks, by some of them."""
    cost = search_all(poses, search, min(1.0, most / (len(groups_of(poses)) ** 2 / 2)))
    frames, seconds = len(poses.clip_of), cost.whole / CORES
    told = f"{cost.blocks} of {cost.of} blocks; {load()}"
    line(f"{frames / FPS / 3600:g} h, {frames} frames, {search.method}: two idle cores", f"{seconds:.1f} s", told)
    return seconds


def model(hours: np.ndarray, seconds: Sequence[float]) -> tuple[float, float]:
    """Seconds as a multiple of the hours and of their square, by least squares of relative errors, none below 0."""
    from scipy.optimize import nnls

    table = np.stack((hours, hours**2), axis=1) / np.asarray(seconds)[:, None]
    linear, square = nnls(table, np.ones(len(hours)))[0]
    return float(linear), float(square)


# ---- whole builds and dances


def onbeat(*words: object, **options: Any) -> tuple[list[str], Peak]:
    """Run ``onbeat``, and measure all its processes."""
    code = "from onbeat.cli import main; main()"
    return run_measured([sys.executable, "-c", code, *map(str, words)], **options)


def archive(chosen: argparse.Namespace, hours: float) -> Path:
    """The files of an archive, written once."""
    folder = chosen.cache / f"files-{hours:g}h-seed{chosen.seed}"
    if not (folder / "done").exists():
        begun = time.process_time()
        files = Archive(chosen.seed).write(folder, hours)
        (folder / "done").touch()
        line(f"archive of {hours:g} h written: {len(files)} files", f"{time.process_time() - begun:.0f} s processor")
    return folder


def library(chosen: argparse.Namespace, hours: float) -> Path:
    """Where the library of an archive is built."""
    return chosen.cache / f"library-{hours:g}h-seed{chosen.seed}"


def build(chosen: argparse.Namespace) -> None:
    """The whole build of 1 h and of 10 h: reading, clips, transitions, graph."""
    import shutil

    for hours, seconds, memory in [(chosen.hours, 300.0, 2.0), *[(chosen.great, np.nan, 6.0)] * chosen.with_great]:
        source, place = archive(chosen, hours), library(chosen, hours)
        shutil.rmtree(place, ignore_errors=True)
        words = ["moves", "build", source, "-o", place, "--no-mirror", *chosen.words]
        lines, peak = onbeat(*words)
        line(
            f"build of {hours:g} h: clock, {load()}",
            f"{peak.seconds:.0f} s",
            f"<= {seconds:g} s" if seconds > 0 else "",
        )
        line("  processor, all processes", f"{peak.cpu:.0f} s", f"on two idle cores {peak.cpu / CORES:.0f} s")
        line("  peak of memory (without mapped files)", f"{peak.memory:.2f} ({peak.own:.2f}) GB", f"<= {memory:g} GB")
        size = sum(path.stat().st_size for path in place.rglob("*") if path.is_file()) / 1e9
        line("  on disk", f"{size:.2f} GB", (lines or [""])[-1][:100])
        _, again = onbeat(*words)
        line("  built again, nothing changed", f"{again.seconds:.1f} s")


def dance(chosen: argparse.Namespace) -> None:
    """Dancing 60 s out of the libraries that ``build`` made."""
    for hours in (chosen.hours, chosen.great):
        place = library(chosen, hours)
        if not (place / "index.sqlite").exists():
            continue
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "dance"
            lines, peak = onbeat("dance", "--seconds", 60, "--moves", place, "-o", out)
            line(f"60 s from {hours:g} h, {load()}", f"{peak.seconds:.1f} s", "<= 30 s from 10 h")
            line(
                "  processor",
                f"{peak.cpu:.1f} s",
                f"exit {peak.status} {(lines or [''])[-1][:100] if peak.status else ''}",
            )
            line("  peak of memory (without mapped files)", f"{peak.memory:.2f} ({peak.own:.2f}) GB", "<= 4 GB")
            if (out / "dance.json").exists():
                tell_search(out / "dance.json")


def tell_search(path: Path) -> None:
    """What a dance says of how it was searched."""
    import json

    search = json.loads(path.read_text()).get("metrics", {}).get("search", {})
    for name, value in search.items():
        line(f"  dance.json: search.{name}", str(value), "<= 0.02 of the optimum" if "gap" in name else "")


def workers(chosen: argparse.Namespace) -> None:
    """The same build by one worker process and by two."""
    import shutil

    source, times = archive(chosen, chosen.few), {}
    for count in (1, 2):
        place = chosen.cache / f"library-workers{count}"
        shutil.rmtree(place, ignore_errors=True)
        words = ("moves", "build", source, "-o", place, "--no-mirror", "--workers", count)
        times[count] = onbeat(*words)[1]
        peak = times[count]
        line(f"{count} worker(s), {chosen.few:g} h", f"{peak.seconds:.1f} s; {peak.cpu:.1f} s processor", load())
    line("two against one", f"{times[1].seconds / times[2].seconds:.2f} x", ">= 1.6 x on an idle machine")
    names = [[path.name for path in (chosen.cache / f"library-workers{n}").glob("graph-*")] for n in (1, 2)]
    line("  same graph", str(names[0] == names[1]), str(names[0]))


def faults(chosen: argparse.Namespace) -> None:
    """What a build lives through."""
    words = ["--seed", str(chosen.seed)]
    subprocess.run([sys.executable, str(Path(__file__).with_name("scale_faults.py")), *words], check=False)


PARTS: dict[str, Callable[[argparse.Namespace], None]] = {
    "transitions": transitions,
    "recall": recall,
    "growth": growth,
    "build": build,
    "dance": dance,
    "workers": workers,
    "faults": faults,
}


def chosen_parts(words: str) -> Iterator[str]:
    """The parts that were asked for, in order."""
    for name in words.split(","):
        if name not in PARTS:
            sys.exit(f"no part {name!r}; there are {', '.join(PARTS)}")
        yield name


def main() -> None:
    """Print the parts that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="transitions,recall,growth,build,dance,workers,faults")
    parser.add_argument("--hours", type=float, default=1.0, help="the smaller archive")
    parser.add_argument("--great", type=float, default=10.0, help="the greater archive")
    parser.add_argument("--with-great", action="store_true", help="build that one, too")
    parser.add_argument("--few", type=float, default=0.3, help="hours for the comparison of workers")
    parser.add_argument("--sizes", default="1,3,10", help="hours for the growth")
    parser.add_argument("--share", type=float, default=1.0, help="share of the blocks for transitions")
    parser.add_argument("--most", type=float, default=400, help="blocks at most for each size of the growth")
    parser.add_argument("--audit", type=float, default=40, help="blocks in which recall is taken")
    parser.add_argument("--search", nargs="*", help="exact, coarse, approximate")
    parser.add_argument("--words", nargs="*", default=[], help="more words for moves build, without their dashes")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "onbeat-scale")
    chosen = parser.parse_args()
    chosen.words = [f"--{word}" for word in chosen.words]
    print(f"{load()}; 1 h is {3600 * FPS:.0f} frames")
    for name in chosen_parts(chosen.only):
        print(f"{name}: {(PARTS[name].__doc__ or '').splitlines()[0]}", flush=True)
        PARTS[name](chosen)


if __name__ == "__main__":
    main()
