"""Keyposes do not depend on how a motion is stored, where it is danced, by whom of which size, or on which side."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.extract import Keyposes, Options, find_keyposes
from onbeat.motion import rotations as rot
from onbeat.motion.edit import scaled
from onbeat.motion.mirror import mirrored

FRAME = 1.0 / 120.0
CLIP = perform(DANCERS[2], [FOLK_DANCE], 1.2, 2, np.random.default_rng(0), 120.0)
FOUND = find_keyposes(CLIP.motion, CLIP.beats)


def same(one: Keyposes, other: Keyposes = FOUND) -> None:
    assert one.beats.tolist() == other.beats.tolist()
    assert np.abs(one.times - other.times).max() <= FRAME


@given(st.sampled_from([30.0, 50.0, 60.0, 72.0, 90.0, 100.0, 144.0, 200.0, 240.0]))
@settings(deadline=None, max_examples=9)
def test_the_rate_does_not_matter(fps: float) -> None:
    same(find_keyposes(CLIP.motion.resampled(fps), CLIP.beats))


@given(st.floats(-3.1, 3.1), st.floats(-50, 50), st.floats(-50, 50))
@settings(deadline=None, max_examples=10)
def test_the_place_on_the_stage_does_not_matter(turn: float, x: float, y: float) -> None:
    motion = CLIP.motion
    spin = rot.yaw(np.array(turn))
    rotations = np.array(motion.rotations)
    rotations[:, 0] = rot.multiply(spin, rotations[:, 0])
    moved = motion.replace(
        rotations=rotations, root_positions=rot.rotate(spin, motion.root_positions) + np.array([x, y, 0.0])
    )
    same(find_keyposes(moved, CLIP.beats))


@given(st.floats(0.3, 3.0))
@settings(deadline=None, max_examples=10)
def test_the_size_and_the_unit_do_not_matter(factor: float) -> None:
    same(find_keyposes(scaled(CLIP.motion, factor), CLIP.beats))


@pytest.mark.parametrize("order", ["global-local", "local"])
def test_the_mirror_image_has_the_same_keyposes(order: str) -> None:
    options = Options(order=order)
    straight = find_keyposes(CLIP.motion, CLIP.beats, options=options)
    same(find_keyposes(mirrored(CLIP.motion), CLIP.beats, options=options), straight)


@given(st.floats(0.0, 5.0))
@settings(deadline=None, max_examples=8)
def test_a_clock_that_starts_elsewhere_does_not_matter(later: float) -> None:
    count = round(later * CLIP.motion.fps)
    late = count / CLIP.motion.fps
    longer = CLIP.motion.at(np.concatenate([np.zeros(count), CLIP.motion.times]))
    found = find_keyposes(longer, CLIP.beats + late)
    kept = found.times > late + 0.2
    assert np.abs(found.times[kept] - late - FOUND.times[FOUND.times > 0.2]).max() <= FRAME
