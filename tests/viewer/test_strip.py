"""The strip of a film: what its marks are is written beside them, where there are any and there is room."""

from __future__ import annotations

import numpy as np

from onbeat.viewer.film.strip import PAPER, Strip


def corner(stops: list[float], height: int, marked: str = "stops") -> np.ndarray:
    """Which pixels of the upper left corner are drawn on."""
    strip = Strip.of(None, None, np.array(stops), 10.0, height, 640, marked)
    return (strip.coming[: height // 3, :160] != PAPER).any(axis=2)


def test_marks_are_named_where_there_is_room() -> None:
    assert corner([2.0, 5.0], 72).sum() > 50
    assert corner([2.0, 5.0], 72, "keyposes").sum() > 1.3 * corner([2.0, 5.0], 72).sum()
    assert not corner([], 72).any()
    assert not corner([2.0, 5.0], 24).any()
