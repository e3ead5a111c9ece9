"""What a build of many files lives through: being killed anywhere, a full disk, files that change, broken files."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion import Motion
from onbeat.moves.build import build_library
from onbeat.moves.disk.lock import StorageError
from onbeat.moves.store import open_library

FORKS = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs processes that are forked")

# Builds in a process of its own for each fault, all forked from one that has imported and compiled everything.
FAULTS = """
import json, os, resource, signal, sqlite3, sys, warnings
from pathlib import Path
from onbeat.errors import OnbeatError
from onbeat.moves import build
from onbeat.moves.making import stock
from onbeat.moves.making.generations import Options
from onbeat.moves.recordings import find_recordings

warnings.simplefilter("ignore")
calls = 0

def dies(name, at, module=os):
    given = getattr(module, name)
    def call(*words, **named):
        global calls
        calls += 1
        if calls == at:
            if name == "write":  # half of what was to be written is there
                given(words[0], words[1][: len(words[1]) // 2])
            os.kill(os.getpid(), signal.SIGKILL)
        return given(*words, **named)
    setattr(module, name, call)

def fault(kind, at):
    if kind == "kill":
        for name in ("write", "fsync", "ftruncate", "rename", "mkdir"):
            dies(name, at)
    elif kind == "kill in a commit":
        given = stock.create_index
        def create(path):
            index = given(path)
            index.execute("PRAGMA cache_size=1")
            def trace(text):
                global calls
                calls += text.startswith("INSERT")
                if calls >= at:
                    os.kill(os.getpid(), signal.SIGKILL)
            index.set_trace_callback(trace)
            return index
        stock.create_index = create
    elif kind == "kill with half a transaction on disk":
        index = sqlite3.connect(library / "index.sqlite", isolation_level=None)
        index.execute("PRAGMA cache_size=1")
        index.execute("BEGIN IMMEDIATE")
        rows = [(f"{n}", "x" * 500, "", 0, "[]") for n in range(at)]
        index.execute("DELETE FROM generations")
        index.executemany("INSERT INTO readings (content, method, body, seconds, notes) VALUES (?, ?, ?, ?, ?)", rows)
        os.kill(os.getpid(), signal.SIGKILL)
    elif kind == "full":
        resource.setrlimit(resource.RLIMIT_FSIZE, (at, at))

def stored():  # where clips and blocks of pairs lie, by what they are
    if not (library / "index.sqlite").exists():
        return {}
    index = sqlite3.connect(library / "index.sqlite")
    try:
        rows = index.execute("SELECT content, mirrored, id, shard, offset, sha256 FROM clips").fetchall()
        rows += index.execute("SELECT hex(key), 0, shard, offset, count, crc FROM blocks").fetchall()
    except sqlite3.OperationalError:  # not even the tables
        return {}
    finally:
        index.close()
    return {repr(row[:2]): repr(row[2:]) for row in rows}

def outcome(kind, at):
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        told = "built"
        try:
            fault(kind, at)
            build.build_library([source], library)
        except OnbeatError as error:
            told = f"{type(error).__name__}: {error}"
        except BaseException as error:
            told = f"not an error of ours: {error!r}"
        os.write(writing, told.encode())
        os._exit(0)
    os.close(writing)
    status = os.waitpid(pid, 0)[1]
    told = os.read(reading, 10000).decode() if not os.WIFSIGNALED(status) else "killed"
    os.close(reading)
    return told, stored() if kind == "kill" else {}

warm = False
for line in sys.stdin:
    source, library, faults = json.loads(line)
    source, library = Path(source), Path(library)
    if not warm:
        build.assemble(find_recordings([source]), Options())
        warm = True
    print(json.dumps([outcome(*fault) for fault in faults]), flush=True)
"""

Faults = Callable[..., list[tuple[str, dict[str, str]]]]


@pytest.fixture(scope="module")
def faults() -> Iterator[Faults]:
    """Builds once for each fault, and says what came of it, and what was then in the index."""
    command = [sys.executable, "-c", FAULTS]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin
        assert process.stdout
        asked, answers = process.stdin, process.stdout

        def build(source: Path, library: Path, *wanted: tuple[str, int]) -> list[tuple[str, dict[str, str]]]:
            print(json.dumps([str(source), str(library), wanted]), file=asked, flush=True)
            return [tuple(outcome) for outcome in json.loads(answers.readline())]

        yield build


def content(folder: Path) -> str:
    """A digest of what a reader of a library sees."""
    library, total = open_library(folder), hashlib.sha256()
    for clip in library.clips:
        total.update(clip.name.encode())
        for array in (clip.motion.rotations, clip.motion.root_positions, clip.poses, clip.stops, clip.intensity):
            total.update(np.ascontiguousarray(array).data)
    for array in (library.graph.indptr, library.graph.targets, library.graph.costs):
        total.update(np.ascontiguousarray(array).data)
    return total.hexdigest()


@FORKS
def test_a_build_killed_at_any_write_is_finished_by_the_next_and_keeps_what_was_done(
    faults: Faults, clips_folder: Path, tmp_path: Path
) -> None:
    whole, library = tmp_path / "whole", tmp_path / "library"
    build_library([clips_folder], whole)
    moments = (1, 8, 15, 19, 20, 14, 13, 9, 5)
    known: dict[str, str] = {}
    for told, after in faults(clips_folder, library, *(("kill", moment) for moment in moments)):
        assert told == "killed"
        assert {key: after.get(key) for key in known} == known
        known = after
    assert len(known) >= 4
    build_library([clips_folder], library)
    assert content(library) == content(whole)
    assert [path.name for path in library.glob("graph-*")] == [path.name for path in whole.glob("graph-*")]
    assert sorted(path.name for path in library.iterdir()) == sorted(path.name for path in whole.iterdir())


@FORKS
def test_the_old_library_is_read_whatever_the_next_builder_was_killed_at(
    faults: Faults, clips_folder: Path, dances: list[Motion], tmp_path: Path
) -> None:
    library = tmp_path / "library"
    build_library([clips_folder], library)
    old = content(library)
    write_motion(dances[5], clips_folder / "d.npz")
    moments = [("kill in a commit", 2), ("kill in a commit", 4), ("kill with half a transaction on disk", 500)]
    assert [told for told, _ in faults(clips_folder, library, *moments)] == ["killed"] * 3
    assert (library / "index.sqlite-journal").exists()
    assert content(library) == old
    assert len(build_library([clips_folder], library).clips) == 8


@FORKS
def test_a_full_disk_is_one_clear_line_and_leaves_the_old_library_good(
    faults: Faults, clips_folder: Path, dances: list[Motion], tmp_path: Path
) -> None:
    library, whole = tmp_path / "library", tmp_path / "whole"
    build_library([clips_folder], library)
    old = content(library)
    for n in range(4, 8):
        write_motion(dances[n], clips_folder / f"d{n}.npz")
    size = max(path.stat().st_size for path in library.rglob("*"))
    for told, _ in faults(clips_folder, library, ("full", 0), ("full", 4096), ("full", size + 100_000)):
        assert told.startswith("StorageError: cannot write in ")
        assert "\n" not in told
        assert content(library) == old
    build_library([clips_folder], whole)
    build_library([clips_folder], library)
    assert content(library) == content(whole)


@FORKS
def test_a_disk_that_is_full_at_first_is_told_and_built_on_later(
    faults: Faults, clips_folder: Path, tmp_path: Path
) -> None:
    library, whole = tmp_path / "library", tmp_path / "whole"
    for told, _ in faults(clips_folder, library, ("full", 0), ("full", 100), ("full", 70_000), ("full", 400_000)):
        assert told.startswith("StorageError: cannot write in ")
        with pytest.raises(LibraryError):
            open_library(library)
    build_library([clips_folder], whole)
    build_library([clips_folder], library)
    assert content(library) == content(whole)


def test_a_reader_sees_the_old_library_and_a_second_builder_is_refused_until_the_first_is_done(
    clips_folder: Path, dances: list[Motion], tmp_path: Path
) -> None:
    library = tmp_path / "library"
    build_library([clips_folder], library)
    old, seen, refused = content(library), set[str](), []
    write_motion(dances[5], clips_folder / "d.npz")

    def step(what: str, share: float) -> None:
        if share < 1.0:
            seen.add(content(library))
            with pytest.raises(StorageError, match=f"being built by process {os.getpid()}") as error:
                build_library([clips_folder], library)
            refused.append(error.value)

    build_library([clips_folder], library, step=step)
    assert seen == {old}
    assert len(refused) > 3
    assert content(library) != old


def test_a_clip_that_changes_while_it_is_read_is_told_and_read_again_the_next_time(
    clips_folder: Path, dances: list[Motion], tmp_path: Path
) -> None:
    library, whole, changed = tmp_path / "library", tmp_path / "whole", clips_folder / "b.npz"
    data = changed.read_bytes()

    def step(what: str, share: float) -> None:
        if what == "reading":  # after its digest was taken, before it is read
            write_motion(dances[7], changed)

    problems = build_library([clips_folder], library, step=step).problems
    assert problems == ("b.npz: changed while it was read; build again when nobody writes to it",)
    changed.write_bytes(data)
    assert not build_library([clips_folder], library).problems
    build_library([clips_folder], whole)
    assert content(library) == content(whole)


def test_broken_files_among_many_are_listed_and_the_others_used(dances: list[Motion], tmp_path: Path) -> None:
    source, motion = tmp_path / "source", dances[0]
    source.mkdir()
    for n in range(30):
        write_motion(dances[n % 17][40 * (n // 17) : 40 * (n // 17) + 60 + n], source / f"good{n:02}.npz")
    data = (source / "good00.npz").read_bytes()
    write_motion(motion, source / "words.bvh")
    text = (source / "words.bvh").read_bytes()
    write_motion(motion[:20], source / "short.npz")
    shutil.copy(source / "good03.npz", source / "second.npz")
    broken = {
        "empty.npz": b"",
        "cut.npz": data[: len(data) // 2],
        "noise.npz": np.random.default_rng(0).bytes(5000),
        "words.bvh": text[:-2000] + b"no numbers",
        "tree.bvh": text[:500],
        "nothing.bvh": b"",
        "alone.amc": b"#!OML:ASF\n:FULLY-SPECIFIED\n1\nroot 0 0 0\n",
    }
    for name, bytes_ in broken.items():
        (source / name).write_bytes(bytes_)
    told = {line.split(":")[0] for line in build_library([source], tmp_path / "library", mirror=False).problems}
    assert told == {*broken, "short.npz", "second.npz"}
    assert len(open_library(tmp_path / "library").clips) == 30
