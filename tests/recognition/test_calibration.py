"""Reliability: bins of what is said beside what is right."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition.calibration import calibration_error, reliability


def test_answers_as_right_as_they_say_have_no_error():
    rng = np.random.default_rng(0)
    said = rng.uniform(size=20_000)
    honest, boastful = rng.uniform(size=20_000) < said, rng.uniform(size=20_000) < said**3
    assert calibration_error(said, honest) < 0.02 < 0.1 < calibration_error(said, boastful)


def test_every_answer_is_in_one_bin():
    said = np.array([0.0, 0.5, 0.50001, 0.95, 1.0])
    found = reliability(said, np.ones(5, bool))
    assert [one.answers for one in found] == [2, 1, 0, 0, 1, 1]
    assert np.isnan(found[2].said)


def test_no_answer_has_no_error():
    assert np.isnan(calibration_error(np.zeros(0), np.zeros(0, bool)))


def test_what_is_no_probability_is_said():
    for said in (np.array([1.2]), np.array([np.nan])):
        with pytest.raises(MetricError, match="between 0 and 1"):
            reliability(said, np.ones(1, bool))
    with pytest.raises(MetricError, match="1 probabilities of 2 answers"):
        reliability(np.ones(1), np.ones(2, bool))
