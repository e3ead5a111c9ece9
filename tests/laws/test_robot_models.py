"""Laws of robots' models: configurations are motions, exports are kept."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.motion import rotations as rot
from onbeat.robots.model import robot_named
from onbeat.robots.sequences.hrpsys import read_hrpsys, write_hrpsys
from onbeat.robots.sequences.mcap import read_mcap, write_mcap
from onbeat.robots.state import configurations, derivatives, motion_of

NAMES = st.sampled_from(("g1", "hrp4c", "talos"))
SEEDS = st.integers(0, 10**6)


def path(name: str, seed: int, frames: int) -> np.ndarray:
    """Configurations at random, the root turned any way."""
    rng, body = np.random.default_rng(seed), robot_named(name).body
    angles = rng.uniform(body.low, body.high, (frames, len(body.low)))
    return np.hstack((rng.normal(size=(frames, 3)), rot.normalise(rng.normal(size=(frames, 4))), angles))


@given(NAMES, SEEDS, st.integers(1, 9))
def test_configurations_of_a_motion_of_configurations_are_those(name: str, seed: int, frames: int):
    robot, qpos = robot_named(name), path(name, seed, frames)
    np.testing.assert_allclose(configurations(robot, motion_of(robot, qpos, 30)), qpos, atol=1e-11)


@settings(max_examples=12, deadline=None)
@given(NAMES, SEEDS, st.integers(1, 9), st.sampled_from((25, 30, 60, 200)))
def test_exports_keep_every_frame(name: str, seed: int, frames: int, fps: int):
    robot, qpos = robot_named(name), path(name, seed, frames)
    motion, zmp = motion_of(robot, qpos, fps), qpos[:, :2] - 0.3
    with tempfile.TemporaryDirectory() as folder:
        write_mcap(robot, motion, Path(folder) / "dance.mcap")
        write_hrpsys(robot, motion, zmp, Path(folder) / "dance")
        bag = read_mcap(robot, Path(folder) / "dance.mcap")
        sequence = read_hrpsys(robot, Path(folder) / "dance")
    for back, atol in ((bag, 1e-11), (sequence.motion, 1e-8)):
        assert back.fps == fps or frames == 1
        found = configurations(robot, back)
        np.testing.assert_allclose(found[:, 7:], qpos[:, 7:], atol=atol)
        np.testing.assert_allclose(found[:, :3], qpos[:, :3], atol=atol)
        assert rot.angle_between(found[:, 3:7], qpos[:, 3:7]).max() < 1e-7
    np.testing.assert_allclose(sequence.zmp[:, :2], zmp, atol=1e-7)


@given(NAMES, SEEDS, st.integers(2, 30), st.floats(0.1, 4))
def test_played_faster_it_moves_faster(name: str, seed: int, frames: int, times: float):
    robot, qpos = robot_named(name), path(name, seed, frames)
    slow, fast = derivatives(robot, qpos, 30), derivatives(robot, qpos, 30 * times)
    scale = max(1.0, float(np.abs(slow.qacc).max()))
    np.testing.assert_allclose(fast.qvel, slow.qvel * times, atol=1e-7 * scale * times)
    np.testing.assert_allclose(fast.qacc, slow.qacc * times**2, atol=1e-7 * scale * times**2)
