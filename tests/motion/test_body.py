import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats import read_motion
from onbeat.motion import Body, Skeleton, body_frames
from onbeat.motion import rotations as rot
from onbeat.motion.body import NEEDED, ROLES, ancestors, chain_length, facing, frames_from
from persons import person, swinging


def test_hand_and_toe_are_beyond_wrist_and_ankle():
    body = Body.of(person())
    assert body.skeleton.names[body["left_hand"]] == "LeftWrist_end"
    assert body.skeleton.names[body["right_toe"]] == "RightToe"


def test_missing_roles_are_listed():
    with pytest.raises(BodyError, match=r"no joint found for .*left_wrist.*the skeleton has Hips, Spine") as caught:
        Body.of(Skeleton(["Hips", "Spine"], [-1, 0], np.zeros((2, 3))))
    assert all(role in str(caught.value) for role in NEEDED if role not in ("hips",) and role != "chest")
    with pytest.raises(BodyError, match="the body has no tail; it has hips"):
        Body.of(person())["tail"]


def test_leg_length():
    assert Body.of(person(2.0)).leg_length == pytest.approx(2 * (0.42 + np.hypot(0.42, 0.01)))


def test_chains_from_a_joint_up():
    s = person()
    assert [s.names[j] for j in ancestors(s, s.index("LeftKnee"))] == ["LeftKnee", "LeftHip", "Hips"]
    assert chain_length(s, s.index("Hips"), s.index("LeftKnee")) == pytest.approx(0.42 + np.hypot(0.1, 0.05))
    assert set(NEEDED) < set(ROLES)


def test_a_frame_is_square_to_what_points_up():
    frame = frames_from(np.array([0, 0, 2.0]), np.array([3.0, 0, 5]))
    np.testing.assert_allclose(rot.rotate(frame, np.eye(3)), np.eye(3), atol=1e-12)


def test_a_bone_of_several_joints_is_turned_by_the_last():
    s = person()
    twisted = Skeleton(
        ["Hips", "LeftUpLeg", "LeftUpLegTwist", "LeftLeg", "LeftFoot", *s.names[1:]],
        [-1, 0, 1, 2, 3, *[0 if p == 0 else p + 4 for p in s.parents[1:]]],
        [[0, 0, 0], [-0.1, 0, 0], *[[0, 0, -0.2]] * 3, *s.offsets[1:]],
    )
    hip = twisted.index("LeftUpLeg")
    body = Body.of(twisted.with_roles({"left_hip": "LeftUpLeg", "left_knee": "LeftLeg", "left_ankle": "LeftFoot"}))
    assert body["left_hip"] == hip
    assert twisted.names[body.turning("left_hip")] == "LeftUpLegTwist"
    assert body.turning("left_knee") == body["left_knee"]
    plain = Body.of(s)
    assert all(plain.turning(role) == plain[role] for role in plain.joints)


def test_the_body_centre_frame_faces_the_front():
    motion = swinging(person(), angle=0.0)
    frames, origins = body_frames(motion)
    np.testing.assert_allclose(origins, motion.root_positions)
    np.testing.assert_allclose(rot.rotate(frames, np.array([0, 1.0, 0])), np.tile([0, 1.0, 0], (60, 1)), atol=1e-9)
    turned = motion.replace(
        rotations=np.concatenate((np.tile(rot.yaw(0.8), (60, 1, 1)), motion.rotations[:, 1:]), axis=1)
    )
    np.testing.assert_allclose(facing(body_frames(turned)[0]), 0.8)


@pytest.mark.data
@pytest.mark.parametrize(
    "name", ["cmu/05_01.amc", "cmu/01_01.bvh", "cmu/131_01.bvh", "bandai/dance-short_normal_001.bvh"]
)
def test_roles_of_real_bodies_lie_as_in_a_body(data, name):
    motion = read_motion(data / name, fps=120)
    body = Body.of(motion.skeleton)
    frames, waist = body_frames(motion, body)
    local = np.median(rot.rotate(rot.inverse(frames)[:, None], motion.positions - waist[:, None]), axis=0)
    for side, sign in (("left", -1), ("right", 1)):
        x = {role: sign * local[body[f"{side}_{role}"], 0] for role in ("collar", "shoulder", "hip")}
        assert x["shoulder"] > x["hip"] > 0.03
        assert x["shoulder"] > x["collar"] + 0.04
        hip, knee, ankle, toe = (local[body[f"{side}_{role}"]] for role in ("hip", "knee", "ankle", "toe"))
        assert hip[2] > knee[2] > ankle[2] > toe[2] - 0.02
        assert toe[1] > ankle[1]
    assert local[body["head"], 2] > local[body["neck"], 2] >= local[body["chest"], 2] > 0


def test_bodies_without_a_shape_are_refused_in_a_line():
    whole = person()
    with pytest.raises(BodyError, match=r"^the arms and legs have no length, so a body cannot be told; export"):
        Body.of(whole.replace(offsets=np.zeros_like(whole.offsets)))
    lame = np.array(whole.offsets)
    lame[[whole.index("LeftElbow"), whole.index("LeftWrist")]] = 0
    with pytest.raises(BodyError, match=r"^the left arm has no length"):
        Body.of(whole.replace(offsets=lame))
    flat = whole.replace(offsets=np.tile([0, 0.02, 0], (len(whole), 1)))
    with pytest.raises(BodyError, match="left and right of the body cannot be told"):
        body_frames(swinging(flat, angle=0.0))
