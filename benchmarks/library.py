"""How fast a library is built, opened and built anew: ``python benchmarks/library.py FOLDER``.

Each figure is taken in a process of its own, on a copy of the folder's motion files in a fresh temporary folder; the
time of starting Python and importing is told apart. Beside each figure stands its share of what is allowed.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

BUILD_S, OPEN_S, MEMORY_MB = 30.0, 1.0, 1000.0

MEASURED = """
import time; begun = time.perf_counter()
import json, resource, sys, warnings
from pathlib import Path
from onbeat.moves.build import build_library
from onbeat.moves.cache import build_or_open
from onbeat.moves.store import open_library
warnings.simplefilter("ignore")
verb, source, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
imported = time.perf_counter()
if verb == "build": library = build_library([source], folder)
elif verb == "open": library = open_library(folder)
else: library = build_or_open(source, folder)
done = time.perf_counter()
print(json.dumps({
    "import_s": imported - begun, "s": done - imported,
    "mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3,
    "clips": len(library.clips), "seconds": library.seconds, "frames": len(library.graph),
    "joins": library.graph.join_count, "core": float(library.graph.core.mean()), "problems": len(library.problems),
}))
"""


def measure(verb: str, source: Path, folder: Path) -> dict[str, float]:
    """Run one step in a process of its own."""
    run = subprocess.run(
        [sys.executable, "-c", MEASURED, verb, str(source), str(folder)], check=True, stdout=subprocess.PIPE
    )
    return json.loads(run.stdout)


def main(folder: Path) -> None:
    table = Table("", "s", "of the limit", "import s", "peak MB", "of the limit", box=None, pad_edge=False)
    with tempfile.TemporaryDirectory() as temporary:
        source, library, cache = (Path(temporary) / name for name in ("source", "library", "cache"))
        shutil.copytree(folder, source)
        for file in source.rglob("*"):
            os.chmod(file, 0o755 if file.is_dir() else 0o644)
        steps = [("built cold", "build", library, BUILD_S), ("built again, nothing changed", "build", library, OPEN_S)]
        steps += [("opened", "open", library, OPEN_S)]
        steps += [("built into the cache", "cached", cache, BUILD_S), ("found in the cache", "cached", cache, OPEN_S)]
        found: dict[str, float] = {}
        for name, verb, place, limit in steps:
            found = measure(verb, source, place)
            add(table, name, found, limit)
        longest = max((f for f in source.rglob("*") if f.suffix.lower() in (".amc", ".bvh", ".npz")), key=_size)
        longest.unlink()
        add(table, f"built again without {longest.name}", measure("build", source, library), BUILD_S)
        size = sum(_size(f) for f in library.rglob("*") if f.is_file()) / 1e6
    Console().print(table)
    print(
        f"{found['clips']:.0f} clips with mirror images, {found['seconds']:.0f} s of recordings, {found['frames']:.0f} "
        f"graph frames, {found['joins']:.0f} joins, {found['core']:.0%} in the core, {found['problems']:.0f} problems, "
        f"{size:.0f} MB on disk"
    )


def add(table: Table, name: str, found: dict[str, float], limit: float) -> None:
    seconds, memory = found["s"], found["mb"]
    table.add_row(
        name,
        f"{seconds:.2f}",
        f"{seconds / limit:.0%}",
        f"{found['import_s']:.2f}",
        f"{memory:.0f}",
        f"{memory / MEMORY_MB:.0%}",
    )


def _size(file: Path) -> int:
    return file.stat().st_size


if __name__ == "__main__":
    main(Path(sys.argv[1]))
