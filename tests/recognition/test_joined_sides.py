"""A recogniser that does not tell left from right, and one that does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from made_segments import cycles_of, danced
from onbeat.recognition.joined_sides import JoinedSides
from onbeat.recognition.mirroring import mirrored
from onbeat.recognition.model_file import load_recogniser, save_recogniser
from onbeat.recognition.recogniser import Prediction, Recogniser
from onbeat.recognition.segments import Segments


@pytest.fixture(scope="module")
def taught() -> Segments:
    return cycles_of(danced())


def answers(found: list[Prediction]) -> list[tuple[str, str, float]]:
    return [(one.task, one.person, round(one.margins[0], 9)) for one in found]


def test_a_step_and_its_mirror_image_have_the_same_answer(taught: Segments):
    joined = JoinedSides.train(taught, np.random.default_rng(0))
    assert isinstance(joined, JoinedSides)
    plain = Recogniser.train(taught, np.random.default_rng(0))
    assert answers(joined.predict(taught)) == answers(joined.predict(mirrored(taught)))
    assert answers(plain.predict(taught)) != answers(plain.predict(mirrored(taught)))
    assert [one.task for one in joined.predict(taught)] == list(taught.task)


def test_the_file_keeps_whether_sides_are_joined(taught: Segments, tmp_path: Path):
    for kind in (JoinedSides, Recogniser):
        model = kind.train(taught, np.random.default_rng(0))
        save_recogniser(model, tmp_path / "model.npz")
        again = load_recogniser(tmp_path / "model.npz")
        assert type(again) is kind
        assert answers(again.predict(mirrored(taught))) == answers(model.predict(mirrored(taught)))
