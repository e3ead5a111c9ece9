from __future__ import annotations

import numpy as np

from onbeat.capture.body import template
from onbeat.capture.toes import MOST, bend_toes
from onbeat.motion import Motion
from onbeat.motion import rotations as rot


def standing(pitch: np.ndarray, lift: np.ndarray) -> Motion:
    """Feet that point down by ``pitch`` radians, their toes' joints ``lift`` metres over where they stand."""
    skeleton = template().skeleton
    rotations = np.tile(rot.IDENTITY, (len(pitch), len(skeleton), 1))
    for side in ("Left", "Right"):
        rotations[:, skeleton.index(f"{side}Foot")] = rot.about(np.array([1.0, 0, 0]), -pitch)
    motion = Motion(skeleton, rotations, np.zeros((len(pitch), 3)), 60)
    root = np.zeros((len(pitch), 3))
    root[:, 2] = lift - motion.positions[:, skeleton.index("LeftToeBase"), 2]
    return Motion(skeleton, rotations, root, 60)


def test_toes_on_the_floor_bend_and_toes_in_the_air_do_not():
    motion = bend_toes(standing(np.array([0.0, 0.8, 0.8]), np.array([0.0, 0.0, 0.5])), floor=0.0)
    skeleton = motion.skeleton
    tips = motion.positions[:, skeleton.index("LeftToeEnd"), 2] - motion.positions[:, skeleton.index("LeftToeBase"), 2]
    assert abs(tips[0]) < 1e-9
    assert abs(tips[1]) < 1e-9
    assert tips[2] < -0.04


def test_toes_bend_only_so_far():
    motion = bend_toes(standing(np.array([1.5]), np.array([0.0])), floor=0.0)
    angle = rot.angle_between(motion.rotations[:, motion.skeleton.index("LeftToeBase")], rot.IDENTITY)
    assert abs(float(angle[0]) - MOST) < 1e-9
