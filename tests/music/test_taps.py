"""What somebody means who taps along."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.taps import beats_meant, denser

TRUE = 0.31 + 0.48 * np.arange(120)  # 125 BPM
LONG = 60.0


def tapped(beats: np.ndarray, jitter: float = 0.025, ahead: float = 0.03, seed: int = 0) -> np.ndarray:
    """Taps of a hand that is uneven and early."""
    rng = np.random.default_rng(seed)
    return np.sort(beats - ahead + jitter * rng.standard_normal(len(beats)))


@pytest.mark.parametrize("seed", range(5))
def test_taps_on_the_beats_heard_mean_these(seed: int) -> None:
    meant = beats_meant(tapped(TRUE[20:60], seed=seed), TRUE, LONG)
    assert meant.ratio == 1.0
    np.testing.assert_array_equal(meant.times, TRUE)


@pytest.mark.parametrize(
    ("heard", "ratio"),
    [
        (TRUE[::2], 2.0),  # heard at half the tempo that is tapped
        (TRUE[1::2], 2.0),
        (denser(TRUE, 2), 0.5),  # heard twice as fast
        (denser(TRUE, 2)[1:], 0.5),
        (denser(TRUE, 3), 1.0 / 3.0),
    ],
)
def test_the_tempo_of_the_taps_wins(heard: np.ndarray, ratio: float) -> None:
    meant = beats_meant(tapped(TRUE[20:70]), heard, LONG)
    assert meant.ratio == pytest.approx(ratio)
    inside = TRUE[(heard[0] + 0.01 <= TRUE) & (heard[-1] - 0.01 >= TRUE)]
    assert np.abs(inside[:, None] - meant.times).min(axis=1).max() < 1e-9


def test_the_phase_of_the_taps_wins() -> None:
    off = 0.5 * (TRUE[1:] + TRUE[:-1])
    meant = beats_meant(tapped(TRUE[20:60]), off, LONG)  # heard between the beats
    assert meant.ratio == 1.0
    np.testing.assert_allclose(meant.times, TRUE[1:-1], atol=1e-9)


def test_taps_that_fit_nothing_heard_are_evened_and_gone_on_with() -> None:
    heard = np.arange(0.0, LONG, 0.7)
    meant = beats_meant(tapped(TRUE[20:60], ahead=0.0), heard, LONG)
    assert meant.ratio is None
    assert meant.times[0] < 0.48
    assert meant.times[-1] > LONG - 0.49
    inner = meant.times[(meant.times > TRUE[20] - 0.1) & (meant.times < TRUE[59] + 0.1)]
    assert np.sqrt(np.mean((inner - TRUE[20:60]) ** 2)) < 0.02  # the hand itself scatters by 25 ms
    assert (np.diff(meant.times) > 0.3).all()


def test_a_tap_left_out_is_filled_in() -> None:
    taps = np.delete(TRUE[20:60], [7, 20, 21])
    meant = beats_meant(taps, np.zeros(0), LONG)
    inner = meant.times[(meant.times > TRUE[20] - 0.1) & (meant.times < TRUE[59] + 0.1)]
    np.testing.assert_allclose(inner, TRUE[20:60], atol=1e-6)


@pytest.mark.parametrize("taps", [[3.0, 3.5], [3.0, 3.5, 4.0]])
def test_few_taps_are_enough_for_a_tempo(taps: list[float]) -> None:
    meant = beats_meant(np.array(taps), np.zeros(0), 10.0)
    np.testing.assert_allclose(np.diff(meant.times), 0.5, atol=1e-9)
    assert meant.times[0] <= 0.5 + 1e-9
