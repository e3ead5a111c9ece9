"""The multi-factor tensor model."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from made_segments import POINTS, cycles_of, danced, made
from onbeat.errors import MetricError
from onbeat.formats.read import read_motion
from onbeat.recognition.segments import Segments, segments_of
from onbeat.recognition.tensor import TensorModel


def share(model: TensorModel, probes: Segments, mode: str) -> float:
    return float(np.mean(np.array(model.match(probes, mode).best) == np.array(getattr(probes, mode))))


def test_tasks_and_people_of_another_take_are_recognised():
    segments = made(takes=2)
    model = TensorModel.fit(segments[segments.cycle == 0])
    for mode in ("task", "person"):
        assert share(model, segments[segments.cycle == 1], mode) == 1.0


def test_dancers_and_figures_of_another_cycle_are_recognised():
    segments = cycles_of(danced(), frame="body")
    model = TensorModel.fit(segments[segments.cycle == 0])
    for mode in ("task", "person"):
        assert share(model, segments[segments.cycle == 1], mode) == 1.0


def test_at_full_rank_it_is_the_nearest_neighbour_by_elements():
    segments = made(noise=0.8)
    known, probes = segments[segments.cycle == 0], segments[segments.cycle == 1]
    model = TensorModel.fit(known)
    apart = np.square(probes.positions[:, None] - known.positions).sum(-1).mean(axis=2)  # (N, S, E)
    task = np.array(known.task)
    expected = np.stack([apart[:, task == name].min(axis=1) for name in model.categories("task")], axis=-1)
    assert np.allclose(model.element_distances(probes, "task"), expected, atol=1e-10)


def test_cells_come_back_and_are_the_mean_of_their_segments():
    segments = made(takes=3)
    model = TensorModel.fit(segments)
    of = [t == "task 2" and p == "person 1" for t, p in zip(segments.task, segments.person, strict=True)]
    assert np.allclose(model.reconstruct("task 2", "person 1"), segments[of].positions.mean(axis=0), atol=1e-10)
    assert model.length("task 2", "person 1") == pytest.approx((1.0, 1.0))


def test_fewer_columns_leave_out_noise():
    segments = made(people=6, tasks=6, takes=1, noise=0.5, seed=3)
    clean = made(people=6, tasks=6, takes=1, noise=0.0, seed=3)
    errors = []
    for ranks in (None, (11, None, None)):  # 6 + 6 − 1 additive parts
        model = TensorModel.fit(segments, ranks)
        pairs = [model.reconstruct(t, p) - x for t, p, x in zip(clean.task, clean.person, clean.positions, strict=True)]
        errors.append(np.sqrt(np.mean(np.square(pairs))))
    assert errors[1] < 0.8 * errors[0]


def test_probes_are_seen_in_the_subspace_that_is_kept():
    segments = made()
    model = TensorModel.fit(segments, (4, None, None))
    basis = model.parts.factors[0]
    lifted = replace(segments, positions=segments.positions + off(basis, segments.positions.shape))
    assert np.allclose(model.match(lifted, "task").values, model.match(segments, "task").values, atol=1e-9)


def off(basis: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Something of which a basis sees nothing."""
    random = np.random.default_rng(0).normal(size=(shape[0], len(basis)))
    return (random - random @ basis @ basis.T).reshape(shape)


def test_weights_decide_who_is_heard():
    segments = made()
    known, probes = segments[segments.cycle == 0], segments[segments.cycle == 1]
    swapped = probes.positions.copy()
    wrong = known.positions[np.roll(np.arange(len(known)), 1)]  # the next task by (mostly) the same person
    swapped[:, :, 2] = wrong[:, :, 2]
    only_left = TensorModel.fit(known, weights=np.array([0.0, 0, 1, 0, 0, 0]))
    without_left = TensorModel.fit(known, weights=np.array([1.0, 1, 0, 1, 1, 1]))
    liars = replace(probes, positions=swapped)
    assert share(only_left, liars, "task") == 0.0
    assert share(without_left, liars, "task") == 1.0


def test_further_modes_are_recognised_too():
    segments = made(takes=4)
    tempo = ["slow" if cycle < 2 else "fast" for cycle in segments.cycle]
    shifted = replace(segments, positions=segments.positions + np.where(segments.cycle < 2, 0, 1)[:, None, None, None])
    some = segments.cycle % 2 == 0
    model = TensorModel.fit(shifted[some], more={"tempo": [t for t, on in zip(tempo, some, strict=True) if on]})
    assert model.parts.core.shape[1:] == (3, 4, 2)
    best = model.match(shifted[~some], "tempo").best
    assert best == tuple(t for t, on in zip(tempo, some, strict=True) if not on)
    assert share(model, shifted[~some], "person") == 1.0


