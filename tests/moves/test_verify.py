"""A library is checked whole: each byte of it that goes bad is found."""

import os

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.moves.build import build_library
from onbeat.moves.disk.lock import building
from onbeat.moves.verify import verify_library
from stored_libraries import change


@pytest.fixture(scope="module")
def whole(tmp_path_factory, dances):
    from onbeat.formats import write_motion

    folder = tmp_path_factory.mktemp("clips")
    for name, motion in zip("ab", dances, strict=False):
        write_motion(motion, folder / f"{name}.npz")
    build_library([folder], folder / "lib")
    return folder / "lib"


@pytest.fixture
def library(whole, tmp_path):
    import shutil

    shutil.copytree(whole, tmp_path / "lib")
    return tmp_path / "lib"


def test_a_good_library_has_nothing_wrong(library):
    steps = []
    assert verify_library(library, lambda what, share: steps.append(what)) == []
    assert set(steps) == {"clips", "pairs"}


@pytest.mark.parametrize("file", ["shards/clips-00000.bin", "shards/pairs-00000.bin", "costs.npy", "targets.npy"])
def test_a_bit_that_turns_is_found_wherever_it_is(library, file):
    path = library / file if "/" in file else next(library.glob("graph-*")) / file
    whole = path.read_bytes()
    for at in np.linspace(128, len(whole) - 1, 5).astype(int):
        data = bytearray(whole)
        data[at] ^= 1
        path.write_bytes(data)
        assert verify_library(library), at
    path.write_bytes(whole)
    assert verify_library(library) == []


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE recordings SET name = 'other' WHERE position = 0",
        "UPDATE clips SET sha256 = 'other' WHERE id = 1",
        "UPDATE blocks SET count = count - 1",
        "UPDATE blocks SET offset = offset + 1000000000",
        "UPDATE blocks SET count = 'many'",
        "UPDATE generations SET graph = 'graph-0'",
        "DELETE FROM members",
    ],
)
def test_an_index_that_says_something_else_is_found(library, statement):
    change(library, statement)
    assert verify_library(library)


def test_where_there_is_none_or_somebody_builds_it_says_so(library, tmp_path):
    with pytest.raises(LibraryError, match="no library in"):
        verify_library(tmp_path)
    with building(library), pytest.raises(LibraryError, match=f"being built by process {os.getpid()}"):
        verify_library(library)
