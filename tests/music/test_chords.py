"""Chord changes and the cues of downbeats, on chords that are known."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.bars import downbeat_log_odds, find_downbeats
from onbeat.music.harmony.chords import between_beats, chord_change, harmony_change, harmony_slices, new_harmony
from onbeat.music.hearing import Hearing, hear
from onbeat.music.profile import Profiler
from sounds import mix, piano

CHORDS = ((57, 61, 64), (50, 54, 57), (52, 56, 59), (54, 57, 61))  # A, D, E, F sharp minor
BEATS = 0.3 + 0.5 * np.arange(48)


def hertz(note: int) -> float:
    return 440.0 * 2.0 ** ((note - 69) / 12)


def chords_each(bar: int) -> Hearing:
    """A chord on every beat, a new one every ``bar`` beats."""
    events = [
        (beat, piano(hertz(note), 0.5, 0.2))
        for index, beat in enumerate(BEATS)
        for note in CHORDS[index // bar % len(CHORDS)]
    ]
    return hear([mix(25.0, events).samples], 22050)


def test_change_is_high_where_the_chord_changes() -> None:
    hearing = chords_each(4)
    change = chord_change(harmony_slices(hearing.tones, hearing.tone_rate, BEATS))
    changing = np.arange(len(BEATS)) % 4 == 0
    changing[0] = False
    assert change[0] == 0.0
    assert change[changing].min() > 2.0 * np.delete(change, np.flatnonzero(changing)).max()
    assert change.max() == 1.0


def test_downbeats_are_where_the_chords_change() -> None:
    for bar in (3, 4):
        hearing = chords_each(bar)
        slices = harmony_slices(hearing.tones, hearing.tone_rate, BEATS)
        downbeats, meter = find_downbeats(downbeat_log_odds(slices, np.zeros(len(BEATS))))
        assert meter == bar
        assert (np.flatnonzero(downbeats) % bar == 0).all()


def test_new_harmony_rises_at_changes() -> None:
    hearing = chords_each(4)
    rises = new_harmony(hearing.tones, hearing.tone_rate)
    at = rises[np.round(BEATS * hearing.tone_rate).astype(int)]
    assert np.median(at[4::4]) > 3.0 * np.median(np.delete(at, np.arange(0, len(at), 4)))


def test_no_beats_no_changes() -> None:
    tones = np.ones((10, 61), np.float32)
    assert between_beats(tones, 20.0, np.zeros(0)).shape == (0, 61)
    assert chord_change(harmony_slices(tones, 20.0, np.zeros(0))).shape == (0,)
    assert chord_change(harmony_slices(tones, 20.0, np.array([0.1]))).tolist() == [0.0]
    assert find_downbeats(np.zeros(0))[1] == 4


def change_in_own_tuning(bar: int, cents: float, gain: np.ndarray | float = 1.0) -> np.ndarray:
    """Harmony change at the beats of chords that are ``cents`` sharp, under a gain."""
    events = [
        (beat, piano(hertz(note) * 2.0 ** (cents / 1200.0), 0.5, 0.2))
        for index, beat in enumerate(BEATS)
        for note in CHORDS[index // bar % len(CHORDS)]
    ]
    samples = mix(25.0, events).samples
    profiler = Profiler(22050)
    for _ in profiler.watch([(samples * gain).astype(np.float32)]):
        pass
    return harmony_change(profiler.profile().chroma(BEATS))


@pytest.mark.parametrize("cents", [-50.0, -25.0, 0.0, 30.0])
def test_harmony_changes_where_chords_do_in_any_tuning(cents: float) -> None:
    change = change_in_own_tuning(4, cents)
    changing = np.arange(len(BEATS)) % 4 == 0
    changing[0] = False
    assert change[0] == 0.0
    assert change[changing].min() > 3.0 * np.delete(change, np.flatnonzero(changing)).max()


@pytest.mark.parametrize("decibels", [-40.0, -20.0, 3.0])
def test_harmony_change_does_not_follow_the_volume(decibels: float) -> None:
    np.testing.assert_allclose(
        change_in_own_tuning(4, 10.0, 10.0 ** (decibels / 20.0)), change_in_own_tuning(4, 10.0), atol=0.02
    )


def test_a_crescendo_is_no_change_of_harmony() -> None:
    steady = change_in_own_tuning(4, 0.0)
    growing = change_in_own_tuning(4, 0.0, 10.0 ** (np.linspace(-30.0, 0.0, 25 * 22050) / 20.0))
    np.testing.assert_allclose(growing, steady, atol=0.12)


def test_silence_is_no_change_of_harmony() -> None:
    chroma = np.zeros((4, 2, 12))
    chroma[[0, 3], :, 0] = 1.0
    assert harmony_change(chroma).tolist() == [0.0] * 4
    assert harmony_change(chroma[:0]).shape == (0,)
    assert harmony_change(chroma[:1]).tolist() == [0.0]
