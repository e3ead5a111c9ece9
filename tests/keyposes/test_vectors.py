import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.errors import BodyError, MetricError
from onbeat.keyposes.vectors import CROWN, body_size, pose_vectors
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.edit import scaled


@pytest.fixture(scope="module")
def dance():
    return dancers(1)[0].motion


@pytest.fixture(scope="module")
def own(dance):
    return pose_vectors([dance])[0]


def test_a_pose_is_three_numbers_a_point_in_body_sizes(dance, own):
    assert own.values.shape == (len(dance), 3 * len(own.points))
    assert {"hips", "left_wrist", "right_toe", CROWN} <= set(own.points)
    hips = own.points.index("hips")
    assert np.abs(own.values[:, 3 * hips : 3 * hips + 3]).max() < 1e-12
    assert 0.3 < np.abs(own.values).max() < 1.0
    assert not own.values.flags.writeable


def test_the_way_back_gives_the_joints(dance, own):
    assert np.abs(own.world() - dance.positions[:, own.joints]).max() < 1e-12


def test_place_and_facing_are_not_in_a_pose(dance, own):
    turn = rot.yaw(2.0)
    rotations = np.array(dance.rotations)
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    path = rot.rotate(turn, dance.root_positions) + np.array([3.0, -2.0, 0.5])
    moved = dance.replace(rotations=rotations, root_positions=path)
    assert np.abs(pose_vectors([moved])[0].values - own.values).max() < 1e-9


def test_size_is_not_in_a_pose(dance, own):
    tall = pose_vectors([scaled(dance, 1.3)])[0]
    assert np.abs(tall.values - own.values).max() < 1e-9
    assert tall.size == pytest.approx(1.3 * own.size)
    assert body_size(dance, Body.of(dance.skeleton)) == own.size


def test_a_pose_between_frames_does_not_depend_on_the_rate():
    slow, fast = (pose_vectors([dancers(1, fps=fps)[0].motion])[0] for fps in (30.0, 120.0))
    times = np.arange(1.0, 10.0, 0.0371)
    off = np.linalg.norm((slow.at(times) - fast.at(times)).reshape(len(times), -1, 3), axis=-1) * slow.size
    assert off.mean() < 0.003
    assert np.abs(slow.speeds(times) - fast.speeds(times)).mean() < 0.03


def test_times_outside_of_the_motion_are_its_ends(own):
    assert np.array_equal(own.at(np.array([-5.0, 999.0])), own.values[[0, -1]])


def test_people_are_compared_by_the_points_that_all_have(dance):
    body = Body.of(dance.skeleton)
    headless = dance.skeleton.replace(
        names=[f"{name}_x" if name == "HeadEnd" else name for name in dance.skeleton.names]
    )
    handless = [j for j in range(len(headless)) if j not in (body["left_hand"], body["right_hand"])]
    parents = [handless.index(headless.parents[j]) if j else -1 for j in handless]
    other = Skeleton([headless.names[j] for j in handless], parents, headless.offsets[handless])
    bare = Motion(other, dance.rotations[:, handless], dance.root_positions, dance.fps)
    first, second = pose_vectors([dance, bare])
    assert first.points == second.points
    assert "left_hand" not in first.points
    assert np.abs(first.values - second.values).max() < 1e-9


def test_what_is_no_body_is_named():
    rod = Skeleton(("foot", "head"), [-1, 0], [[0, 0, 0], [0, 0, 1.7]])
    with pytest.raises(BodyError, match="rod: no joint found"):
        pose_vectors([Motion(rod, np.tile(rot.IDENTITY, (2, 2, 1)), np.zeros((2, 3)), 30, "rod")])
    with pytest.raises(MetricError, match="no motion"):
        pose_vectors([])


def test_a_body_without_size_is_refused(dance):
    point = dance.skeleton.replace(offsets=np.zeros_like(dance.skeleton.offsets))
    with pytest.raises(BodyError, match=r"^point: the arms and legs have no length, so a body cannot be told"):
        pose_vectors([Motion(point, dance.rotations, dance.root_positions, dance.fps, "point")])
    speck = dance.skeleton.replace(offsets=dance.skeleton.offsets * 1e-4)
    with pytest.raises(MetricError, match=r"the body of speck is 0\.0001"):
        pose_vectors([Motion(speck, dance.rotations, dance.root_positions, dance.fps, "speck")])
    huge = dance.skeleton.replace(offsets=dance.skeleton.offsets * 1e150)
    with pytest.raises(MetricError, match="is the unit right"):
        pose_vectors([Motion(huge, dance.rotations, dance.root_positions, dance.fps)])


def test_poses_of_another_motion_do_not_fit(own):
    with pytest.raises(MetricError, match="cannot stand for"):
        own.world(own.values[:3])
