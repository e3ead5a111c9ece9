"""Shards written anew without what no row names, where most of them is of no use any longer."""

from __future__ import annotations

import contextlib
from typing import NamedTuple

from onbeat.errors import LibraryError
from onbeat.moves.disk.index import committed
from onbeat.moves.disk.shards import DiskShards, Span
from onbeat.moves.making.stock import PAIR, Stock

SPARE = 64 << 20
"""Bytes of no use that are left alone."""


class Series(NamedTuple):
    """A series of shards, and the table of the index that names places in it."""

    shards: DiskShards
    table: str
    key: str
    size: str


def compact(stock: Stock) -> None:
    """Write those series anew of whose bytes more than half are of no use; a disk too full for it is no error."""
    if isinstance(stock.clips, DiskShards) and isinstance(stock.pairs, DiskShards):
        for series in (
            Series(stock.clips, "clips", "id", "size"),
            Series(stock.pairs, "blocks", "key", f"count * {PAIR.itemsize}"),
        ):
            with contextlib.suppress(LibraryError, OSError):
                if _is_mostly_waste(stock, series):
                    _rewrite(stock, series)


def _is_mostly_waste(stock: Stock, series: Series) -> bool:
    ((used,),) = stock.rows(f"SELECT coalesce(sum({series.size}), 0) FROM {series.table}")
    return series.shards.bytes_on_disk() > 2 * used + SPARE


def _rewrite(stock: Stock, series: Series) -> None:
    """Copy all places to new files, name them in one transaction, and delete the old files."""
    query = f"SELECT {series.key}, shard, offset, {series.size} FROM {series.table} ORDER BY shard, offset"
    rows = stock.rows(query)
    series.shards.begin_anew()
    moved = [(series.shards.append([series.shards.read(Span(*place))]), key) for key, *place in rows]
    series.shards.sync()
    with stock.storing(), committed(stock.index):
        stock.index.executemany(
            f"UPDATE {series.table} SET shard = ?, offset = ? WHERE {series.key} = ?",
            [(span.shard, span.offset, key) for span, key in moved],
        )
    series.shards.drop({span.shard for span, _ in moved})
