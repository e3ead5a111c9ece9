"""What a build of a library lives through: ``python benchmarks/scale_faults.py [--only kills,disk,…]``.

Each part builds with ``onbeat moves build`` as a process of its own and says what came of it beside what is wanted.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import psutil

from archive import Archive
from archive_broken import WAYS, write_broken
from onbeat.errors import OnbeatError
from onbeat.moves.store import open_library
from watched_build import WAIT, Builder, command, content, graph, one_clear_line, resize, small_disk, stock, told

IN_HAND = 2 * 2 * 8
"""Units that two workers have in hand at most: two tasks each, of eight files or blocks."""


def kill_at(builder: Builder, target: int, delay: float) -> tuple[bool, list[int]]:
    """Build until so many units more are done, and kill -9: whether it was still at work, and processes it left."""
    before = builder.lines()
    process = builder.start(env=os.environ | {"OPENBLAS_NUM_THREADS": "1"})
    while process.poll() is None and builder.lines() - before < target:
        time.sleep(0.005)
    time.sleep(delay)
    children = psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []
    running = process.poll() is None
    if running:
        os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert process.stderr is not None
    process.stderr.close()
    _, alive = psutil.wait_procs(children, timeout=20)
    for child in alive:
        child.kill()
    return running, [child.pid for child in alive]


def kills(place: Path, chosen: argparse.Namespace) -> None:
    """``kill -9`` at random moments, from nothing and on top of an older library, and resumed each time."""
    source = place / "source"
    files = Archive(chosen.seed).write(source, chosen.hours)
    more = (*chosen.build,)
    whole = Builder(place / "whole", [source], place / "whole.log", more)
    status, lines, seconds = whole.build()
    total = whole.lines()
    told("undisturbed build", status == 0, f"{seconds:.1f} s, {total} units of {len(files)} files {lines[-3:]}")
    wanted = content(whole.library)
    for name, old in (("from nothing", False), ("on top of an older library", True)):
        builder = Builder(place / name.replace(" ", "-"), [source], place / f"{name}.log", more)
        before = ""
        if old:
            half = place / "half"
            if not half.exists():
                for file in files[::2]:
                    (half / file.parent.name).mkdir(parents=True, exist_ok=True)
                    shutil.copy(file, half / file.parent.name)
            Builder(builder.library, [half], place / "half.log", more).build()
            before = content(builder.library)
        one_by_one(name, builder, (before, wanted), chosen, total)
        status, lines, _ = builder.build()
        out, done = builder.counts()
        again = sum((done - Counter(set(done))).values())
        told(f"{name}: finished", status == 0, f"exit {status} {lines[-2:] if status else ''}")
        told(f"{name}: same content as the undisturbed build", content(builder.library) == wanted, wanted)
        told(f"{name}: same bytes of the graph", graph(builder.library) == graph(whole.library), graph(whole.library))
        told(f"{name}: units done more than once", again == 0, f"{again} of {len(done)}")
        lost, most = sum((out - done).values()), chosen.kills * IN_HAND
        told(f"{name}: units in hand at a kill, done again", lost <= most, f"{lost}; at most {IN_HAND} a kill in hand")
        status, lines = command("moves", "verify", builder.library)
        told(f"{name}: moves verify", status == 0, lines[-1:])


def one_by_one(name: str, builder: Builder, contents: tuple[str, str], chosen: argparse.Namespace, total: int) -> None:
    """The kills, and what is to hold after each."""
    rng = np.random.default_rng(chosen.seed)
    moments = np.sort(rng.integers(0, total + 1, chosen.kills))
    old, wanted = contents
    bad, killed, leftover, opened = [], 0, 0, 0
    for moment in moments:
        before = stock(builder.library)
        target = max(int(moment) - builder.lines(), 0)
        hit, left = kill_at(builder, target, float(rng.uniform(0, 0.3) if target else rng.uniform(0, 3.0)))
        killed, leftover = killed + hit, leftover + len(left)
        found = ""
        try:  # before anything repairs the index: a reader comes first
            found = content(builder.library)
            opened += 1
            if found not in (old, wanted):
                bad.append(f"after {moment}: a library of other content")
        except OnbeatError as error:
            if old:
                bad.append(f"after {moment}: the older library is not there: {error}")
        after = stock(builder.library)
        lost = {key for key, row in before.items() if after.get(key) != row}
        if lost and found != wanted:  # else what the new library does not need was swept out
            bad.append(f"after {moment}: {len(lost)} of {len(before)} rows are gone or were made anew")
    told(f"{name}: killed", killed > 0, f"{killed} of {len(moments)} times at work, at units {moments.tolist()}")
    told(f"{name}: after each kill, rows kept and readers served", not bad, bad or f"opened {opened} times")
    told(f"{name}: processes left behind", leftover == 0, leftover)


def disk(place: Path, chosen: argparse.Namespace) -> None:
    """A disk that fills while a library is built, from nothing and on top of an older one; a read-only one."""
    source = place / "source"
    files = Archive(chosen.seed).write(source, chosen.hours / 2)
    whole = Builder(place / "whole", [source], place / "whole.log", chosen.build)
    whole.build()
    wanted = content(whole.library)
    size = sum(path.stat().st_size for path in whole.library.rglob("*") if path.is_file())
    for share in (0.001, 0.02, 0.3, 0.6, 0.9, 0.97, 0.995):
        with small_disk(place / "disk", max(int(size * share), 4096)) as small:
            builder = Builder(small / "library", [source], place / "disk.log", chosen.build)
            status, lines, _ = builder.build()
            told(f"disk of {share:.1%} of what is needed", one_clear_line(status, lines), f"exit {status}: {lines}")
            resize(small, f"size={2 * size}")
            status, lines, _ = builder.build()
            good = (
                status == 0
                and content(builder.library) == wanted
                and command("moves", "verify", builder.library)[0] == 0
            )
            told("  with room, built on", good, "same content, verified" if good else lines)
    with small_disk(place / "disk", 4 * size) as small:
        few = place / "few"
        for file in files[: len(files) // 2]:
            (few / file.parent.name).mkdir(parents=True, exist_ok=True)
            shutil.copy(file, few / file.parent.name)
        Builder(small / "library", [few], place / "disk.log", chosen.build).build()
        old = content(small / "library")
        used = shutil.disk_usage(small).used
        resize(small, f"size={used + 300_000}")
        builder = Builder(small / "library", [source], place / "disk.log", chosen.build)
        status, lines, _ = builder.build()
        told("full on top of an older library", one_clear_line(status, lines), f"exit {status}: {lines}")
        told("  the older one is still there", content(builder.library) == old, old)
        resize(small, "ro")
        status, lines, _ = builder.build()
        told("read-only disk", one_clear_line(status, lines), f"exit {status}: {lines}")
        status, lines, _ = Builder(small / "library", [few], place / "disk.log", chosen.build).build()
        told("read-only disk, nothing to do", status == 0, f"exit {status}: {lines[-1:]}")
        told("read-only disk, opened", content(small / "library") == old, old)


def changes(place: Path, chosen: argparse.Namespace) -> None:
    """A clip that somebody writes to while the library is built: its content is one that it once had, or it is told."""
    source = place / "source"
    files = Archive(chosen.seed).write(source, chosen.hours / 2)
    builder = Builder(place / "library", [source], place / "log", chosen.build)
    process, n = builder.start(), 0
    bytes_ = [file.read_bytes() for file in files[:2]]
    while process.poll() is None:  # half a file, another file, the file: as a copying program leaves it
        files[0].write_bytes([bytes_[0][: len(bytes_[0]) // 2], bytes_[1], bytes_[0]][n % 3])
        n += 1
        time.sleep(0.003)
    lines = process.communicate()[1].splitlines()
    files[0].write_bytes(bytes_[0])
    told(
        f"a clip written to {n} times while it was read",
        process.returncode == 0,
        [x for x in lines if files[0].stem in x],
    )
    status, lines, _ = builder.build()
    whole = Builder(place / "whole", [source], place / "whole.log", chosen.build)
    whole.build()
    told("  built again when it rests", status == 0 and content(builder.library) == content(whole.library), lines[-1:])


def broken(place: Path, chosen: argparse.Namespace) -> None:
    """Thousands of files, a tenth of them broken in many ways."""
    source = place / "source"
    count, bad = chosen.files, chosen.files // 10
    good = Archive(chosen.seed, seconds=2.2).write(source, 50.0, at_most=count - bad)
    wrong = write_broken(source / "z-broken", good, bad)
    builder = Builder(place / "library", [source], place / "log", (*chosen.build, "--no-mirror"))
    status, lines, seconds = builder.build()
    listed = [line for line in lines if "left out" in line]
    told(f"{count} files, {len(wrong)} of them broken", status == 0, f"exit {status} in {seconds:.0f} s")
    told("  listed", all(any(file.name in line for line in listed) for file in wrong), f"{len(listed)} lines")
    stray = [line for line in listed if not any(file.name in line for file in wrong)]
    twins = [line for line in stray if ": moves as " in line]
    told("  good files left out", len(stray) == len(twins), [line for line in stray if line not in twins][:2])
    told("  taken for the same take as another", not twins, f"{len(twins)} {twins[:1]}")
    told(
        "  no traceback, no warning of a library", not any("Traceback" in x or "RuntimeWarning" in x for x in lines), ""
    )
    for way in WAYS:
        missing = f"{way}: {'NOT LISTED' if len(wrong) >= len(WAYS) else 'none made'}"
        print("      ", next((line for line in listed if way in line), missing)[:200])
    begun, busy = time.perf_counter(), time.process_time()
    clips = len(open_library(builder.library).clips)
    seconds, busy = time.perf_counter() - begun, time.process_time() - busy
    told("  opened", busy < 0.5, f"{clips} clips in {seconds:.2f} s, {busy:.2f} s of CPU (0.5 s)")
    status, lines = command("moves", "verify", builder.library)
    told("  moves verify", status == 0, lines[-1:])
    status, _, seconds = builder.build()
    told("  built again, nothing changed", status == 0, f"{seconds:.1f} s")


def two(place: Path, chosen: argparse.Namespace) -> None:
    """Two builders at once, and a reader that opens the library all the time."""
    source, few = place / "source", place / "few"
    files = Archive(chosen.seed).write(source, chosen.hours)
    for file in files[::3]:
        (few / file.parent.name).mkdir(parents=True, exist_ok=True)
        shutil.copy(file, few / file.parent.name)
    builder = Builder(place / "library", [few], place / "log", chosen.build)
    builder.build()
    old, seen, errors, over = content(builder.library), Counter[str](), [], threading.Event()

    def read() -> None:
        while not over.is_set():
            try:
                seen[content(builder.library)] += 1
            except Exception as error:
                errors.append(repr(error))

    reader = threading.Thread(target=read)
    reader.start()
    first = Builder(builder.library, [source], place / "log1", chosen.build).start()
    time.sleep(0.5)
    while first.poll() is None and not (place / "log1").exists():
        time.sleep(0.01)
    status, lines, _ = Builder(builder.library, [source], place / "log2", chosen.build).build()
    alone = first.poll() is not None
    told(
        "the second builder",
        alone or one_clear_line(status, lines),
        f"exit {status}: {lines[-1:]}{' (too late)' * alone}",
    )
    first.communicate()
    over.set()
    reader.join()
    new = content(builder.library)
    told("the first", first.returncode == 0, f"exit {first.returncode}")
    told("a reader saw the old library or the new one", set(seen) <= {old, new} and not errors, f"{seen} {errors[:2]}")


def workers(place: Path, chosen: argparse.Namespace) -> None:
    """Worker processes of which one is killed midway, of this machine and of a cluster."""
    source = place / "source"
    Archive(chosen.seed).write(source, chosen.hours)
    whole = Builder(place / "whole", [source], place / "whole.log", chosen.build)
    whole.build()
    wanted = content(whole.library)
    builder = Builder(place / "processes", [source], place / "processes.log", (*chosen.build, "--workers", "2"))
    process = builder.start()
    wait_for(builder, whole.lines() // 3, process)
    below = [
        child
        for child in psutil.Process(process.pid).children(recursive=True)
        if "resource_tracker" not in " ".join(child.cmdline())
    ]
    if below:
        below[-1].kill()
    told_lines = process.communicate(timeout=WAIT)[1].splitlines()
    good = process.returncode == 0 and content(builder.library) == wanted
    told(f"one of {len(below)} processes killed", good and bool(below), "same content" if good else told_lines[-3:])
    with cluster(place, 2) as (address, crew):
        builder = Builder(place / "cluster", [source], place / "cluster.log", (*chosen.build, "--scheduler", address))
        process = builder.start()
        wait_for(builder, whole.lines() - 3, process)
        running = process.poll() is None
        crew[0].kill()
        told_lines = process.communicate(timeout=WAIT)[1].splitlines()
        good = process.returncode == 0 and content(builder.library) == wanted
        told("one of a cluster's two workers killed", good and running, "same content" if good else told_lines[-3:])


def wait_for(builder: Builder, target: int, process: subprocess.Popen[str]) -> None:
    """Wait until so many units are done."""
    while process.poll() is None and builder.lines() < target:
        time.sleep(0.002)


@contextmanager
def cluster(place: Path, count: int) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler and workers, each a process of its own: the scheduler's address and the workers."""
    begin = "import sys; from distributed.cli.dask_{0} import main; sys.argv[0] = 'dask-{0}'; main()"
    card = place / "scheduler.json"

    def start(kind: str, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-c", begin.format(kind), *words, "--host", "127.0.0.1", "--no-dashboard"]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    started = [start("scheduler", "--port", "0", "--scheduler-file", str(card))]
    try:
        while not card.exists():
            time.sleep(0.05)
        address = json.loads(card.read_text())["address"]
        words = ("--nthreads", "1", "--no-nanny", "--local-directory", str(place))
        started += [start("worker", address, *words) for _ in range(count)]
        time.sleep(10)
        yield address, started[1:]
    finally:
        for process in started:
            process.kill()
            process.wait()


PARTS = {"workers": workers, "kills": kills, "disk": disk, "changes": changes, "broken": broken, "two": two}


def main() -> None:
    """Print what came of each part."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--hours", type=float, default=0.1, help="of the archives that are built")
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--build", nargs="*", default=[], help="more words for moves build, such as workers=2")
    chosen = parser.parse_args()
    chosen.build = tuple(f"--{word}" for word in chosen.build)
    warnings.simplefilter("ignore")
    for name in chosen.only.split(","):
        print(f"{name}: {(PARTS[name].__doc__ or '').splitlines()[0]}", flush=True)
        with tempfile.TemporaryDirectory(prefix="scale-") as place:
            PARTS[name](Path(place), chosen)


if __name__ == "__main__":
    main()
