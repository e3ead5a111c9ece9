"""Chords and keys of music that is known."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.harmony.key import find_key
from onbeat.music.harmony.names import TONES, chord_likeness, name_chords
from onbeat.music.profile import Profile, Profiler
from sounds import hat, kick, mix, piano, snare

BARS = 16


def hertz(note: float) -> float:
    return 440.0 * 2.0 ** ((note - 69.0) / 12.0)


def band(roots: np.ndarray, thirds: np.ndarray, cents: float, drums: bool) -> tuple[np.ndarray, Profile]:
    """A triad on each of four beats a bar, a bass, and drums over them."""
    rng = np.random.default_rng(0)
    beats = 0.3 + 0.5 * np.arange(4 * len(roots))
    events = []
    for index, beat in enumerate(beats):
        root, third = int(roots[index // 4]), int(thirds[index // 4])
        events += [(beat, piano(hertz(60 + (root + step) % 12 + cents / 100), 0.45, 0.15)) for step in (0, third, 7)]
        if index % 2 == 0:
            events.append((beat, piano(hertz(36 + root + (12 if root < 4 else 0) + cents / 100), 0.9, 0.4)))
        if drums:
            events += [(beat, 0.6 * (kick() if index % 2 == 0 else snare(rng))), (beat + 0.25, hat(rng))]
    profiler = Profiler(22050)
    for _ in profiler.watch([mix(float(beats[-1]) + 1.0, events).samples]):
        pass
    return beats, profiler.profile()


@pytest.mark.parametrize("drums", [False, True])
@pytest.mark.parametrize("cents", [0.0, 35.0, -45.0])
def test_triads_are_named_in_any_tuning_and_under_drums(cents: float, drums: bool) -> None:
    rng = np.random.default_rng(1)
    roots, thirds = rng.integers(0, 12, BARS), rng.integers(3, 5, BARS)
    beats, profile = band(roots, thirds, cents, drums)
    named = name_chords(profile.chroma(beats), np.arange(len(beats)) % 4 == 0)
    true = [f"{TONES[r]}:{'maj' if t == 4 else 'min'}" for r, t in zip(roots, thirds, strict=True) for _ in range(4)]
    right = np.mean([found == name for found, name in zip(named, true, strict=True)])
    assert right > 0.95
    assert profile.tuning == pytest.approx(cents, abs=2.0)


def test_noise_and_silence_are_no_chord() -> None:
    rng = np.random.default_rng(0)
    flat = 1.0 + 0.05 * rng.random((8, 2, 12))
    assert name_chords(flat, np.ones(8, np.bool_)) == ["N"] * 8
    assert name_chords(np.zeros((4, 2, 12)), np.ones(4, np.bool_)) == ["N"] * 4
    assert name_chords(np.zeros((0, 2, 12)), np.zeros(0, np.bool_)) == []


def test_one_odd_beat_within_a_bar_is_passed_over() -> None:
    chroma = np.zeros((8, 2, 12))
    chroma[:, 1, [0, 4, 7]] = 1.0
    chroma[2, 1] = np.roll(chroma[2, 1] * 0.3, 1) + 0.7 * chroma[2, 1]
    assert name_chords(chroma, np.arange(8) % 4 == 0) == ["C:maj"] * 8


def test_likeness_is_highest_for_the_triad_itself() -> None:
    for root in range(12):
        chroma = np.zeros((1, 2, 12))
        chroma[0, :, [root, (root + 3) % 12, (root + 7) % 12]] = 1.0
        assert chord_likeness(chroma).argmax() == 12 + root


@pytest.mark.parametrize("tonic", [0, 5, 10])
def test_a_scale_with_its_tonic_chord_has_its_key(tonic: int) -> None:
    major = np.isin(np.arange(12), [0, 2, 4, 5, 7, 9, 11]) + 2.0 * np.isin(np.arange(12), [0, 4, 7])
    minor = np.isin(np.arange(12), [0, 2, 3, 5, 7, 8, 11]) + 2.0 * np.isin(np.arange(12), [0, 3, 7])
    assert find_key(np.roll(major, tonic)) == f"{TONES[tonic]}:major"
    assert find_key(np.roll(minor, tonic)) == f"{TONES[tonic]}:minor"


def test_drums_have_no_key() -> None:
    assert find_key(np.ones(12)) == ""
    assert find_key(np.array([1.0, 0.0] * 6)) == ""  # whole tones: as near to one key as to another
