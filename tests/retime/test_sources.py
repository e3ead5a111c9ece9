import numpy as np
import pytest

from onbeat.errors import OnbeatError, PlanError
from onbeat.examples.body import Build
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.motion.unitree_g1 import G1
from onbeat.retime.bspline import Spline
from onbeat.retime.lock import TimeMap
from onbeat.retime.retime import retime
from onbeat.retime.sources import Character, Robot, Table, is_g1, source_of
from onbeat.retime.upper_body import above_the_legs

FPS = 60.0
BEATS = np.arange(0, 4.01, 0.5)
KEYPOSES = np.arange(0.25, 4, 0.5)


def robot(seconds: float = 4.0) -> Motion:
    """A G1 that waves all its hinges within their range while it goes along a curve."""
    times = np.arange(int(seconds * FPS) + 1) / FPS
    phase = np.arange(len(G1.names))
    middle, half = (G1.low + G1.high) / 2, (G1.high - G1.low) / 2
    angles = middle + 0.3 * half * np.sin(2 * np.pi * times[:, None] + phase)
    root = np.stack((np.sin(times), times / 3, 0.75 + 0.02 * np.cos(times)), axis=1)
    return hinge_motion(G1, root, rot.about(np.array([0, 0, 1.0]), np.sin(times)), angles, FPS, "wave")


def dancer(seconds: float = 4.0, size: float = 1.0, fps: float = FPS) -> Motion:
    """A person all of whose joints turn in all directions."""
    skeleton, times = Build(1.7).skeleton, np.arange(int(seconds * fps) + 1) / fps
    rng = np.random.default_rng(0)
    hertz, phase = rng.uniform(0.3, 1.6, (2, 1, len(skeleton), 3))
    rotations = rot.exp(size * np.sin(2 * np.pi * hertz * times[:, None, None] + 7 * phase))
    root = np.stack((np.sin(times), times / 3, 1 + 0.05 * np.cos(3 * times)), axis=1)
    return Motion(skeleton, rotations, root, fps, "dancer")


def limits(source: Character, speed: float = 2.0, acceleration: float = np.inf) -> Limits:
    n = len(source.joints)
    return Limits(
        "person", source.joints, np.array(-np.inf), np.array(np.inf), np.full(n, speed), np.full(n, acceleration)
    )


def angular(rotations: np.ndarray, hertz: float) -> np.ndarray:
    """(N − 1, J) rad/s between neighbouring rotations, without the cosine's loss near 0."""
    turn = rot.multiply(rot.inverse(rotations[:-1]), rotations[1:])
    return 2 * np.arcsin(np.minimum(np.linalg.norm(turn[..., 1:], axis=-1), 1)) * hertz


def test_a_table_goes_through_its_rows_and_comes_back():
    angles = np.random.default_rng(0).normal(size=(50, 2))
    source = source_of(JointAngles(("a", "b"), angles, 30.0, "arm"))
    assert isinstance(source, Table)
    assert (source.name, source.joints, source.size) == ("arm", ("a", "b"), 1)
    np.testing.assert_allclose(source.curve(np.arange(50) / 30), angles, atol=1e-12)
    back = source.made(angles, np.arange(50) / 30, 30.0)
    np.testing.assert_array_equal(back.angles, angles)
    assert (back.names, back.fps, back.name) == (("a", "b"), 30.0, "arm")


def test_a_robot_goes_through_its_angles_and_comes_back():
    motion = robot()
    source = source_of(motion)
    assert isinstance(source, Robot)
    assert source.joints == G1.names
    back = source.made(source.curve.samples, motion.times, FPS)
    assert rot.angle_between(back.rotations, motion.rotations).max() < 1e-7
    np.testing.assert_allclose(back.root_positions, motion.root_positions, atol=1e-12)
    assert back.name == "wave"


