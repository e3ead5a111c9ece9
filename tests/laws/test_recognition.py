"""Laws of recognition: what tensors, votes and names must do whatever the dance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from made_segments import made, renamed
from onbeat.recognition.hosvd import hosvd, unfold
from onbeat.recognition.mirroring import joined, mirrored
from onbeat.recognition.open_set import learn
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.tensor import TensorModel
from recognition_takes import takes

SEEDS = st.integers(0, 2**32 - 1)
MODES = ("task", "person")


@given(st.lists(st.integers(1, 6), min_size=1, max_size=5), SEEDS, st.floats(-6, 6))
def test_a_decomposed_tensor_comes_back(shape: list[int], seed: int, size: float):
    tensor = 10**size * np.random.default_rng(seed).normal(size=shape)
    parts = hosvd(tensor)
    assert np.abs(parts.tensor() - tensor).max() <= 1e-10 * np.abs(tensor).max()
    for mode, factor in enumerate(parts.factors):
        assert np.allclose(factor.T @ factor, np.eye(factor.shape[1]), atol=1e-10)
        assert np.linalg.matrix_rank(unfold(tensor, mode)) <= factor.shape[1]


@given(SEEDS, st.integers(1, 5), st.integers(1, 4), st.integers(1, 4))
def test_more_columns_never_come_farther(seed: int, position: int, person: int, task: int):
    tensor = np.random.default_rng(seed).normal(size=(6, 4, 4))
    errors = [np.linalg.norm(hosvd(tensor, (position + more, person, task)).tensor() - tensor) for more in (0, 1)]
    assert errors[1] <= errors[0] + 1e-9


@settings(max_examples=25)
@given(SEEDS, st.integers(2, 4), st.integers(2, 5), st.sampled_from([None, (5, None, None), (5, 2, 2)]))
def test_permuting_people_or_tasks_permutes_the_answer(seed: int, people: int, tasks: int, ranks):
    rng = np.random.default_rng(seed)
    segments = made(people, tasks, takes=2, noise=0.5, seed=seed, without=[(0, 0)])
    of = {
        name: dict(
            zip([f"{name} {i}" for i in range(count)], [f"{name} {i}" for i in rng.permutation(count)], strict=True)
        )
        for name, count in (("task", tasks), ("person", people))
    }
    other = renamed(segments, of["task"], of["person"])
    first = segments.cycle == 0
    before, after = TensorModel.fit(segments[first], ranks), TensorModel.fit(other[first], ranks)
    for mode in MODES:
        a, b = before.match(segments[~first], mode), after.match(other[~first], mode)
        place = [b.names.index(of[mode][name]) for name in a.names]
        assert np.allclose(a.scores, b.scores[:, place], atol=1e-9)
        assert np.allclose(a.values, b.values[:, place], rtol=1e-7)


@settings(max_examples=25)
@given(SEEDS)
def test_the_order_of_segments_and_probes_is_nothing(seed: int):
    segments = made(noise=0.5, seed=seed)
    shuffled = np.random.default_rng(seed).permutation(len(segments))
    a, b = (TensorModel.fit(s).match(segments[shuffled], "task") for s in (segments, segments[shuffled]))
    assert np.allclose(a.values, b.values)
    assert np.allclose(a.scores, TensorModel.fit(segments).match(segments, "task").scores[shuffled])


@settings(max_examples=25)
@given(SEEDS, st.floats(-2, 2))
def test_a_larger_scale_changes_no_vote_and_no_judgement(seed: int, power: float):
    segments = made(people=2, tasks=3, takes=3, noise=0.5, seed=seed)
    larger = replace(segments, positions=segments.positions * 10**power)
    first = segments.cycle < 2
    found = []
    for given_ in (segments, larger):
        matches = TensorModel.fit(given_[first]).match(given_[~first], "task")
        found.append((matches, learn(given_[first], "task").judge(matches)))
    (a, known), (b, also_known) = found
    assert np.allclose(a.scores, b.scores)
    assert np.allclose(known.margins, also_known.margins, atol=1e-6)


@given(SEEDS)
def test_scores_are_shares_and_the_best_has_the_most(seed: int):
    segments = made(noise=1.0, seed=seed)
    matches = TensorModel.fit(segments[segments.cycle == 0]).match(segments, "person")
    assert np.allclose(matches.scores.sum(axis=1), 1)
    assert (np.diff(np.take_along_axis(matches.scores, matches.order, 1), axis=1) <= 1e-9).all()


@given(SEEDS)
def test_dropping_cells_costs_little_where_people_and_tasks_add_up(seed: int):
    rng = np.random.default_rng(seed)
    gone = {(p, int(t)) for p, t in enumerate(rng.permutation(6)[:5])} | {
        (p, int(t)) for p, t in enumerate(rng.permutation(6)[:5])
    }
    segments, whole = made(5, 6, 1, seed=seed, without=gone), made(5, 6, 2, seed=seed)
    probes = whole[whole.cycle == 1]
    model = TensorModel.fit(segments)
    for mode in MODES:
        right = np.array(model.match(probes, mode).best) == np.array(getattr(probes, mode))
        assert right.mean() > 0.9


@given(SEEDS)
def test_joining_forgets_the_side_and_nothing_else(seed: int):
    segments = made(seed=seed, noise=1.0)
    assert np.array_equal(mirrored(mirrored(segments)).positions, segments.positions)
    assert np.array_equal(joined(segments).positions, joined(mirrored(segments)).positions)
    assert np.array_equal(joined(joined(segments)).positions, joined(segments).positions)


@settings(max_examples=6, deadline=None)
@given(SEEDS, st.booleans(), st.integers(1, 2))
def test_a_recogniser_knows_no_names(seed: int, across: bool, count: int):
    segments, rng = takes(count, seed=seed, tasks=3, people=3, noise=0.05), np.random.default_rng(seed)
    of: dict[str, dict[str, str]] = {}
    for mode in MODES:
        names = sorted(set(getattr(segments, mode)))
        of[mode] = dict(zip(names, [names[i] for i in rng.permutation(len(names))], strict=True))
    other = renamed(segments, of["task"], of["person"])
    before, after = (
        Recogniser.train(some, np.random.default_rng(0), across=across).predict(takes(1, seed=seed + 1))
        for some in (segments, other)
    )
    for a, b in zip(before, after, strict=True):
        assert np.allclose(a.margins, b.margins, atol=1e-6)
        for mode in MODES:
            chances = ({m.name: m.probability for m in getattr(one, f"{mode}_scores")} for one in (a, b))
            mine, theirs = chances
            assert np.allclose([mine[name] for name in mine], [theirs[of[mode][name]] for name in mine], atol=1e-6)
