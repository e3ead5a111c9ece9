"""What is told of recordings: a table of performers, genres and licences."""

from __future__ import annotations

import csv
import fnmatch
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from onbeat.errors import LibraryError
from onbeat.moves.recordings import About, Recording

COLUMNS = ("file", *About._fields)


class Told(NamedTuple):
    """A row of the table: a file, or a pattern of files, and what is told of it."""

    pattern: str
    about: About


def read_about(path: Path) -> list[Told]:
    """Read a table of values separated by commas, with the columns file, performer, genre and licence.

    ``file`` is a file's path in its folder, or a pattern such as ``S01/*``; later rows add to earlier ones.

    Raises
    ------
    LibraryError
        If it cannot be read, or has no column ``file`` or one that is not known.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file, strict=True))
    except OSError as error:
        raise LibraryError(f"cannot read {path}: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise LibraryError(f"{path} is no table of text ({error}); give one with the columns {_listed()}") from None
    columns = list(rows[0]) if rows else []
    if "file" not in columns or not set(columns) <= set(COLUMNS):
        found = ", ".join(str(column) for column in columns) or "nothing"
        raise LibraryError(f"{path} has the columns {found}; {_listed()} are known, and file is needed")
    return [Told(row["file"], About(*(row.get(name) or None for name in About._fields))) for row in rows]


def _listed() -> str:
    return ", ".join(COLUMNS)


def with_about(recordings: Sequence[Recording], told: Sequence[Told]) -> list[Recording]:
    """Recordings with what a table tells of them.

    Raises
    ------
    LibraryError
        If a row of the table fits no file.
    """
    found = [recording.about for recording in recordings]
    for row in told:
        fits = [n for n, recording in enumerate(recordings) if fnmatch.fnmatchcase(recording.file, row.pattern)]
        if not fits:
            raise LibraryError(f"no file is {row.pattern!r}, of which something is told; there is {recordings[0].file}")
        for n in fits:
            found[n] = About(*(new or old for new, old in zip(row.about, found[n], strict=True)))
    return [replace(recording, about=about) for recording, about in zip(recordings, found, strict=True)]
