"""The index of a library: what is where, in one SQLite file.

Its tables are of two kinds. What files and blocks hold is known by content (``readings``, ``clips``, ``blocks``): rows
are added as soon as the bytes they name are on disk, and serve every later build. What a library *is* is a generation
(``generations``, ``recordings``, ``members``), written in one transaction when all it names is there: a reader sees the
old library or the new one. docs/library.md tells each column.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from onbeat.errors import LibraryError
from onbeat.moves.disk.lock import StorageError
from onbeat.moves.disk.undo import undone

INDEX = "index.sqlite"
FORMER = "library.json"  # what versions 1 and 2 had in its place, with arrays in ``data-*``
FORMAT, VERSION = "onbeat library", 3
WAIT = 30.0  # s that a reader waits for a builder's commit and it for readers, which takes milliseconds

TABLES = {
    "library": "format TEXT NOT NULL, version INTEGER NOT NULL",
    "readings": "content TEXT NOT NULL, method TEXT NOT NULL, body TEXT NOT NULL, seconds REAL NOT NULL, "
    "notes TEXT NOT NULL, problem TEXT, PRIMARY KEY (content, method)",
    "clips": "id INTEGER PRIMARY KEY, content TEXT NOT NULL, stage TEXT NOT NULL, mirrored INTEGER NOT NULL, "
    "fps REAL NOT NULL, frames INTEGER NOT NULL, joints INTEGER NOT NULL, poses INTEGER NOT NULL, "
    "width INTEGER NOT NULL, stops INTEGER NOT NULL, keyposes INTEGER NOT NULL, shard INTEGER NOT NULL, "
    "offset INTEGER NOT NULL, size INTEGER NOT NULL, sha256 TEXT NOT NULL, UNIQUE (content, stage, mirrored)",
    "blocks": "key BLOB PRIMARY KEY, shard INTEGER NOT NULL, offset INTEGER NOT NULL, count INTEGER NOT NULL, "
    "crc INTEGER NOT NULL) WITHOUT ROWID",
    "generations": "id INTEGER PRIMARY KEY, method TEXT NOT NULL, options TEXT NOT NULL, reading TEXT NOT NULL, "
    "stage TEXT NOT NULL, skeleton TEXT NOT NULL, graph TEXT NOT NULL, content TEXT NOT NULL",
    "recordings": "generation INTEGER NOT NULL, position INTEGER NOT NULL, file TEXT NOT NULL, name TEXT NOT NULL, "
    "content TEXT NOT NULL, performer TEXT, genre TEXT, licence TEXT, problem TEXT, "
    "PRIMARY KEY (generation, position)",
    "members": "generation INTEGER NOT NULL, position INTEGER NOT NULL, recording INTEGER NOT NULL, "
    "clip INTEGER NOT NULL, PRIMARY KEY (generation, position)",
}


class DamagedIndexError(LibraryError):
    """An index that cannot be read, or of another version: a builder begins anew."""


def _sql(name: str) -> str:
    columns = TABLES[name]
    return f"CREATE TABLE {name} ({columns}" + ("" if columns.endswith("ROWID") else ")")


def create_index(path: Path | None) -> sqlite3.Connection:
    """Open the index of a folder for its one builder, made new where there is none; in memory without a path.

    Raises
    ------
    LibraryError
        If the file is no index, damaged, or of another version.
    """
    with storing(path):
        index = sqlite3.connect(":memory:" if path is None else path, isolation_level=None, timeout=WAIT)
    try:
        with storing(path):
            index.execute("PRAGMA synchronous=FULL")
            index.execute("PRAGMA journal_mode=DELETE")
            if index.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0:
                _make(index)
        _check(index, path)
    except BaseException:
        index.close()
        raise
    return index


def _make(index: sqlite3.Connection) -> None:
    with committed(index):
        for name in TABLES:
            index.execute(_sql(name))
        index.execute("INSERT INTO library VALUES (?, ?)", (FORMAT, VERSION))


def open_index(path: Path) -> sqlite3.Connection:
    """Open an index to read it as of now; a ``LibraryError`` says what is wrong with it."""
    try:
        path.stat()
        try:
            index = _snapshot(path, "ro")
        except sqlite3.OperationalError as error:
            if error.sqlite_errorname != "SQLITE_READONLY_ROLLBACK":
                raise
            index = _recovered(path)
    except OSError as error:
        raise LibraryError(f"cannot read {path}: {error.strerror or error}") from None
    except sqlite3.Error as error:
        raise _damaged(path, error) from None
    try:
        _check(index, path)
    except LibraryError:
        index.close()
        raise
    return index


def _recovered(path: Path) -> sqlite3.Connection:
    """As ``_snapshot``, after a builder was stopped while it committed."""
    try:
        return _snapshot(path, "rw")  # SQLite undoes that first
    except sqlite3.OperationalError:
        return undone(path)


def _snapshot(path: Path, mode: str) -> sqlite3.Connection:
    """A connection that sees what is committed now, and nothing later."""
    index = sqlite3.connect(f"{path.absolute().as_uri()}?mode={mode}", uri=True, isolation_level=None, timeout=WAIT)
    try:
        index.execute("BEGIN")
        index.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except sqlite3.Error:
        index.close()
        raise
    return index


def _check(index: sqlite3.Connection, path: Path | None) -> None:
    """Refuse a file with other tables than ours, which might do anything (views, triggers), or of another version."""
    try:
        found = dict(index.execute("SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL").fetchall())
        row = index.execute("SELECT format, version FROM library").fetchone() if "library" in found else None
    except sqlite3.Error as error:
        raise _damaged(path, error) from None
    if row is None or row[0] != FORMAT:
        raise LibraryError(f"{path} is not the index of a library; choose another folder")
    if row[1] != VERSION:
        raise DamagedIndexError(f"{path} is of version {row[1]}, {VERSION} is expected; build the library again")
    if found != {name: _sql(name) for name in TABLES}:
        raise DamagedIndexError(f"{path} is damaged (other tables than expected); build the library again")


def _damaged(path: Path | None, error: Exception) -> LibraryError:
    return DamagedIndexError(f"{path} is damaged ({error}); build the library again")


def remove_index(folder: Path) -> None:
    """Take away an index that cannot be used; what lies in the shards is then as good as gone."""
    with storing(folder / INDEX):
        for name in (INDEX, f"{INDEX}-journal", f"{INDEX}-wal", f"{INDEX}-shm"):
            (folder / name).unlink(missing_ok=True)


@contextmanager
def reading(path: Path) -> Generator[sqlite3.Connection, None, None]:
    """An index as of one moment; what SQLite finds wrong with it is a ``LibraryError``."""
    index = open_index(path)
    try:
        yield index
    except sqlite3.Error as error:
        raise _damaged(path, error) from None
    finally:
        index.close()


@contextmanager
def storing(path: Path | None) -> Generator[None, None, None]:
    """What cannot be written is a ``StorageError`` in one line; what was there stays good."""
    try:
        yield
    except OSError as error:
        where = path.parent if path else "memory"
        raise StorageError(f"cannot write in {where}: {error.strerror or error}; choose another folder") from None
    except sqlite3.OperationalError as error:
        where = path.parent if path else "memory"
        raise StorageError(f"cannot write in {where}: {error}; choose another folder") from None
    except sqlite3.DatabaseError as error:
        raise _damaged(path, error) from None


@contextmanager
def committed(index: sqlite3.Connection) -> Generator[None, None, None]:
    """A transaction: all of it or nothing."""
    index.execute("BEGIN IMMEDIATE")
    try:
        yield
        index.execute("COMMIT")
    except BaseException:
        if index.in_transaction:
            index.execute("ROLLBACK")
        raise
