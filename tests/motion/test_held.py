import numpy as np
import pytest

from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.held import held_poses
from persons import person, swinging


def with_pose(frames: int, fps: float, *, at_end: bool = False) -> Motion:
    """A swinging body with frames of its rest pose before or after."""
    motion = swinging(person(), 90, fps, angle=1.0)
    motion = motion.replace(rotations=motion.rotations[20:], root_positions=motion.root_positions[20:])
    pose = np.tile(rot.IDENTITY, (frames, len(motion.skeleton), 1))
    parts, paths = [pose, motion.rotations], [np.zeros((frames, 3)), motion.root_positions]
    if at_end:
        parts, paths = parts[::-1], paths[::-1]
    return motion.replace(rotations=np.concatenate(parts), root_positions=np.concatenate(paths))


@pytest.mark.parametrize("frames", [1, 2, 30, 200])
@pytest.mark.parametrize("fps", [30.0, 120.0])
def test_a_pose_in_front_or_at_the_end_is_counted(frames, fps):
    assert held_poses(with_pose(frames, fps)) == (frames, 0)
    assert held_poses(with_pose(frames, fps, at_end=True)) == (0, frames)


def test_a_movement_out_of_the_pose_is_none():
    assert held_poses(swinging(person(), 90, 30.0, angle=1.0)) == (0, 0)


def test_a_body_that_never_moves_is_none():
    skeleton = person()
    still = Motion(skeleton, np.tile(rot.IDENTITY, (40, len(skeleton), 1)), np.zeros((40, 3)), 30)
    assert held_poses(still) == (0, 0)
