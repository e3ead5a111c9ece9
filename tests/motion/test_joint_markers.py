import numpy as np

from onbeat.motion.joint_markers import joint_markers
from onbeat.motion.marker_labels import distinct_labels, safe_labels, shared_prefix
from persons import person, swinging


def test_every_joint_is_a_marker_where_it_is():
    motion = swinging(person(), 7, 60, seed=2)
    found = joint_markers(motion)
    assert (found.names, found.fps, len(found)) == (motion.skeleton.names, 60, 7)
    assert found.seen.all()
    np.testing.assert_array_equal(found.positions, motion.positions)


def test_labels_that_every_program_reads():
    assert safe_labels(["a:Hüfte links", "a:L/R", "a:L R"]) == ("H_fte_links", "L_R", "L_R_2")
    assert safe_labels(["a:x", "b:x"]) == ("a_x", "b_x")
    assert safe_labels(["", " "]) == ("point_1", "point_2")
    long = safe_labels(["x" * 40 + "1", "x" * 40 + "2"])
    assert len(set(long)) == 2
    assert max(map(len, long)) <= 34


def test_twins_never_meet_a_label_that_is_there():
    labels = ["a", "a", "a_2", "a", "", "point_5"]
    found = distinct_labels(labels)
    assert len(set(found)) == len(found)
    assert found[0] == "a"
    assert found[2] == "a_2"


def test_a_label_that_is_only_a_prefix_keeps_it():
    assert shared_prefix(["Anna:", "Anna:LASI"]) == ""
    assert shared_prefix([]) == ""
