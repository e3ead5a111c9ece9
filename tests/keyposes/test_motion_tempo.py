"""The pulse of a motion without music."""

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.examples.repertoire import CLAPS, SWAY
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion import Motion


@pytest.mark.parametrize("speed", [1.0, 1.5])
@pytest.mark.parametrize("figure", [FOLK_DANCE, CLAPS])
def test_figures_keep_their_beats(figure: object, speed: float) -> None:
    clip = perform(DANCERS[3], [figure], speed, 3, np.random.default_rng(1))  # type: ignore[list-item]
    found = motion_beats(clip.motion)
    off = np.abs(found[:, None] - clip.beats).min(axis=1)
    assert np.median(np.diff(found)) == pytest.approx(np.diff(clip.beats)[0], rel=0.03)
    assert np.median(off) < 0.06


def test_a_dance_with_a_keypose_every_other_beat_has_half_the_pulse() -> None:
    clip = perform(DANCERS[3], [SWAY], 1.5, 4, np.random.default_rng(1))
    assert np.median(np.diff(motion_beats(clip.motion))) == pytest.approx(2 * np.diff(clip.beats)[0], rel=0.05)


@pytest.mark.parametrize("frames", [1, 3, 400])
def test_a_motion_without_rests_has_no_pulse(frames: int) -> None:
    body = DANCERS[0].build.skeleton
    still = Motion(body, np.tile([1.0, 0, 0, 0], (frames, len(body), 1)), np.zeros((frames, 3)), 60, "statue")
    with pytest.raises(PlanError, match="statue has no pulse of its own"):
        motion_beats(still)
