"""Confusion matrices as figures."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.viewer.plots.confusion import names_of, write_confusion


def test_what_is_right_lies_on_the_diagonal() -> None:
    rows, columns = names_of({"b": {"b": 2, "c": 1}, "a": {"new": 1, "b": 1}})
    assert rows == ["a", "b"]
    assert columns == ["a", "b", "c", "new"]


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_the_same_matrix_makes_the_same_bytes(tmp_path: Path, kind: str) -> None:
    confusion = {"bow & <turn>": {"bow & <turn>": 3}, r"$\frac{$": {"new": 1}}
    for name in ("a", "b"):
        write_confusion(tmp_path / f"{name}.{kind}", confusion, "task: 3 of 4 right")
    assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()


def test_many_names_are_drawn_too(tmp_path: Path) -> None:
    write_confusion(tmp_path / "many.png", {"step 0": {f"step {i}": 1 for i in range(62)}})
    assert (tmp_path / "many.png").stat().st_size > 1000
    with pytest.raises(OnbeatError, match="cannot draw"):
        write_confusion(tmp_path / "many.bmp", {"a": {"a": 1}})
