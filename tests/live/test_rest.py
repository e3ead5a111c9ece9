"""Standing at ease: the feet stay, the chest rises, and the end goes on into the beginning."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.troupe import dance_library
from onbeat.live.bodies.rest import BREATHS, SECONDS, resting
from onbeat.motion.body import Body
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

CLIPS = [performance.motion for performance in dance_library(fps=60.0)][:2]


def without_toes_and_collars(clip: Motion) -> Motion:
    """The same body with bones less: no toes, no neck, and arms that grow from the chest."""
    names = clip.skeleton.names
    kept = [n for n, name in enumerate(names) if not any(part in name for part in ("Toe", "Neck", "Head", "End"))]
    kept = [n for n in kept if not names[n].endswith("Shoulder")]
    place = {joint: n for n, joint in enumerate(kept)}
    parents, offsets = list[int](), list[np.ndarray]()
    for joint in kept:
        offset, above = np.array(clip.skeleton.offsets[joint]), int(clip.skeleton.parents[joint])
        while above >= 0 and above not in place:
            offset, above = offset + clip.skeleton.offsets[above], int(clip.skeleton.parents[above])
        parents.append(place.get(above, -1))
        offsets.append(offset)
    skeleton = Skeleton(tuple(names[n] for n in kept), parents, offsets)
    return Motion(skeleton, clip.rotations[:, kept], clip.root_positions, clip.fps)


@pytest.mark.parametrize("clips", [CLIPS, [without_toes_and_collars(CLIPS[0])]], ids=["whole", "few bones"])
def test_feet_stay_while_the_chest_rises(clips):
    rest = resting(clips)
    body, at = Body.of(rest.skeleton), rest.positions
    assert rest.duration == pytest.approx(SECONDS)
    feet = [role for role in ("left_ankle", "right_ankle", "left_toe", "right_toe") if role in body]
    assert np.ptp(at[:, body.indices(*feet)], axis=0).max() < 1e-3
    shoulders = at[:, body.indices("left_elbow", "right_elbow")].mean(axis=1) - at[:, body["hips"]]
    strength = np.abs(np.fft.rfft(np.linalg.norm(shoulders - shoulders[0], axis=1)))[1:]
    assert np.argmax(strength) + 1 == BREATHS
    assert np.ptp(at[:, body["hips"], :2], axis=0).max() > 0.01


def test_its_end_goes_on_into_its_beginning():
    at = resting(CLIPS).positions
    round_about = np.diff(np.concatenate((at, at[:2])), axis=0)
    usual = np.linalg.norm(round_about[:-2], axis=-1).max()
    assert np.linalg.norm(round_about[-2:], axis=-1).max() <= 1.01 * usual
    assert usual * 60 < 0.1  # m/s


def test_arms_hang_and_the_body_is_upright():
    rest = resting(CLIPS)
    body, at = Body.of(rest.skeleton), rest.positions[0]
    for side in ("left", "right"):
        assert at[body[f"{side}_wrist"], 2] < at[body[f"{side}_elbow"], 2] < at[body[f"{side}_shoulder"], 2]
    trunk = at[body["chest"]] - at[body["hips"]]
    assert trunk[2] > 0.95 * np.linalg.norm(trunk)


def test_nothing_to_stand_like_is_said():
    with pytest.raises(PlanError, match="no clips"):
        resting([])
