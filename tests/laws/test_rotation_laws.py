"""Laws of rotations, for any unit quaternions."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from onbeat.motion import rotations as rot

numbers = st.floats(-1, 1, allow_subnormal=False)
quaternions = (
    st.tuples(numbers, numbers, numbers, numbers)
    .map(np.array)
    .filter(lambda q: np.linalg.norm(q) > 0.1)
    .map(lambda q: q / np.linalg.norm(q))
)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)


@given(quaternions, quaternions, vectors)
def test_products_compose(a, b, v):
    np.testing.assert_allclose(rot.rotate(rot.multiply(a, b), v), rot.rotate(a, rot.rotate(b, v)), atol=1e-9)


@given(quaternions, vectors)
def test_inverses_undo_and_lengths_stay(q, v):
    np.testing.assert_allclose(rot.rotate(rot.inverse(q), rot.rotate(q, v)), v, atol=1e-9)
    assert abs(np.linalg.norm(rot.rotate(q, v)) - np.linalg.norm(v)) < 1e-9


@given(quaternions)
def test_exp_undoes_log(q):
    assert rot.angle_between(rot.exp(rot.log(q)), q) < 1e-6
    assert np.linalg.norm(rot.log(q)) <= np.pi + 1e-9


@given(quaternions, st.sampled_from(["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]))
def test_euler_angles_come_back(q, order):
    assert rot.angle_between(rot.from_euler(order, rot.to_euler(order, q)), q) < 1e-6


@given(quaternions, quaternions, st.floats(0, 1))
def test_slerp_divides_the_angle(a, b, t):
    whole = rot.angle_between(a, b)
    assert abs(rot.angle_between(a, rot.slerp(a, b, t)) - t * whole) < 1e-6


@given(vectors, vectors)
def test_between_is_the_smallest_turn(a, b):
    if min(np.linalg.norm(a), np.linalg.norm(b)) > 1e-3:
        unit = a / np.linalg.norm(a), b / np.linalg.norm(b)
        np.testing.assert_allclose(rot.rotate(rot.between(a, b), unit[0]), unit[1], atol=1e-4)
