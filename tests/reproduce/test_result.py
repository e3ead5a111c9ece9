"""Tables have as many cells as heads, and parts have numbers of their own."""

import pytest

from made_results import RESULT
from onbeat.errors import OnbeatError
from onbeat.reproduce.result import FigureResult, PaperResult, Row, TableResult


def test_a_row_has_a_cell_under_each_head():
    with pytest.raises(OnbeatError, match=r"Table I: 5 cells under 4 heads"):
        TableResult("Table I", "Beats", (Row("song", "0.6", "0.5", "", ("0.4",)),))


def test_what_a_claim_points_to_and_is_not_there_is_left_out():
    assert RESULT.claims[0].see == ("Table I",)
    assert RESULT.claims[0].told == "12 of 13 (Table I)"


def test_two_parts_cannot_have_one_number():
    figures = tuple(FigureResult("Fig. 5", "paths", b"<svg/>", "a diagram", "a decision") for _ in range(2))
    with pytest.raises(OnbeatError, match=r"P1: more than one Fig\. 5"):
        PaperResult("P1", "dance", "somebody", "songs", "others", (), (), figures)
