"""A library on disk, opened: its clips are read when they are asked for.

A reader holds what it mapped, so it is not disturbed by a builder: it sees the library as of the moment it was opened.
docs/library.md tells what lies where.
"""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Ints
from onbeat.errors import LibraryError
from onbeat.moves.disk.bodies import skeleton_of
from onbeat.moves.disk.graph_files import open_graph
from onbeat.moves.disk.index import FORMER, INDEX, reading
from onbeat.moves.disk.layout import Label, stored_clip
from onbeat.moves.disk.shards import DiskShards, Shards
from onbeat.moves.graph import MotionGraph
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.moves.making.clips import MIRROR_SUFFIX
from onbeat.moves.making.generations import Generation, notes_of, read_generation, rows_of
from onbeat.moves.making.stock import SHARDS, Row
from onbeat.moves.recordings import About


class Stored(NamedTuple):
    """What the index says of a library: the generation, the rows of its clips, and what was assumed."""

    generation: Generation
    rows: list[Row]
    notes: list[str]

    @classmethod
    def of(cls, index: sqlite3.Connection) -> Stored | None:
        """All of it; nothing before the first build is done."""
        generation = read_generation(index)
        return None if generation is None else cls(generation, rows_of(index, generation), notes_of(index, generation))

    @property
    def clip_of(self) -> Ints:
        """(N,) the clip of each graph frame."""
        return np.repeat(np.arange(len(self.rows)), [row.shape.poses for row in self.rows])


def is_library(folder: Path) -> bool:
    """Whether a folder holds a library, be it of a former version."""
    return (folder / INDEX).is_file() or (folder / FORMER).is_file()


def open_library(folder: str | os.PathLike[str]) -> MoveLibrary:
    """Open a library that was built.

    Raises
    ------
    LibraryError
        If there is none, or it is damaged or of another version: then it is to be built again.
    """
    place = Path(folder)
    stored = read_stored(place)
    try:
        return _opened(place, stored)
    except LibraryError:
        newer = read_stored(place)  # a builder may just have replaced it
        if newer.generation.content == stored.generation.content:
            raise
        return _opened(place, newer)


def read_stored(folder: Path) -> Stored:
    """What the index of a library's folder says."""
    if not (folder / INDEX).is_file():
        if (folder / FORMER).is_file():
            raise LibraryError(f"{folder} holds a library of a former version; build the library again")
        raise LibraryError(f"no library in {folder}; build one with `onbeat moves build FOLDER -o {folder}`")
    with reading(folder / INDEX) as index:
        if (stored := Stored.of(index)) is None:
            raise LibraryError(f"the library in {folder} was not built to the end; run the same build again")
        return stored


def _opened(folder: Path, stored: Stored) -> MoveLibrary:
    shards = DiskShards(folder / SHARDS, "clips")
    last = {row.span.shard: row.span for row in sorted(stored.rows, key=lambda row: row.span.offset + row.span.size)}
    for span in last.values():
        shards.read(span)  # maps each file: no place in it is beyond its end
    return library_of(stored, shards, open_graph(folder, stored.generation.graph, stored.clip_of))


def library_of(stored: Stored, shards: Shards, graph: MotionGraph) -> MoveLibrary:
    """The library that an index describes."""
    entries = stored.generation.entries
    problems = tuple(f"{entry.file}: {entry.problem}" for entry in entries if entry.problem is not None)
    return MoveLibrary(tuple(_clips(stored, shards)), graph, problems, tuple(stored.notes))


def _clips(stored: Stored, shards: Shards) -> list[Clip]:
    skeleton = skeleton_of(stored.generation.skeleton)
    sources = _sources(stored)
    clips: list[Clip] = []
    originals: dict[str, Clip] = {}
    for (number, _), row in zip(stored.generation.members, stored.rows, strict=True):
        entry = stored.generation.entries[number]
        name = entry.name + row.stretch.suffix
        if row.shape.joints != len(skeleton):
            raise LibraryError(f"the library is damaged ({name} has {row.shape.joints} joints); build it again")
        original = originals.get(row.content) if row.shape.mirrored else None
        if row.shape.mirrored and original is None:
            raise LibraryError(f"the library is damaged ({name} has no original); build the library again")
        name += MIRROR_SUFFIX if row.shape.mirrored else ""
        label = Label(name, sources[number, row.content], About(entry.performer, entry.genre, entry.licence))
        clip = stored_clip(shards, row.span, row.shape, skeleton, label, original)
        originals.setdefault(row.content, clip)
        clips.append(clip)
    return clips


def _sources(stored: Stored) -> dict[tuple[int, str], int]:
    """For each stretch of a recording that clips were made of, which it is among these."""
    stretches = [(n, row.content) for (n, _), row in zip(stored.generation.members, stored.rows, strict=True)]
    return {stretch: source for source, stretch in enumerate(dict.fromkeys(stretches))}
