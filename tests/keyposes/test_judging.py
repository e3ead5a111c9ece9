import json
import math

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.keyposes.judging import SPACES, AnswersDocument, trials, verdict, verdict_of


def answers(*chosen, a="keyposes", b="uniform", dims=3):
    rows = [{"motion": "Aiko", "a": a, "b": b, "chosen": one, "seconds": 1.5} for one in chosen]
    return json.dumps({"version": 1, "dims": dims, "answers": rows}).encode()


def test_each_motion_is_asked_and_keyposes_are_as_often_a_as_b():
    names = [f"person {n}" for n in range(9)]
    asked = trials(names, np.random.default_rng(0), repeats=2)
    assert sorted(trial.motion for trial in asked) == sorted(2 * names)
    assert sum(trial.a == "keyposes" for trial in asked) == 9
    assert all({trial.a, trial.b} == set(SPACES) for trial in asked)
    assert {(trial.motion, trial.stretch) for trial in asked} == {(name, n) for name in names for n in (0, 1)}


def test_the_seed_draws_the_order():
    names = [f"person {n}" for n in range(9)]
    first, again, other = (trials(names, np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert first == again != other


def test_the_test_is_the_sum_of_binomial_chances():
    found = verdict(8, 9)
    assert found.p == pytest.approx(2 * (math.comb(9, 8) + 1) / 2**9)
    # Clopper and Pearson: at the bounds 8 or more, and 8 or fewer, of 9 have a chance of 2.5 %.
    above = sum(math.comb(9, k) * found.low**k * (1 - found.low) ** (9 - k) for k in (8, 9))
    assert above == pytest.approx(0.025)
    assert 1 - found.high**9 == pytest.approx(0.025)


def test_the_papers_answers_are_no_chance():
    found = verdict(92, 102)
    assert (round(found.low, 2), round(found.high, 2)) == (0.83, 0.95)
    assert found.p < 1e-15
    assert verdict(51, 102).p == 1.0


def test_answers_of_several_people_are_counted_by_what_was_shown():
    one = AnswersDocument.from_json(answers("a", "a", "b"))
    other = AnswersDocument.from_json(answers("a", "b", a="uniform", b="keyposes"))
    found = verdict_of([one, other])
    assert (found.chosen, found.trials) == (3, 5)


def test_answers_on_motions_in_other_dimensions_are_not_counted_together():
    documents = [AnswersDocument.from_json(answers("a", dims=dims)) for dims in (3, 2, 3)]
    with pytest.raises(MetricError, match="of 2 and of 3 dimensions"):
        verdict_of(documents)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "not a file of answers"),
        (b"[" * 100000, "not a file of answers"),
        (b'{"version": 1}', "not a file of answers"),
        (b'{"version": 3, "dims": 1, "answers": []}', "version 3"),
        (answers("c"), "answer 0 chose 'c'"),
        (answers("a", b="keyposes"), "'keyposes' and 'keyposes'"),
    ],
)
def test_what_are_no_answers_is_told(data, told):
    with pytest.raises(MetricError, match=told):
        AnswersDocument.from_json(data, "x.json")


def test_no_answer_is_no_verdict():
    with pytest.raises(MetricError, match="one answer at least"):
        verdict_of([])
    with pytest.raises(MetricError, match="0 of 0"):
        verdict(0, 0)
    with pytest.raises(MetricError, match="5 of 4"):
        verdict(5, 4)
