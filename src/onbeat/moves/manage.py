"""Libraries as wholes: recordings taken out of one, several made one; nothing is read again."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Sequence
from pathlib import Path

import msgspec

from onbeat.errors import LibraryError
from onbeat.moves.build import opened_stock
from onbeat.moves.disk.index import INDEX, reading
from onbeat.moves.disk.lock import building
from onbeat.moves.disk.shards import DiskShards, Span
from onbeat.moves.engine import Engine
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.generations import Entry
from onbeat.moves.making.placing import Reading
from onbeat.moves.making.publish import Draft, Step, publish, rising
from onbeat.moves.making.stock import PAIR, SHARDS, Row, Stock, select_clips
from onbeat.moves.making.taken import twin_recordings
from onbeat.moves.store import Stored, is_library, open_library, read_stored

COMPARED = 0.05  # share of a merger's time at which takes are compared


def remove_recordings(
    folder: Path, names: Sequence[str], *, engine: Engine | None = None, step: Step | None = None
) -> MoveLibrary:
    """Take recordings, with their clips and mirror images, out of a library.

    Parameters
    ----------
    folder : the library's.
    names : of recordings, or patterns such as ``walk*``; of files that are left out, too.

    Raises
    ------
    LibraryError
        If a name fits none, or none would be left.
    """
    read_stored(folder)
    with building(folder):
        stored = read_stored(folder)
        entries = stored.generation.entries
        gone = {n for name in names for n in _named(name, entries, folder)}
        kept = {n: place for place, n in enumerate(n for n in range(len(entries)) if n not in gone)}
        numbers = [n for n, _ in stored.generation.members]
        members = [(kept[n], row) for n, row in zip(numbers, stored.rows, strict=True) if n in kept]
        if not members:
            raise LibraryError(f"no clip would be left in {folder}; delete the folder instead")
        g = stored.generation
        draft = Draft(g.method, g.options, g.reading, g.stage, g.skeleton, [entries[n] for n in kept], members)
        _publish(folder, draft, engine, step)
    return open_library(folder)


def _publish(folder: Path, draft: Draft, engine: Engine | None, step: Step | None) -> None:
    stock = opened_stock(folder)
    try:
        publish(stock, draft, engine or Engine(), step or (lambda what, share: None))
    finally:
        stock.close()


def _named(name: str, entries: Sequence[Entry], folder: Path) -> list[int]:
    exact = [n for n, entry in enumerate(entries) if name in (entry.name, entry.file)]
    found = exact or [n for n, entry in enumerate(entries) if fnmatch.fnmatchcase(entry.name, name)]
    if not found:
        raise LibraryError(f"nothing in {folder} is named {name!r}; `onbeat moves show {folder}` lists what is")
    return found


def merge_libraries(
    folders: Sequence[Path], output: Path, *, engine: Engine | None = None, step: Step | None = None
) -> MoveLibrary:
    """Make one library of several that are on the same body; clips and pairs that are known are copied.

    Raises
    ------
    LibraryError
        If bodies, options or methods differ, or there is a library in ``output`` already.
    """
    stored = [read_stored(folder) for folder in folders]
    _refuse_others(folders, stored)
    if is_library(output):
        raise LibraryError(f"there is a library in {output} already; choose another folder")
    step = rising(step or (lambda what, share: None))
    with building(output):
        stock = opened_stock(output)
        try:
            publish(stock, _draft(stock, folders, stored, step), engine or Engine(), step)
        finally:
            stock.close()
    return open_library(output)


def _refuse_others(folders: Sequence[Path], stored: Sequence[Stored]) -> None:
    if len(folders) < 2:
        raise LibraryError("one library is whole already; give two or more to merge")
    one = stored[0].generation
    for folder, other in zip(folders, stored, strict=True):
        new = other.generation
        if (new.stage, new.skeleton) != (one.stage, one.skeleton):
            raise LibraryError(
                f"{folder} is on another body than {folders[0]}, or was built by another version; build one library "
                "of the motion files of both"
            )
        if new.options != one.options:
            raise LibraryError(f"{folder} was built with other options than {folders[0]}; build it again with the same")


def _draft(stock: Stock, folders: Sequence[Path], stored: Sequence[Stored], step: Step) -> Draft:
    """What all libraries hold together, copied into stock."""
    entries: list[Entry] = []
    rows: dict[int, list[Row]] = {}
    seen: dict[str, str] = {}
    for folder, one in zip(folders, stored, strict=True):
        _copy(stock, folder)
        first = len(entries)
        for entry in one.generation.entries:
            twin = seen.get(entry.content)
            if entry.problem is None and twin is not None:
                entry = entry._replace(problem=f"the same as {twin}")
            elif entry.problem is None:
                seen[entry.content] = entry.file
            entries.append(entry)
        for number, _ in one.generation.members:
            if entries[first + number].problem is None:
                rows[first + number] = stock.clips_of(entries[first + number].content, one.generation.stage)
    _leave_out_twins(stock, entries, rows, lambda share: step("comparing takes", COMPARED * share))
    new = stored[0].generation
    members = [(n, row) for n, found in rows.items() for row in found]
    named = _unique(entries, folders, stored)
    return Draft(new.method, new.options, new.reading, new.stage, new.skeleton, named, members)


def _leave_out_twins(
    stock: Stock, entries: list[Entry], rows: dict[int, list[Row]], step: Callable[[float], None]
) -> None:
    for later, earlier in twin_recordings(stock, rows, step).items():
        told = f"moves as {entries[earlier].name} does, all along"
        entries[later] = entries[later]._replace(problem=told)
        del rows[later]


def _unique(entries: Sequence[Entry], folders: Sequence[Path], stored: Sequence[Stored]) -> list[Entry]:
    """Entries of which no two are named alike: the library's name goes before a name that is there already."""
    origin = [folder.name for folder, one in zip(folders, stored, strict=True) for _ in one.generation.entries]
    taken: set[str] = set()
    unique: list[Entry] = []
    for entry, folder in zip(entries, origin, strict=True):
        name, count = entry.name, 1
        while name in taken:
            name = f"{folder}/{entry.name}" + (f" ({count})" if count > 1 else "")
            count += 1
        taken.add(name)
        unique.append(entry._replace(name=name))
    return unique


def _copy(stock: Stock, folder: Path) -> None:
    """Copy all that a library has in stock, clip by clip."""
    clips, pairs = (DiskShards(folder / SHARDS, series) for series in ("clips", "pairs"))
    with reading(folder / INDEX) as index:
        rows = select_clips(index, "ORDER BY shard, offset")
        stages = dict(index.execute("SELECT id, stage FROM clips"))
        readings = index.execute("SELECT content, method, body, seconds, notes, problem FROM readings").fetchall()
        blocks = index.execute("SELECT key, shard, offset, count FROM blocks").fetchall()
    for row in rows:
        stock.put_copy(row, stages[row.id], clips.read(row.span))
    for content, method, body, seconds, notes, problem in readings:
        told = tuple(msgspec.json.decode(notes, type=list[str]))
        stock.put_readings([Reading(content, body, seconds, told, problem)], method)
    for start in range(0, len(blocks), 1000):
        places = (
            (key, Span(shard, at, count * PAIR.itemsize)) for key, shard, at, count in blocks[start : start + 1000]
        )
        stock.put_blocks((key, pairs.read(span).view(PAIR)) for key, span in places if span.size)
