"""Protocols ask what they say they ask: every learner sees only what it may learn from."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.examples.troupe import FIGURES
from onbeat.recognition.hard_troupe import hard_troupe
from onbeat.recognition.protocols import both_new, crossed, known_set, open_set, paper_tables, score
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import Segments
from recognition_takes import takes


class Said(NamedTuple):
    task: str
    person: str
    margins: tuple[float, float]


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


class Oracle:
    """Knows the truth, says new of what it was not taught, and keeps what it was shown."""

    def __init__(self) -> None:
        self.taught: list[Segments] = []
        self.asked: list[Segments] = []

    def __call__(self, segments: Segments, rng: np.random.Generator) -> Callable[[Segments], list[Said]]:
        self.taught.append(segments)

        def answer(probes: Segments) -> list[Said]:
            self.asked.append(probes)
            return [
                Said(t, p, (1.0 if t in segments.task else -1.0, 1.0 if p in segments.person else -1.0))
                for t, p in zip(probes.task, probes.person, strict=True)
            ]

        return answer


def test_no_take_that_teaches_probes():
    oracle = Oracle()
    assert known_set(takes(3), oracle, rng(), (0, 2))["task"].share == 1
    assert set(oracle.taught[0].cycle.tolist()) == {0, 2}
    assert set(oracle.asked[0].cycle.tolist()) == {1}


def test_across_people_no_person_who_probes_was_seen():
    oracle = Oracle()
    assert crossed(takes(2), oracle, "task", rng())[:2] == (32, 32)
    assert all(not set(a.person) & set(b.person) for a, b in zip(oracle.taught, oracle.asked, strict=True))
    oracle = Oracle()
    crossed(takes(2), oracle, "person", rng())
    assert all(not set(a.task) & set(b.task) for a, b in zip(oracle.taught, oracle.asked, strict=True))


def test_an_open_set_leaves_out_every_pair():
    oracle = Oracle()
    found = open_set(takes(2), oracle, "task", rng())
    assert (found.auroc, found.known_and_right.share, found.new_found.share) == (1, 1, 1)
    assert len({frozenset(one.task) for one in oracle.taught}) == 6
    assert all(set(one.cycle.tolist()) == {0} for one in oracle.taught)


def test_aliens_are_new_in_both():
    oracle = Oracle()
    assert both_new(takes(2), oracle, rng(), left_out=1)["person"].new_found[:2] == (16, 16)
    assert len(oracle.taught) == 16


def test_the_papers_tables_have_the_papers_sizes():
    oracle = Oracle()
    found = paper_tables(takes(4, tasks=6, people=8), oracle, rng())
    assert [one.of for one in found] == [48, 48, 24, 24, 12, 12]
    assert all(one.share == 1 for one in found)
    assert (len(set(oracle.taught[1].task)), len(set(oracle.taught[1].person))) == (4, 4)


def test_too_few_people_for_the_papers_tables_are_counted():
    with pytest.raises(MetricError, match="4 tasks by 4 people"):
        paper_tables(takes(4), Oracle(), rng())


def test_one_take_cannot_be_measured():
    with pytest.raises(MetricError, match="more takes"):
        known_set(takes(1), Oracle(), rng())


def test_the_interval_holds_the_share_and_is_wide_where_cells_differ():
    right = np.repeat([True, False], 20)
    mixed, split = score(np.tile([True, False], 20), ["a", "a", "b", "b"] * 10), score(right, ["a"] * 20 + ["b"] * 20)
    assert split.low <= split.share <= split.high
    assert split.high - split.low > mixed.high - mixed.low


def test_the_harder_the_troupe_the_less_are_takes_alike():
    def apart(hardness: float) -> float:
        two = hard_troupe(hardness, rng(), FIGURES[1:2], takes=2)
        return float(np.abs(two.positions[0::2] - two.positions[1::2]).mean())

    assert apart(0.0) < 0.5 * apart(0.5) < 0.5 * apart(1.5)


def test_a_prediction_is_an_answer():
    learner = lambda segments, rng: Recogniser.train(segments, rng).predict  # noqa: E731
    assert known_set(takes(2), learner, rng())["task"].share == 1
