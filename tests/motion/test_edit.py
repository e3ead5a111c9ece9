import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.edit import concatenated, cropped, heading, scaled, stature
from persons import person, swinging


def test_cropping_keeps_the_frames_shown_in_the_stretch():
    motion = swinging(person(), frames=60, fps=30)
    part = cropped(motion, 0.5, 1.0)
    assert len(part) == 15
    np.testing.assert_array_equal(part.rotations, motion.rotations[15:30])
    assert len(cropped(motion, 1.9)) == 3
    for start, end in ((2.0, None), (1.0, 1.0), (-0.5, 1.0), (1.5, 0.5)):
        with pytest.raises(FormatError, match=r"no frame from .* the motion lasts 2\.00 s"):
            cropped(motion, start, end)


def test_cuts_at_third_seconds_are_on_the_frame():
    assert len(cropped(swinging(person(), frames=120, fps=120), 1 / 3, 2 / 3)) == 40


@pytest.mark.parametrize("blend", [0.0, 0.3])
def test_one_motion_goes_on_where_the_other_stands(blend):
    a, b = (swinging(person(), frames=40, fps=30, seed=seed, angle=0.3) for seed in (1, 2))
    turned = b.replace(
        rotations=_turned(b, 2.0), root_positions=rot.rotate(rot.yaw(2.0), b.root_positions) + np.array([5, 3, 0])
    )
    joined = concatenated([a, turned], blend)
    assert len(joined) == 80 - round(blend * 30)
    np.testing.assert_array_equal(joined.rotations[:30], a.rotations[:30])
    at = 40 - round(blend * 30)
    step = np.linalg.norm(np.diff(joined.root_positions[at - 2 : at + 14, :2], axis=0), axis=1)
    assert step.max() < 0.05
    assert np.abs(np.diff(np.unwrap(heading(joined)))).max() < 0.4
    # What comes after the blend moves as it did: only turned and moved over the ground.
    tail = slice(len(joined) - 20, None)
    np.testing.assert_allclose(joined.positions[tail, :, 2], b.positions[20:, :, 2], atol=1e-9)
    np.testing.assert_allclose(joined.rotations[tail, 1:], b.rotations[20:, 1:], atol=1e-9)


def _turned(motion: Motion, angle: float) -> np.ndarray:
    rotations = np.array(motion.rotations)
    rotations[:, 0] = rot.multiply(rot.yaw(angle), rotations[:, 0])
    return rotations


def test_a_blend_goes_smoothly_from_one_to_the_other():
    a, b = (swinging(person(), frames=60, fps=60, seed=seed, angle=0.5) for seed in (1, 2))

    def jump(motion: Motion) -> float:
        return float(rot.angle_between(motion.rotations[1:], motion.rotations[:-1]).max())

    assert jump(concatenated([a, b], 0.4)) < 0.5 * jump(concatenated([a, b]))


def test_rates_are_brought_to_the_first_and_other_skeletons_refused():
    a, b = swinging(person(), 30, 30), swinging(person(), 60, 60)
    assert len(concatenated([a, b])) == 60
    with pytest.raises(FormatError, match=r"motion 2 .* has another skeleton"):
        concatenated([a, swinging(person(1.2), 30, 30)])
    with pytest.raises(FormatError, match="too short for a blend"):
        concatenated([a, b], 0.6)
    with pytest.raises(FormatError, match="no motions"):
        concatenated([])


def test_animated_offsets_go_through_joins():
    a = swinging(person(), 20, 30)
    moved = np.tile(a.skeleton.offsets, (20, 1, 1)) * 1.1
    b = Motion(a.skeleton, a.rotations, a.root_positions, 30, "b", moved)
    joined = concatenated([a, b], 0.2)
    assert joined.translations is not None
    np.testing.assert_allclose(joined.translations[0], a.skeleton.offsets)
    np.testing.assert_allclose(joined.translations[-1], a.skeleton.offsets * 1.1)


def test_scaling_scales_all_lengths():
    motion = swinging(person(), 10)
    np.testing.assert_allclose(scaled(motion, 1.5).positions, motion.positions * 1.5, atol=1e-12)
    assert stature(scaled(motion, 2.0)) == pytest.approx(2 * stature(motion))
    for factor in (0.0, -1.0, float("nan")):
        with pytest.raises(FormatError, match="a scale of"):
            scaled(motion, factor)


def test_what_is_no_body_heads_where_its_root_does():
    rod = Skeleton(("a", "b"), [-1, 0], [[0, 0, 0], [0, 0, 1]])
    spin = np.tile(rot.yaw(np.array([0.3, 0.6]))[:, None], (1, 2, 1))
    np.testing.assert_allclose(heading(Motion(rod, spin, np.zeros((2, 3)), 30)), [0.3, 0.6])
