"""A dancer's motion as a robot's."""

import numpy as np
import pytest

from onbeat.motion.body import Body
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.motion import Motion
from onbeat.robots.ik.collision import capsules_of, clearances
from onbeat.robots.model import robot_named
from onbeat.robots.retarget import held_back, retarget

pytest.importorskip("mujoco")


def arm_errors(motion: Motion, moved: Motion) -> np.ndarray:
    """Degrees (F, 4) between the arm links of a dancer and a robot."""
    source, target = Body.of(motion.skeleton), Body.of(moved.skeleton)
    errors = []
    for side in ("left", "right"):
        for start, end in (("shoulder", "elbow"), ("elbow", "wrist")):
            roles = f"{side}_{start}", f"{side}_{end}"
            a = np.diff(motion.positions[:, source.indices(*roles)], axis=1)[:, 0]
            b = np.diff(moved.positions[:, target.indices(*roles)], axis=1)[:, 0]
            cosine = np.sum(a * b, axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
            errors.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.stack(errors, axis=1)


@pytest.fixture(scope="module")
def swung(swinger):
    return retarget(swinger, robot_named("g1"))


def test_arms_point_as_the_dancers_do(swinger, swung):
    assert len(swung) == len(swinger)
    assert swung.fps == swinger.fps
    assert arm_errors(swinger, swung).mean() < 3


def test_angles_and_speeds_keep_their_limits(swung):
    body = robot_named("g1").body
    angles = hinge_angles(body, swung)
    assert (angles >= body.low - 1e-9).all()
    assert (angles <= body.high + 1e-9).all()
    assert (np.abs(np.diff(angles, axis=0)) * swung.fps <= body.speed * (1 + 1e-9)).all()


def test_nothing_collides(swung):
    assert clearances(swung, capsules_of(robot_named("g1"))).min() > 0


def test_the_result_does_not_depend_on_the_rate(swinger, swung):
    slow = retarget(swinger.resampled(30), robot_named("g1"))
    again = swung.at(slow.times)
    assert np.linalg.norm(slow.positions - again.positions, axis=-1).max() < 0.03


def test_a_single_frame_is_a_motion_too(swinger):
    assert len(retarget(swinger[:1], robot_named("g1"))) == 1


def test_the_same_motion_gives_the_same_bytes(swinger):
    one, other = (retarget(swinger[:40], robot_named("g1")) for _ in range(2))
    assert one.rotations.tobytes() == other.rotations.tobytes()


def test_steps_are_held_back_by_the_limit_and_only_then():
    rng = np.random.default_rng(0)
    angles, most = np.cumsum(rng.normal(size=(200, 3)), axis=0), np.array([0.5, 1.0, 9.0])
    held = held_back(angles, most)
    assert (np.abs(np.diff(held, axis=0)) <= most + 1e-12).all()
    np.testing.assert_array_equal(held[:, 2], angles[:, 2])
