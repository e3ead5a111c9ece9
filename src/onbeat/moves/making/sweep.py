"""What no generation needs any longer, swept out of a library's folder."""

from __future__ import annotations

import contextlib
import shutil
from pathlib import Path

from onbeat.moves.disk.graph_files import drop_graphs
from onbeat.moves.disk.index import FORMER, committed
from onbeat.moves.disk.shards import DiskShards
from onbeat.moves.engines.cluster import MARK
from onbeat.moves.making.compact import compact
from onbeat.moves.making.generations import Generation
from onbeat.moves.making.joining import Join
from onbeat.moves.making.stock import SHARDS, Stock

SPOOL = ".joins"
"""Folder in which joins are collected while a graph is made."""


def sweep(stock: Stock, current: Generation, join: Join) -> None:
    """Forget readings, clips and blocks that the current generation does not use, and delete files without any."""
    index = stock.index
    keys = ((join.key(a, b),) for a in range(len(join.lots)) for b in range(a, len(join.lots)))
    with committed(index):
        index.execute("CREATE TEMP TABLE IF NOT EXISTS used (key BLOB PRIMARY KEY) WITHOUT ROWID")
        index.execute("DELETE FROM used")
        index.executemany("INSERT INTO used VALUES (?)", keys)
        index.execute("DELETE FROM blocks WHERE key NOT IN (SELECT key FROM used)")
        index.execute("DELETE FROM clips WHERE id NOT IN (SELECT clip FROM members)")
        stale = "content NOT IN (SELECT content FROM recordings) OR method NOT IN (?, ?)"
        index.execute(f"DELETE FROM readings WHERE {stale}", (current.reading, current.stage))
    if stock.folder is not None and isinstance(stock.clips, DiskShards) and isinstance(stock.pairs, DiskShards):
        stock.clips.drop(shard for (shard,) in stock.rows("SELECT DISTINCT shard FROM clips"))
        stock.pairs.drop(shard for (shard,) in stock.rows("SELECT DISTINCT shard FROM blocks"))
        compact(stock)
        drop_graphs(stock.folder, current.graph)
        _drop_leftovers(stock.folder)


def _drop_leftovers(folder: Path) -> None:
    """Delete the spool, marks of runs that were killed, and the arrays of a library of a former version."""
    with contextlib.suppress(OSError):
        shutil.rmtree(folder / SPOOL)
    for mark in (folder / SHARDS).glob(f"{MARK}*"):
        with contextlib.suppress(OSError):
            mark.unlink()
    if (folder / FORMER).is_file():
        (folder / FORMER).unlink()
        for path in [*folder.glob("data-*"), *folder.glob(".data-*")]:
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
