"""A build of a library as a process of its own, watched through the tasks it takes in hand and finishes.

Each is told in a line of a log that outlives the builder, whatever ends it. Run as a program it is that builder:
``python benchmarks/watched_build.py LOG moves build FOLDER -o LIBRARY``.
"""

from __future__ import annotations

import hashlib
import os
import sqlite3
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from onbeat.moves.store import open_library

WAIT = 3600.0
"""Seconds after which a builder is taken to hang."""


def watched(log: Path, words: list[str]) -> None:
    """Run ``onbeat`` in this process, and write each task taken in hand and each one done into a log."""
    import onbeat.moves.build  # noqa: F401
    from onbeat.cli import main
    from onbeat.moves import engine

    handle = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    given = engine.run

    def run(tasks: Iterable[Any], work: Any, done: Callable[[Any, Any], None], *rest: Any, **named: Any) -> None:
        def taken() -> Iterator[Any]:
            for task in tasks:
                os.write(handle, "".join(f"out {unit}\n" for unit in units(task)).encode())
                yield task

        def finished(task: Any, result: Any) -> None:
            done(task, result)
            os.write(handle, "".join(f"done {unit}\n" for unit in units(task)).encode())

        given(taken(), work, finished, *rest, **named)

    for module in list(sys.modules.values()):
        if getattr(module, "__name__", "").startswith("onbeat.moves") and getattr(module, "run", None) is given:
            module.run = run  # type: ignore[attr-defined]
    sys.argv = ["onbeat", *words]
    main()


def units(task: Any) -> list[str]:
    """What a task is made of: files read, recordings placed, blocks searched."""
    if hasattr(task, "keys"):
        return [f"block {key.hex()}" for key in task.keys]
    if hasattr(task, "recording"):
        return [f"place {task.recording.digest}"]
    if isinstance(task, tuple) and task and hasattr(task[0], "digest"):
        return [f"read {recording.file}" for recording in task]
    return [f"{type(task).__name__} {hashlib.sha256(repr(task).encode()).hexdigest()[:16]}"]


@dataclass
class Builder:
    """A build as a process of its own.

    Parameters
    ----------
    library : its folder.
    sources : what it is built of.
    log : where its tasks are told.
    more : other words of the command line.
    """

    library: Path
    sources: list[Path]
    log: Path
    more: tuple[str, ...] = ()

    def start(self, **options: Any) -> subprocess.Popen[str]:
        """Begin."""
        words = ["moves", "build", *map(str, self.sources), "-o", str(self.library), *self.more, "--json"]
        command = [sys.executable, str(Path(__file__).resolve()), str(self.log), *words]
        return subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True, **options
        )

    def build(self, **options: Any) -> tuple[int, list[str], float]:
        """Build to the end: exit status, lines on stderr, seconds."""
        begun = time.perf_counter()
        process = self.start(**options)
        _, told = process.communicate(timeout=WAIT)
        return process.returncode, told.splitlines(), time.perf_counter() - begun

    def counts(self) -> tuple[Counter[str], Counter[str]]:
        """How often each unit was taken in hand, and done."""
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        out, done = (Counter(x.split(" ", 1)[1] for x in lines if x.startswith(word)) for word in ("out ", "done "))
        return out, done

    def lines(self) -> int:
        """How many units were done."""
        return self.log.read_bytes().count(b"done ") if self.log.exists() else 0


def command(*words: object) -> tuple[int, list[str]]:
    """Run ``onbeat`` to its end: exit status and lines on stderr."""
    code = "from onbeat.cli import main; main()"
    run = subprocess.run(
        [sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True, timeout=WAIT, check=False
    )
    return run.returncode, [*run.stdout.splitlines(), *run.stderr.splitlines()]


def content(folder: Path) -> str:
    """A digest of all that a reader of a library can see."""
    library, total = open_library(folder), hashlib.sha256()
    for clip in library.clips:
        total.update(f"{clip.name} {clip.source} {clip.mirrored} {clip.motion.fps}\n".encode())
        for array in (clip.motion.rotations, clip.motion.root_positions, clip.stops, clip.keyposes, clip.intensity):
            total.update(np.ascontiguousarray(array).data)
        total.update(np.ascontiguousarray(clip.poses).data)
    for array in (library.graph.indptr, library.graph.targets, library.graph.costs):
        total.update(np.ascontiguousarray(array).data)
    total.update("\n".join(library.problems).encode())
    return total.hexdigest()[:16]


def stock(folder: Path) -> dict[tuple[Any, ...], tuple[Any, ...]]:
    """What an index says is there: each clip and block, and where it lies."""
    path = folder / "index.sqlite"
    if not path.exists():
        return {}
    index = sqlite3.connect(path, timeout=60)
    try:
        clips = index.execute("SELECT content, stage, mirrored, id, shard, offset, size, sha256 FROM clips").fetchall()
        blocks = index.execute("SELECT key, shard, offset, count, crc FROM blocks").fetchall()
    except sqlite3.OperationalError:  # killed before there were tables
        return {}
    finally:
        index.close()
    return {row[:3]: row[3:] for row in clips} | {row[:1]: row[1:] for row in blocks}


def told(name: str, good: bool, found: object) -> None:
    """A line of the report."""
    print(f"  {'good' if good else 'BAD '}  {name}: {found}", flush=True)


def graph(folder: Path) -> str:
    """The name of the graph, which follows from its bytes."""
    return ", ".join(sorted(path.name for path in folder.glob("graph-*")))


@contextmanager
def small_disk(place: Path, size: int) -> Iterator[Path]:
    """A disk of so many bytes (Linux, as root)."""
    place.mkdir(parents=True, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place], check=True, capture_output=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", place], check=False)


def resize(place: Path, options: str) -> None:
    """Mount a disk anew."""
    subprocess.run(["mount", "-o", f"remount,{options}", place], check=True)


def one_clear_line(status: int, lines: list[str]) -> bool:
    """Whether a build that failed said so as it is to."""
    return status == 1 and len(lines) == 1 and "Traceback" not in lines[0]


if __name__ == "__main__":
    watched(Path(sys.argv[1]), sys.argv[2:])
