import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import Markers


def walking(frames=10, fps=30.0) -> Markers:
    t = np.arange(frames) / fps
    return Markers(("a", "b"), np.stack((np.c_[t, t, t], np.c_[t, 2 * t, 3 * t]), axis=1), fps, "walk")


def test_gaps_are_listed_marker_by_marker():
    positions = np.array(walking().positions)
    positions[:2, 0] = np.nan
    positions[4, 1, 2] = np.nan
    positions[9, 1] = np.nan
    markers = Markers(("a", "b"), positions, 30)
    assert markers.gaps() == [("a", 0, 2), ("b", 4, 5), ("b", 9, 10)]
    assert markers.seen.sum() == 16


def test_resampling_is_linear_and_keeps_gaps():
    twice = walking().resampled(60)
    assert len(twice) == 19
    np.testing.assert_allclose(twice.positions[:, 1, 1], 2 * np.arange(19) / 60, atol=1e-12)
    positions = np.array(walking().positions)
    positions[5, 0] = np.nan
    gappy = Markers(("a", "b"), positions, 30).resampled(60)
    assert np.flatnonzero(~gappy.seen[:, 0]).tolist() == [9, 10, 11]
    assert walking().resampled(30).positions is not None


def test_some_markers_some_frames():
    some = walking().chosen(["b"])[2:5]
    assert some.names == ("b",)
    assert len(some) == 3
    with pytest.raises(FormatError, match="no marker 'c'; there are a, b"):
        walking().chosen(["c"])


@pytest.mark.parametrize(
    ("names", "positions", "fps", "message"),
    [
        (("a",), np.zeros((3, 2, 3)), 30, r"shape \(3, 2, 3\); \(frames, 1, 3\) is needed"),
        ((), np.zeros((3, 0, 3)), 30, "3 frames of 0 markers"),
        (("a", "a"), np.zeros((3, 2, 3)), 30, "labels occur twice: a"),
        (("a",), np.zeros((3, 1, 3)), 0, "positive rate"),
        (("a",), np.full((3, 1, 3), np.inf), 30, "frame 0 of 'a' is infinite"),
    ],
)
def test_what_is_no_markers_is_refused(names, positions, fps, message):
    with pytest.raises(FormatError, match=message):
        Markers(names, positions, fps)


def test_arrays_cannot_be_changed():
    markers = walking()
    with pytest.raises(ValueError, match="read-only"):
        markers.positions[0] = 0
