"""Tempi, and folding them for a dance."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.song import Song
from onbeat.music.tempo import beat_space, danceable_beats, tempo_of


def steady(tempo: float, meter: int = 4, first_downbeat: int = 0, count: int = 40) -> Song:
    beats = 0.1 + np.arange(count) * 60.0 / tempo
    change = np.where((np.arange(count) - first_downbeat) % meter == 0, 1.0, 0.2)
    return Song(beats[-1] + 1.0, tempo, meter, beats, beats[first_downbeat::meter], change, [0.0], [0.5])


def test_space_covers_40_to_240_and_its_changes_are_chances() -> None:
    space = beat_space(100.0, 60.0)
    assert 60.0 * 100.0 / space.intervals.max() == pytest.approx(40.0)
    assert 60.0 * 100.0 / space.intervals.min() == pytest.approx(240.0)
    np.testing.assert_allclose(np.exp(space.log_change).sum(axis=1), 1.0)
    assert (space.log_change.argmax(axis=1) == np.arange(len(space.intervals))).all()


def test_tempo_is_of_the_line_not_of_one_interval() -> None:
    beats = np.arange(100) * 0.5 + np.where(np.arange(100) % 2, 0.02, 0.0)
    assert tempo_of(beats) == pytest.approx(120.0, rel=1e-3)
    assert tempo_of(np.array([1.0])) == 0.0


@pytest.mark.parametrize("first", [0, 1, 2, 3])
def test_fast_songs_are_halved_on_their_downbeats(first: int) -> None:
    song = steady(184.0, first_downbeat=first)
    folded = danceable_beats(song)
    assert folded.tempo == pytest.approx(92.0)
    assert folded.meter == 2
    assert set(folded.downbeats) == set(song.downbeats)
    assert np.median(np.diff(folded.beats)) == pytest.approx(60.0 / 92.0)
    assert len(folded.chord_change) == len(folded.beat_strength) == len(folded.beats)


def test_a_bar_with_a_beat_too_many_keeps_downbeats_and_distance() -> None:
    beats = 0.3 * np.arange(41)
    downbeats = beats[[0, 4, 8, 12, 17, 21, 25, 29, 33, 37]]
    folded = danceable_beats(Song(13.0, 200.0, 4, beats, downbeats, np.zeros(41), [0.0], [0.5]))
    assert set(folded.downbeats) == set(downbeats)
    gaps = np.diff(folded.beats) / 0.3
    assert sorted(set(np.round(gaps).tolist())) == [2.0, 3.0]
    assert (np.round(gaps) == 3.0).sum() == 1


def test_slow_songs_are_doubled_with_the_old_beats_kept() -> None:
    song = steady(60.0)
    folded = danceable_beats(song)
    assert folded.tempo == pytest.approx(120.0)
    np.testing.assert_array_equal(folded.beats[::2], song.beats)
    assert folded.chord_change[1::2].max() == 0.0
    assert set(folded.downbeats) == set(song.downbeats)


def test_a_song_one_dances_to_stays_as_it_is() -> None:
    song = steady(120.0)
    assert danceable_beats(song) is song
    empty = Song(3.0, 0.0, 4, [], [], [], [0.0], [0.0])
    assert danceable_beats(empty) is empty


def test_a_fast_waltz_keeps_its_meter() -> None:
    folded = danceable_beats(steady(174.0, meter=3))
    assert folded.tempo == pytest.approx(87.0)
    assert folded.meter == 3
