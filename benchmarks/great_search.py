"""Dancing out of great libraries: seconds, memory, and how far the pruned search is from the best there is.

    python benchmarks/great_search.py make 1 great1h       # a library of 1 h, as arrays in a folder
    python benchmarks/great_search.py copies 10 great1h great10h
    python benchmarks/great_search.py search great1h --exact
    python benchmarks/great_search.py search great10h

``make`` lets the embedded troupe improvise with other seeds until there are enough hours (mirror images counted) and
finds the joins, in libraries of more than an hour within groups of clips, by two ways of grouping: nearly all frames
have as many joins then as ``FAN`` allows. ``copies`` writes a library of many copies of one whose joins each lead to a
copy chosen at random: its optimum with repeats is that of the one. ``search`` plans a dance to the embedded song on the
part that is worth it, and with ``--exact`` on all, and prints both scores, the bound, seconds and the peak of memory.
"""

from __future__ import annotations

import argparse
import resource
import time
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from onbeat.dance.search import Found, Settings
from onbeat.examples import embedded_motions, embedded_song
from onbeat.motion.mirror import mirrored
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.moves.graph import GRID, MotionGraph
from onbeat.moves.lazy import Maker
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats

WHOLE, GROUP = 120_000, 54_000  # frames up to which all joins are found at once, and else of a group
FIELDS = ("rotations", "root_positions", "stops", "intensity", "poses")


def improvised(seed: int, source: int) -> list[Clip]:
    """The troupe's clips of one seed at the graph's rate, each followed by its mirror image."""
    clips: list[Clip] = []
    for number, motion in enumerate(embedded_motions(seed)):
        name = f"{seed}/{motion.name}"
        for kind in (motion, mirrored(motion)):
            clip = Clip.of(kind, name, source + number, mirrored=kind is not motion)
            clips.append(slim(clip))
    return clips


def slim(clip: Clip) -> Clip:
    """A clip at the graph's rate: half the memory."""
    return Clip(
        clip.motion.resampled(GRID), clip.name, clip.source, clip.mirrored, clip.stops, clip.intensity, clip.poses
    )


