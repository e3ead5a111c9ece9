import numpy as np

from onbeat.motion import Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import forward_kinematics, local_rotations
from persons import person, swinging

ARM = Skeleton(("shoulder", "elbow", "hand"), [-1, 0, 1], [[0, 0, 0], [1, 0, 0], [1, 0, 0]])


def test_an_arm_bends():
    bent = np.array([rot.yaw(np.pi / 2), rot.yaw(np.pi / 2), rot.IDENTITY])
    world, positions = forward_kinematics(ARM, bent, np.array([0, 0, 1.0]))
    np.testing.assert_allclose(positions, [[0, 0, 1], [0, 1, 1], [-1, 1, 1]], atol=1e-12)
    assert rot.angle_between(world[2], rot.yaw(np.pi)) < 1e-9


def test_bones_keep_their_length():
    p = swinging(person()).positions
    lengths = np.linalg.norm(p[:, 1:] - p[:, person().parents[1:]], axis=-1)
    np.testing.assert_allclose(lengths, np.tile(person().bone_lengths[1:], (60, 1)), atol=1e-12)


def test_translations_replace_offsets():
    stretched = np.tile(ARM.offsets, (4, 1, 1)) * 2
    _, positions = forward_kinematics(ARM, np.tile(rot.IDENTITY, (4, 3, 1)), np.zeros((4, 3)), stretched)
    np.testing.assert_allclose(positions[:, 2, 0], 4)


def test_local_rotations_undo_the_kinematics():
    motion = swinging(person())
    again = local_rotations(motion.skeleton, motion.world_rotations)
    assert rot.angle_between(again, motion.rotations).max() < 1e-7