def test_a_robot_danced_faster_stays_inside_its_table_and_on_its_path():
    source = source_of(robot())
    faster = retime(source, TimeMap.steady(1.5), robot_limits("g1").scaled(0.3), BEATS, KEYPOSES)
    assert faster.measures.violations == (0, 0)
    assert isinstance(faster.dance, Motion)
    again = source_of(faster.dance)
    np.testing.assert_allclose(again.curve.samples, faster.answer.trajectory.samples, atol=1e-7)
    wanted = robot().at(faster.dance.times * 1.5)
    np.testing.assert_allclose(faster.dance.root_positions, wanted.root_positions, atol=1e-12)
    assert rot.angle_between(faster.dance.rotations[:, 0], wanted.rotations[:, 0]).max() < 1e-7


def test_a_character_is_found_to_be_one_and_a_g1_not():
    assert is_g1(robot(0.1))
    assert not is_g1(dancer(0.1))
    assert isinstance(source_of(dancer(0.1)), Character)


@pytest.mark.parametrize("method", ["qp", "layers-qp", "layers2007"])
def test_joints_of_a_character_turn_no_faster_than_their_speed(method: str):
    """The angular speed itself, not that of vectors, a thousand times a second."""
    motion = dancer()
    source = source_of(motion)
    assert isinstance(source, Character)
    assert (angular(motion.rotations[:, list(source.chosen)], FPS).max(axis=0) > 3).all(), "else there is no need"
    faster = retime(source, TimeMap.steady(1.2), limits(source, 2.0), BEATS, KEYPOSES, method)
    assert faster.measures.violations == (0, 0)
    assert isinstance(faster.dance, Motion)
    times = np.arange(0, faster.answer.trajectory.knots.end, 1e-3)
    vectors = faster.answer.trajectory(times).reshape(len(times), -1, 3)
    assert angular(source.turning.rotations(vectors), 1000.0).max() <= 2.0 + 1e-6
    shown = faster.dance.at(times).rotations[:, list(source.chosen)]
    assert angular(shown, 1000.0).max() <= 2.0 + 1e-6
    assert angular(shown, 1000.0).max() > 1.8, "nor much slower than it may"


def test_legs_and_root_of_a_character_are_the_same_at_another_time():
    motion = dancer()
    source = source_of(motion)
    assert isinstance(source, Character)
    faster = retime(source, TimeMap.steady(1.25), limits(source), BEATS, KEYPOSES).dance
    assert isinstance(faster, Motion)
    wanted = motion.at(faster.times * 1.25)
    rest = [k for k in range(len(motion.skeleton)) if k not in source.chosen]
    assert rot.angle_between(faster.rotations[:, rest], wanted.rotations[:, rest]).max() < 1e-7
    np.testing.assert_allclose(faster.root_positions, wanted.root_positions, atol=1e-12)
    assert rot.angle_between(faster.rotations, wanted.rotations).max() > 0.1, "the others were slowed"
    assert {"LeftUpLeg", "RightFoot", "Hips"} <= {motion.skeleton.names[k] for k in rest}


def test_without_need_a_character_is_the_same_at_another_time():
    motion = dancer()
    source = source_of(motion)
    assert isinstance(source, Character)
    same = retime(source, TimeMap.steady(1.0), limits(source, 100.0, 1e5), BEATS, KEYPOSES).dance
    assert isinstance(same, Motion)
    assert rot.angle_between(same.rotations, motion.rotations).max() < 1e-6


def test_a_box_of_speeds_has_its_far_corner_at_the_joints_speed():
    source = source_of(dancer())
    assert isinstance(source, Character)
    wish = source.curve
    box = source.speed(limits(source, 2.0), wish).reshape(len(wish.controls) - 1, -1, 3)
    np.testing.assert_allclose(np.linalg.norm(box, axis=2), 2.0, atol=1e-12)
    assert (box > 0.2).all()


