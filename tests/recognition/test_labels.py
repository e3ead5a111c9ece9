"""Label files say what they hold, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.recognition.labels import Label, read_labels

HEAD = "file,from,to,task,person,cycle\n"


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "labels.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_labels_are_read_in_order_and_files_found_beside_them(tmp_path: Path):
    path = written(tmp_path, HEAD + 'a/b.bvh,0.5,1.75,bow,Aiko,2\n\n"c,d.bvh",0,1,,,\n')
    assert read_labels(path) == [
        Label(tmp_path / "a/b.bvh", 0.5, 1.75, "bow", "Aiko", 2, 2),
        Label(tmp_path / "c,d.bvh", 0.0, 1.0, "", "", 0, 4),
    ]


def test_columns_may_be_in_any_order_and_some_left_out(tmp_path: Path):
    (label,) = read_labels(written(tmp_path, "To , from,FILE\r\n2,1,x.bvh\r\n"))
    assert (label.start, label.end, label.task, label.person, label.cycle) == (1, 2, "", "", 0)


def test_a_stretch_without_seconds_is_the_whole_file(tmp_path: Path):
    rows = read_labels(written(tmp_path, HEAD + "x.bvh,,,bow,Aiko,0\nx.bvh,2,,bow,Aiko,1\nx.bvh,,2,bow,Aiko,1\n"))
    assert [(row.start, row.end) for row in rows] == [(0, np.inf), (2, np.inf), (0, 2)]
    (row,) = read_labels(written(tmp_path, "file,task\nx.bvh,bow\n"))
    assert (row.start, row.end, row.task) == (0, np.inf, "bow")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", ":1: no column file"),
        ("file,to\nx,1\n", ":1: no column from"),
        ("file,from\nx,1\n", ":1: no column to"),
        (HEAD, "no label found"),
        (HEAD + "x.bvh,0,1\n", ":2: 3 values found, 6 expected"),
        (HEAD + "x.bvh,zero,1,,,\n", ":2: from is 'zero'"),
        (HEAD + "x.bvh,0,nan,,,\n", ":2: to is 'nan'"),
        (HEAD + "x.bvh,2,1,,,\n", ":2: from 2 to 1 s"),
        (HEAD + "x.bvh,0,1,,,half\n", ":2: cycle is 'half'"),
        (HEAD + "x.bvh,0,1,,,1.5\n", ":2: cycle '1.5' found"),
        (HEAD + ",0,1,,,\n", ":2: no file is named"),
        (HEAD + "a\0b,0,1,,,\n", "no file is named|no CSV"),
        (HEAD + '"' + "x" * 200_000 + '",0,1,,,\n', "no CSV: field larger"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path: Path, text: str, says: str):
    with pytest.raises(FormatError, match=says):
        read_labels(written(tmp_path, text))


def test_a_file_that_is_not_there_or_no_text_is_refused(tmp_path: Path):
    with pytest.raises(FormatError, match="cannot read"):
        read_labels(tmp_path / "none.csv")
    with pytest.raises(FormatError):
        read_labels(written(tmp_path, bytes(range(256)) * 10))
