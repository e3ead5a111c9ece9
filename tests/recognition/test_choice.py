"""Choosing by cross-validation: folds, subspaces, and which views win where they should."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat.recognition.choice import Compared, nearest
from onbeat.recognition.folds import by_repetition, crossing, merged, thinned
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.subspace import Basis, Subspace
from recognition_takes import REST, takes


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


def test_no_fold_shares_a_person_with_what_teaches():
    some = takes(2)
    folds = crossing(some.task, some.person, some.cycle, rng())
    people = np.array(some.person)
    assert all(not set(people[folds == f]) & set(people[folds != f]) for f in np.unique(folds))


def test_many_groups_are_merged_and_many_segments_thinned_evenly():
    groups = np.repeat(np.arange(50), 3)
    few = merged(groups, 50, rng())
    assert len(set(few.tolist())) == 12
    assert all(len(set(few[groups == g].tolist())) == 1 for g in range(50))
    kept = thinned(groups, 100, rng())
    assert set(np.bincount(groups[kept]).tolist()) == {2}


def test_repetitions_are_held_out_cycle_by_cycle_where_there_are_some():
    cells, once = np.array([0, 0, 1, 1, 2]), np.full(5, 9)
    assert by_repetition(cells, np.array([0, 1, 0, 1, 0]), once).tolist() == [0, 1, 0, 1, 0]
    assert by_repetition(cells[[0, 2, 4]], np.zeros(3, int), once[:3]).tolist() == [9, 9, 9]


def test_at_full_shrinkage_the_subspace_is_euclidean():
    values = rng().normal(size=(12, 5)) * [3, 1, 1, 1, 0.1]
    basis, classes = Basis.of(values[:8]), np.arange(8) % 2
    inside, _ = basis.coordinates(values[:8])
    found = Subspace.of(inside, classes, 2, 1.0).distances(*basis.coordinates(values[8:]))
    centres = np.array([values[:8][classes == c].mean(axis=0) for c in range(2)])
    plain = np.linalg.norm(values[8:, None] - centres, axis=-1)
    np.testing.assert_allclose(found / found[0, 0], plain / plain[0, 0], rtol=1e-8)


def test_a_class_of_which_nothing_was_learned_is_infinitely_far():
    learned = Subspace.of(np.eye(3), np.array([0, 0, 2]), 3, 0.1)
    assert np.isinf(learned.distances(np.eye(3), np.zeros(3))[:, 1]).all()
    assert np.isinf(nearest(np.ones((2, 3)), np.array([0, 0, 2]), 3)[:, 1]).all()


def test_a_fold_learns_from_its_own_segments_only():
    some = takes(2)
    compared = Compared.of(some)
    classes, learned = np.unique(some.task, return_inverse=True)[1], np.flatnonzero(np.arange(len(some)) % 2)
    for view in ("posture", "elastic course"):
        for found in compared.distances(view, learned, np.array([0]), np.where(classes == 1, 0, classes), 4):
            assert np.isinf(found[0, 1])


def test_people_who_differ_by_posture_alone_are_told_by_it():
    some = takes(2, noise=0.005)
    people = np.unique(some.person, return_inverse=True)[1]
    still = some.positions.mean(axis=1, keepdims=True) - REST
    moved = some.positions - still
    stance = np.zeros((4, *REST.shape))
    stance[:, 5:] = 0.1 * rng().normal(size=(4, 4, 3))
    model = Recogniser.train(replace(some, positions=moved + stance[people][:, None]), rng())
    assert model.person is not None
    assert {option.view for option in model.person.choice.options} & {"posture", "outline", "elastic poses"}
    assert model.person.choice.accuracy == 1


def test_shrinkages_share_their_directions_and_give_the_same():
    values, classes = rng().normal(size=(20, 6)), np.arange(20) % 3
    several = Subspace.each(values, classes, 4, (0.01, 0.3))
    for one, shrinkage in zip(several, (0.01, 0.3), strict=True):
        alone = Subspace.of(values, classes, 4, shrinkage)
        covariance = sum(np.cov(values[classes == c].T, ddof=0) * (classes == c).sum() for c in range(3)) / 17
        wide = (1 - shrinkage) * covariance + shrinkage * np.trace(covariance) / 6 * np.eye(6)
        away = values[0] - values[classes == 1].mean(axis=0)
        assert abs(one.distances(values[:1], np.zeros(1))[0, 1] - np.sqrt(away @ np.linalg.solve(wide, away))) < 1e-9
        np.testing.assert_allclose(one.distances(values, np.zeros(20)), alone.distances(values, np.zeros(20)))


def test_people_hardly_known_across_tasks_are_taken_by_the_very_cell_where_nothing_is_repeated():
    some, names = takes(1, noise=0.005), sorted(set(takes(1).person))
    tasks, people = (np.unique(of, return_inverse=True)[1] for of in (some.task, some.person))
    mixed = replace(some, person=tuple(names[i] for i in (tasks + people) % 4))  # another in each task
    model = Recogniser.train(mixed, rng())
    assert model.person is not None
    assert [option.view for option in model.person.choice.options] == ["outline", "elastic course"]
