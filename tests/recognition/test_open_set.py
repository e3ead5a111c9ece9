"""What is new."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from made_segments import made
from onbeat.errors import MetricError
from onbeat.recognition.open_set import KNOWN_EPSILON, NEW_EPSILON, OpenSet, learn
from onbeat.recognition.tensor import TensorModel
from onbeat.recognition.voting import Matches

ALL = made(people=5, tasks=6, takes=4, noise=0.1)
NEW_TASK = np.isin(ALL.task, ["task 4", "task 5"])
NEW_PERSON = np.isin(ALL.person, ["person 4"])
TRAINING = ~NEW_TASK & ~NEW_PERSON & (ALL.cycle < 3)
PROBES = ALL.cycle == 3


@pytest.mark.parametrize(("mode", "new"), [("task", NEW_TASK), ("person", NEW_PERSON)])
def test_new_tasks_and_people_are_found_and_known_ones_kept(mode: str, new: np.ndarray):
    known = ALL[TRAINING]
    judged = learn(known, mode).judge(TensorModel.fit(known).match(ALL[PROBES], mode))
    other = (NEW_PERSON if mode == "task" else NEW_TASK)[PROBES]
    assert not judged.known[new[PROBES]].any()
    assert judged.known[~new[PROBES] & ~other].mean() > 0.8
    assert all(bool(names) == bool(on) for names, on in zip(judged.candidates, judged.known, strict=True))


def test_the_learned_threshold_accepts_its_quantile_of_held_out_takes():
    shares = []
    known = ALL[TRAINING]
    model = TensorModel.fit(known)
    probes = ALL[PROBES & ~NEW_TASK & ~NEW_PERSON]
    for quantile in (0.2, 0.5, 0.99):
        shares.append(learn(known, "task", quantile=quantile).judge(model.match(probes, "task")).known.mean())
    assert shares[0] <= shares[1] <= shares[2]
    assert shares[0] < 0.75
    assert shares[2] > 0.9


def test_the_papers_epsilon_is_two_sided():
    known = ALL[TRAINING]
    open_set = learn(known, "task", epsilon=KNOWN_EPSILON)
    assert open_set.two_sided
    matches = TensorModel.fit(known).match(known, "task")  # on their own model they are nearer than usual
    assert (open_set.deviations(matches).min(axis=1) < -KNOWN_EPSILON).any()
    assert open_set.judge(matches).known.mean() < learn(known, "task").judge(matches).known.mean() == 1.0


def test_deviations_compare_the_value_with_the_categorys_own():
    open_set = OpenSet("task", ("a", "b"), np.array([1.0, 2.0]), 0.05, two_sided=True)
    matches = Matches("task", ("a", "b"), np.zeros((3, 2)), np.array([[1.0, 6.0], [1.04, 2.04], [0.5, 9.0]]))
    judged = open_set.judge(matches)
    assert judged.deviations[0].tolist() == [0.0, 0.5]
    assert judged.candidates == (("a",), ("a", "b"), ())
    assert judged.margins.round(3).tolist() == [0.05, 0.04, -0.283]


def test_a_take_is_measured_against_its_own_category():
    calm = ALL[TRAINING]
    wild = np.random.default_rng(0).normal(size=calm.positions.shape)
    wild[np.array(calm.task) != "task 0"] = 0
    mixed = replace(calm, positions=calm.positions + wild)
    open_set = learn(mixed, "task")
    assert open_set.values[0] > 10 * open_set.values[1:].max()
    assert open_set.epsilon < 0.5  # measured against the mean of all, the wild task would be far beyond


def test_a_margin_says_by_how_much():
    known = ALL[TRAINING]
    open_set, model = learn(known, "task"), TensorModel.fit(known)
    near = known[[0]]
    margins = [
        float(open_set.judge(model.match(replace(near, positions=near.positions + far), "task")).margins[0])
        for far in (0.0, 0.5, 1.0, 5.0)
    ]
    assert margins == sorted(margins, reverse=True)
    assert margins[0] > 0 > margins[-1]


def test_how_the_model_is_fitted_is_up_to_the_caller():
    known = ALL[TRAINING]
    low = partial(TensorModel.fit, ranks=(6, None, None))
    assert not np.allclose(learn(known, "task", low).values, learn(known, "task").values)


def test_a_category_of_one_take_takes_the_mean_of_the_others():
    known = ALL[TRAINING & ~((np.array(ALL.task) == "task 0") & (ALL.cycle > 0))]
    values = learn(known, "task").values
    assert values[0] == pytest.approx(np.mean(values[1:]))


def test_one_take_tells_nothing_of_what_is_usual():
    with pytest.raises(MetricError, match="no task has segments of two takes"):
        learn(made(takes=1), "task")
    with pytest.raises(MetricError, match="no person has segments of two takes"):
        learn(made(people=1, tasks=1, takes=1), "person")


def test_what_cannot_be_judged_is_refused():
    known = ALL[TRAINING]
    with pytest.raises(MetricError, match="epsilon 0"):
        learn(known, "task", epsilon=0.0)
    with pytest.raises(MetricError, match="quantile nan"):
        learn(known, "task", quantile=float("nan"))
    with pytest.raises(MetricError, match="no mode 'cycle'"):
        learn(known, "cycle")
    with pytest.raises(MetricError, match="2 takes of"):
        learn(known, "task", takes=[0, 1])
    with pytest.raises(MetricError, match="cannot be judged by the thresholds of task"):
        learn(known, "task", epsilon=NEW_EPSILON).judge(TensorModel.fit(known).match(known, "person"))
