"""Generations: what a library is at a time; the index holds one, and the next takes its place in one transaction."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from typing import NamedTuple

import msgspec

from onbeat.errors import LibraryError
from onbeat.moves.making.stock import Row, select_clips
from onbeat.moves.similarity import Method


class Options(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The options of a build.

    Parameters
    ----------
    mirror : each clip is followed by its mirror image.
    fps : the rate of files that store none.
    search : how pairs are to be found, "exact", "coarse" or "approximate"; as suits the size where it is not told.
    """

    mirror: bool = True
    fps: float | None = None
    search: Method | None = None


class Entry(NamedTuple):
    """A recording in a library, or left out of it: where it lies, what it is, and why it is left out."""

    file: str
    name: str
    content: str
    performer: str | None = None
    genre: str | None = None
    licence: str | None = None
    problem: str | None = None


class Generation(NamedTuple):
    """What a library is.

    Parameters
    ----------
    method : digest of the code that made it.
    options : of its build.
    reading : how its files were read.
    stage : what its clips depend on besides their own recordings.
    skeleton : all clips', as JSON.
    graph : folder of its graph.
    content : a digest of all of it: equal libraries have equal ones, wherever and however they were built.
    entries : recordings, in order.
    members : for each clip, in order, the number of its recording and of its row in ``clips``.
    """

    method: str
    options: Options
    reading: str
    stage: str
    skeleton: str
    graph: str
    content: str
    entries: Sequence[Entry]
    members: Sequence[tuple[int, int]]


def put_generation(index: sqlite3.Connection, new: Generation) -> None:
    """Put a generation in the place of the one there is; within a transaction."""
    for table in ("generations", "recordings", "members"):
        index.execute(f"DELETE FROM {table}")
    options = msgspec.json.encode(new.options).decode()
    head = (1, new.method, options, new.reading, new.stage, new.skeleton, new.graph, new.content)
    index.execute("INSERT INTO generations VALUES (?, ?, ?, ?, ?, ?, ?, ?)", head)
    entries = [(1, n, *entry) for n, entry in enumerate(new.entries)]
    index.executemany("INSERT INTO recordings VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", entries)
    members = [(1, n, *member) for n, member in enumerate(new.members)]
    index.executemany("INSERT INTO members VALUES (?, ?, ?, ?)", members)


def read_generation(index: sqlite3.Connection) -> Generation | None:
    """The generation there is; none before the first build is done."""
    head = index.execute("SELECT method, options, reading, stage, skeleton, graph, content FROM generations").fetchone()
    if head is None:
        return None
    columns = "file, name, content, performer, genre, licence, problem"
    entries = [Entry(*row) for row in index.execute(f"SELECT {columns} FROM recordings ORDER BY position").fetchall()]
    members = index.execute("SELECT recording, clip FROM members ORDER BY position").fetchall()
    try:
        options = msgspec.json.decode(head[1], type=Options)
    except msgspec.DecodeError as error:
        raise LibraryError(f"the index of the library is damaged ({error}); build the library again") from None
    method, _, how, stage, skeleton, graph, content = head
    return Generation(method, options, how, stage, skeleton, graph, content, entries, members)


def rows_of(index: sqlite3.Connection, generation: Generation) -> list[Row]:
    """The rows of a generation's clips, in order; a ``LibraryError`` says if one is missing."""
    rows = {row.id: row for row in select_clips(index, "WHERE id IN (SELECT clip FROM members)")}
    try:
        found = [rows[clip] for _, clip in generation.members]
        for (number, _), row in zip(generation.members, found, strict=True):
            if not 0 <= number < len(generation.entries) or not row.is_of(generation.entries[number].content):
                raise KeyError(row.id)
    except KeyError as error:
        raise LibraryError(f"the index of the library is damaged (clip {error}); build the library again") from None
    return found


def notes_of(index: sqlite3.Connection, generation: Generation) -> list[str]:
    """What readers warned of in the files of a library, each warning once with the number of files."""
    query = "SELECT content, notes FROM readings WHERE method = ? AND notes != '[]'"
    rows = index.execute(query, (generation.reading,)).fetchall()
    try:
        told = {content: msgspec.json.decode(notes, type=list[str]) for content, notes in rows}
    except msgspec.DecodeError as error:
        raise LibraryError(f"the index of the library is damaged ({error}); build the library again") from None
    files: dict[str, list[str]] = {}
    for entry in generation.entries:
        for note in told.get(entry.content, []) if entry.problem is None else []:
            files.setdefault(note, []).append(entry.file)
    return [f"{names[0] if len(names) == 1 else f'{len(names)} files'}: {note}" for note, names in files.items()]
