"""What is wrong in a frame."""

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.robots.ik.residuals import turned


def test_the_wrong_turn_is_the_rotation_vector_between_two_matrices():
    rng = np.random.default_rng(6)
    wanted = rot.normalise(rng.normal(size=4))
    for vector in (np.zeros(3), np.array([0.1, -0.2, 0.3]), np.array([2.0, 1.0, -1.0])):
        found = np.empty(3)
        turned(rot.to_matrix(rot.multiply(rot.exp(vector), wanted)), rot.to_matrix(wanted), found)
        np.testing.assert_allclose(found, vector, atol=1e-9)
