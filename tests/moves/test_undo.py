"""What a builder that was stopped in a commit left is undone for whoever reads, also where nothing may be written."""

import shutil
import sqlite3
import tempfile
from pathlib import Path

import pytest

from onbeat.errors import LibraryError
from onbeat.moves.disk import index
from onbeat.moves.disk.index import DamagedIndexError, create_index, open_index

ROWS = "INSERT INTO readings (content, method, body, seconds, notes) VALUES (?, ?, '', 0, '[]')"


@pytest.fixture
def stopped(tmp_path: Path) -> Path:
    """An index of one reading, as it lies there when a builder that adds many more is killed."""
    made = create_index(tmp_path / "made.sqlite")
    made.execute(ROWS, ("kept", ""))
    made.execute("PRAGMA cache_size=1")
    made.execute("BEGIN IMMEDIATE")
    made.executemany(ROWS, [(f"{n}", 500 * "x") for n in range(500)])
    for end in ("", "-journal"):
        shutil.copy(tmp_path / f"made.sqlite{end}", tmp_path / f"index.sqlite{end}")
    made.close()
    return tmp_path / "index.sqlite"


@pytest.fixture
def read_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is written beside an index, whoever runs this."""
    given = index._snapshot

    def snapshot(path: Path, mode: str) -> sqlite3.Connection:
        if mode == "rw":
            raise sqlite3.OperationalError("attempt to write a readonly database")
        return given(path, mode)

    monkeypatch.setattr(index, "_snapshot", snapshot)


@pytest.mark.usefixtures("read_only")
def test_half_a_commit_is_undone_in_a_copy_where_nothing_may_be_written(stopped: Path):
    before = [path.read_bytes() for path in sorted(stopped.parent.iterdir())]
    found = open_index(stopped)
    assert found.execute("SELECT content FROM readings").fetchall() == [("kept",)]
    found.close()
    assert [path.read_bytes() for path in sorted(stopped.parent.iterdir())] == before


@pytest.mark.usefixtures("read_only")
def test_where_there_is_no_room_for_a_copy_it_is_told_what_to_do(stopped: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(tempfile, "tempdir", str(stopped.parent / "nowhere"))
    with pytest.raises(
        LibraryError, match=r"a builder was stopped .* open the library once where .* can be written$"
    ) as e:
        open_index(stopped)
    assert not isinstance(e.value, DamagedIndexError)  # else the next builder would begin anew


def test_where_it_may_be_written_it_is_undone_for_good(stopped: Path):
    open_index(stopped).close()
    assert not stopped.with_name("index.sqlite-journal").exists()
