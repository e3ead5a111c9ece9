"""Arms and legs in closed form reach what they are asked to reach; paths are at rest where they should be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat.examples.figures import PLACES
from onbeat.examples.limbs import arm_direction, arm_rotations, leg_rotations, mirrored
from onbeat.examples.paths import Keys, exaggeration, follow, minimum_jerk, soften
from onbeat.motion import rotations as rot

ARM, LEG = (0.30, 0.25), (0.42, 0.42)
unit = st.floats(-1.0, 1.0)


def wrist_of(place: np.ndarray, reach: float, swivel: float) -> tuple[np.ndarray, np.ndarray]:
    """Elbow and wrist of the right arm about its shoulder."""
    upper, forearm = arm_rotations(arm_direction(place)[None], np.array([reach]), np.array([swivel]), ARM)
    elbow = rot.rotate(upper, np.array([ARM[0], 0.0, 0.0]))
    return elbow[0], (elbow + rot.rotate(rot.multiply(upper, forearm), np.array([ARM[1], 0.0, 0.0])))[0]


@given(place=st.tuples(st.floats(-0.3, 1), st.floats(-0.2, 1), unit), reach=st.floats(0.35, 0.98), swivel=unit)
def test_the_wrist_is_where_it_was_asked_to_be(place: tuple[float, float, float], reach: float, swivel: float) -> None:
    direction = np.array(place) + np.array([0.05, 0.05, 0.0])
    if np.linalg.norm(direction) < 0.1:
        return
    _, wrist = wrist_of(direction, reach, swivel)
    assert np.allclose(wrist, reach * sum(ARM) * direction / np.linalg.norm(direction), atol=1e-9)


@pytest.mark.parametrize("name", sorted(PLACES))
def test_elbows_do_not_point_up_or_into_the_body(name: str) -> None:
    place = PLACES[name]
    point = np.array(place[:3])
    elbow, wrist = wrist_of(point, min(float(np.linalg.norm(point)), 0.97), place.swivel)
    middle = wrist * (elbow @ wrist) / (wrist @ wrist)
    bend = elbow - middle
    assert bend[0] > -0.12, "the elbow would be in the ribs"
    assert bend[2] < 0.12, "the elbow would be over the arm"


@given(x=unit, y=unit, heading=st.floats(-3.0, 3.0), bent=st.floats(0.6, 0.99))
def test_the_ankle_is_where_it_was_asked_to_be_and_the_knee_is_in_front(
    x: float, y: float, heading: float, bent: float
) -> None:
    down = np.array([0.6 * x, 0.6 * y, -1.0])
    target = bent * sum(LEG) * down / np.linalg.norm(down)
    thigh, shin = leg_rotations(target[None], np.array([heading]), LEG)
    knee = rot.rotate(thigh, np.array([0.0, 0.0, -LEG[0]]))
    ankle = knee + rot.rotate(rot.multiply(thigh, shin), np.array([0.0, 0.0, -LEG[1]]))
    assert np.allclose(ankle[0], target, atol=1e-9)
    front = np.array([-np.sin(heading), np.cos(heading), 0.0])
    assert (knee[0] - target / 2) @ front > 0


@given(st.tuples(unit, unit, unit))
def test_the_left_arm_is_the_right_one_in_a_mirror(vector: tuple[float, float, float]) -> None:
    q = rot.exp(np.array(vector) * 3)
    mirror = np.array([-1.0, 1.0, 1.0])
    v = np.array([0.3, -0.2, 0.5])
    assert np.allclose(rot.rotate(mirrored(q), v * mirror), rot.rotate(q, v) * mirror)


@given(hold=st.floats(0.0, 0.4), seed=st.integers(0, 99))
def test_a_path_is_at_its_keys_on_time_and_slowest_there(hold: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    keys = Keys(np.cumsum(rng.uniform(0.4, 1.2, 6)), rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    assert np.allclose(follow(keys.times, keys, hold), keys.values)
    near = follow(np.concatenate((keys.times - 1e-3, keys.times + 1e-3)), keys, hold)
    assert np.abs(near - np.tile(keys.values, (2, 1))).max() < 1e-4


def test_wind_up_and_overshoot_do_not_move_the_stop() -> None:
    times = np.arange(0, 1.8, 1 / 60)
    there_and_back = Keys(np.arange(4) * 0.6, np.array([[0.0], [1.0], [0.0], [1.0]]))
    path = follow(times, there_and_back, 0.2)
    sharp = path + 0.5 * exaggeration(follow(times, there_and_back), 60.0, 0.18)
    assert sharp.max() > path.max() + 0.02
    for touched in (sharp, soften(path, 60.0, 0.05)):
        assert abs(times[20 + np.argmax(touched[20:55, 0])] - 0.6) < 0.02


def test_minimum_jerk_rests_at_both_ends() -> None:
    u = np.array([0.0, 1e-4, 0.5, 1 - 1e-4, 1.0])
    assert np.allclose(minimum_jerk(u), [0, 0, 0.5, 1, 1], atol=1e-10)
