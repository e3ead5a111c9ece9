"""Variety: what is shown, and shown again."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat.errors import MetricError
from onbeat.metrics import variety

SPAN = st.tuples(st.integers(0, 2), st.integers(0, 80), st.integers(0, 40)).map(
    lambda s: (s[0], s[1] / 8, (s[1] + s[2]) / 8)
)
MOVES = st.lists(SPAN, max_size=8)


def test_nothing_repeated() -> None:
    found = variety.evaluate([(0, 0.0, 2.0), (1, 3.0, 5.0), (0, 2.0, 4.0)], 6.0)
    assert found == {
        "distinct_s": 6.0,
        "repeated_s": 0.0,
        "repeated_cells_s": 0.0,
        "longest_repeat_s": 0.0,
        "joins_per_minute": 20.0,
    }


def test_each_showing_beyond_the_first_counts() -> None:
    found = variety.evaluate([(0, 0.0, 3.0), (1, 0.0, 1.0), (0, 1.0, 3.0), (0, 2.5, 4.0)], 7.5)
    assert found["distinct_s"] == 5.0
    assert found["repeated_s"] == 2.5
    assert found["repeated_cells_s"] == 2.5
    assert found["longest_repeat_s"] == 2.0


def test_a_mirrored_clip_repeats_its_source_in_the_strict_variant() -> None:
    found = variety.evaluate([(0, 0.0, 3.0), (1, 1.0, 3.0)], 5.0, sources=[0, 0])
    assert found["repeated_s"] == 0.0
    assert found["repeated_s_strict"] == 2.0
    assert found["longest_repeat_s_strict"] == 2.0
    assert found["distinct_s_strict"] == 3.0


def test_a_cell_counts_when_half_of_it_is_shown() -> None:
    assert variety.repeated_cells([(0, 0.0, 0.75), (0, 0.75, 1.5)]) == 0.5
    assert variety.repeated_cells([(0, 0.0, 0.7), (0, 0.7, 1.5)]) == 0.0


def test_no_moves_and_one_move() -> None:
    assert set(variety.evaluate([], 5.0).values()) == {0.0}
    one = variety.evaluate([(3, 1.0, 2.0)], 1.0)
    assert (one["distinct_s"], one["joins_per_minute"], one["longest_repeat_s"]) == (1.0, 0.0, 0.0)


@given(MOVES)
def test_order_does_not_matter_and_parts_add_up(moves: list[variety.Span]) -> None:
    forth, back = (variety.evaluate(m, 10.0, [0, 1, 1]) for m in (moves, moves[::-1]))
    assert forth == pytest.approx(back)
    shown = sum(end - start for _, start, end in moves)
    assert forth["distinct_s"] + forth["repeated_s"] == pytest.approx(shown)
    assert forth["repeated_s_strict"] >= forth["repeated_s"] - 1e-9
    assert forth["longest_repeat_s"] <= forth["repeated_s"] + 1e-9


@given(MOVES)
def test_distinct_seconds_by_counting_eighths(moves: list[variety.Span]) -> None:
    eighths = {(clip, k) for clip, start, end in moves for k in range(round(start * 8), round(end * 8))}
    assert variety.distinct_seconds(moves) == pytest.approx(len(eighths) / 8)


@pytest.mark.parametrize(
    ("moves", "duration", "sources", "message"),
    [
        ([(0, 2.0, 1.0)], 5.0, None, "move 0 shows clip 0 from 2.0 s to 1.0 s"),
        ([(0, 0.0, 1.0), (0, np.nan, 1.0)], 5.0, None, "move 1 shows clip 0 from nan s"),
        ([(-1, 0.0, 1.0)], 5.0, None, "move 0 shows clip -1; 0 or more is needed"),
        ([(2, 0.0, 1.0)], 5.0, [0, 1], "move 0 shows clip 2; 0…1 is needed"),
        ([], 0.0, None, "the duration is 0.0 s"),
    ],
)
def test_bad_input_is_named(moves: list, duration: float, sources: list[int] | None, message: str) -> None:
    with pytest.raises(MetricError, match=message):
        variety.evaluate(moves, duration, sources)
