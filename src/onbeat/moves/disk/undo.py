"""An index whose builder was stopped while it committed, read where nothing may be written.

SQLite undoes half a transaction before anybody reads, by the journal beside the file. Where the folder cannot be
written it is undone in a copy, which is kept in memory.
"""

from __future__ import annotations

import os
import shutil
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path

from onbeat.errors import LibraryError

JOURNAL = "-journal"


def undone(path: Path) -> sqlite3.Connection:
    """The index as it was before the transaction that was not finished, in memory.

    Raises
    ------
    LibraryError
        If there is no room for a copy, or a builder is at work now.
    """
    index = sqlite3.connect(":memory:", isolation_level=None)
    try:
        with tempfile.TemporaryDirectory(prefix="onbeat-") as folder:
            _copy(path, Path(folder) / path.name)
            with closing(sqlite3.connect(Path(folder) / path.name)) as half:
                half.backup(index)
    except (OSError, sqlite3.OperationalError) as error:
        index.close()
        raise LibraryError(
            f"a builder was stopped while it wrote {path}, and what it left cannot be undone here ({error}); open the "
            "library once where its folder can be written"
        ) from None
    except BaseException:
        index.close()
        raise
    return index


def _copy(path: Path, copy: Path) -> None:
    """Copy an index and its journal; both have to be what they were when it began."""
    files = {Path(f"{path}{end}"): Path(f"{copy}{end}") for end in (JOURNAL, "")}
    before = [_state(file) for file in files]
    for file, there in files.items():
        shutil.copyfile(file, there)
    if before != [_state(file) for file in files]:
        raise LibraryError(f"{path} changed while it was read, for a builder began; open the library again")


def _state(file: Path) -> tuple[int, int, int]:
    found = os.stat(file)
    return found.st_ino, found.st_size, found.st_mtime_ns
