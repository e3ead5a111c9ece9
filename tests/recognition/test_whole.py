"""Learning and recognising in one call each: persons too, and what cannot be is said."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.recognition.whole import recognise, train_recogniser


def test_persons_are_known_in_another_take_of_the_same_step():
    takes = [[perform(dancer, [FOLK_DANCE], 1.0, 1, np.random.default_rng(seed)) for dancer in DANCERS[:3]]
             for seed in range(3)]  # fmt: skip
    clips = [clip for take in takes[:2] for clip in take]
    span = [(float(clip.keyposes[0]), float(clip.keyposes[4])) for clip in clips]
    knows = train_recogniser([c.motion for c in clips], ["folk"] * 6, [c.person for c in clips], span)
    told = recognise(knows, [clip.motion for clip in takes[2]], span[:3])
    assert [one.person for one in told] == [clip.person for clip in takes[2]]
    assert {one.task for one in told} == {"folk"}


def test_lists_that_are_not_equally_long_are_refused():
    motion = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0)).motion
    with pytest.raises(MetricError, match="as many of each are needed"):
        train_recogniser([motion, motion], ["one"])
    with pytest.raises(MetricError, match="as many of each are needed"):
        train_recogniser([motion, motion], ["one", "two"], spans=[(0.0, 1.0)])
