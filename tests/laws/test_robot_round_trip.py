"""A robot's motion is the same through CSV, tracking files and GMR's dictionaries, whatever its joints do."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onbeat.formats.gmr import gmr_arrays, gmr_motion
from onbeat.formats.robot_csv import read_robot_csv, write_robot_csv
from onbeat.formats.tracking import tracking_motion, write_tracking
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.unitree_g1 import G1, g1_motion

anyhow = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@st.composite
def motions(draw) -> Motion:
    """Up to nine frames anywhere within four metres and, by 0.2 rad, past the limits."""
    rng, frames = np.random.default_rng(draw(st.integers(0, 2**32))), draw(st.integers(1, 9))
    angles = rng.uniform(G1.low - 0.2, G1.high + 0.2, (frames, 29)) * draw(st.sampled_from([0.0, 0.1, 1.0]))
    turns = rot.normalise(rng.normal(size=(frames, 4)))
    return g1_motion(rng.uniform(-4, 4, (frames, 3)), turns, angles, draw(st.sampled_from([29.97, 30.0, 50.0, 120.0])))


@anyhow
@given(motion=motions())
def test_csv_keeps_motion_and_its_own_digits(tmp_path, motion):
    write_robot_csv(motion, tmp_path / "a.csv")
    again = read_robot_csv(tmp_path / "a.csv", motion.fps)
    np.testing.assert_allclose(again.rotations, motion.rotations, atol=2e-9)
    np.testing.assert_allclose(again.positions, motion.positions, atol=2e-8)
    write_robot_csv(again, tmp_path / "b.csv")
    assert (tmp_path / "b.csv").read_bytes() == (tmp_path / "a.csv").read_bytes()


@anyhow
@given(motion=motions())
def test_six_digits_come_back_as_six_digits(tmp_path, motion):
    table = np.column_stack((motion.root_positions, motion.rotations[:, 0, [1, 2, 3, 0]], hinge_angles(G1, motion)))
    text = "".join(",".join(f"{value + 0:.6f}" for value in row) + "\n" for row in table.round(6) + 0.0)
    (tmp_path / "a.csv").write_bytes(text.encode())
    write_robot_csv(read_robot_csv(tmp_path / "a.csv", 30), tmp_path / "b.csv")
    assert (tmp_path / "b.csv").read_bytes().decode() == text


@pytest.mark.parametrize("order", ["mujoco", "isaac"])
@anyhow
@given(motion=motions(), named=st.booleans())
def test_csv_to_tracking_and_back(tmp_path, order, motion, named):
    write_robot_csv(motion, tmp_path / "a.csv")
    first = read_robot_csv(tmp_path / "a.csv", motion.fps)
    write_tracking(first, tmp_path / "a.tracking.npz", joint_order=order)
    with np.load(tmp_path / "a.tracking.npz", allow_pickle=False) as file:
        arrays = {key: file[key] for key in file.files if named or not key.endswith("names")}
    again = tracking_motion(arrays, "a.npz")
    assert again.fps == motion.fps
    np.testing.assert_allclose(again.root_positions, first.root_positions, atol=1e-6)
    np.testing.assert_allclose(hinge_angles(G1, again), hinge_angles(G1, first), atol=1e-6)
    assert rot.angle_between(again.rotations[:, 0], first.rotations[:, 0]).max() < 1e-6


@anyhow
@given(motion=motions())
def test_gmr_and_back(motion):
    again = gmr_motion(gmr_arrays(motion), "a.pkl")
    np.testing.assert_allclose(again.rotations, motion.rotations, atol=1e-12)
    assert again.root_positions.tolist() == motion.root_positions.tolist()


@anyhow
@given(motion=motions())
def test_angles_are_what_made_the_motion(motion):
    angles = hinge_angles(G1, motion)
    rebuilt = g1_motion(motion.root_positions, motion.rotations[:, 0], angles, motion.fps)
    np.testing.assert_allclose(rebuilt.positions, motion.positions, atol=1e-12)
