import os
import signal
import sqlite3
import subprocess
import sys
import threading

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.moves import store
from onbeat.moves.build import build_library
from onbeat.moves.disk.index import create_index
from onbeat.moves.disk.lock import StorageError, building
from onbeat.moves.store import open_library, read_stored
from onbeat.moves.verify import verify_library
from stored_libraries import change, kept


@pytest.fixture
def stored(clips_folder, tmp_path):
    build_library([clips_folder], tmp_path / "lib")
    return tmp_path / "lib"


def graph_of(folder):
    (found,) = folder.glob("graph-*")
    return found


def test_what_is_opened_is_what_was_placed(dances, tmp_path):
    write_motion(dances[0], tmp_path / "a.npz")
    build_library([tmp_path], tmp_path / "lib")
    original, image = open_library(tmp_path / "lib").clips
    np.testing.assert_array_equal(original.motion.rotations[:, 1:], dances[0].rotations[:, 1:])
    assert image.motion.name == "a~mirror"
    assert image.length == (len(image.motion), image.motion.fps) == (120, 30.0)
    assert not original.poses.flags.writeable


def test_nothing_of_a_clip_is_read_before_it_is_asked_for(stored, monkeypatch):
    asked = []
    read = store.DiskShards.read
    monkeypatch.setattr(store.DiskShards, "read", lambda self, span: asked.append(span) or read(self, span))
    library = open_library(stored)
    opening = len(asked)
    assert (library.seconds, library.clips[3].fps, library.clips[3].name) == (12, 30, "b~mirror")
    assert len(asked) == opening == 1
    assert len(library.clips[0].motion) == 120
    assert len(asked) == 3


def test_a_folder_without_a_library_says_how_to_build_one(tmp_path):
    with pytest.raises(LibraryError, match="build one with `onbeat moves build"):
        open_library(tmp_path)


def test_a_library_of_a_former_version_is_to_be_built_again(clips_folder, tmp_path):
    lib = tmp_path / "lib"
    (lib / "data-0123").mkdir(parents=True)
    (lib / "library.json").write_text('{"format": "onbeat library", "version": 2}')
    with pytest.raises(LibraryError, match="of a former version; build the library again"):
        open_library(lib)
    build_library([clips_folder], lib)
    assert sorted(p.name for p in lib.iterdir()) == [".lock", graph_of(lib).name, "index.sqlite", "shards"]


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("UPDATE library SET version = 4", "is of version 4, 3 is expected; build the library again"),
        ("CREATE TABLE more (x)", "other tables than expected"),
        ("DELETE FROM generations", "was not built to the end"),
        ("UPDATE clips SET poses = poses + 1", "is damaged"),
        ("UPDATE clips SET frames = -5", "is damaged"),
        ("UPDATE clips SET joints = 'many'", "is damaged"),
        ("UPDATE clips SET fps = 0", "is damaged"),
        ("UPDATE clips SET poses = poses + 1000000000000, size = size + 456000000000000", "are expected; build"),
        ("UPDATE clips SET offset = offset + 100000000", "are expected; build the library again"),
        ("UPDATE members SET clip = 77 WHERE position = 2", "is damaged"),
        ("UPDATE members SET recording = 2 WHERE position = 1", "is damaged"),
        ("DELETE FROM members WHERE position = 0", "is expected; build the library again"),
        ("UPDATE generations SET skeleton = '{}'", "skeleton is damaged"),
        ("UPDATE generations SET graph = '../clips'", "is damaged"),
        ("UPDATE generations SET options = '7'", "is damaged"),
    ],
)
def test_a_damaged_index_is_told_and_built_anew(stored, clips_folder, tmp_path, statement, told):
    change(stored, statement)
    with pytest.raises(LibraryError, match=told) as error:
        open_library(stored)
    assert "again" in str(error.value)
    build_library([clips_folder], stored)
    build_library([clips_folder], tmp_path / "fresh")
    assert kept(stored)["generation"] == kept(tmp_path / "fresh")["generation"]
    assert verify_library(stored) == []


@pytest.mark.parametrize("data", [b"", b"\xff\xfe" * 5000, None], ids=["empty", "other", "half"])
def test_an_index_that_is_none_is_told_and_built_anew(stored, clips_folder, data):
    path = stored / "index.sqlite"
    path.write_bytes(path.read_bytes()[:9000] if data is None else data)
    with pytest.raises(LibraryError, match=r"damaged|not the index"):
        open_library(stored)
    build_library([clips_folder], stored)
    assert len(open_library(stored).clips) == 6


def test_the_index_of_another_program_is_left_alone(clips_folder, tmp_path):
    index = sqlite3.connect(tmp_path / "index.sqlite")
    index.execute("CREATE TABLE music (song TEXT)")
    index.close()
    with pytest.raises(LibraryError, match="not the index of a library; choose another folder"):
        build_library([clips_folder], tmp_path)
    assert sqlite3.connect(tmp_path / "index.sqlite").execute("SELECT * FROM music").fetchall() == []