def test_what_nobody_danced_is_recognised_by_its_guess():
    gone = [(0, 1), (1, 2), (2, 3)]
    segments = made(without=gone)
    whole = made()
    lost = np.array([(int(p[-1]), int(t[-1])) in gone for p, t in zip(whole.person, whole.task, strict=True)])
    model = TensorModel.fit(segments)
    assert not model.seen.all()
    assert share(model, whole[lost], "person") == share(model, whole[lost], "task") == 1.0
    # Not compared with, a task that a person never danced says nothing for the person.
    assert share(TensorModel.fit(segments, guesses=False), whole[lost], "person") < 1.0


def test_one_person_one_task_and_one_segment_are_enough():
    segments = made(people=1, tasks=1, takes=1)
    model = TensorModel.fit(segments)
    assert model.match(segments, "task").best == ("task 0",)
    assert model.match(segments, "person").scores.tolist() == [[1.0]]
    assert TensorModel.fit(segments, (1, 1, 1)).match(segments, "task").best == ("task 0",)


def test_a_probe_that_nothing_tells_apart_is_shared_evenly():
    same = replace(made(people=2, tasks=2, takes=1), positions=np.zeros((4, 8, len(POINTS), 3)))
    assert TensorModel.fit(same).match(same, "task").scores == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda s: s[[]], "no segment to recognise"),
        (lambda s: replace(s, positions=s.positions[:, :4]), "probes of 4 moments"),
        (
            lambda s: replace(s, positions=s.positions[:, :, :2], elements=POINTS[:2], links=s.links[:2]),
            "without left_wrist, right_wrist, left_ankle, right_ankle",
        ),
    ],
)
def test_probes_that_do_not_fit_are_refused(wrong, says: str):
    segments = made()
    with pytest.raises(MetricError, match=says):
        TensorModel.fit(segments).match(wrong(segments), "task")


def test_a_probe_with_more_points_in_another_order_is_recognised():
    segments = made()
    model = TensorModel.fit(segments)
    around = [5, 3, 1, 0, 2, 4]
    names = (*(POINTS[i] for i in around), "tail")
    positions = np.concatenate((segments.positions[:, :, around], np.ones((len(segments), 8, 1, 3))), axis=2)
    other = replace(segments, positions=positions, elements=names, links=np.arange(7))
    assert np.allclose(model.match(other, "task").values, model.match(segments, "task").values)


def test_what_cannot_be_learned_is_refused():
    segments = made()
    with pytest.raises(MetricError, match="0 segments"):
        TensorModel.fit(segments[[]])
    with pytest.raises(MetricError, match="the person of segment 0 is not known"):
        TensorModel.fit(replace(segments, person=("",) * len(segments)))
    with pytest.raises(MetricError, match="one each is needed"):
        TensorModel.fit(segments, (3, 3))
    with pytest.raises(MetricError, match="6 numbers"):
        TensorModel.fit(segments, weights=np.ones(2))
    with pytest.raises(MetricError, match="modes already"):
        TensorModel.fit(segments, more={"task": segments.task})
    model = TensorModel.fit(segments)
    with pytest.raises(MetricError, match="there are person, task"):
        model.match(segments, "cycle")
    with pytest.raises(MetricError, match="no task 'waltz' in the model; there are task 0"):
        model.reconstruct("waltz", "person 0")


def test_a_probe_takes_milliseconds():
    rng = np.random.default_rng(0)
    names = [(f"p{i % 8}", f"t{i // 8}") for i in range(136)]
    known = Segments(
        rng.normal(size=(136, 32, 24, 3)), np.ones(136), [t for _, t in names], [p for p, _ in names],
        np.zeros(136), [f"e{i}" for i in range(24)], np.arange(24),
    )  # fmt: skip
    model = TensorModel.fit(known)
    model.match(known, "task")
    start = time.process_time()
    model.match(known, "task")
    assert (time.process_time() - start) / 136 < 0.05


def test_real_gestures_of_another_take_are_recognised(data: Path):
    files = sorted((data / "bandai").glob("[rw]*_[enm]*_00[12].bvh"))
    motions = [read_motion(file) for file in files]
    said = [file.stem.split("_") for file in files]
    spans = [(0.0, float(motion.times[-1])) for motion in motions]
    segments = segments_of(
        motions, spans, [w[0] for w in said], [w[1] for w in said], [int(w[2]) for w in said], frame="body"
    )
    assert len(set(segments.task)) == 6
    model = TensorModel.fit(segments[segments.cycle == 1], (12, None, None))
    for mode in ("task", "person"):
        assert share(model, segments[segments.cycle == 2], mode) > 0.9
