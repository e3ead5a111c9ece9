"""One performance of the CMU archive as AMC and as somebody else's BVH of it: two files, two readers, one movement.

That BVH has a T-pose in front, and it leaves out two kinds of bones: what hangs on the end of the thorax and of the
wrists (neck, collars; fingers, thumbs) hangs on their start instead, 117 mm and 93 mm off. With these bones put back
all joints agree.
"""

import numpy as np
import pytest

from onbeat.formats import read_motion
from onbeat.motion.kinematics import forward_kinematics

pytestmark = pytest.mark.data

SAME = {
    "root": "Hips", "lowerback": "LowerBack", "upperback": "Spine", "thorax": "Spine1",
    "lowerneck": "Neck", "upperneck": "Neck1", "head": "Head",
    **{f"{side}{acclaim}": bvh.replace("*", word) for side, word in (("l", "Left"), ("r", "Right"))
       for acclaim, bvh in {"femur": "*UpLeg", "tibia": "*Leg", "foot": "*Foot", "toes": "*ToeBase",
                            "clavicle": "*Shoulder", "humerus": "*Arm", "radius": "*ForeArm", "wrist": "*Hand",
                            "hand": "*FingerBase"}.items()},
}  # fmt: skip
LEFT_OUT = {
    "thorax": ("Neck", "LeftShoulder", "RightShoulder"),
    "lwrist": ("LeftFingerBase", "LThumb"),
    "rwrist": ("RightFingerBase", "RThumb"),
}


def test_both_files_put_the_joints_in_the_same_places(data):
    ours = read_motion(data / "cmu" / "01_01.amc", fps=120)
    theirs = read_motion(data / "cmu" / "01_01.bvh")[1:]
    assert theirs.fps == 120
    assert len(theirs) == len(ours)
    offsets = np.array(theirs.skeleton.offsets)
    for bone, joints in LEFT_OUT.items():
        end = ours.skeleton.children[ours.skeleton.index(bone)][0]
        for joint in joints:
            assert theirs.skeleton.bone_lengths[theirs.skeleton.index(joint)] == 0
            offsets[theirs.skeleton.index(joint)] = ours.skeleton.offsets[end]
    whole = theirs.skeleton.replace(offsets=offsets)
    _, positions = forward_kinematics(whole, theirs.rotations, theirs.root_positions)
    a = ours.positions[:, [ours.skeleton.index(name) for name in SAME]]
    b = positions[:, [whole.index(name) for name in SAME.values()]]
    assert np.linalg.norm(a - b, axis=-1).max() < 1e-3


def test_what_the_file_itself_says_agrees_up_to_the_bones_it_leaves_out(data):
    ours = read_motion(data / "cmu" / "01_01.amc", fps=120)
    theirs = read_motion(data / "cmu" / "01_01.bvh")[1:]
    legs = [name for name in SAME if name[1:] in ("femur", "tibia", "foot", "toes") or name in ("root", "thorax")]
    a = ours.positions[:, [ours.skeleton.index(name) for name in legs]]
    b = theirs.positions[:, [theirs.skeleton.index(SAME[name]) for name in legs]]
    assert np.linalg.norm(a - b, axis=-1).max() < 1e-3
