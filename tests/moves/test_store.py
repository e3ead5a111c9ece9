import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.moves import store
from onbeat.moves.build import build_library
from onbeat.moves.lock import StorageError, building
from onbeat.moves.store import open_library


@pytest.fixture
def stored(clips_folder, tmp_path):
    build_library([clips_folder], tmp_path / "lib")
    return tmp_path / "lib"


def data_of(folder):
    (found,) = folder.glob("data-*")
    return found


def test_what_is_opened_is_what_was_built(clips_folder, tmp_path):
    built, opened = build_library([clips_folder], tmp_path / "lib"), open_library(tmp_path / "lib")
    for name in ("clip_of", "indptr", "targets", "costs"):
        a, b = getattr(built.graph, name), getattr(opened.graph, name)
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    for a, b in zip(built.clips, opened.clips, strict=True):
        assert (a.name, a.source, a.mirrored, a.motion.fps) == (b.name, b.source, b.mirrored, b.motion.fps)
        assert a.motion.skeleton == b.motion.skeleton
        for name in ("stops", "intensity", "poses"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
        np.testing.assert_array_equal(a.motion.rotations, b.motion.rotations)
        np.testing.assert_array_equal(a.motion.root_positions, b.motion.root_positions)


def test_a_folder_without_a_library_says_how_to_build_one(tmp_path):
    with pytest.raises(LibraryError, match="build one with `onbeat moves build"):
        open_library(tmp_path)


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda text: text.replace(b'"version": 2', b'"version": 1'), "is of version 1, 2 is expected"),
        (lambda text: text[: len(text) // 2], "is damaged"),
        (lambda text: b"", "is damaged"),
        (lambda text: b"\xff\xfe", "is damaged"),
        (lambda text: b'{"version": 1}', "not the manifest of a library"),
        (lambda text: text.replace(b'"frames": 120', b'"frames": 121', 1), "is expected; build"),
        (lambda text: text.replace(b'"frames": 120', b'"frames": "many"', 1), "is damaged"),
        (lambda text: text.replace(b'"parents": [', b'"parents": [7,', 1), "is damaged"),
    ],
)
def test_a_damaged_or_unknown_manifest_says_to_build_again(stored, clips_folder, damage, told):
    path = stored / "library.json"
    whole = path.read_bytes()
    damaged = damage(whole.replace(b'"parents":[', b'"parents": ['))
    assert damaged != whole
    path.write_bytes(damaged)
    with pytest.raises(LibraryError, match=told) as error:
        open_library(stored)
    assert "again" in str(error.value)
    build_library([clips_folder], stored)
    assert path.read_bytes() == whole


@pytest.mark.parametrize("name", ["rotations", "poses", "targets", "stops"])
@pytest.mark.parametrize("how", ["truncated", "missing", "other", "pickled"])
def test_damaged_arrays_say_to_build_again(stored, clips_folder, name, how):
    path = data_of(stored) / f"{name}.npy"
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


def test_a_change_that_is_not_seen_on_opening_is_not_built_upon(stored, clips_folder, dances, tmp_path):
    path = data_of(stored) / "poses.npy"
    np.save(path, np.load(path) + 1)
    write_motion(dances[3], clips_folder / "d.npz")
    build_library([clips_folder], stored)
    build_library([clips_folder], tmp_path / "fresh")
    assert data_of(stored).name == data_of(tmp_path / "fresh").name


def test_joins_that_lead_nowhere_are_refused(stored):
    path = data_of(stored) / "targets.npy"
    targets = np.load(path)
    targets[0] = 10**6
    np.save(path, targets)
    with pytest.raises(LibraryError, match="joins lead to frames that are not there"):
        open_library(stored)


@pytest.mark.parametrize("when", ["reading", "placing", "finding", "done"])
def test_a_build_that_is_stopped_leaves_the_old_library(stored, clips_folder, dances, when):
    before = (stored / "library.json").read_bytes()
    write_motion(dances[3], clips_folder / "d.npz")

    def stop(what, share):
        if what.startswith(when):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_library([clips_folder], stored, step=stop)
    assert (stored / "library.json").read_bytes() == before
    assert len(open_library(stored).clips) == 6
    assert len(build_library([clips_folder], stored).clips) == 8


def test_a_build_killed_between_arrays_and_manifest_leaves_the_old_library(stored, clips_folder, dances, monkeypatch):
    write_motion(dances[3], clips_folder / "d.npz")
    (stored / ".data-0123.part").mkdir()  # of a build that was killed while it wrote
    with monkeypatch.context() as patch:
        patch.setattr(store, "write_atomically", lambda path, data: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            build_library([clips_folder], stored)
    assert len(list(stored.glob("data-*"))) == 2
    assert len(open_library(stored).clips) == 6
    assert len(build_library([clips_folder], stored).clips) == 8
    assert sorted(p.name for p in stored.iterdir()) == [".lock", data_of(stored).name, "library.json"]


def test_a_reader_may_go_on_while_the_library_is_replaced(stored, clips_folder):
    library = open_library(stored)
    before = library.clips[-1].poses.sum(), library.clips[-1].motion.rotations.sum()
    (clips_folder / "a.npz").unlink()
    build_library([clips_folder], stored)
    assert (library.clips[-1].poses.sum(), library.clips[-1].motion.rotations.sum()) == before


def test_a_reader_between_two_manifests_reads_the_newer(stored, clips_folder, monkeypatch):
    old = store.read_manifest(stored)
    (clips_folder / "a.npz").unlink()
    build_library([clips_folder], stored)
    read, seen = store.read_manifest, [old]
    monkeypatch.setattr(store, "read_manifest", lambda folder: seen.pop() if seen else read(folder))
    assert len(open_library(stored).clips) == 4


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
        "import sys, pathlib; from onbeat.moves.lock import building\n"
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
