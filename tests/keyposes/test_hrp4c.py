"""The authored dance of HRP-4C, as the benchmark reads it: the robot's own numbers against what comes out."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.hinges import limit_violations

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def poses():
    pytest.importorskip("yaml")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        yield importlib.import_module("hrp4c_poses")
        for name in ("hrp4c_poses", "hrp4c_body"):
            sys.modules.pop(name, None)


@pytest.fixture(scope="module", params=["rest", "choreonoid"])
def dance(poses, data, request):
    return poses.read_dance(data / "hrp4c_dance", request.param)


def test_72_key_poses_move_the_upper_body(dance):
    assert len(dance.key_poses) == 72
    assert (np.diff(dance.key_poses) >= 0).all()
    assert dance.key_poses[-1] < dance.motion.duration


def test_waist_and_feet_are_where_the_key_poses_put_them(dance):
    motion = dance.motion
    assert set(dance.places) == {"WAIST", "L_ANKLE_R", "R_ANKLE_R"}
    assert dance.out_of_reach.max() < 1e-9
    for name, (positions, rotations) in dance.places.items():
        joint = motion.skeleton.index(name)
        assert np.linalg.norm(motion.positions[:, joint] - positions, axis=1).max() < 1e-6
        assert rot.angle_between(motion.world_rotations[:, joint], rotations).max() < 1e-6


def test_the_legs_bend_as_the_author_bent_them(poses, dance, data):
    import yaml

    refs = yaml.safe_load((data / "hrp4c_dance" / "TurnToTheFuture.pseq").read_text(encoding="utf-8"))["refs"]
    first = dict(zip(refs[0]["refer"]["joints"], refs[0]["refer"]["q"], strict=True))
    # The sequence's joints are numbered as the body's hinges; its feet stand a little lower than its angles put them.
    leg = [k for k in first if k < 13]
    np.testing.assert_allclose(dance.angles[0, leg], [first[k] for k in leg], atol=np.radians(4))


def test_joints_stay_within_their_limits_and_the_body_upright(dance):
    past = limit_violations(dance.body, dance.angles, dance.motion.fps)
    assert past.angle.max() < 0.01
    chest = dance.motion.world_rotations[:, dance.motion.skeleton.index("CHEST_Y")]
    assert rot.rotate(chest, np.array([0.0, 0.0, 1.0]))[:, 2].min() > np.cos(np.radians(20))


def test_feet_that_stand_do_not_slide_and_soles_stay_above_the_floor(poses, dance):
    motion = dance.motion
    for foot, toe, heel in (("L_ANKLE_R", "L_TOE", "L_HEEL"), ("R_ANKLE_R", "R_TOE", "R_HEEL")):
        path = motion.positions[:, motion.skeleton.index(foot)]
        speed = np.linalg.norm(np.gradient(path[:, :2], axis=0), axis=1) * motion.fps
        assert speed[path[:, 2] < 0.0945].max() < 0.05
        assert motion.positions[:, [motion.skeleton.index(end) for end in (toe, heel)], 2].min() > -0.002


def test_the_body_has_its_roles_where_they_are(dance):
    body = Body.of(dance.motion.skeleton)
    assert body.skeleton.names[body["left_wrist"]] == "L_WRIST_R"  # L_WRIST_Y turns in the elbow
    assert {"right_knee", "right_ankle", "left_elbow", "chest", "head"} <= set(body.joints)


def test_a_held_joint_moves_only_during_its_transition(poses):
    keys = [poses.Key(0.0, np.array([0.0]), 0.0, False), poses.Key(2.0, np.array([1.0]), 0.5, False)]
    found = poses.follow(keys, np.array([0.0, 1.0, 1.5, 1.75, 2.0, 3.0]))[:, 0]
    np.testing.assert_allclose(found, [0, 0, 0, 0.5, 1, 1], atol=1e-12)


def test_a_leg_out_of_reach_is_told(poses):
    leg = sys.modules["hrp4c_body"].Leg(np.zeros(3), 0.0, 0.4, 0.4)
    still = np.array([[1.0, 0, 0, 0]])
    angles, missing = poses.bend_leg(leg, (np.array([[0, 0, 1.0]]), still), (np.zeros((1, 3)), still))
    np.testing.assert_allclose(missing, 0.2)
    np.testing.assert_allclose(angles, 0.0, atol=1e-9)
