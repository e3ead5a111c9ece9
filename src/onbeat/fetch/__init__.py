"""Motion capture and songs by one word: known sources, their licences, downloads that go on and are checked."""

from onbeat.fetch.fetching import fetch
from onbeat.fetch.places import data_folder, fetched_moves, fetched_song
from onbeat.fetch.receipts import Receipt, receipt_above, receipt_of
from onbeat.fetch.sources import Source, all_sources, source_named

__all__ = [
    "Receipt",
    "Source",
    "all_sources",
    "data_folder",
    "fetch",
    "fetched_moves",
    "fetched_song",
    "receipt_above",
    "receipt_of",
    "source_named",
]
