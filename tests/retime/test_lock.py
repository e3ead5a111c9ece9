import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.retime.lock import SLOWEST, TOLERANCE, TimeMap, lock

FRAME = 1 / 60


def jittered(seed: int, count: int = 60, spread: float = 0.02, pulse: float = 0.5) -> np.ndarray:
    return np.arange(count) * pulse + np.random.default_rng(seed).uniform(-spread, spread, count)


def fine(beats: np.ndarray) -> np.ndarray:
    return np.linspace(beats[0] - 4, beats[-1] + 4, 5000)


def test_at_a_steady_tempo_the_map_is_exactly_a_line():
    beats = np.arange(40) * 0.5
    warp = lock(beats / 1.2 + 3.0, beats)
    times = fine(beats / 1.2 + 3.0)
    np.testing.assert_allclose(warp(times), (times - 3.0) * 1.2, atol=1e-9)
    np.testing.assert_allclose(warp(times, 1), 1.2, atol=1e-7)


@pytest.mark.parametrize("seed", range(5))
def test_beats_that_jitter_are_met_within_the_tolerance_and_the_map_rises(seed: int):
    music, dance = jittered(seed), jittered(seed + 100) * 1.2
    warp = lock(music, dance)
    rate = (dance[-1] - dance[0]) / (music[-1] - music[0])
    assert np.abs(warp(music) - dance).max() < 1.05 * TOLERANCE * rate < FRAME / 2
    assert warp(fine(music), 1).min() >= 0.9 * SLOWEST * rate
    assert (np.diff(warp(fine(music))) > 0).all()


def test_a_smooth_map_is_smoother_than_lines_from_beat_to_beat():
    music, dance = jittered(1), np.arange(60) * 0.5
    warp = lock(music, dance)
    times = np.linspace(music[0], music[-1], 3000)
    kicks = np.abs(np.diff(np.diff(dance) / np.diff(music))).max()
    assert np.abs(np.diff(warp(times, 1))).max() < kicks / 10


@pytest.mark.parametrize("seed", range(4))
def test_the_inverse_undoes_the_map_within_it_and_past_its_ends(seed: int):
    warp = lock(jittered(seed, spread=0.1), np.arange(60) * 0.6)
    times = np.linspace(-30, 60, 2001)
    np.testing.assert_allclose(warp.inverse(warp(times)), times, atol=1e-9)
    np.testing.assert_allclose(warp(warp.inverse(times)), times, atol=1e-9)


@pytest.mark.parametrize("factor", [0.6, 1.5, 2.0])
def test_a_change_of_tempo_is_met_on_every_beat(factor: float):
    steps = np.concatenate((np.full(20, 0.5), np.full(20, 0.5 / factor)))
    music, dance = np.concatenate(([0.0], np.cumsum(steps))), np.arange(41) * 0.5
    warp = lock(music, dance)
    assert np.abs(warp(music) - dance).max() < 2 * TOLERANCE
    assert warp(music[5:15], 1) == pytest.approx(1.0, abs=0.01)
    assert warp(music[25:36], 1) == pytest.approx(factor, abs=0.02)


def test_a_tempo_that_drifts_does_not_drift_off():
    music = np.cumsum(np.linspace(0.6, 0.4, 120))
    warp = lock(music, np.arange(120, dtype=float))
    assert np.abs(warp(music) - np.arange(120)).max() < 0.01


def test_where_a_smooth_map_would_turn_back_it_goes_on():
    dance = np.cumsum([0.5] * 6 + [0.06] + [0.5] * 6 + [1.2] + [0.5] * 6)
    music = np.arange(len(dance)) * 0.5
    warp = lock(music, dance)
    rate = (dance[-1] - dance[0]) / (music[-1] - music[0])
    assert warp(np.linspace(2, 4, 4000), 1).min() == pytest.approx(SLOWEST * rate, rel=0.2)
    assert np.abs(warp(music) - dance).max() < 2 * TOLERANCE


