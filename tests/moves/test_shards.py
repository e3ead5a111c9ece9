"""Shards only grow, and what no row of an index names is written over."""

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.moves.disk import shards
from onbeat.moves.disk.shards import DiskShards, MemoryShards, Span


@pytest.mark.parametrize("made", [lambda folder: DiskShards(folder, "clips"), lambda folder: MemoryShards()])
def test_what_was_written_is_read(tmp_path, made):
    series = made(tmp_path / "shards")
    spans = [series.append([np.arange(n, dtype=np.float32), np.arange(n)[::2]]) for n in (5, 0, 40)]
    series.sync()
    assert series.read(spans[0])[:20].view(np.float32).tolist() == [0, 1, 2, 3, 4]
    assert series.read(spans[2])[160:].view(np.int64).tolist() == list(range(0, 40, 2))
    assert len(series.read(spans[1])) == 0


def test_a_new_file_is_begun_when_one_is_full_and_empty_ones_go(tmp_path, monkeypatch):
    monkeypatch.setattr(shards, "SHARD", 100)
    series = DiskShards(tmp_path, "clips")
    spans = [series.append([np.full(8, n, np.int64)]) for n in range(5)]
    assert [span.shard for span in spans] == [0, 0, 1, 1, 2]
    assert [int(series.read(span).view(np.int64)[0]) for span in spans] == [0, 1, 2, 3, 4]
    series.drop({1})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["clips-00001.bin", "clips-00002.bin"]
    series.close()


def test_bytes_that_nobody_names_are_written_over(tmp_path):
    first = DiskShards(tmp_path, "clips")
    good = first.append([np.arange(10)])
    first.append([np.full(1000, 7)])  # its builder was killed before it was named
    first.close()
    second = DiskShards(tmp_path, "clips", good.end)
    other = second.append([np.arange(3)])
    second.close()
    assert other == Span(0, 128, 24)
    assert (tmp_path / "clips-00000.bin").stat().st_size == 152
    assert second.read(good).view(np.int64).tolist() == list(range(10))


@pytest.mark.parametrize("span", [Span(0, 0, 81), Span(0, 80, 1), Span(1, 0, 1), Span(0, -8, 8)])
def test_a_place_that_is_not_there_is_told(tmp_path, span):
    series = DiskShards(tmp_path, "clips")
    series.append([np.arange(10)])
    with pytest.raises(LibraryError, match="build the library again"):
        series.read(span)
    series.close()
