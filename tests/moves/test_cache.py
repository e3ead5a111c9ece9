import os
import sys

import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.moves.build import build_library
from onbeat.moves.cache import CacheWarning, build_from, build_or_open, cache_folder
from onbeat.moves.disk.lock import building
from onbeat.moves.making.steps import Making


@pytest.fixture
def built(monkeypatch):
    """Notes each library that is really built."""
    made, make = [], Making.make
    monkeypatch.setattr(Making, "make", lambda self: made.append(len(self.recordings)) or make(self))
    return made


def names(library):
    return [clip.name for clip in library.clips]


def test_a_library_s_folder_is_opened_as_it_is(clips_folder, tmp_path, built):
    build_library([clips_folder], tmp_path / "lib", mirror=False)
    assert names(build_or_open(tmp_path / "lib", tmp_path / "cache")) == ["a", "b", "c"]
    assert built == [3]
    assert not (tmp_path / "cache").exists()


def test_a_folder_is_built_once_and_again_when_it_changes(clips_folder, dances, tmp_path, built):
    cache = tmp_path / "cache"
    for _ in range(2):
        assert len(build_or_open(clips_folder, cache).clips) == 6
    assert built == [3]
    write_motion(dances[3], clips_folder / "d.npz")
    for _ in range(2):
        assert len(build_or_open(clips_folder, cache).clips) == 8
    assert built == [3, 4]
    assert len(build_or_open(clips_folder, cache, mirror=False).clips) == 4
    assert len(build_or_open(clips_folder, cache).clips) == 8
    assert built == [3, 4, 4]
    assert len(list(cache.iterdir())) == 2


def test_files_and_several_paths_may_be_given(clips_folder, tmp_path):
    assert names(build_or_open(clips_folder / "b.npz", tmp_path / "cache")) == ["b", "b~mirror"]
    both = build_or_open([clips_folder / "c.npz", clips_folder / "a.npz"], tmp_path / "cache", mirror=False)
    assert names(both) == ["c", "a"]


def test_a_relative_path_is_the_same_folder(clips_folder, tmp_path, built, monkeypatch):
    build_or_open(clips_folder, tmp_path / "cache")
    monkeypatch.chdir(tmp_path)
    build_or_open(clips_folder.relative_to(tmp_path), tmp_path / "cache")
    assert built == [3]


def test_problems_are_told_from_the_cache_too(clips_folder, tmp_path, built):
    (clips_folder / "x.bvh").write_text("no")
    first, second = (build_or_open(clips_folder, tmp_path / "cache").problems for _ in range(2))
    assert first == second
    assert len(first) == 1
    assert built == [4]


def test_a_damaged_library_in_the_cache_is_built_again(clips_folder, tmp_path, built):
    build_or_open(clips_folder, tmp_path / "cache")
    for array in tmp_path.glob("cache/*/graph-*/costs.npy"):
        array.unlink()
    assert len(build_or_open(clips_folder, tmp_path / "cache").clips) == 6
    assert built == [3, 3]


def test_where_nothing_can_be_kept_it_is_built_in_memory_with_a_warning(clips_folder, tmp_path, built):
    (tmp_path / "cache").write_text("a file")
    with pytest.warns(CacheWarning, match="not kept for the next time: cannot write in"):
        library = build_or_open(clips_folder, tmp_path / "cache")
    assert len(library.clips) == 6
    with pytest.raises(LibraryError, match="too short"):
        build_from(lambda: [library.clips[0].motion[:10]], "key", tmp_path / "other")
    assert built == [3, 1]


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="everybody may write everywhere")
def test_a_library_in_a_read_only_cache_is_opened(clips_folder, tmp_path, built):
    build_or_open(clips_folder, tmp_path / "cache")
    (folder,) = (tmp_path / "cache").iterdir()
    folder.chmod(0o555)
    try:
        assert len(build_or_open(clips_folder, tmp_path / "cache").clips) == 6
    finally:
        folder.chmod(0o755)
    assert built == [3]


def test_while_another_builds_there_it_is_built_in_memory(clips_folder, tmp_path):
    build_or_open(clips_folder, tmp_path / "cache")
    (folder,) = (tmp_path / "cache").iterdir()
    (clips_folder / "a.npz").unlink()
    with building(folder), pytest.warns(CacheWarning, match="is being built by process"):
        assert len(build_or_open(clips_folder, tmp_path / "cache").clips) == 4


def test_made_motions_are_made_once_for_a_key(dances, tmp_path, built):
    asked = []

    def motions():
        asked.append(1)
        return dances[:2]

    for _ in range(2):
        library = build_from(motions, "version 1 seed 0", tmp_path)
        assert names(library)[::2] == [dance.name for dance in dances[:2]]
    assert (len(asked), built) == (1, [2])
    build_from(motions, "version 1 seed 1", tmp_path)
    build_from(motions, "version 1 seed 0", tmp_path, mirror=False)
    assert (len(asked), built) == (3, [2, 2, 2])


def test_the_environment_says_where(monkeypatch, tmp_path):
    monkeypatch.setenv("ONBEAT_CACHE", str(tmp_path))
    assert cache_folder() == tmp_path / "libraries"
    monkeypatch.delenv("ONBEAT_CACHE")
    assert "onbeat" in str(cache_folder())
