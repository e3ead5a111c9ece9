"""A live session without a clock: characters and robots become motions, and what is no sound is refused."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import OnbeatError, PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.live.rehearsed import dance_live, live_session
from onbeat.motion import Motion


@pytest.mark.parametrize("samples", [np.zeros(10), np.zeros((0, 2)), np.zeros((4410, 0)), np.full(44100, np.nan)])
def test_what_is_no_sound_is_refused(samples: np.ndarray, swinger: Motion):
    with pytest.raises(OnbeatError, match="are no sound"):
        dance_live(samples, 44100, swinger)


def test_nobody_cannot_dance():
    with pytest.raises(PlanError, match="no choreography to dance"):
        live_session([])


def test_sound_of_any_rate_is_danced_for_as_long_as_it_lasts():
    folk = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0)).motion
    danced = dance_live(np.zeros((22050, 2), np.float32), 22050, folk)
    assert danced.motion.duration == pytest.approx(1.0)
    assert len(danced.beats) == 0
    assert {status.hearing for status in danced.said} == {"nothing"}
