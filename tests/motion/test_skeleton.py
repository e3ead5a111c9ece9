import pickle

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import Skeleton
from persons import person


def test_rest_positions_and_children():
    s = person()
    knee = s.index("LeftKnee")
    np.testing.assert_allclose(s.rest_positions[knee], [-0.1, 0, -0.47])
    assert s.children[knee] == (s.index("LeftAnkle"),)
    assert len(s) == len(s.names)


def test_values_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        person().offsets[0] = 1


def test_equality_is_to_a_micrometre():
    s = person()
    near = Skeleton(s.names, s.parents, s.offsets + 1e-7 * (np.arange(len(s)) > 0)[:, None], s.end_sites)
    assert near == s
    assert hash(near) == hash(s)
    assert person(1.01) != s
    assert s != "a skeleton"


@pytest.mark.parametrize(
    ("names", "parents", "offsets", "message"),
    [
        ([], [], np.zeros((0, 3)), "no joints"),
        (["a", "a"], [-1, 0], np.zeros((2, 3)), "joint names occur twice: a"),
        (["a", "b"], [-1, -1], np.zeros((2, 3)), "not one tree"),
        (["a", "b"], [-1, 1], np.zeros((2, 3)), "not one tree"),
        (["a", "b"], [-1, 0], np.zeros((3, 3)), "offsets of shape"),
        (["a", "b"], [-1, 0], [[0, 0, 0], [0, np.nan, 0]], "the offset of joint 'b' is not a finite number"),
    ],
)
def test_what_is_no_tree_is_refused(names, parents, offsets, message):
    with pytest.raises(FormatError, match=message):
        Skeleton(names, parents, offsets)


def test_unknown_names_are_answered_with_the_known_ones():
    with pytest.raises(FormatError, match="no joint 'tail'; the skeleton has Hips, Spine"):
        person().index("tail")


def test_told_roles_are_kept_in_order_and_do_not_count_in_equality():
    told = person().with_roles({"left_wrist": "LeftElbow", "head": "Neck"})
    assert list(told.roles.items()) == [("head", "Neck"), ("left_wrist", "LeftElbow")]
    assert told == person()
    assert hash(told) == hash(person())
    assert not person().roles
    with pytest.raises(TypeError):
        told.roles["head"] = "Head"
    assert pickle.loads(pickle.dumps(told)).roles == told.roles


@pytest.mark.parametrize(
    ("roles", "message"),
    [
        ({"left_rist": "LeftWrist"}, r"no role 'left_rist' \(is 'left_wrist' or .* meant\?\); there are hips, spine"),
        (
            {"head": "Haed"},
            r"head is to be 'Haed', which is no joint \(is 'Head' .*meant\?\); the skeleton has Hips, Spine",
        ),
        ({"head": ""}, r"head is to be '', which is no joint; the skeleton has"),
    ],
)
def test_told_roles_that_are_not_known_are_refused(roles, message):
    with pytest.raises(FormatError, match=message):
        Skeleton(["Hips", "Spine", "Head"], [-1, 0, 1], np.zeros((3, 3)), roles=roles)


def test_a_changed_copy_keeps_what_is_told():
    told = person().with_roles({"left_wrist": "LeftElbow", "hips": "Hips"})
    assert told.replace(offsets=told.offsets * 2).roles == told.roles
    assert told.replace(names=[f"j{n}" for n in range(len(told))]).roles == {
        "hips": "j0",
        "left_wrist": f"j{told.index('LeftElbow')}",
    }
    below = told.replace(
        names=told.names[1:6], parents=[-1, 0, 1, 2, 3], offsets=told.offsets[1:6], end_sites=told.end_sites[1:6]
    )
    assert not below.roles  # the joints they are told of are gone
    assert told.with_roles({}) is told
    assert told.with_roles({"hips": "Spine"}).roles["hips"] == "Spine"
