import numpy as np
import pytest

from folk_dancers import dancers, spaces_of
from onbeat.errors import BodyError
from onbeat.keyposes.unnatural import Natural, bone_gaps
from onbeat.keyposes.vectors import pose_vectors


@pytest.fixture(scope="module")
def people():
    return pose_vectors([clip.motion for clip in dancers(3)])


@pytest.fixture(scope="module")
def natural(people):
    return Natural.of(people)


def posed(people, **moved):
    """The first person's first pose with some points moved, in body sizes."""
    pose = people[0].values[:1].reshape(-1, 3).copy()
    for name, place in moved.items():
        pose[people[0].points.index(name)] = place
    return pose.reshape(1, -1)


def place(people, name):
    return people[0].values[0].reshape(-1, 3)[people[0].points.index(name)]


def test_originals_are_natural(people, natural):
    for clip, one in zip(dancers(3), people, strict=True):
        shares = natural.judge(one.values, one, clip.motion).shares()
        assert shares == {"through": 0, "beyond": 0, "stretched": 0, "postures": 0, "length_change": 0}


def test_a_hand_inside_the_trunk_is_unnatural(people, natural):
    inside = 0.5 * (place(people, "hips") + place(people, "neck"))
    found = natural.judge(posed(people, right_wrist=inside, right_hand=inside), people[0], dancers(3)[0].motion)
    assert found.through[0] > 0.05
    assert found.postures[0]


def test_a_leg_bent_to_the_other_side_is_unnatural(people, natural):
    hip, knee, ankle = (place(people, f"left_{part}") for part in ("hip", "knee", "ankle"))
    straight = hip + (ankle - hip) * np.linalg.norm(knee - hip) / np.linalg.norm(ankle - hip)
    behind = straight - [0, 0.12, 0]
    found = natural.judge(posed(people, left_knee=behind), people[0], dancers(3)[0].motion)
    assert np.degrees(found.beyond[0]) > 10
    assert found.postures[0]
    fine = natural.judge(posed(people, left_knee=straight), people[0], dancers(3)[0].motion)
    assert fine.beyond[0] <= 0


def test_a_forearm_folded_into_the_upper_arm_is_unnatural(people, natural):
    near = place(people, "left_shoulder") + np.array([0.0, 0.02, 0.0])
    found = natural.judge(posed(people, left_wrist=near), people[0], dancers(3)[0].motion)
    assert found.beyond[0] > 0


def test_a_longer_bone_is_told(people, natural):
    elbow, wrist = place(people, "left_elbow"), place(people, "left_wrist")
    more = 0.2 * (wrist - elbow)
    pose = posed(people, left_wrist=wrist + more, left_hand=place(people, "left_hand") + more)
    longer = natural.judge(pose, people[0], dancers(3)[0].motion)
    assert longer.stretched[0] == pytest.approx(0.1, abs=0.02)
    assert longer.change[0] > 0


def test_playable_motions_keep_their_bones():
    found = spaces_of(3)
    assert found.unnatural(0, "keyposes", 2, played=True).shares()["stretched"] == 0
    assert found.unnatural(0, "keyposes", 2).shares()["stretched"] > 0.5
    # All dimensions are not the dance, but near: what is natural does not depend on the frame it is seen from.
    points, played = (found.unnatural(0, "keyposes", 99, played=played) for played in (False, True))
    assert np.abs(points.through - played.through).mean() < 0.01


def test_gaps_between_bones_are_those_of_many_points_on_them():
    rng = np.random.default_rng(3)
    poses = rng.normal(size=(40, 4, 3))
    poses[:5, 1] = poses[:5, 0]  # a bone without a length
    poses[5:10, 3] = poses[5:10, 2] + 2 * (poses[5:10, 1] - poses[5:10, 0])  # two along each other
    share = np.linspace(0, 1, 201)[:, None]
    for pose, gap in zip(poses, bone_gaps(poses, np.array([[0, 1, 2, 3]]))[:, 0], strict=True):
        one, other = (pose[k] + share * (pose[k + 1] - pose[k]) for k in (0, 2))
        near = np.linalg.norm(one[:, None] - other[None], axis=-1).min()
        assert near - 0.03 < gap <= near + 1e-9


def test_the_natural_is_learned_from_motions_by_the_same_points(people):
    with pytest.raises(BodyError, match="same points"):
        Natural.of([])
