"""Recordings taken out of libraries, libraries made one, without a motion file."""

import shutil

import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion.retarget import retarget
from onbeat.moves.build import build_library
from onbeat.moves.making import compact
from onbeat.moves.manage import merge_libraries, remove_recordings
from onbeat.moves.store import open_library
from onbeat.moves.verify import verify_library
from persons import person
from stored_libraries import kept


def named(library):
    return [clip.name for clip in library.clips if not clip.mirrored]


def part(clips_folder, tmp_path, name, files):
    """The library of some of the clips."""
    build_library([clips_folder / f"{file}.npz" for file in files], tmp_path / name)
    return tmp_path / name


def test_what_is_left_is_the_library_that_would_be_built_without_it(clips_folder, tmp_path):
    build_library([clips_folder], tmp_path / "lib")
    left = tmp_path / "left"
    left.mkdir()
    for file in "ac":
        shutil.move(clips_folder / f"{file}.npz", left)
    shutil.rmtree(clips_folder)
    assert named(remove_recordings(tmp_path / "lib", ["b"])) == ["a", "c"]
    build_library([left], tmp_path / "fresh")
    assert kept(tmp_path / "lib") == kept(tmp_path / "fresh")
    assert verify_library(tmp_path / "lib") == []


def test_bytes_of_no_use_are_given_back(clips_folder, tmp_path, monkeypatch):
    monkeypatch.setattr(compact, "SPARE", 0)
    build_library([clips_folder], tmp_path / "lib")
    before = open_library(tmp_path / "lib")
    shards = tmp_path / "lib" / "shards"
    size = (shards / "clips-00000.bin").stat().st_size
    (shards / ".run-0").touch()  # a builder on a cluster was killed
    assert verify_library(tmp_path / "lib") == []
    remove_recordings(tmp_path / "lib", ["a", "b"])
    assert not (shards / ".run-0").exists()
    assert [path.name for path in sorted(shards.glob("clips-*"))] == ["clips-00001.bin"]
    assert (shards / "clips-00001.bin").stat().st_size < 0.4 * size
    assert verify_library(tmp_path / "lib") == []
    after = open_library(tmp_path / "lib").clips[0]
    assert after.motion.rotations.tobytes() == before.clips[4].motion.rotations.tobytes()
    assert len(build_library([clips_folder], tmp_path / "lib").clips) == 6


def test_names_may_be_patterns_and_files_that_are_left_out(clips_folder, tmp_path):
    (clips_folder / "x.bvh").write_text("no")
    build_library([clips_folder], tmp_path / "lib")
    library = remove_recordings(tmp_path / "lib", ["[ab]", "x.bvh"])
    assert named(library) == ["c"]
    assert library.problems == ()


@pytest.mark.parametrize(("names", "told"), [(["d"], "nothing in .* is named 'd'"), (["*"], "no clip would be left")])
def test_what_cannot_be_removed_is_told_and_nothing_is(clips_folder, tmp_path, names, told):
    build_library([clips_folder], tmp_path / "lib")
    with pytest.raises(LibraryError, match=told):
        remove_recordings(tmp_path / "lib", names)
    assert len(open_library(tmp_path / "lib").clips) == 6


def test_merged_libraries_are_the_library_of_all_files(clips_folder, tmp_path):
    one, two = part(clips_folder, tmp_path, "one", "a"), part(clips_folder, tmp_path, "two", "bc")
    merged = merge_libraries([one, two], tmp_path / "all")
    whole = part(clips_folder, tmp_path, "whole", "abc")
    assert named(merged) == ["a", "b", "c"]
    assert kept(tmp_path / "all") == kept(whole)
    assert verify_library(tmp_path / "all") == []


def test_what_is_in_both_is_used_once_and_no_two_names_are_alike(clips_folder, dances, tmp_path):
    one = part(clips_folder, tmp_path, "one", "ab")
    shutil.copy(clips_folder / "a.npz", clips_folder / "copy.npz")
    write_motion(dances[5], clips_folder / "b.npz")
    two = part(clips_folder, tmp_path, "two", ["copy", "b"])
    merged = merge_libraries([one, two], tmp_path / "all")
    assert named(merged) == ["a", "b", "two/b"]
    assert merged.problems == ("copy.npz: the same as a.npz",)


def test_libraries_that_do_not_fit_are_refused(clips_folder, dances, tmp_path):
    one = part(clips_folder, tmp_path, "one", "ab")
    write_motion(retarget(dances[3], person()), clips_folder / "d.npz")
    other = part(clips_folder, tmp_path, "other", "d")
    build_library([clips_folder / "c.npz"], tmp_path / "plain", mirror=False)
    for folders, told in (
        ([one, other], "is on another body than"),
        ([one, tmp_path / "plain"], "built with other options"),
        ([one], "give two or more"),
        ([one, tmp_path], "no library in"),
    ):
        with pytest.raises(LibraryError, match=told):
            merge_libraries(folders, tmp_path / "all")
    assert not (tmp_path / "all").exists()
    with pytest.raises(LibraryError, match="there is a library in"):
        merge_libraries([one, one], other)
