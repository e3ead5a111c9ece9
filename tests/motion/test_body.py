import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats import read_motion
from onbeat.motion import Body, Skeleton, body_frames
from onbeat.motion import rotations as rot
from onbeat.motion.body import NEEDED, facing
from persons import person, swinging


def chain(*names: str) -> dict[str, str]:
    return dict(zip(names[1:], names[:-1], strict=True))


def body_of(spine: str, arm: str, leg: str, marks: str, on: str) -> Body:
    """A body from its joints' names from the root out; ``#`` stands for the side, ``,`` parts the names."""
    trunk = spine.split(",")
    tree = {trunk[0]: ""} | chain(*trunk)
    for mark in marks.split(","):
        tree |= chain(on, *arm.replace("#", mark).split(","))
        tree |= chain(trunk[0], *leg.replace("#", mark).split(","))
    names = list(tree)
    offsets = np.full((len(names), 3), 0.1) * (np.arange(len(names)) > 0)[:, None]
    return Body.of(Skeleton(names, [names.index(p) if p else -1 for p in tree.values()], offsets))


# spine, arm, leg, marks of the sides, the joint on which the arms hang, and what plays the roles of ASKED
SCHEMES = {
    "CMU": (
        "root,lowerback,upperback,thorax,lowerneck,upperneck,head",
        "#clavicle,#humerus,#radius,#wrist,#hand,#fingers",
        "#hipjoint,#femur,#tibia,#foot,#toes",
        "l,r",
        "thorax",
        "root,thorax,lclavicle,lhumerus,lradius,lwrist,lfemur,ltibia,lfoot,ltoes",
    ),
    "CMU as BVH": (
        "Hips,LowerBack,Spine,Spine1,Neck,Neck1,Head",
        "#Shoulder,#Arm,#ForeArm,#Hand,#FingerBase",
        "#HipJoint,#UpLeg,#Leg,#Foot,#ToeBase",
        "Left,Right",
        "Spine1",
        "Hips,Spine1,LeftShoulder,LeftArm,LeftForeArm,LeftHand,LeftUpLeg,LeftLeg,LeftFoot,LeftToeBase",
    ),
    "CMU as BVH, joints named": (
        "Hips,lowerback,Chest,Chest2,lowerneck,Neck,Head",
        "#Collar,#Shoulder,#Elbow,#Wrist",
        "#Hip,#Knee,#Ankle,#Toe",
        "Left,Right",
        "Chest2",
        "Hips,Chest2,LeftCollar,LeftShoulder,LeftElbow,LeftWrist,LeftHip,LeftKnee,LeftAnkle,LeftToe",
    ),
    "Mixamo": (
        "m:Hips,m:Spine,m:Spine1,m:Spine2,m:Neck,m:Head",
        "m:#Shoulder,m:#Arm,m:#ForeArm,m:#Hand,m:#HandMiddle1",
        "m:#UpLeg,m:#Leg,m:#Foot,m:#ToeBase",
        "Left,Right",
        "m:Spine2",
        "m:Hips,m:Spine2,m:LeftShoulder,m:LeftArm,m:LeftForeArm,m:LeftHand,m:LeftUpLeg,m:LeftLeg,m:LeftFoot,m:LeftToeBase",
    ),
    "LAFAN1": (
        "Hips,Spine,Spine1,Spine2,Neck,Head",
        "#Shoulder,#Arm,#ForeArm,#Hand",
        "#UpLeg,#Leg,#Foot,#Toe",
        "Left,Right",
        "Spine2",
        "Hips,Spine2,LeftShoulder,LeftArm,LeftForeArm,LeftHand,LeftUpLeg,LeftLeg,LeftFoot,LeftToe",
    ),
    "Bandai-Namco": (
        "Hips,Spine,Chest,Neck,Head",
        "Shoulder_#,UpperArm_#,LowerArm_#,Hand_#",
        "UpperLeg_#,LowerLeg_#,Foot_#,Toes_#",
        "L,R",
        "Chest",
        "Hips,Chest,Shoulder_L,UpperArm_L,LowerArm_L,Hand_L,UpperLeg_L,LowerLeg_L,Foot_L,Toes_L",
    ),
    "SMPL": (
        "pelvis,spine1,spine2,spine3,neck,head",
        "#_collar,#_shoulder,#_elbow,#_wrist,#_hand",
        "#_hip,#_knee,#_ankle,#_foot",
        "left,right",
        "spine3",
        "pelvis,spine3,left_collar,left_shoulder,left_elbow,left_wrist,left_hip,left_knee,left_ankle,left_foot",
    ),
    "Biped": (
        "Bip01,Bip01 Spine,Bip01 Spine1,Bip01 Neck,Bip01 Head",
        "Bip01 # Clavicle,Bip01 # UpperArm,Bip01 # Forearm,Bip01 # Hand",
        "Bip01 # Thigh,Bip01 # Calf,Bip01 # Foot,Bip01 # Toe0",
        "L,R",
        "Bip01 Neck",
        "Bip01,Bip01 Spine1,Bip01 L Clavicle,Bip01 L UpperArm,Bip01 L Forearm,Bip01 L Hand,"
        "Bip01 L Thigh,Bip01 L Calf,Bip01 L Foot,Bip01 L Toe0",
    ),
}
SIDE = ("collar", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toe")
ASKED = ("hips", "chest", *(f"left_{role}" for role in SIDE))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_roles_of_the_naming_schemes(scheme):
    *rows, expected = (words.replace("m:", "mixamorig:") for words in SCHEMES[scheme])
    body = body_of(*rows)
    assert ",".join(body.skeleton.names[body[role]] for role in ASKED) == expected
    for role, joint in body.joints.items():
        if role.startswith("left_"):
            other = body["right_" + role.removeprefix("left_")]
            assert body.skeleton.names[other] != body.skeleton.names[joint]
    assert len(set(body.joints.values())) == len(body.joints)


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
