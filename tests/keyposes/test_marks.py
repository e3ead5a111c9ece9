"""Marked keyposes as people write them."""

from pathlib import Path

import pytest

from onbeat.errors import MetricError
from onbeat.keyposes.marks import read_marks


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1.5\n2.25\n", [1.5, 2.25]),
        ("# seconds\n1.5\n\n2\n", [1.5, 2.0]),
        ("time,label\n1.5,left arm up\n2.5,bow\n", [1.5, 2.5]),
        ("1.5 left arm up\n2.5\tbow\n", [1.5, 2.5]),
        ("1.5;1\n2.5;2\n", [1.5, 2.5]),
        ("\ufeff3.0\r\n", [3.0]),
    ],
)
def test_the_first_column_is_the_second(tmp_path: Path, text: str, expected: list[float]) -> None:
    path = tmp_path / "a.keyposes.csv"
    path.write_text(text, encoding="utf-8")
    assert read_marks(path).tolist() == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1,5\n", "csv:1: '1,5' may be one number or two; write a point, as in 1.5"),
        ("1.0\nx\n", "csv:2: 'x' is no second"),
        ("2.0\n1.0\n", "csv:2: 1.0 does not follow 2"),
        ("1.0\nnan\n", "csv:2: nan does not follow 1"),
        ("99\n", "csv:1: a keypose at 99 s, but the motion goes from 0 to 23.00 s"),
        ("-1\n", "a keypose at -1 s"),
        ("", "marks no keypose"),
        ("# nothing\n", "marks no keypose"),
    ],
)
def test_what_cannot_be_is_told_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.keyposes.csv"
    path.write_text(text)
    with pytest.raises(MetricError) as told:
        read_marks(path, 23.0)
    assert message in str(told.value)


def test_a_file_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00")
    for path in (tmp_path / "none.csv", tmp_path, tmp_path / "b.csv"):
        with pytest.raises(MetricError, match="cannot read"):
            read_marks(path)
