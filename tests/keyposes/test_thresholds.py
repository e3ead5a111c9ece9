"""Thresholds learned from marked dances."""

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Reading
from onbeat.keyposes.thresholds import Example, Sweep, learn, sweep


@pytest.fixture(scope="module")
def examples() -> list[Example]:
    rng = np.random.default_rng(0)
    clips = [perform(dancer, [FOLK_DANCE], 1.0, 2, rng) for dancer in DANCERS[:3]]
    return [Example(Reading(clip.motion, clip.beats), clip.keyposes, clip.person) for clip in clips]


def test_learned_thresholds_find_the_keyposes_of_other_dancers(examples: list[Example]) -> None:
    learned = learn(examples, 0.12)
    assert learned.held_out.f > 0.9
    (low, high), _ = learned.plateau
    assert low <= learned.thresholds.t1 <= high


def test_a_single_example_is_tested_on_its_other_half(examples: list[Example]) -> None:
    assert learn(examples[:1], 0.12).held_out.f > 0.8


def test_the_middle_of_the_plateau_is_taken() -> None:
    f = np.zeros((7, 7))
    f[1:6, 2:7] = 0.9
    f[0, 0] = 0.91
    scores = np.stack([f, f, f], axis=-1)[None]
    swept = Sweep(np.arange(7.0), np.arange(7.0), scores)
    assert swept.best() == Thresholds(3.0, 4.0)
    assert swept.plateau() == ((1.0, 5.0), (2.0, 6.0))


def test_a_sweep_scores_each_pair_as_finding_with_it_does(examples: list[Example]) -> None:
    swept = sweep(examples[:1], (0.2, 0.6), (1.0, 3.0), 0.1)
    assert swept.scores.shape == (1, 2, 2, 3)
    assert swept.scores[0, 1, 1, 1] >= swept.scores[0, 0, 1, 1]  # recall grows with T1


def test_nothing_to_learn_from_is_told(examples: list[Example]) -> None:
    with pytest.raises(MetricError, match="no example to learn from"):
        learn([])
    with pytest.raises(MetricError, match="Aiko has no keypose marked"):
        learn([Example(examples[0].reading, np.zeros(0), "Aiko")])
    with pytest.raises(MetricError, match="2 keyposes; four are needed"):
        learn([Example(examples[0].reading, examples[0].truth[:2], "Aiko")])
