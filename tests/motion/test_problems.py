import numpy as np
import pytest

from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.edit import scaled
from onbeat.motion.problems import problems
from persons import person, swinging

LEGS = ("Hip", "Knee", "Ankle", "Toe")


def standing(frames: int = 90, fps: float = 30.0) -> Motion:
    """Somebody who moves the arms a little while the feet stand on the floor."""
    motion = swinging(person(), frames, fps, angle=0.25)
    still = np.array(motion.rotations)
    legs = [
        j for j, name in enumerate(motion.skeleton.names) if any(k in name for k in ("Hip", "Knee", "Ankle", "Toe"))
    ]
    still[:, [0, *legs]] = rot.IDENTITY
    height = -motion.skeleton.rest_positions[:, 2].min()
    return motion.replace(rotations=still, root_positions=np.tile([0, 0, height], (frames, 1)))


def found(motion: Motion) -> str:
    return "\n".join(problems(motion))


def test_a_good_motion_has_none():
    assert problems(standing()) == []


@pytest.mark.parametrize("fps", [30.0, 60.0, 120.0])
def test_what_is_wrong_is_named_with_its_place_at_any_rate(fps):
    good = standing(int(3 * fps), fps)
    path = np.array(good.root_positions)
    path[int(fps) :] += [2, 0, 0]
    assert f"the root leaps at 1 frame, first between {int(fps) - 1} and {int(fps)}" in found(
        good.replace(root_positions=path)
    )
    flipped = np.array(good.rotations)
    elbow = good.skeleton.index("LeftElbow")
    flipped[int(fps), elbow] = rot.multiply(flipped[int(fps), elbow], rot.about(np.array([1.0, 0, 0]), 2.5))
    assert f"(LeftElbow 2×), first after frame {int(fps) - 1}" in found(good.replace(rotations=flipped))


def test_frames_that_were_filled_in():
    good = standing()
    frozen = np.array(good.rotations)
    frozen[20:50] = frozen[20]
    assert "frames 20–49 are exactly alike (1.00 s)" in found(good.replace(rotations=frozen))
    twice = np.repeat(good.rotations, 2, axis=0)
    doubled = Motion(good.skeleton, twice, np.repeat(good.root_positions, 2, axis=0), 60)
    assert "each frame is there 2 times: it was stored at 60 frames a second but made at 30" in found(doubled)


def test_a_pose_of_reference_in_front():
    good = standing()
    posed = np.array(good.rotations)
    posed[0] = rot.IDENTITY
    for side, turn in (("Left", 1.2), ("Right", -1.2)):
        for joint, share in (("Shoulder", 1.0), ("Elbow", 0.9)):
            at = good.skeleton.index(side + joint)
            posed[1:, at] = rot.multiply(rot.about(np.array([0, 1.0, 0]), turn * share), posed[1:, at])
    said = found(good.replace(rotations=posed))
    assert "frame 0 is a pose by itself" in said
    assert "--start 0.03333" in said
    assert "flip" not in said


def test_sizes_floors_and_stretching_bones():
    good = standing()
    assert "the body is 0.02 m tall, its legs 0.01 m long: is the unit right?" in found(scaled(good, 0.01))
    assert "feet stand at +0.30 m" in found(good.replace(root_positions=good.root_positions + np.array([0, 0, 0.3])))
    moved = np.tile(good.skeleton.offsets, (len(good), 1, 1))
    moved[:, good.skeleton.index("LeftWrist")] *= 1 + 0.1 * np.sin(np.arange(len(good)))[:, None]
    stretching = Motion(good.skeleton, good.rotations, good.root_positions, 30, "s", moved)
    assert "that to LeftWrist by up to 50 mm (1 bones do)" in found(stretching)


def test_feet_that_slide():
    good = standing()
    slid = good.replace(root_positions=good.root_positions + np.linspace(0, 0.25 * 3, 90)[:, None] * [0, 1, 0])
    assert "feet slide while they stand (0.25 m/s" in found(slid)


def test_sides_that_differ():
    good = standing()
    s = good.skeleton
    offsets = np.array(s.offsets)
    offsets[s.index("LeftElbow")] *= 1.3
    lame = Motion(type(s)(s.names, s.parents, offsets, s.end_sites), good.rotations, good.root_positions, 30)
    assert "the bone to the elbow is 0.377 m on the left, 0.290 m on the right" in found(lame)


def test_what_is_no_body_is_said():
    rod = swinging(type(person())(("a", "b"), [-1, 0], [[0, 0, 0], [0, 0, 1]]), 90, 30)
    assert "no joint found for hips" in found(rod) or "no joint found for" in found(rod)


@pytest.mark.parametrize("fps", [30.0, 120.0])
def test_a_pose_of_several_frames_in_front_is_no_flip_and_no_leap(fps):
    good = standing(int(3 * fps), fps)
    turns, path = np.array(good.rotations), np.array(good.root_positions)
    arms = [j for j, name in enumerate(good.skeleton.names) if "Shoulder" in name or "Elbow" in name]
    turns[:20] = turns[20]
    turns[:20, arms] = rot.about(np.array([0, 1.0, 0]), np.radians(80))
    path[:20] += [3, 0, 0]
    said = found(good.replace(rotations=turns, root_positions=path))
    assert said.startswith("frames 0–19 are a pose by itself")
    assert f"--start {20 / fps:.4g}" in said
    assert "leap" not in said
    assert "flip" not in said


def test_a_joint_that_leaps_is_named():
    good = standing(120, 60.0)
    turns = np.array(good.rotations)
    shoulder = good.skeleton.names.index("LeftShoulder")
    turns[60, shoulder] = rot.about(np.array([0, 1.0, 0]), np.pi)
    assert found(good.replace(rotations=turns)).startswith("LeftWrist leaps at 4 frames, furthest between 60 and 61")


def test_motion_without_its_path_is_told():
    motion = swinging(person(), 90, 30.0, angle=0.5)
    turns = np.array(motion.rotations)
    turns[:, 0] = rot.IDENTITY
    fixed = motion.replace(rotations=turns, root_positions=np.tile([0, 0, 0.9], (90, 1)))
    assert "the hips never move, though the feet do" in found(fixed)
    assert "the hips never move" not in found(standing())


def test_feet_in_the_air_are_no_floor():
    upright = standing()
    turns = np.array(upright.rotations)
    turns[:, 0] = rot.about(np.array([1.0, 0, 0]), np.pi)
    over = upright.replace(rotations=turns, root_positions=np.zeros((len(upright), 3)))
    over = over.replace(root_positions=np.tile([0, 0, 0.1 - over.positions[..., 2].min()], (len(over), 1)))
    said = found(over)
    assert "the feet are in the air all along" in said
    assert "--ground" not in said
