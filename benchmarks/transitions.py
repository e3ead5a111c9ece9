"""What finding close pairs of frames costs, beside the rate at which this machine multiplies matrices.

    python benchmarks/transitions.py --hours 1 --cache FOLDER
    python benchmarks/transitions.py --hours 10 --cache FOLDER --only sampled

``whole`` searches all blocks of the archive, exactly and by cells, and prints CPU seconds, the share of them that the
matrix products alone take (measured in the same run, on some of the blocks), and the recall of the exact pairs.
``sampled`` takes blocks at random: the cost of all is that of one times their number, for libraries of several sizes,
whose pairs are capped by their size; recall is audited on the same blocks. ``model`` holds the model against whole runs
of three sizes. ``nearest`` tells what an index of nearest neighbours (extra ``[scale]``) would find. CPU seconds are of
all threads: on two idle cores half of them pass.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from threadpoolctl import threadpool_limits

from onbeat.moves.library import REACH
from onbeat.moves.pairs.blocks import NEAR, Group, Pairs, Span, group_spans
from onbeat.moves.pairs.caps import capped, density_for
from onbeat.moves.pairs.cells import cells_of
from onbeat.moves.pairs.exact import TILE, Product
from onbeat.moves.similarity import EXACT, Search, block_pairs

sys.path.insert(0, str(Path(__file__).parent))
from archive import Poses

FAIRMOTION_MS = 19.0  # a pair of windows, as its authors publish
FRAMES = 108_000  # of an hour
CORES = 2
Block = tuple[Group, Group]


def groups_of(poses: Poses, frames: int) -> list[Group]:
    """The groups of the first so many frames."""
    starts = poses.starts[: np.searchsorted(poses.starts, frames, "right")]
    spans = group_spans(np.diff(np.append(starts, frames) if starts[-1] < frames else starts).tolist())
    return [Group(np.array(poses.rows[s.start : s.stop]), poses.clip_of[s.start : s.stop]) for s in spans]


def all_blocks(groups: list[Group]) -> list[Block]:
    return [(groups[a], groups[b]) for a in range(len(groups)) for b in range(a, len(groups))]


def entries(blocks: list[Block]) -> float:
    """Pairs of frames."""
    return sum(len(a) * len(b) / (2 if a is b else 1) for a, b in blocks)


def timed(blocks: list[Block], search: Search, workers: int = CORES) -> tuple[list[Pairs], float, float]:
    """Pairs, CPU seconds and seconds."""
    cpu, wall = time.process_time(), time.perf_counter()
    with ThreadPoolExecutor(workers) as pool:
        found = list(pool.map(lambda block: block_pairs(*block, REACH, search), blocks))
    return found, time.process_time() - cpu, time.perf_counter() - wall


def gemm_seconds(blocks: list[Block]) -> tuple[float, float]:
    """CPU seconds of the products of the exact path alone, and GFLOP/s."""
    cpu, flop = 0.0, 0.0
    for a, b in blocks:
        product = Product(a, b)
        begun = time.thread_time()
        for i in range(0, len(a), TILE):
            for j in range(i if a is b else 0, len(b), TILE):
                rows, columns = (
                    Span(max(i - 2, 0), min(i + TILE + 2, len(a))),
                    Span(max(j - 2, 0), min(j + TILE + 2, len(b))),
                )
                product.table(rows, columns)
                flop += 2 * (rows.stop - rows.start) * (columns.stop - columns.start) * product.left.shape[1]
        cpu += time.thread_time() - begun
    return cpu, flop / cpu / 1e9


def recall(found: list[Pairs], exact: list[Pairs], blocks: list[Block], density: float) -> tuple[float, int]:
    """Share of the exact pairs, capped in the same way, that were found; and how many there are."""
    hits = total = 0
    for pairs, every, (a, b) in zip(found, exact, blocks, strict=True):
        wanted = capped(every, a, b, density)
        hits += len(np.intersect1d(wanted.first * len(b) + wanted.second, pairs.first * len(b) + pairs.second))
        total += len(wanted.first)
    return hits / max(total, 1), total


def whole(groups: list[Group], console: Console) -> None:
    """Every block, exactly and by cells."""
    blocks = all_blocks(groups)
    frames = sum(len(group) for group in groups)
    density = density_for(frames)
    some = [blocks[k] for k in np.random.default_rng(0).permutation(len(blocks))[:24]]
    product_s, rate = gemm_seconds(some)
    product_s *= entries(blocks) / entries(some)
    exact, cpu, wall = timed(blocks, EXACT)
    table = Table("", "CPU s", f"s on {CORES} idle cores", "s now", "pairs/s", "pairs", "recall", "in GEMM", box=None)
    add(table, "exact, all pairs", cpu, wall, blocks, sum(len(p.first) for p in exact), 1.0, product_s / cpu)
    for method in ("coarse", "approximate"):
        for cap in (math.inf, density):
            found, cpu, wall = timed(blocks, Search(method, cap))
            share, total = recall(found, exact, blocks, cap)
            add(table, f"{method}, {'no cap' if math.isinf(cap) else 'capped'}", cpu, wall, blocks, total, share, None)
    console.print(f"{frames} frames, {len(blocks)} blocks; products at {rate:.0f} GFLOP/s a core")
    console.print(table)
    console.print(f"fairmotion, as published: {FAIRMOTION_MS} ms a pair of windows, {1e3 / FAIRMOTION_MS:.0f} pairs/s")


def add(
    table: Table, name: str, cpu: float, wall: float, blocks: list[Block], pairs: int, share: float, gemm: float | None
) -> None:
    rate = entries(blocks) / (cpu / CORES)
    told = "" if gemm is None else f"{gemm:.0%}"
    row = (f"{cpu:.1f}", f"{cpu / CORES:.1f}", f"{wall:.1f}", f"{rate:.2g}", f"{pairs}", f"{share:.4%}", told)
    table.add_row(name, *row)


def sampled(groups: list[Group], console: Console, size: int, seed: int) -> None:
    """Blocks at random, searched as in libraries of several sizes."""
    rng = np.random.default_rng(seed)
    chosen = [sorted(rng.choice(len(groups), 2, replace=False).tolist()) for _ in range(size)]
    blocks = [(groups[a], groups[b]) for a, b in chosen]
    timed(blocks[:1], Search("approximate"))
    exact, cpu, _ = timed(blocks, EXACT)
    console.print(
        f"{size} blocks at random of {len(groups)} groups; exactly {1e9 * cpu / entries(blocks):.2f} ns a pair"
    )
    table = Table("hours", "pairs a frame", "method", "ns a pair", f"minutes on {CORES} idle cores", "recall", box=None)
    for hours in (1, 3, 10, 45):
        frames = hours * FRAMES
        for method in ("exact", "coarse", "approximate"):
            density = density_for(frames)
            found, cpu, _ = timed(blocks, Search(method, density), 1)
            share, _ = recall(found, exact, blocks, density)
            each = cpu / entries(blocks)
            minutes = each * frames**2 / 2 / CORES / 60
            table.add_row(
                f"{hours}", f"{density * frames:.1f}", method, f"{1e9 * each:.3f}", f"{minutes:.2f}", f"{share:.4%}"
            )
    console.print(table)


def model(poses: Poses, console: Console) -> None:
    """The cost of a library from that of some of its blocks, against whole runs of three sizes."""
    table = Table("frames", "method", "CPU s of all", "by the model", "model / all", box=None)
    for frames in (len(poses.clip_of) // 2, len(poses.clip_of) * 3 // 4, len(poses.clip_of)):
        blocks = all_blocks(groups_of(poses, frames))
        some = [blocks[k] for k in np.random.default_rng(1).permutation(len(blocks))[: max(len(blocks) // 10, 4)]]
        search = Search("approximate", density_for(frames))
        timed(some, search, 1)
        _, part, _ = timed(some, search, 1)
        _, cpu, _ = timed(blocks, search)
        guess = part / entries(some) * entries(blocks)
        table.add_row(f"{frames}", "approximate", f"{cpu:.1f}", f"{guess:.1f}", f"{guess / cpu:.2f}")
    console.print(table)


def nearest(groups: list[Group], console: Console, seed: int) -> None:
    """Whether an index of nearest cells (faiss) would find the pairs that are kept: each two clips' smoothest."""
    import faiss

    faiss.omp_set_num_threads(1)
    cells = [cells_of(group, NEAR) for group in groups]
    starts = np.cumsum([0, *(len(c.start) for c in cells)])
    rows = np.ascontiguousarray(np.concatenate([c.poses for c in cells]))
    density = density_for(sum(len(group) for group in groups))
    wanted: list[tuple[int, int]] = []
    rng = np.random.default_rng(seed)
    for x, y in (sorted(rng.choice(len(groups), 2, replace=False).tolist()) for _ in range(4)):
        pairs = capped(block_pairs(groups[x], groups[y], REACH), groups[x], groups[y], density)
        i = np.searchsorted(cells[x].start, pairs.first, "right") - 1 + starts[x]
        j = np.searchsorted(cells[y].start, pairs.second, "right") - 1 + starts[y]
        wanted += list(zip(i.tolist(), j.tolist(), strict=True))
    index = faiss.IndexIVFFlat(faiss.IndexFlatL2(rows.shape[1]), rows.shape[1], 128)
    index.train(rows)
    index.add(rows)
    index.nprobe = 16
    asked = sorted({i for i, _ in wanted})[::4]
    for count in (256, 1024):
        cpu = time.thread_time()
        _, near = index.search(rows[asked], count)
        cpu = (time.thread_time() - cpu) * len(rows) / len(asked)
        known = dict(zip(asked, map(set, near.tolist()), strict=True))
        hits = [j in known[i] for i, j in wanted if i in known]
        console.print(
            f"faiss IVF128, 16 probed, the {count} nearest of {len(rows)} cells: {cpu:.1f} CPU s without looking into "
            f"them, {np.mean(hits):.1%} of the pairs that are kept are among them"
        )


def main() -> None:
    """Print what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--cache", type=Path, required=True, help="where pose vectors of the archive are kept")
    parser.add_argument("--only", choices=["whole", "sampled", "model", "nearest"], action="append")
    parser.add_argument("--blocks", type=int, default=12, help="blocks that are sampled")
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    parts = chosen.only or ["whole", "sampled", "model"]
    poses, console = Poses.of(chosen.hours, 0, chosen.cache), Console(width=140)
    with threadpool_limits(1, "blas"):
        if "whole" in parts:
            whole(groups_of(poses, len(poses.clip_of)), console)
        if "sampled" in parts:
            sampled(groups_of(poses, len(poses.clip_of)), console, chosen.blocks, chosen.seed)
        if "nearest" in parts:
            nearest(groups_of(poses, len(poses.clip_of)), console, chosen.seed)
        if "model" in parts:
            model(poses, console)


if __name__ == "__main__":
    main()
