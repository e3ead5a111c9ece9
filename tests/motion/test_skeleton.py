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