def test_a_box_of_speeds_is_long_where_the_joint_turns():
    vectors = np.zeros((200, 3))
    vectors[:100, 0] = np.arange(100) / 60
    vectors[100:, :2] = np.stack((np.full(100, 99 / 60), np.arange(100) / 30), axis=1)
    source = source_of(dancer(0.1), ["Head"])
    box = source.speed(limits(source, 1.0), Spline.through(vectors, 60.0))  # pyright: ignore[reportArgumentType]
    assert (box[10:80, 0] > 0.9).all()
    assert (box[120:190, 1] > 0.9).all()
    assert np.isfinite(box).all()


def test_a_character_that_stands_still_may_turn_any_way():
    source = source_of(dancer(0.1), ["Head"])
    still = Spline.through(np.zeros((5, 3)), 60.0)
    box = source.speed(limits(source, 3.0), still)  # pyright: ignore[reportArgumentType]
    np.testing.assert_allclose(box, 3 / np.sqrt(3))


def test_a_joint_without_a_limit_is_free():
    source = source_of(dancer(0.5), ["Head"])
    free = Limits("free", ("Head",), [-np.inf], [np.inf], [np.inf])
    assert np.isposinf(source.speed(free, source.curve)).all()
    same = retime(source, TimeMap.steady(1.0), free, BEATS, KEYPOSES)
    assert same.measures.violations == (0, 0)
    assert same.measures.rms.max() < 1e-12


def test_told_joints_are_those_that_are_retimed():
    source = source_of(dancer(0.1), ["Head", "LeftArm", "Head"])
    assert source.joints == ("Head", "LeftArm")
    assert source.curve.channels == 6


def test_the_upper_body_is_all_but_legs_root_and_ends():
    skeleton = Build(1.7).skeleton
    names = {skeleton.names[k] for k in above_the_legs(skeleton)}
    assert {"Spine", "Chest", "Head", "LeftArm", "RightForeArm"} <= names
    assert not names & {"Hips", "LeftUpLeg", "LeftLeg", "RightFoot"}
    assert not any(skeleton.end_sites[k] for k in above_the_legs(skeleton))


@pytest.mark.parametrize(
    ("joints", "said"), [(["Wing"], "Wing"), (["Head", ""], "joint"), (["no such", "LeftArm"], "no such")]
)
def test_a_joint_that_is_not_there_is_named(joints: list[str], said: str):
    with pytest.raises(OnbeatError, match=said):
        source_of(dancer(0.1), joints)


def test_the_end_of_a_bone_is_no_joint():
    skeleton = Build(1.7).skeleton
    end = skeleton.names[int(np.argmax(skeleton.end_sites))]
    with pytest.raises(PlanError, match="has no rotation of its own"):
        source_of(dancer(0.1), [end])


@pytest.mark.parametrize("dance", [robot(0.1), JointAngles(("a",), np.zeros((5, 1)), 30.0)], ids=["g1", "table"])
def test_joints_are_not_told_of_robots(dance: Motion | JointAngles):
    with pytest.raises(PlanError, match="joints are told of characters alone"):
        source_of(dance, ["a"])


def test_a_body_with_nothing_to_retime_says_so():
    top = Motion(Skeleton(("top",), [-1], [[0, 0, 0]]), np.tile(rot.IDENTITY, (60, 1, 1)), np.zeros((60, 3)), 30)
    with pytest.raises(PlanError, match="no joint but its root and legs"):
        source_of(top)
    with pytest.raises(PlanError, match="dancer has no joint"):
        source_of(dancer(0.1), [])


def test_one_frame_is_a_dance_of_a_frame():
    motion = dancer()[:1]
    source = source_of(motion)
    same = retime(source, TimeMap.steady(1.0), limits(source), BEATS, KEYPOSES)  # pyright: ignore[reportArgumentType]
    assert isinstance(same.dance, Motion)
    assert rot.angle_between(same.dance.rotations, motion.rotations).max() < 1e-7
