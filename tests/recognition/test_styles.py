"""One's task in another's style."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from made_segments import cycles_of, danced, made
from onbeat.errors import MetricError
from onbeat.formats import read_motion
from onbeat.recognition.segments import Segments, segments_of
from onbeat.recognition.styles import danced_by, restyled, style_matrix, style_model, task_vectors
from onbeat.recognition.tensor import TensorModel


def of(segments: Segments, person: str, task: str, cycle: int = 0) -> Segments:
    said = zip(segments.person, segments.task, segments.cycle, strict=True)
    return segments[[p == person and t == task and c == cycle for p, t, c in said]]


def test_a_persons_matrix_gives_the_persons_cells():
    segments = made()
    model = TensorModel.fit(segments)
    cells = style_matrix(model, "person 1") @ model.parts.factors[2].T
    assert np.allclose(cells, model.cells[:, 1], atol=1e-10)


def test_a_known_segment_has_the_vector_of_its_task():
    segments = made(takes=1)
    model = TensorModel.fit(segments)
    found = task_vectors(model, of(segments, "person 0", "task 2"), "person 0")
    assert np.allclose(found[0], model.parts.factors[2][2], atol=1e-9)


def test_a_segment_in_its_own_style_stays_as_it_is():
    segments = made()
    assert np.allclose(restyled(TensorModel.fit(segments), segments, "person 0", "person 0"), segments.positions)


def test_a_take_in_anothers_style_is_nearer_to_the_other():
    segments = made(people=4, tasks=6, takes=2, noise=0.05)
    gone = np.array([p == "person 3" and t == "task 5" for p, t in zip(segments.person, segments.task, strict=True)])
    model = TensorModel.fit(segments[(segments.cycle == 0) & ~gone])
    source, truth = of(segments, "person 0", "task 5", 1), of(segments, "person 3", "task 5", 1)
    before = np.sqrt(np.square(source.positions - truth.positions).mean())
    for keep in (0.0, 1.0):
        made_ = restyled(model, source, "person 0", "person 3", keep)
        assert np.sqrt(np.square(made_ - truth.positions).mean()) < 0.4 * before


def test_a_task_that_the_model_does_not_know_can_be_restyled():
    segments = made(people=4, tasks=7, takes=1)
    unknown = np.array(segments.task) == "task 6"
    model = TensorModel.fit(segments[~unknown])
    made_ = restyled(model, of(segments, "person 0", "task 6"), "person 0", "person 2")
    truth, source = (of(segments, person, "task 6").positions for person in ("person 2", "person 0"))
    assert np.square(made_ - truth).mean() < 0.5 * np.square(source - truth).mean()


def test_what_a_person_never_danced_is_danced_on_any_body():
    clips = danced()
    segments = cycles_of(clips)
    task, person = clips[0].task, clips[1].person
    gone = np.array([p == person and t == task for p, t in zip(segments.person, segments.task, strict=True)])
    model = TensorModel.fit(segments[~gone])
    base = clips[5].motion
    motion = danced_by(model, task, person, base)
    assert motion.skeleton is base.skeleton
    assert motion.name == f"{task} by {person}"
    assert abs(motion.duration - float(segments.durations[gone].mean())) < 0.1
    again = segments_of([motion], [(0, float(motion.times[-1]))], [""], [""], [0])
    assert model.match(again, "task").best == (task,)
    errors = [np.square(again.positions - of(segments, p, task).positions).mean() for p in model.categories("person")]
    assert max(errors) < 0.02


def test_people_and_shares_that_are_none_are_refused():
    segments = made()
    model = TensorModel.fit(segments)
    with pytest.raises(MetricError, match="no person 'Nobody' in the model; there are person 0"):
        restyled(model, segments, "person 0", "Nobody")
    with pytest.raises(MetricError, match="0 to 1"):
        restyled(model, segments, "person 0", "person 1", keep=float("nan"))
    with pytest.raises(MetricError, match="give one at least"):
        restyled(model, segments[[]], "person 0", "person 1")
    with pytest.raises(MetricError, match="no task 'waltz'"):
        danced_by(model, "waltz", "person 0", danced()[0].motion)
    with pytest.raises(MetricError, match="a body cannot be placed"):
        danced_by(model, "task 0", "person 0", danced()[0].motion)


def test_further_modes_are_averaged():
    segments = made(takes=2)
    plain = TensorModel.fit(segments)
    more = TensorModel.fit(segments, more={"take": [str(cycle) for cycle in segments.cycle]})
    same = replace(segments, positions=segments.positions)
    a, b = (restyled(model, same, "person 0", "person 1") for model in (plain, more))
    assert np.allclose(a, b, atol=1e-6)


def test_ranks_are_chosen_by_what_was_not_seen():
    segments = made(people=5, tasks=6, takes=1, noise=0.4, without=[(4, 5)])
    chosen, whole = style_model(segments), TensorModel.fit(segments)
    truth = made(people=5, tasks=6, takes=1, noise=0.0)
    wanted = of(truth, "person 4", "task 5").positions[0]
    errors = [np.square(m.reconstruct("task 5", "person 4") - wanted).mean() for m in (chosen, whole)]
    assert errors[0] <= errors[1] * 1.05
    assert style_model(segments).parts.core.shape == chosen.parts.core.shape
    one = style_model(made(people=1, tasks=1, takes=1))
    assert one.categories("task") == ("task 0",)


def test_a_gesture_in_a_style_it_was_never_seen_in_is_nearer_to_the_real_one(data: Path):
    files = [file for file in sorted((data / "bandai").glob("*_001.bvh")) if not file.name.startswith("dance")]
    motions = [read_motion(file) for file in files]
    task, person, _ = zip(*(file.stem.split("_") for file in files), strict=True)
    spans = [(0.0, (len(motion) - 1) / motion.fps) for motion in motions]
    segments = segments_of(motions, spans, task, person, [0] * len(files))
    gone = np.array([(t, p) == ("wave-left-hand", "elderly") for t, p in zip(task, person, strict=True)])
    made_ = style_model(segments[~gone]).reconstruct("wave-left-hand", "elderly")
    real, neutral = (of(segments, who, "wave-left-hand").positions[0] for who in ("elderly", "normal"))
    assert np.sqrt(np.square(made_ - real).mean()) < 0.6 * np.sqrt(np.square(neutral - real).mean())
