"""The causal tracker: the same beats from blocks of any size, in time, through breaks; and what is not music."""

from __future__ import annotations

import tracemalloc
from functools import cache

import numpy as np
import pytest
import soxr
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.errors import AudioError
from onbeat.music.causal import Beat, CausalTracker
from sounds import beat_times, click_track, hat, kick, mix, piano, snare

RATE = 22050


def band(beats: np.ndarray, seconds: float, meter: int = 4) -> np.ndarray:
    """Drums in eighths, a chord a bar."""
    rng = np.random.default_rng(0)
    events = []
    for index, at in enumerate(beats):
        after = beats[index + 1] if index + 1 < len(beats) else at + 0.4
        events += [
            (at, kick() if index % meter in (0, 2) and index % meter < meter - 1 else snare(rng) * 0.5),
            (at, hat(rng, 0.2)),
        ]
        events += [((at + after) / 2.0, hat(rng, 0.15))]
        if index % meter == 0:
            root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // meter % 4] / 12)
            events += [(at, piano(root * ratio, 1.5, 0.3)) for ratio in (0.5, 1.0, 2.0, 2.52, 3.0)]
    return mix(seconds, events).samples


@cache
def steady(bpm: float = 120.0, seconds: float = 16.0) -> tuple[np.ndarray, np.ndarray]:
    beats = beat_times(bpm, seconds)
    return beats, band(beats, seconds)


def right(said: list[Beat], beats: np.ndarray, since: float, until: float, within: float = 0.05) -> None:
    """Between two times every beat is said once, in its time, and nothing else."""
    times = np.array([beat.time for beat in said])
    times, true = times[(times > since) & (times < until)], beats[(beats > since) & (beats < until)]
    assert len(times) == len(true)
    assert np.abs(times - true).max() < within


@settings(max_examples=8, deadline=None)
@given(st.lists(st.integers(0, 5000) | st.sampled_from([0, 1, 219, 220, 221]), min_size=1, max_size=20), st.booleans())
def test_blocks_of_any_size_give_the_same_to_the_bit(sizes: list[int], learned: bool) -> None:
    samples = steady()[1][: RATE * 3]
    whole, parts = CausalTracker(RATE, learned=learned), CausalTracker(RATE, learned=learned)
    said, at = [], 0
    for size in sizes * 5:
        said += parts.push(samples[at : at + size])
        at += size
    said += parts.push(samples[at:])
    assert said == whole.push(samples)
    assert (parts.tempo, parts.confidence, parts.position) == (whole.tempo, whole.confidence, whole.position)
    assert parts.next_beats(3).tolist() == whole.next_beats(3).tolist()


