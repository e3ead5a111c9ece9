"""The table of methods."""

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.evaluate import compare
from onbeat.keyposes.extract import Reading
from onbeat.keyposes.thresholds import Example


def test_the_default_is_above_the_baselines_and_all_above_chance() -> None:
    clip = perform(DANCERS[4], [FOLK_DANCE], 1.0, 3, np.random.default_rng(0))
    examples = [Example(Reading(clip.motion, clip.beats), clip.keyposes)]
    rows = {row.name: row for row in compare(examples, np.random.default_rng(0), 0.1)}
    assert rows["energy"].score.f > rows["shiratori2004"].score.f + 0.2
    assert rows["energy"].score.precision > rows["every beat"].score.precision
    assert rows["energy"].chance < rows["energy"].score.f - 0.2
    assert {"paper2009", "hands", "energy, mass weights", "energy, local"} <= set(rows)
