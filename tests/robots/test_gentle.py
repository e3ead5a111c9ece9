"""Paths inside bounds."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.robots.gentle import Bounds, Grid, gentle


def swing(fps: float) -> np.ndarray:
    times = np.arange(0, 3, 1 / fps)
    return np.sin(2 * np.pi * times) + 0.02 * np.sin(2 * np.pi * 13 * times)


def test_what_is_gentle_already_stays():
    times = np.arange(0, 3, 1 / 60)
    slow = 0.3 * np.sin(2 * np.pi * times)
    np.testing.assert_allclose(gentle(slow, 60, Bounds(-1, 1, 10, 100)), slow, atol=2e-3)


def test_a_tremble_is_taken_out():
    calm = gentle(swing(60), 60, Bounds())
    assert np.abs(calm - np.sin(2 * np.pi * np.arange(0, 3, 1 / 60)))[20:-20].max() < 0.006


def test_bounds_hold_to_the_millisecond():
    path = gentle(np.sign(swing(60)), 60, Bounds(-0.9, 0.9, 5.0, 60.0))
    assert np.abs(path).max() <= 0.9 + 1e-6
    assert np.abs(np.diff(path)).max() * 60 <= 5 + 1e-4
    assert np.abs(np.diff(path, 2)).max() * 3600 <= 60 + 1e-2


def test_the_rate_at_which_a_path_is_stored_does_not_matter():
    coarse, fine = gentle(swing(60), 60, Bounds(acceleration=30)), gentle(swing(120), 120, Bounds(acceleration=30))
    np.testing.assert_allclose(coarse[5:-5], fine[::2][5:-5], atol=5e-3)


def test_derivatives_of_the_grid_are_those_of_its_values():
    grid = Grid(301, 300.0, 0.05)
    controls = np.sin(np.arange(grid.controls) / 3)
    values, second = grid.values() @ controls, grid.values(2) @ controls
    np.testing.assert_allclose(np.diff(values, 2) * 300**2, second[1:-1], atol=2.0)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_a_path_of_few_frames_is_kept_inside(frames: int):
    assert gentle(np.full(frames, 5.0), 30, Bounds(0.0, 1.0)).tolist() == pytest.approx([1.0] * frames, abs=1e-5)