def test_one_sample_at_a_time() -> None:
    samples = steady()[1][: RATE // 2]
    whole, single = CausalTracker(RATE), CausalTracker(RATE)
    said = [beat for index in range(len(samples)) for beat in single.push(samples[index : index + 1])]
    assert said == whole.push(samples)
    assert single.time == whole.time == 0.5


@pytest.mark.parametrize("bpm", [72, 90, 112, 128, 150, 172])
def test_clicks_are_said_on_time(bpm: int) -> None:
    beats, audio = click_track(bpm, 14.0)
    tracker = CausalTracker(audio.rate)
    said = tracker.push(audio.samples)
    assert tracker.tempo == pytest.approx(bpm, rel=0.02)
    right(said, beats, 5.0, 13.5, 0.03)
    assert abs(np.median([beat.emitted_at - beat.time for beat in said])) < 0.01


@pytest.mark.parametrize("rate", [8000, 11025, 48000, 96000, 192000])
def test_any_rate_hears_the_same(rate: int) -> None:
    beats, samples = steady()
    tracker = CausalTracker(rate)
    said = tracker.push(soxr.resample(samples, RATE, rate).astype(np.float32))
    right(said, beats, 4.0, 15.5)


def test_the_lock_is_quick() -> None:
    beats, samples = steady()
    said = CausalTracker(RATE).push(samples)
    right(said, beats, beats[3] - 0.1, 15.0, 0.07)


def test_a_beat_can_be_said_before_or_after_it() -> None:
    beats, samples = steady()
    for ahead in (-0.05, 0.1):
        said = CausalTracker(RATE, ahead=ahead).push(samples)
        right(said, beats, 4.0, 15.0)
        assert np.median([beat.time - beat.emitted_at for beat in said]) == pytest.approx(ahead, abs=0.01)


def test_next_beats_phase_and_position_foretell() -> None:
    beats, samples = steady()
    tracker = CausalTracker(RATE)
    tracker.push(samples[: RATE * 10])
    following = beats[beats > 10.0][:4]
    foretold = tracker.next_beats(4)
    assert np.abs(foretold - following).max() < 0.03
    between = float(np.mean(foretold[:2]))
    assert tracker.phase(between) == pytest.approx(0.5, abs=0.02)
    assert 0.0 <= tracker.position < tracker.meter
    assert tracker.next_beats(0).tolist() == []


def test_bars_are_found() -> None:
    beats = beat_times(150.0, 24.0)
    said = CausalTracker(RATE).push(band(beats, 24.0, meter=3))
    late = np.array([beat.time for beat in said if beat.downbeat and beat.time > 14.0])
    assert np.abs(late[:, None] - beats[::3]).min(axis=1).max() < 0.06
    assert np.diff(late) == pytest.approx(1.2, abs=0.1)


def test_a_step_of_thirty_percent_is_followed_within_three_seconds() -> None:
    beats = np.concatenate([np.arange(0.3, 10.0, 0.6), 9.9 + np.arange(0.0, 10.0, 0.6 / 1.3)])
    said = CausalTracker(RATE).push(band(beats, 20.0))
    right(said, beats, 12.9, 19.5, 0.07)


def test_the_tempo_is_held_through_a_break() -> None:
    beats, samples = steady(seconds=20.0)
    paused = samples.copy()
    paused[RATE * 8 : RATE * 13] = 0.0
    tracker = CausalTracker(RATE)
    said = tracker.push(paused[: RATE * 13])
    assert tracker.tempo == pytest.approx(120.0, rel=0.03)
    assert not tracker.is_music
    assert tracker.confidence < 0.1
    assert [beat for beat in said if 10.0 < beat.time < 13.0]
    assert max(beat.confidence for beat in said if beat.time > 12.0) < 0.1
    said += tracker.push(paused[RATE * 13 :])
    assert tracker.is_music
    assert tracker.confidence > 0.5
    right(said, beats, 15.0, 19.5)


@pytest.mark.parametrize("decibels", [-40.0, 40.0])
def test_a_change_of_gain_is_survived(decibels: float) -> None:
    beats, samples = steady()
    changed = samples * np.float32(0.01 if decibels > 0 else 1.0)
    changed[RATE * 8 :] *= np.float32(10.0 ** (decibels / 20.0))
    said = CausalTracker(RATE).push(changed)
    right(said, beats, 11.0, 15.5)


@pytest.mark.parametrize("kind", ["silence", "constant", "hum", "noise", "one click"])
def test_what_is_not_music_is_told(kind: str) -> None:
    length = RATE * 12
    sound = {
        "silence": np.zeros(length),
        "constant": np.full(length, 0.5),
        "hum": 0.3 * np.sin(np.arange(length) * 2 * np.pi * 100.0 / RATE),
        "noise": 0.1 * np.random.default_rng(0).standard_normal(length),
        "one click": np.eye(1, length, 40000)[0],
    }[kind]
    tracker = CausalTracker(RATE)
    said = tracker.push(sound.astype(np.float32))
    assert not tracker.is_music
    assert tracker.confidence < 0.2
    assert not [beat for beat in said if beat.confidence > 0.4 and beat.time > 2.0]  # one click may be a beginning


def test_music_after_noise_and_silence() -> None:
    beats, samples = steady()
    rng = np.random.default_rng(0)
    before = np.concatenate([0.02 * rng.standard_normal(RATE * 4), np.zeros(RATE * 4)]).astype(np.float32)
    tracker = CausalTracker(RATE)
    said = tracker.push(np.concatenate([before, samples]))
    assert tracker.is_music
    right(said, beats + 8.0, 12.0, 23.5)


def test_beats_are_well_formed() -> None:
    tracker = CausalTracker(RATE)
    said = tracker.push(steady()[1])
    assert (np.diff([beat.time for beat in said]) > 0.1).all()
    assert all(0.0 <= beat.confidence <= 1.0 and 1 <= beat.position <= 7 for beat in said)
    assert all(beat.downbeat == (beat.position == 1) for beat in said)
    assert all(0.0 < beat.emitted_at <= tracker.time for beat in said)


def test_nothing_is_known_before_anything_is_heard() -> None:
    tracker = CausalTracker(RATE)
    assert tracker.push(np.zeros(0, np.float32)) == []
    assert (tracker.tempo, tracker.confidence, tracker.phase(1.0), tracker.is_music) == (0.0, 0.0, 0.0, False)
    assert tracker.next_beats(4).tolist() == []


def test_reset_forgets() -> None:
    samples = steady()[1][: RATE * 6]
    tracker = CausalTracker(RATE)
    first = tracker.push(samples)
    tracker.reset()
    assert tracker.time == 0.0
    assert tracker.push(samples) == first


def test_bad_samples_are_refused_and_not_taken() -> None:
    samples = steady()[1][: RATE * 4]
    tracker, same = CausalTracker(RATE), CausalTracker(RATE)
    said = tracker.push(samples[:RATE])
    bad = samples[RATE : RATE + 100].copy()
    bad[50] = np.nan
    with pytest.raises(AudioError, match=r"sample 50 of the block \(1\.002 s\) is nan; expected numbers"):
        tracker.push(bad)
    bad[50] = np.inf
    with pytest.raises(AudioError, match="is inf"):
        tracker.push(bad)
    with pytest.raises(AudioError, match=r"shape \(10, 2\).*mix to mono"):
        tracker.push(np.zeros((10, 2), np.float32))
    with pytest.raises(AudioError, match="kind int16; expected floats"):
        tracker.push(np.zeros(10, np.int16))  # pyright: ignore
    assert said + tracker.push(samples[RATE:]) == same.push(samples)
    for rate in (0, -5, 10**9):
        with pytest.raises(AudioError, match="samples per second; expected 4000 to 400000"):
            CausalTracker(rate)


def test_huge_samples_do_no_harm() -> None:
    tracker = CausalTracker(RATE)
    tracker.push(np.full(RATE, 3e38, np.float32))
    beats, samples = steady()
    right(tracker.push(np.concatenate([np.zeros(10 * RATE, np.float32), samples])), beats + 11.0, 17.0, 26.0)


def test_memory_does_not_grow() -> None:
    samples = steady()[1]
    tracker = CausalTracker(RATE)
    tracemalloc.start()
    tracker.push(samples)
    before = tracemalloc.get_traced_memory()[0]
    for _ in range(3):
        tracker.push(samples)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20_000