def make(hours: float, folder: Path) -> None:
    """Write a library of so many hours."""
    clips: list[Clip] = []
    frames, seed = 0, 0
    while frames < hours * 3600 * GRID:
        clips += improvised(seed, len(clips) // 2)
        frames, seed = sum(len(clip.poses) for clip in clips), seed + 1
        print(f"{frames} frames of {len(clips)} clips", flush=True)
    write(folder, clips, joined(clips))


def joined(clips: list[Clip]) -> MotionGraph:
    """The graph of all clips, from pairs within groups of clips."""
    starts = np.concatenate(([0], np.cumsum([len(clip.poses) for clip in clips])))
    groups = 1 if starts[-1] <= WHOLE else round(int(starts[-1]) / GROUP)
    kinds = [np.arange(len(clips)) % groups]
    if groups > 1:
        kinds.append(np.random.default_rng(0).permutation(len(clips)) % (2 * groups))
    parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for kind in kinds:
        for group in range(int(kind.max()) + 1):
            members = np.flatnonzero(kind == group)
            part = MoveLibrary.of([clips[m] for m in members]).graph
            place = np.concatenate([np.arange(starts[m], starts[m + 1]) for m in members])
            once = part.sources < part.targets
            parts.append((place[part.sources[once]], place[part.targets[once]], part.costs[once]))
            print(f"{part.join_count} joins in group {group} of {int(kind.max()) + 1}", flush=True)
    first, second, cost = (np.concatenate(column) for column in zip(*parts, strict=True))
    _, once = np.unique(first * starts[-1] + second, return_index=True)
    return MotionGraph.of(np.repeat(np.arange(len(clips)), np.diff(starts)), first[once], second[once], cost[once])


def write(folder: Path, clips: list[Clip], graph: MotionGraph) -> None:
    """Keep clips and graph as arrays."""
    folder.mkdir(parents=True, exist_ok=True)
    columns = {
        "rotations": [clip.motion.rotations for clip in clips],
        "root_positions": [clip.motion.root_positions for clip in clips],
        "stops": [clip.stops for clip in clips],
        "intensity": [clip.intensity for clip in clips],
        "poses": [clip.poses for clip in clips],
    }
    for name, parts in columns.items():
        np.save(folder / f"{name}.npy", np.concatenate(parts))
        np.save(folder / f"{name}_at.npy", np.concatenate(([0], np.cumsum([len(part) for part in parts]))))
    names = np.array([clip.name for clip in clips])
    np.savez(
        folder / "graph.npz",
        names=names,
        sources=[c.source for c in clips],
        mirrored=[c.mirrored for c in clips],
        fps=[c.motion.fps for c in clips],
    )
    for name in ("clip_of", "indptr", "targets", "costs"):
        np.save(folder / f"{name}.npy", getattr(graph, name))


def copies(many: int, one: Path, folder: Path) -> None:
    """Write a library of ``many`` copies of another, joined at random."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in FIELDS:
        np.save(folder / f"{name}.npy", np.concatenate([np.load(one / f"{name}.npy")] * many))
        at = np.load(one / f"{name}_at.npy")
        np.save(folder / f"{name}_at.npy", np.append(_shifted(at[:-1], int(at[-1]), many), at[-1] * many))
    rows, clip_of, indptr = np.load(one / "graph.npz"), np.load(one / "clip_of.npy"), np.load(one / "indptr.npy")
    tiled = {key: np.tile(rows[key], many) for key in ("names", "mirrored", "fps")}
    np.savez(folder / "graph.npz", sources=_shifted(rows["sources"], int(rows["sources"].max()) + 1, many), **tiled)
    np.save(folder / "clip_of.npy", _shifted(clip_of, len(rows["names"]), many))
    np.save(folder / "indptr.npy", np.append(_shifted(indptr[:-1], int(indptr[-1]), many), indptr[-1] * many))
    targets = np.tile(np.load(one / "targets.npy"), many)
    chosen = np.random.default_rng(0).integers(0, many, len(targets))
    np.save(folder / "targets.npy", targets + len(clip_of) * chosen)
    np.save(folder / "costs.npy", np.tile(np.load(one / "costs.npy"), many))


def _shifted(values: np.ndarray, by: int, many: int) -> np.ndarray:
    """Values of the copies one after another, those of each copy ``by`` more than those of the one before."""
    return (values[None] + by * np.arange(many)[:, None]).ravel()


def read(folder: Path) -> MoveLibrary:
    """A library that was written, its arrays mapped."""
    skeleton = embedded_motions(0)[0].skeleton
    rows, arrays = np.load(folder / "graph.npz"), {n: np.load(folder / f"{n}.npy", mmap_mode="r") for n in FIELDS}
    at = {name: np.load(folder / f"{name}_at.npy") for name in FIELDS}
    graph = MotionGraph(
        *(np.load(folder / f"{name}.npy", mmap_mode="r") for name in ("clip_of", "indptr", "targets", "costs"))
    )
    clips: list[Clip] = []
    for k, name in enumerate(rows["names"].tolist()):
        part = {n: arrays[n][at[n][k] : at[n][k + 1]] for n in FIELDS}
        motion = Maker(partial(_motion, skeleton, part, name))
        kind = int(rows["sources"][k]), bool(rows["mirrored"][k])
        length = len(part["rotations"]), GRID
        clips.append(Clip(motion, name, *kind, part["stops"], part["intensity"], part["poses"], np.zeros(0), length))
    return MoveLibrary(tuple(clips), graph)


def _motion(skeleton: Skeleton, part: dict[str, np.ndarray], name: str) -> Motion:
    return Motion(skeleton, np.asarray(part["rotations"], np.float64), part["root_positions"], GRID, name)


def report(what: str, found: Found, wall: float, cpu: float) -> None:
    """Print a search and what it took."""
    took, peak = time.perf_counter() - wall, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{what}: {took:.1f} s, {time.process_time() - cpu:.1f} CPU s, peak {peak:.2f} GB")
    print(f"  objective {found.objective:.2f}, optimum with repeats {found.optimum:.2f}")
    if (part := found.searched) is not None:
        print(f"  searched {part.seconds:.0f} s of {part.whole:.0f} s; no dance is above {part.bound:.2f}")


def planned(what: str, work: Callable[[Settings], Found]) -> Found:
    """Search in one way and print what came of it."""
    wall, cpu = time.perf_counter(), time.process_time()
    found = work(Settings("optimal", rhythm_only=False, variety=True, seed=0, step=None))
    report(what, found, wall, cpu)
    return found


def compare(library: MoveLibrary, song: Song, *, exact: bool) -> None:
    """Search the part, and the whole if ``exact``."""
    graph = library.graph
    print(f"{len(library.clips)} clips, {len(graph)} frames, {graph.join_count} joins; song of {song.duration:.0f} s")
    few = MoveLibrary.of(library.clips[:4])
    few_song = song.cut(0.0, 8.0)
    settings = Settings("optimal", rhythm_only=False, variety=True, seed=0, step=None)
    settings.part(few, few_song)  # compiles
    part = planned("part", lambda how: how.part(library, song))
    if exact:
        whole = planned("whole", lambda how: how.whole(library, song))
        for name in ("optimum", "objective"):
            print(f"  {name} of the part is {1 - getattr(part, name) / getattr(whole, name):.2%} below the whole's")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("make", "copies", "search"))
    parser.add_argument("arguments", nargs="+")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--exact", action="store_true")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    first, *others = options.arguments
    if options.what == "make":
        make(float(first), Path(others[0]))
    elif options.what == "copies":
        copies(int(first), Path(others[0]), Path(others[1]))
    else:
        song = danceable_beats(embedded_song(seconds=options.seconds)[0])
        compare(read(Path(first)), song, exact=options.exact)


if __name__ == "__main__":
    main()