def test_two_beats_are_enough():
    warp = lock(np.array([1.0, 1.4]), np.array([0.0, 0.5]))
    np.testing.assert_allclose(warp(np.array([1.0, 1.4, 11.4, -9])), [0.0, 0.5, 13, -12.5], atol=1e-6)


def test_past_its_ends_the_map_is_a_line():
    warp = lock(jittered(3), np.arange(60) * 0.5)
    knots = warp.spline.knots
    for edge, way in ((knots.start, -1), (knots.end, 1)):
        at = edge + way * np.array([0.5, 1.0, 100.0])
        slope = warp(np.array([edge]), 1)
        np.testing.assert_allclose(warp(at), warp(np.array([edge])) + slope * (at - edge), atol=1e-9)
        assert not warp(at, 2).any()
        np.testing.assert_allclose(warp(at, 1), slope[0])


def test_derivatives_are_finite_differences():
    warp, h = lock(jittered(2), np.arange(60) * 0.5), 1e-5
    times = np.linspace(1, 20, 77)
    np.testing.assert_allclose(warp(times, 1), (warp(times + h) - warp(times - h)) / (2 * h), atol=1e-6)


def test_a_later_song_gets_the_same_map_later():
    music, dance = jittered(4), np.arange(60) * 0.5
    a, b = lock(music, dance), lock(music + 1000.0, dance)
    times = fine(music)
    np.testing.assert_allclose(a(times), b(times + 1000.0), atol=1e-6)


def test_a_longer_dance_is_not_bent_elsewhere():
    """What is bent at one beat stays there: a song's far end is none of a beat's business."""
    music, dance = np.arange(60) * 0.5, np.arange(60) * 0.5
    bent = music.copy()
    bent[50] += 0.05
    times = np.linspace(0, 15, 500)
    np.testing.assert_allclose(lock(bent, dance)(times), lock(music, dance)(times), atol=1e-3)


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, np.inf])
def test_a_steady_rate_is_above_nothing(rate: float):
    with pytest.raises(PlanError):
        TimeMap.steady(rate)


def test_a_steady_map_begins_where_it_is_told():
    np.testing.assert_allclose(TimeMap.steady(2.0, 7.0)(np.array([-1.0, 0.0, 10.0])), [5.0, 7.0, 27.0], atol=1e-12)


LINE = np.arange(5) * 0.5


@pytest.mark.parametrize(
    ("music", "dance", "said"),
    [
        (LINE[:1], LINE[:1], "1 beats of the music and 1 of the dance"),
        (LINE, LINE[:4], "5 beats of the music and 4"),
        (np.zeros(0), np.zeros(0), "0 beats"),
        (LINE.reshape(1, -1), LINE, "beats of the music"),
        ([0, 0.5, np.nan, 1.5, 2], LINE, "beat 2 of the music is at nan"),
        (LINE, [0, 0.5, np.inf, 1.5, 2], "beat 2 of the dance is at inf"),
        ([0, 0.5, 0.5, 1.5, 2], LINE, "beat 2 of the music, at 0.500 s, is not after"),
        (LINE, [0, 0.5, 1.0, 0.7, 2], "beat 3 of the dance, at 0.700 s, is not after"),
        ([0, 5e-324, 1e-323, 1.5, 2], LINE, "not after"),
        ([0, 0.5e300, 1e300, 1.5e300, 2e300], LINE, "beat 1 of the music"),
        ([0, 1e-3, 3e-3, 5e-3, 1e4], LINE, "look for beats"),
        ([0, 0.5, 1.0, 1.5, 1000], LINE, "no smooth map"),
        (LINE, [0, 0.5, 1.0, 1.5, 1000], "no smooth map"),
    ],
)
def test_beats_that_cannot_be_are_said_so(music: object, dance: object, said: str):
    with pytest.raises(PlanError, match=said):
        lock(music, dance)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_the_inverse_of_no_number_is_said_so(bad: float):
    with pytest.raises(PlanError, match="time 1 is not a number"):
        lock(LINE, LINE).inverse(np.array([0.0, bad]))
