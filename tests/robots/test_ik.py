"""A robot's tree as the inverse kinematics sees it."""

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.ik.tree import ROOT, add_point, pose, tree_of, unposed


def posed(x, place, turn):
    tree = tree_of(G1)
    out = unposed(len(tree.parents), len(x))
    pose(tree, x, place, turn, out)
    return tree, out


def test_links_are_where_forward_kinematics_puts_them():
    rng = np.random.default_rng(1)
    x = rng.normal(size=ROOT + 29) * 0.5
    root = rot.normalise(rng.normal(size=4))
    place = rng.normal(size=3)
    _, found = posed(x, place, rot.to_matrix(root))
    turned = rot.multiply(rot.exp(x[3:6]), root)
    motion = hinge_motion(G1, (place + x[:3])[None], turned[None], x[None, ROOT:], 30)
    np.testing.assert_allclose(found.places, motion.positions[0], atol=1e-12)
    np.testing.assert_allclose(found.turns, rot.to_matrix(motion.world_rotations[0]), atol=1e-12)


def test_columns_are_the_derivatives_of_places():
    rng = np.random.default_rng(2)
    x, place, turn = rng.normal(size=ROOT + 29) * 0.3, np.zeros(3), np.eye(3)
    x[3:6] *= 0.2
    hand = G1.skeleton.index("left_hand")
    tree, here = posed(x, place, turn)
    rows = np.zeros((3, len(x)))
    add_point(tree, here, hand, here.places[hand], 1.0, rows)
    for column in range(len(x)):
        step = np.zeros(len(x))
        step[column] = 1e-6
        ahead, behind = (posed(x + sign * step, place, turn)[1].places[hand] for sign in (1, -1))
        np.testing.assert_allclose(rows[:, column], (ahead - behind) / 2e-6, atol=1e-4)
