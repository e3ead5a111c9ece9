"""Work of several threads that comes out in order."""

from __future__ import annotations

import threading

import pytest

from onbeat.viewer.film.in_order import in_order


def test_what_is_made_late_still_comes_in_its_turn() -> None:
    second = threading.Event()

    def make(number: int) -> int:
        if number == 0:
            assert second.wait(20)  # the first is made after the second
        if number == 1:
            second.set()
        return number

    assert list(in_order(9, make, threads=2)) == list(range(9))


def test_only_a_few_are_made_ahead_and_none_once_it_is_closed() -> None:
    made: list[int] = []
    taken = in_order(1000, lambda number: made.append(number) or number, threads=2)
    assert [next(taken) for _ in range(3)] == [0, 1, 2]
    taken.close()
    assert len(made) <= 3 + 4


def test_what_goes_wrong_is_raised_in_its_turn() -> None:
    taken = in_order(5, lambda number: 1 // (2 - number), threads=3)
    assert [next(taken), next(taken)] == [0, 1]
    with pytest.raises(ZeroDivisionError):
        next(taken)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_few_things(count: int) -> None:
    assert list(in_order(count, str, threads=4)) == [str(number) for number in range(count)]
