import numpy as np
import pytest

from folk_dancers import dancers, spaces_of
from onbeat.errors import MetricError
from onbeat.formats import read_motion
from onbeat.keyposes.playable import bone_ends, nearest_rotation, playable, points_below
from onbeat.keyposes.space import KeyposeSpace
from onbeat.keyposes.vectors import pose_vectors
from onbeat.motion import rotations as rot
from onbeat.motion.mirror import mirrored


@pytest.fixture(scope="module")
def dance():
    return dancers(1)[0].motion


@pytest.fixture(scope="module")
def own(dance):
    return pose_vectors([dance])[0]


def lengths(motion):
    above = motion.skeleton.parents[1:]
    return np.linalg.norm(motion.positions[:, 1:] - motion.positions[:, above], axis=-1)


def test_its_own_points_give_a_motion_back(dance, own):
    again = playable(own.values, own, dance)
    assert np.abs(again.positions - dance.positions).max() < 1e-5
    assert rot.angle_between(again.rotations, dance.rotations).max() < 1e-3


def test_bones_keep_their_lengths_and_hips_their_path():
    found = spaces_of(3)
    for space in ("keyposes", "uniform"):
        made = found.motion(1, space, 2)
        assert np.abs(lengths(made) - made.skeleton.bone_lengths[1:]).max() < 1e-9
        assert np.array_equal(made.root_positions, found.motions[1].root_positions)
        assert np.abs(np.linalg.norm(made.rotations, axis=-1) - 1).max() < 1e-9


def test_a_playable_motion_is_as_near_to_the_original_as_its_points_are():
    found = spaces_of(3)
    made, original = found.motion(0, "keyposes"), found.motions[0]
    vectors = found.vectors[0]
    raw = np.linalg.norm(vectors.world(found.poses(0, "keyposes")) - vectors.world(), axis=-1).mean()
    off = np.linalg.norm(made.positions - original.positions, axis=-1).mean()
    assert 0.01 < off < 1.1 * raw


def test_joints_turn_smoothly():
    found = spaces_of(3)
    made, original = found.motion(0, "keyposes"), found.motions[0]
    most = [rot.angle_between(m.rotations[1:], m.rotations[:-1]).max() for m in (made, original)]
    assert most[0] < 1.5 * most[1] + 0.2


def test_another_persons_pose_is_taken_over(dance):
    other = mirrored(dance)
    own, theirs = pose_vectors([dance, other])
    made = playable(theirs.values, own, dance)
    assert np.abs(pose_vectors([made])[0].values - theirs.values).max() < 1e-5


def test_bones_that_are_animated_stay_so(dance, own):
    offsets = np.tile(dance.skeleton.offsets, (len(dance), 1, 1)) * (
        1 + 0.01 * np.sin(np.arange(len(dance)))[:, None, None]
    )
    stretching = type(dance)(dance.skeleton, dance.rotations, dance.root_positions, dance.fps, "s", offsets)
    vectors = pose_vectors([stretching])[0]
    made = playable(vectors.values, vectors, stretching)
    assert np.abs(made.positions - stretching.positions).max() < 1e-5


def test_what_hangs_on_no_point_goes_along(dance, own):
    head = dance.skeleton.index("Head")
    assert points_below(dance.skeleton, head, {head}) == []
    ends = bone_ends(dance.skeleton, own.joints)
    assert len(ends) == len(own.points) - 1
    assert {own.points[a] for a, b in ends.tolist() if own.points[b] == "left_elbow"} == {"left_shoulder"}


def test_the_nearest_rotation_keeps_the_usual_twist():
    usual = rot.about(np.array([[1.0, 0, 0]]), np.array([0.7]))
    x = np.eye(3)[None, :1]
    assert rot.angle_between(nearest_rotation(x, x, usual), usual)[0] < 1e-6
    assert rot.angle_between(nearest_rotation(0 * x, x, usual), usual)[0] < 1e-6
    turned = nearest_rotation(np.eye(3)[None, :2], np.eye(3)[None, 1:], usual)
    assert np.allclose(rot.rotate(turned, np.eye(3)[0]), [0, 1, 0], atol=1e-5)


def test_poses_of_another_length_are_refused(dance, own):
    with pytest.raises(MetricError, match="are not those of"):
        playable(own.values, own, dance[:10])
    with pytest.raises(MetricError, match="cannot stand for"):
        playable(own.values[:10], own, dance)


@pytest.mark.data
@pytest.mark.parametrize("file", ["wave-both-hands_youthful_001.bvh", "raise-up-left-hand_elderly_002.bvh"])
def test_recorded_motions_whose_offsets_are_animated_come_back(data, file):
    recorded = read_motion(data / "bandai" / file)
    (own,) = pose_vectors([recorded])
    assert np.abs(playable(own.values, own, recorded).positions - recorded.positions).max() < 1e-4


@pytest.mark.data
@pytest.mark.filterwarnings("ignore")
def test_a_recorded_dancer_keeps_its_bones_in_few_dimensions(data):
    recorded = read_motion(data / "cmu" / "05_15.amc", 120.0)[::4]
    (own,) = pose_vectors([recorded])
    space = KeyposeSpace.of(own.values[::30])
    made = playable(space.reduced(own.values, 3), own, recorded)
    assert np.abs(lengths(made) - recorded.skeleton.bone_lengths[1:]).max() < 1e-9
    raw = np.linalg.norm(own.world(space.reduced(own.values, 3)) - own.world(), axis=-1).mean()
    off = np.linalg.norm(made.positions - recorded.positions, axis=-1).mean()
    assert off < 1.2 * raw
