import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.links import LINKS
from onbeat.moves.graph import GRID
from onbeat.moves.poses import link_weights, pose_vectors
from persons import person, swinging


def rms(a, b):
    return float(np.sqrt(np.mean(np.sum((a - b) ** 2, axis=1))))


@pytest.fixture
def walk():
    return swinging(person(), frames=90, fps=GRID)


def test_weights_have_mean_square_one():
    assert len(link_weights()) == len(LINKS)
    assert np.mean(link_weights() ** 2) == pytest.approx(1)


def test_neither_place_nor_facing_matters(walk):
    turned = walk.replace(
        rotations=np.concatenate((rot.multiply(rot.yaw(1.3), walk.rotations[:, :1]), walk.rotations[:, 1:]), axis=1),
        root_positions=rot.rotate(rot.yaw(1.3), walk.root_positions) + np.array([5.0, -3.0, 0.0]),
    )
    vectors = pose_vectors(walk)
    assert vectors.dtype == np.float32
    assert rms(vectors, pose_vectors(turned)) < 1e-3


def test_height_lean_and_travel_matter(walk):
    vectors = pose_vectors(walk)
    higher = walk.replace(root_positions=walk.root_positions + np.array([0, 0, 0.1]))
    assert rms(vectors, pose_vectors(higher)) > 0.15
    bowed = walk.replace(
        rotations=np.concatenate(
            (rot.multiply(rot.about(np.array([1.0, 0, 0]), 0.4), walk.rotations[:, :1]), walk.rotations[:, 1:]), axis=1
        )
    )
    assert rms(vectors, pose_vectors(bowed)) > 0.2
    backwards = walk.replace(root_positions=walk.root_positions * [-1, 1, 1] + 0.0)
    assert rms(vectors, pose_vectors(backwards)) > 0.1


def test_a_pose_is_told_from_the_same_one_gone_through_backwards(walk):
    forth, back = pose_vectors(walk), pose_vectors(walk[::-1])[::-1]
    assert rms(forth, back) > 0.15
    middle = np.linalg.norm(forth - back, axis=1)[5:-5]
    assert middle.min() > 0.02


def test_the_rate_of_the_source_hardly_matters():
    fine = swinging(person(), frames=240, fps=120.0)
    a, b = (pose_vectors(fine.resampled(fps).resampled(GRID)) for fps in (120.0, 60.0))
    assert rms(a, b) < 0.01


def test_a_joint_turned_by_an_angle_is_about_that_angle_away(walk):
    still = walk[:1].at(np.zeros(30))
    elbow = still.skeleton.index("LeftShoulder")
    rotations = np.array(still.rotations)
    rotations[:, elbow] = rot.multiply(rotations[:, elbow], rot.about(np.array([0, 1.0, 0]), 0.3))
    apart = np.linalg.norm(pose_vectors(still)[15] - pose_vectors(still.replace(rotations=rotations))[15])
    # upper arm, forearm and hand of seventeen links turn by 0.3 rad
    assert 0.3 * np.sqrt(2 / 17) < apart < 0.3 * np.sqrt(4 / 17)


def test_one_frame_has_a_pose(walk):
    assert np.isfinite(pose_vectors(walk[:1])).all()
