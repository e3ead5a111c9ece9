"""Who dances what is told by a table."""

from pathlib import Path

import pytest

from onbeat.errors import LibraryError
from onbeat.moves.about import read_about, with_about
from onbeat.moves.recordings import Recording


def recordings(*files):
    return [Recording(Path(file).stem, file, file, lambda: pytest.fail("read")) for file in files]


def test_later_rows_add_to_earlier_ones(tmp_path):
    (tmp_path / "t.csv").write_text("file,licence,genre\nS1/*,CC0,\nS1/a.bvh,,salsa\n*b.bvh,CC-BY,\n")
    told = with_about(recordings("S1/a.bvh", "S1/b.bvh", "c.bvh"), read_about(tmp_path / "t.csv")[:2])
    assert [tuple(r.about) for r in told] == [(None, "salsa", "CC0"), (None, None, "CC0"), (None, None, None)]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"", "has the columns nothing"),
        (b"file,mood\na,b\n", "file, performer, genre, licence are known"),
        (b"performer\na\n", "file is needed"),
        (b"\xff\xfe\x00", "is no table of text"),
        (b"file,genre\nz.bvh,salsa\n", "no file is 'z.bvh'"),
        (b"file,genre\na.bvh,salsa,more\n", "columns"),
        (b"file,genre\na.bvh\n", None),
    ],
)
def test_tables_that_are_none_are_told(tmp_path, text, told):
    (tmp_path / "t.csv").write_bytes(text)
    if told is None:
        assert with_about(recordings("a.bvh"), read_about(tmp_path / "t.csv"))[0].about.genre is None
        return
    with pytest.raises(LibraryError, match=told):
        with_about(recordings("a.bvh"), read_about(tmp_path / "t.csv"))


def test_a_table_that_is_not_there_is_told(tmp_path):
    with pytest.raises(LibraryError, match="cannot read"):
        read_about(tmp_path / "none.csv")
