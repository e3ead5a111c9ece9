from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.score import FINE, HIT_WIDTH, INTENSITY, OFF_BEAT, Music, score_music, z_rank
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.music.song import Song


def song(beats: list[float], duration: float = 4.0, intensity: object = (0.2, 0.9)) -> Song:
    values = np.asarray(intensity, float)
    times = np.linspace(0, duration, len(values))
    return Song(duration, 100.0, 4, np.array(beats), np.zeros(0), np.ones(len(beats)), times, values)


def worth_at(music: Music, second: float) -> float:
    return float(music.beat_worth[round((second * GRID + Music.PAD) * FINE)])


def test_a_stop_on_a_beat_earns_one_less_what_every_stop_costs() -> None:
    music = score_music(song([1.0, 2.0]))
    assert worth_at(music, 1.0) == pytest.approx(1 - OFF_BEAT, abs=1e-6)
    assert worth_at(music, 2.0) == pytest.approx(1 - OFF_BEAT, abs=1e-6)
    assert worth_at(music, 1.5) == pytest.approx(-OFF_BEAT)
    near = round((1.0 + HIT_WIDTH) * GRID * FINE) / (GRID * FINE)
    assert worth_at(music, near) == pytest.approx(np.exp(-0.5 * ((near - 1.0) / HIT_WIDTH) ** 2) - OFF_BEAT, abs=1e-6)


def test_beats_outside_the_table_count_for_nothing() -> None:
    np.testing.assert_array_equal(score_music(song([-3.0, 90.0])).beat_worth, np.float32(-OFF_BEAT))


def test_a_beat_at_the_very_beginning_is_seen_from_both_sides() -> None:
    music = score_music(song([0.0]))
    instant = 1 / (GRID * FINE)
    assert worth_at(music, -instant) == pytest.approx(worth_at(music, instant), abs=1e-6)


def test_beats_are_worth_their_weights() -> None:
    music = score_music(song([1.0, 2.0]), beat_weights=np.array([0.25, 1.0]))
    assert worth_at(music, 1.0) == pytest.approx(0.25 - OFF_BEAT, abs=1e-6)
    assert worth_at(music, 2.0) == pytest.approx(1 - OFF_BEAT, abs=1e-6)
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        score_music(song([1.0, 2.0]), beat_weights=np.ones(1))


def test_close_beats_do_not_add_up() -> None:
    assert score_music(song([1.0, 1.02])).beat_worth.max() <= 1 - OFF_BEAT + 1e-6


def test_rhythm_only_is_deaf_to_intensity() -> None:
    loud = score_music(song([1.0]))
    deaf = score_music(song([1.0]), rhythm_only=True)
    assert not deaf.intensity.any()
    assert loud.intensity.any()
    np.testing.assert_array_equal(loud.beat_worth, deaf.beat_worth)


def test_intensity_is_ranked_so_that_its_scale_does_not_matter() -> None:
    values = np.random.default_rng(0).uniform(0, 1, 40)
    one, other = score_music(song([], intensity=values)), score_music(song([], intensity=1e-3 * values + 5))
    np.testing.assert_allclose(one.intensity, other.intensity, atol=1e-6)
    assert float(one.intensity.std()) == pytest.approx(INTENSITY / GRID, rel=1e-5)
    assert float(one.intensity.mean()) == pytest.approx(0, abs=1e-6)


def test_constant_or_missing_intensity_says_nothing() -> None:
    assert not score_music(song([1.0], intensity=(0.5, 0.5))).intensity.any()
    assert not score_music(song([1.0], intensity=())).intensity.any()
    assert not z_rank(np.ones(5)).any()


def test_table_covers_the_song_and_what_stops_reach_beyond() -> None:
    music = score_music(song([1.0], duration=2.5))
    assert music.frames == 75
    assert len(music.beat_worth) == (75 + 2 * Music.PAD) * FINE
    assert len(music.intensity) == 75


def test_part_of_the_music_is_the_music_of_that_part() -> None:
    music = score_music(song([0.5, 1.0, 2.0, 3.0]))
    part = music.part(30, 90)
    assert part.frames == 60
    for second in (0.0, 0.5, 1.0, 1.9):
        assert worth_at(part, second) == worth_at(music, second + 1.0)
    np.testing.assert_array_equal(part.intensity, music.intensity[30:90])


def test_the_weight_of_intensity_is_lambda_unless_told() -> None:
    clock = np.arange(0.0, 6.0, 0.1)
    beats = np.arange(0.5, 6.0, 0.5)
    song = Song(6.0, 120.0, 4, beats, beats[::4], np.zeros(len(beats)), clock, np.sin(clock))
    usual = score_music(song).intensity
    assert np.std(usual) == pytest.approx(INTENSITY / GRID, rel=1e-3)
    np.testing.assert_array_equal(score_music(song, weight=INTENSITY).intensity, usual)
    np.testing.assert_allclose(score_music(song, weight=2 * INTENSITY).intensity, 2 * usual, rtol=1e-5)
    for weight in (-1.0, float("nan"), 1e9):
        with pytest.raises(PlanError, match="of intensity cannot be"):
            score_music(song, weight=weight)
