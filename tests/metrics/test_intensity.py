"""Correlation of a dance's strength with its music's."""

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.metrics import intensity
from onbeat.motion.features import hand_features
from onbeat.music.song import Song

TIMES = np.arange(300) / 10
RISING = np.linspace(0, 1, 300)


def test_same_curve_up_to_scale_and_offset() -> None:
    found = intensity.evaluate(3 * np.sin(TIMES / 3) + 5, np.sin(TIMES / 3))
    assert found == {"pearson": pytest.approx(1.0), "spearman": pytest.approx(1.0)}


def test_opposite_curve() -> None:
    assert intensity.evaluate(RISING, -RISING) == {"pearson": pytest.approx(-1.0), "spearman": pytest.approx(-1.0)}


def test_spearman_asks_only_for_order() -> None:
    found = intensity.evaluate(np.exp(8 * RISING), RISING, smoothing=0.0)
    assert found["spearman"] == pytest.approx(1.0)
    assert found["pearson"] < 0.8


def test_unrelated_noise_is_near_zero() -> None:
    draw = np.random.default_rng(1)
    found = intensity.evaluate(draw.normal(size=6000), draw.normal(size=6000))
    assert abs(found["pearson"]) < 0.15


@pytest.mark.parametrize("length", [0, 1, 2])
def test_too_short_has_no_correlation(length: int) -> None:
    curve = np.arange(length, dtype=float)
    assert intensity.evaluate(curve, curve) == {"pearson": None, "spearman": None}


def test_a_constant_has_no_correlation() -> None:
    assert intensity.evaluate(np.full(300, 0.1), RISING) == {"pearson": None, "spearman": None}
    assert np.isnan(intensity.pearson(np.full(5, 0.3), np.arange(5.0)))


@pytest.mark.parametrize(
    ("motion", "music", "rate", "message"),
    [
        (RISING, RISING[1:], 10.0, r"shape \(300,\) and the music's \(299,\); both \(N,\)"),
        (np.zeros((3, 2)), np.zeros((3, 2)), 10.0, r"shape \(3, 2\)"),
        (np.where(TIMES == 2.0, np.nan, RISING), RISING, 10.0, "the motion's intensity is not a number at sample 20"),
        (RISING, RISING, 0.0, "the rate is 0.0 Hz"),
    ],
)
def test_bad_input_is_named(motion: np.ndarray, music: np.ndarray, rate: float, message: str) -> None:
    with pytest.raises(MetricError, match=message):
        intensity.evaluate(motion, music, rate)


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_hands_that_swing_with_the_music(sway, fps: int) -> None:
    quiet, loud = sway(10.0, fps, every=1.2), sway(10.0, fps, every=0.4)
    song = Song(10.0, 120.0, 4, [], [], [], [0.0, 10.0], [0.0, 1.0])
    assert intensity.evaluate_dance(hand_features(loud), song, 10.0).keys() == {
        f"intensity_{kind}{name}" for kind in ("", "eq2_") for name in ("pearson", "spearman")
    }
    times = np.arange(1, 9, 0.1)
    slow, fast = (intensity.hand_speed(hand_features(motion), times).mean() for motion in (quiet, loud))
    assert fast == pytest.approx(3 * slow, rel=0.15)


def test_a_still_body_has_no_correlation(sway) -> None:
    still = sway(5.0, every=1e9, first=0.0)
    song = Song(5.0, 120.0, 4, [], [], [], [0.0, 5.0], [0.0, 1.0])
    assert set(intensity.evaluate_dance(hand_features(still), song, 5.0).values()) == {None}
