"""Bodies that are their own mirror image, by their toes and knees."""

import warnings

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats import read_motion, write_markers, write_motion
from onbeat.formats.read import MirroredWarning
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.handedness import is_mirrored
from onbeat.motion.joint_markers import joint_markers
from onbeat.motion.mirror import mirrored
from onbeat.motion.problems import problems
from persons import person, swinging


def dancing() -> Motion:
    """A person with bent knees."""
    motion = swinging(person(), frames=90, angle=0.15)
    bent = np.array(motion.rotations)
    for side in ("Left", "Right"):
        for joint, degrees in (("Hip", 25), ("Knee", -50)):
            at = motion.skeleton.index(side + joint)
            bent[:, at] = rot.multiply(bent[:, at], rot.about(np.array([1.0, 0, 0]), np.radians(degrees)))
    return motion.replace(rotations=bent)


def reflected(motion: Motion) -> Motion:
    """X negated and no names changed, as files of left-handed axes have it when they are read as right-handed ones."""
    skeleton = motion.skeleton.replace(offsets=motion.skeleton.offsets * [-1, 1, 1])
    turns = motion.rotations * [1, 1, -1, -1]
    return Motion(skeleton, turns, motion.root_positions * [-1, 1, 1], motion.fps, motion.name)


def judged(motion: Motion) -> bool:
    return is_mirrored(motion, Body.of(motion.skeleton))


@pytest.mark.parametrize("axis", [[1.0, 0, 0], [0, 1.0, 0], [0.6, 0, 0.8]])
@pytest.mark.parametrize("degrees", [0, 75, 180])
def test_a_mirrored_body_is_told_however_it_lies(axis, degrees):
    motion = dancing()
    turns = np.array(motion.rotations)
    turns[:, 0] = rot.multiply(rot.about(np.array(axis), np.radians(degrees)), turns[:, 0])
    lying = motion.replace(rotations=turns)
    assert not judged(lying)
    assert judged(reflected(lying))


def test_a_dance_the_other_way_round_is_a_dance():
    assert not judged(mirrored(dancing()))


def without_toes(motion: Motion) -> Motion:
    s = motion.skeleton
    kept = [joint for joint, name in enumerate(s.names) if "Toe" not in name]
    parents = [-1, *(kept.index(int(s.parents[joint])) for joint in kept[1:])]
    rest = Skeleton([s.names[joint] for joint in kept], parents, s.offsets[kept], s.end_sites[kept])
    return Motion(rest, motion.rotations[:, kept], motion.root_positions, motion.fps)


def test_without_toes_bent_knees_tell_and_straight_legs_say_nothing():
    bent, stiff = without_toes(dancing()), without_toes(swinging(person(), frames=30, angle=0.0))
    assert "left_toe" not in Body.of(bent.skeleton)
    assert [judged(bent), judged(reflected(bent))] == [False, True]
    assert [judged(stiff), judged(reflected(stiff))] == [False, False]


def test_it_is_said_of_files_and_in_their_report(tmp_path):
    write_motion(reflected(dancing()), tmp_path / "a.bvh")
    with pytest.warns(MirroredWarning, match=r"^a\.bvh: toes and knees point backwards"):
        found = read_motion(tmp_path / "a.bvh")
    assert any("mirrored" in line for line in problems(found))
    write_markers(joint_markers(reflected(dancing())), tmp_path / "a.trc")
    with pytest.warns(MirroredWarning, match=r"^a\.trc: toes and knees point backwards"):
        read_motion(tmp_path / "a.trc")


def test_who_is_upside_down_all_the_time_is_said():
    motion = dancing()
    turns = np.array(motion.rotations)
    turns[:, 0] = rot.multiply(rot.about(np.array([1.0, 0, 0]), np.pi), turns[:, 0])
    assert any("the head is under the feet" in line for line in problems(motion.replace(rotations=turns)))
    assert not any("the head is under the feet" in line for line in problems(motion))


def test_no_real_motion_is_taken_for_its_image(data):
    files = [*(data / "cmu").rglob("*.bvh"), *(data / "cmu").rglob("*.amc"), *(data / "g1_moves").glob("*.csv")]
    files += [*sorted((data / "bandai").rglob("*.bvh"))[::8], *(data / "c3d").glob("*.trc")]
    judgements: list[bool] = []
    for path in files:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                judgements.append(judged(read_motion(path)))
            except BodyError:
                continue
    assert len(judgements) > 50
    assert not any(judgements)