@pytest.mark.parametrize("name", ["indptr", "targets", "costs"])
@pytest.mark.parametrize("how", ["truncated", "missing", "other", "pickled"])
def test_damaged_arrays_of_the_graph_say_to_build_again(stored, clips_folder, name, how):
    path = graph_of(stored) / f"{name}.npy"
    whole = path.read_bytes()
    if how == "truncated":
        path.write_bytes(whole[: len(whole) - 8])
    elif how == "missing":
        path.unlink()
    elif how == "other":
        np.save(path, np.zeros((3, 3)))
    else:
        np.save(path, np.array([{}], object), allow_pickle=True)
    with pytest.raises(LibraryError, match="build the library again"):
        open_library(stored)
    build_library([clips_folder], stored)
    assert path.read_bytes() == whole


def test_joins_that_lead_nowhere_are_refused(stored):
    path = graph_of(stored) / "targets.npy"
    targets = np.load(path)
    targets[0] = 10**6
    np.save(path, targets)
    with pytest.raises(LibraryError, match="joins lead to frames that are not there"):
        open_library(stored)


@pytest.mark.parametrize("series", ["clips", "pairs"])
def test_a_change_that_is_not_seen_on_opening_is_not_built_upon(stored, clips_folder, dances, tmp_path, series):
    path = stored / "shards" / f"{series}-00000.bin"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 255
    path.write_bytes(data)
    open_library(stored)
    assert any("are not those it had" in line for line in verify_library(stored))
    write_motion(dances[3], clips_folder / "d.npz")
    build_library([clips_folder], stored)
    build_library([clips_folder], tmp_path / "fresh")
    assert kept(stored) == kept(tmp_path / "fresh")
    assert verify_library(stored) == []


def test_shards_that_are_gone_are_told_and_built_anew(stored, clips_folder):
    (stored / "shards" / "clips-00000.bin").unlink()
    with pytest.raises(LibraryError, match="is missing or damaged"):
        open_library(stored)
    build_library([clips_folder], stored)
    assert verify_library(stored) == []


@pytest.mark.parametrize("when", ["placing", "finding", "joining"])
def test_a_build_that_is_stopped_leaves_the_old_library(stored, clips_folder, dances, when):
    before = kept(stored)["generation"]
    write_motion(dances[3], clips_folder / "d.npz")

    def stop(what, share):
        if what.startswith(when):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_library([clips_folder], stored, step=stop)
    assert kept(stored)["generation"] == before
    assert len(open_library(stored).clips) == 6
    assert len(build_library([clips_folder], stored).clips) == 8


def test_a_reader_may_go_on_while_the_library_is_replaced(stored, clips_folder, dances):
    library = open_library(stored)
    before = library.clips[-2].poses.sum(), library.graph.costs.sum()
    for name in "ab":
        (clips_folder / f"{name}.npz").unlink()
    write_motion(dances[9], clips_folder / "x.npz")
    build_library([clips_folder], stored)
    assert (library.clips[-2].poses.sum(), library.graph.costs.sum()) == before
    assert library.clips[-1].motion.duration == 4


def test_a_reader_between_two_generations_reads_the_newer(stored, clips_folder, monkeypatch):
    old = read_stored(stored)
    (clips_folder / "a.npz").unlink()
    build_library([clips_folder], stored)
    read, seen = store.read_stored, [old]
    monkeypatch.setattr(store, "read_stored", lambda folder: seen.pop() if seen else read(folder))
    assert len(open_library(stored).clips) == 4


def test_an_index_is_read_while_it_is_written(stored):
    index = create_index(stored / "index.sqlite")
    index.execute("BEGIN IMMEDIATE")
    index.execute("DELETE FROM members")
    assert len(open_library(stored).clips) == 6
    index.execute("ROLLBACK")
    index.close()


def test_two_builders_at_once_are_refused(stored, clips_folder, dances):
    write_motion(dances[3], clips_folder / "d.npz")
    told = []

    def other():
        try:
            build_library([clips_folder], stored)
        except LibraryError as error:
            told.append(str(error))

    with building(stored):
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
    assert told == [
        f"{stored} is being built by process {os.getpid()}; wait until it is done, or choose another folder"
    ]
    assert len(build_library([clips_folder], stored).clips) == 8


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_the_lock_of_a_killed_process_is_taken_over(tmp_path):
    holds = (
        "import sys, pathlib; from onbeat.moves.disk.lock import building\n"
        f"with building(pathlib.Path({str(tmp_path)!r})): print('held', flush=True); sys.stdin.read()"
    )
    with subprocess.Popen([sys.executable, "-c", holds], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        with pytest.raises(StorageError, match=f"by process {process.pid}"), building(tmp_path):
            pass
        process.send_signal(signal.SIGKILL)
        process.wait()
    with building(tmp_path):
        assert (tmp_path / ".lock").read_text() == str(os.getpid())


def test_a_folder_that_cannot_be_made_is_told(clips_folder, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LibraryError, match=r"cannot write in .*file"):
        build_library([clips_folder], tmp_path / "file")
