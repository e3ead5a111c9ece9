"""What is read from one format, written in another and read again is the same movement: for each pair of formats."""

import tempfile
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.formats import read_markers, read_motion, write_markers, write_motion
from onbeat.motion import Markers, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.unitree_g1 import G1
from persons import person, swinging

BODIES = (".bvh", ".npz", ".z.bvh")
ROBOTS = (".csv", ".tracking.npz", ".npz", ".bvh")
MARKERS = (".c3d", ".trc")
SEEDS, RATES = st.integers(0, 999), st.sampled_from([24.0, 29.97, 30.0, 50.0, 60.0, 120.0])
few = settings(max_examples=8)


def through(motion: Motion, suffix: str, folder: Path) -> Motion:
    path = folder / f"a{suffix}"
    more = {"up": "z", "unit": "m"} if suffix == ".z.bvh" else {}
    write_motion(motion, path, **more)
    fps = motion.fps if suffix == ".csv" else None
    return read_motion(path, fps, **more)


def close(a: Motion, b: Motion, within: float) -> None:
    assert b.fps == pytest.approx(a.fps, rel=1e-6)
    names = [n for n in a.skeleton.names if n in b.skeleton.names]
    assert len(names) >= 21
    pa, pb = (m.positions[:, [m.skeleton.index(n) for n in names]] for m in (a, b))
    np.testing.assert_allclose(pb, pa, atol=within)


@pytest.mark.parametrize(("first", "second"), list(product(BODIES, repeat=2)))
@few
@given(seed=SEEDS, fps=RATES, size=st.floats(0.8, 1.2))
def test_bodies(first, second, seed, fps, size):
    motion = swinging(person(size), 7, fps, seed, 0.4)
    with tempfile.TemporaryDirectory() as folder:
        again = through(through(motion, first, Path(folder)), second, Path(folder))
    assert again.skeleton == motion.skeleton
    close(motion, again, 1e-5)


@pytest.mark.parametrize(("first", "second"), list(product(ROBOTS, repeat=2)))
@few
@given(seed=SEEDS, fps=RATES)
def test_robots(first, second, seed, fps):
    rng = np.random.default_rng(seed)
    angles = G1.low + (G1.high - G1.low) * rng.uniform(0.2, 0.8, (5, len(G1.low)))
    turns = rot.exp(rng.normal(size=(5, 3)) * 0.3)
    motion = hinge_motion(G1, np.array([0, 0, 0.8]) + 0.1 * rng.normal(size=(5, 3)), turns, angles, fps)
    with tempfile.TemporaryDirectory() as folder:
        again = through(through(motion, first, Path(folder)), second, Path(folder))
    close(motion, again, 2e-5)


@pytest.mark.parametrize(("first", "second"), list(product(MARKERS, repeat=2)))
@few
@given(seed=SEEDS, fps=RATES)
def test_markers(first, second, seed, fps):
    rng = np.random.default_rng(seed)
    seen = rng.normal(size=(9, 4, 3)) + np.array([0, 0, 1.0])
    seen[rng.random((9, 4)) < 0.2] = np.nan
    seen[0] = rng.normal(size=(4, 3))
    markers = Markers(("LASI", "RASI", "C7", "T 10"), seen, fps)
    with tempfile.TemporaryDirectory() as folder:
        for suffix in (first, second):
            write_markers(markers, Path(folder, f"a{suffix}"))
            markers = read_markers(Path(folder, f"a{suffix}"), up={".c3d": "z", ".trc": "y"}[suffix])
    assert markers.names == ("LASI", "RASI", "C7", "T 10")
    assert markers.fps == pytest.approx(fps, rel=1e-5)
    np.testing.assert_allclose(markers.positions, seen, atol=1e-5)
