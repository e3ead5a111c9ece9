"""Rates found in stored times."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.robots.sequences.even import even_rate


@pytest.mark.parametrize("fps", [1, 23.976, 30, 59.94, 60, 200, 1000])
def test_a_rate_is_found_in_rounded_times(fps: float):
    times = (np.arange(2000) / fps).round(6)
    assert even_rate(times, "x") == pytest.approx(fps, rel=1e-6)
    assert even_rate(times[:1], "x", alone=50) == 50


@pytest.mark.parametrize("times", [[0, 0, 0], [0, 0.1, 0.3], [0.2, 0.1, 0], [0, 1e-9]])
def test_times_that_are_not_even_are_told(times: list[float]):
    with pytest.raises(FormatError, match="not even"):
        even_rate(np.array(times, float), "x")
