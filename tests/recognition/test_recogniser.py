"""The recogniser as a whole: known, crossed, new; what it is told, and what it says of poor input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition import choice
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import Segments
from recognition_takes import takes


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


@pytest.fixture(scope="module")
def known() -> Segments:
    return takes(3)


@pytest.fixture(scope="module")
def recogniser(known: Segments) -> Recogniser:
    return Recogniser.train(known, rng())


def share(said: list[str], true: tuple[str, ...]) -> float:
    return float(np.mean([a == b for a, b in zip(said, true, strict=True)]))


def chosen(segments: Segments, **not_: str) -> Segments:
    return segments[[all(getattr(segments, k)[i] != v for k, v in not_.items()) for i in range(len(segments))]]


def test_other_takes_are_known_again(recogniser: Recogniser):
    probes = takes(2, seed=1)
    found = recogniser.predict(probes)
    assert share([one.task for one in found], probes.task) == 1
    assert share([one.person for one in found], probes.person) == 1
    assert np.mean([one.task_known and one.person_known for one in found]) > 0.8


def test_a_task_is_known_across_people_and_a_person_across_tasks(known: Segments):
    probes = takes(1, seed=1)
    for factor, other, left in (("task", "person", "Ben"), ("person", "task", "push")):
        at = [i for i in range(len(probes)) if getattr(probes, other)[i] == left]
        found = Recogniser.train(chosen(known, **{other: left}), rng()).predict(probes[at])
        assert share([getattr(one, factor) for one in found], getattr(probes[at], factor)) == 1


def test_what_was_left_out_is_new(known: Segments):
    found = Recogniser.train(chosen(known, task="wave", person="Dora"), rng()).predict(takes(2, seed=1))
    said = {(t, p): one for t, p, one in zip(takes(2, seed=1).task, takes(2, seed=1).person, found, strict=True)}
    new = [not one.task_known for (task, _), one in said.items() if task == "wave"]
    assert np.mean(new) > 0.8
    assert not said["lift", "Dora"].person_known
    assert said["lift", "Ana"].task_known
    assert said["lift", "Ana"].person_known


def test_what_is_beyond_a_repetition_is_perhaps_known_across_the_other_factor(known: Segments):
    drawn = rng()
    model = Recogniser.train(chosen(known, task="wave", person="Dora"), drawn, newcomers=True)
    guesses = {
        pair: [
            one for one, *of in zip(model.predict(known), known.task, known.person, strict=True) if tuple(of) == pair
        ]
        for pair in (("lift", "Dora"), ("wave", "Ana"), ("wave", "Dora"), ("lift", "Ana"))
    }
    assert [one.said("task") for one in guesses["lift", "Dora"]] == ["lift"] * 3
    assert "task" in {one.perhaps for one in guesses["lift", "Dora"]}
    assert [one.said("person") for one in guesses["wave", "Ana"]] == ["Ana"] * 3
    assert {one.said("task") for one in guesses["wave", "Ana"]} == {""}
    assert {(one.perhaps, one.said("task")) for one in guesses["wave", "Dora"]} == {(None, "")}
    assert {one.perhaps for one in guesses["lift", "Ana"]} == {None}
    # Nothing else is another for it: neither what is known, nor what is drawn next.
    other = rng()
    plain = Recogniser.train(chosen(known, task="wave", person="Dora"), other)
    assert other.integers(1 << 40) == drawn.integers(1 << 40)
    strict = [one._replace(task_across=(), person_across=()) for one in model.predict(known)]
    assert strict == plain.predict(known)


def test_nothing_is_guessed_across_where_that_could_not_be_tried_or_fails(known: Segments):
    alone = Recogniser.train(chosen(known, person="Dora", task="wave")[:9], rng(), newcomers=True)
    assert alone.person is not None
    assert alone.across == (None, None)
    assert Recogniser.train(known, rng(), across=True, newcomers=True).across == (None, None)
    tasks, people = (np.unique(of, return_inverse=True)[1] for of in (known.task, known.person))
    mixed = replace(known, person=tuple(sorted(set(known.person))[i] for i in (tasks + people) % 4))
    assert Recogniser.train(mixed, rng(), newcomers=True).across.person is None  # another body in each task


def test_matches_are_ranked_and_their_probabilities_leave_room_for_new(recogniser: Recogniser, known: Segments):
    for one in recogniser.predict(known[:3]):
        chances = [match.probability for match in one.task_scores]
        assert chances == sorted(chances, reverse=True)
        assert 0 <= sum(chances) <= 1
        assert one.task == one.task_scores[0].name
        assert one.task_known == (one.margins[0] >= 0)


def test_the_same_generator_gives_the_same_answers(known: Segments):
    assert Recogniser.train(known, rng()).predict(known) == Recogniser.train(known, rng()).predict(known)


def test_tasks_that_change_names_change_them_in_the_answers(known: Segments, recogniser: Recogniser):
    names = {"circle": "push", "lift": "wave", "push": "circle", "wave": "lift"}
    renamed = replace(known, task=tuple(names[task] for task in known.task))
    found = Recogniser.train(renamed, rng()).predict(known)
    assert [one.task for one in found] == [names[one.task] for one in recogniser.predict(known)]


def test_the_order_of_the_segments_does_not_matter(known: Segments, recogniser: Recogniser):
    mixed = Recogniser.train(known[np.random.default_rng(3).permutation(len(known))], rng()).predict(known)
    assert [(o.task, o.person) for o in mixed] == [(o.task, o.person) for o in recogniser.predict(known)]


def test_the_order_of_elements_does_not_matter(recogniser: Recogniser, known: Segments):
    back = slice(None, None, -1)
    turned = replace(
        known, positions=known.positions[:, :, back], elements=known.elements[back], links=known.links[back]
    )
    assert [o.task for o in recogniser.predict(turned)] == [o.task for o in recogniser.predict(known)]


def test_probes_do_not_influence_each_other(recogniser: Recogniser, known: Segments):
    alone = recogniser.predict(known[[5]])[0]
    among = recogniser.predict(known)[5]
    assert (alone.task, alone.person) == (among.task, among.person)
    np.testing.assert_allclose(alone.margins, among.margins, atol=1e-6)


def test_choices_see_nothing_but_the_segments_that_teach(known: Segments, monkeypatch: pytest.MonkeyPatch):
    seen: list[int] = []
    compared = choice.Compared.of
    monkeypatch.setattr(choice.Compared, "of", lambda segments: seen.append(len(segments)) or compared(segments))
    teach = known[known.cycle == 0]
    model = Recogniser.train(teach, rng())
    before = model.task and model.task.choice
    model.predict(known)
    assert seen == [len(teach)]
    assert model.task is not None
    assert model.task.choice is before


@pytest.mark.parametrize(("tasks", "people", "count"), [(1, 4, 2), (4, 1, 2), (1, 1, 2), (1, 1, 1), (2, 1, 1)])
def test_one_person_one_task_or_one_segment_is_enough(tasks: int, people: int, count: int):
    few = takes(count, tasks=tasks, people=people)
    with np.errstate(all="raise"):
        found = Recogniser.train(few, rng()).predict(takes(1))
    assert len(found) == 16
    assert {one.task for one in found} <= set(few.task)


def test_a_person_without_some_tasks_is_learned_all_the_same(known: Segments):
    holes = known[[not (t == "lift" and p == "Ana") and not (t == "push" and p == "Cid")
                   for t, p in zip(known.task, known.person, strict=True)]]  # fmt: skip
    probes = takes(1, seed=1)
    found = Recogniser.train(holes, rng()).predict(probes)
    assert share([one.task for one in found], probes.task) == 1


def test_without_any_person_only_tasks_are_recognised(known: Segments):
    nameless = replace(known, person=("",) * len(known))
    one = Recogniser.train(nameless, rng()).predict(known[:1])[0]
    assert (one.task, one.person, one.person_scores, one.person_known) == ("circle", "", (), False)


def test_across_lets_more_in(known: Segments):
    few = chosen(known, person="Dora")
    strict, loose = (Recogniser.train(few, rng(), across=across).task for across in (False, True))
    assert strict is not None
    assert loose is not None
    assert loose.choice.novelty.threshold > strict.choice.novelty.threshold


def test_no_probe_gives_no_answer(recogniser: Recogniser, known: Segments):
    assert recogniser.predict(known[[]]) == []


def test_nothing_to_learn_from_is_said(known: Segments):
    for none in (known[[]], replace(known, task=("",) * len(known), person=("",) * len(known))):
        with pytest.raises(MetricError, match="label some"):
            Recogniser.train(none, rng())


def test_probes_with_fewer_elements_or_other_moments_are_refused(recogniser: Recogniser, known: Segments):
    fewer = replace(known, positions=known.positions[:, :, :8], elements=known.elements[:8], links=known.links[:8])
    with pytest.raises(MetricError, match="no right_wrist"):
        recogniser.predict(fewer)
    with pytest.raises(MetricError, match="at 8 moments, those learned from at 16"):
        recogniser.predict(replace(known, positions=known.positions[:, ::2]))
