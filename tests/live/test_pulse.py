"""The pulse: beats to dance on, foretold and counted; breaks, silence, noise, other clocks, taps."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.live.beat.pulse import EAR_RATE, Heard, Pulse
from onbeat.live.protocol import Clocked

TICK = EAR_RATE // 100


def stroke(kind: str, rng: np.random.Generator) -> np.ndarray:
    time = np.arange(round(0.2 * EAR_RATE)) / EAR_RATE
    if kind == "kick":
        return np.sin(2 * np.pi * (50 * time + 6 * (1 - np.exp(-time / 0.03)))) * np.exp(-time / 0.09)
    noise = np.diff(rng.standard_normal(len(time)), prepend=0.0)
    return noise * (0.4 * np.exp(-time / 0.05) if kind == "snare" else 0.15 * np.exp(-time / 0.012))


def drums(beats: np.ndarray) -> np.ndarray:
    """Kick and snare on the beats, hats in eighths; it ends with the last beat's interval."""
    rng = np.random.default_rng(0)
    sound = np.zeros(round((2 * beats[-1] - beats[-2]) * EAR_RATE))
    for index, (beat, after) in enumerate(pairwise(np.append(beats, 2 * beats[-1] - beats[-2]))):
        for at, kind in ((beat, "snare" if index % 2 else "kick"), (beat, "hat"), ((beat + after) / 2, "hat")):
            begin = round(at * EAR_RATE)
            part = stroke(kind, rng)[: max(len(sound) - begin, 0)]
            sound[begin : begin + len(part)] += part
    return (0.5 * sound / np.abs(sound).max()).astype(np.float32)


def steady(bpm: float, seconds: float) -> np.ndarray:
    return np.arange(0.25, seconds, 60.0 / bpm)


def hear(pulse: Pulse, samples: np.ndarray) -> list[Heard]:
    return [pulse.hear(samples[at : at + TICK]) for at in range(0, len(samples) - TICK + 1, TICK)]


def silence(seconds: float) -> np.ndarray:
    return np.zeros(round(seconds * EAR_RATE), np.float32)


@cache
def a_day() -> tuple[list[Heard], np.ndarray, np.ndarray]:
    """Ten seconds of drums, eleven of silence, seven of faster drums."""
    first, second = steady(110.0, 10.0), steady(128.0, 7.0)
    parts = [drums(first), silence(11.0), drums(second)]
    return hear(Pulse(), np.concatenate(parts)), first, second + (len(parts[0]) + len(parts[1])) / EAR_RATE


def spoken(heard: list[Heard], since: float, until: float) -> set[str]:
    return {now.hearing for now in heard if since <= now.time < until}


def test_beats_are_foretold_a_second_ahead() -> None:
    heard, beats, _ = a_day()
    now = next(now for now in heard if now.time > 7.0)
    ahead = now.times[now.times > 8.0][:3]
    assert np.abs(ahead[:, None] - beats).min(axis=1).max() < 0.025
    assert now.tempo == pytest.approx(110.0, rel=0.01)


def test_what_is_foretold_of_a_steady_beat_hardly_wanders() -> None:
    heard, _, _ = a_day()
    at = {now.first: now.times[0] for now in heard}
    apart = [
        now.times[ahead] - at[now.first + ahead]
        for now in heard
        if 5.0 < now.time < 9.5
        for ahead in (1, 2, 3)
        if now.first + ahead in at and at[now.first + ahead] < 9.9
    ]
    assert np.sqrt(np.mean(np.square(apart))) < 0.015


def test_numbers_count_up_without_a_gap_and_times_rise_whatever_comes() -> None:
    heard, _, _ = a_day()
    for before, now in pairwise(heard):
        assert now.first - before.first in (0, 1)
        assert (np.diff(now.times) > 0.0).all()
        assert now.times[0] <= now.time < now.times[1]
        assert len(now.times) == len(now.positions) >= 9
        if now.first == before.first:
            assert now.times[0] == before.times[0]
        else:  # what was foretold a tick ago came to pass, or moved by an instant
            assert now.times[0] >= before.times[0]


def test_music_a_break_nothing_and_music_again() -> None:
    heard, first, second = a_day()
    silent, again = first[-1] + 60.0 / 110.0, second[0]
    assert spoken(heard, 3.5, 9.5) == {"music"}
    assert spoken(heard, silent + 4.0, silent + 8.0) == {"held"}
    assert spoken(heard, silent + 10.7, again - 0.1) == {"nothing"}
    assert spoken(heard, again + 3.5, again + 6.0) == {"music"}
    told = [now.times[1] for now in heard if again + 4.5 < now.time < again + 6.0]
    assert np.abs(np.array(told)[:, None] - np.append(second, second[-1] + 60 / 128)).min(axis=1).max() < 0.03


def test_beats_of_the_music_are_said_once() -> None:
    heard, _, _ = a_day()
    said = [beat.time for now in heard for beat in now.said if now.time < 9.5]
    assert len(said) > 12
    assert min(np.diff(said)) > 0.4


@pytest.mark.parametrize("kind", ["nothing", "silence", "no numbers", "constant", "hum", "white", "pink", "mouse"])
def test_what_is_not_music_is_not_danced_to(kind: str) -> None:
    count, rng = 8 * EAR_RATE, np.random.default_rng(3)
    time, white = np.arange(count) / EAR_RATE, rng.standard_normal(count)
    if kind == "nothing":
        pulse = Pulse()
        assert {pulse.hear(None).hearing for _ in range(300)} == {"nothing"}
        assert pulse.time == 3.0
        return
    mouse = 1e-4 * white
    for at in (1.1, 1.22, 4.0, 4.13, 4.9, 7.1):
        mouse[round(at * EAR_RATE) :][:300] += 0.1 * rng.standard_normal(300) * np.exp(-np.arange(300) / 60)
    pink = np.fft.irfft(np.fft.rfft(white) / np.sqrt(np.arange(1, count // 2 + 2)), count)
    sounds = {
        "silence": np.zeros(count),
        "no numbers": np.full(count, np.nan),
        "constant": np.full(count, 0.5),
        "hum": 0.1 * sum(np.sin(2 * np.pi * 50 * k * time) / k for k in (1, 2, 3, 5)),
        "white": 0.1 * white,
        "pink": 0.1 * pink / pink.std(),
        "mouse": mouse,
    }
    heard = hear(Pulse(), sounds[kind].astype(np.float32))
    assert {now.hearing for now in heard} == {"nothing"}
    assert all(not now.said for now in heard)
    assert np.isfinite([now.level + now.intensity for now in heard]).all()


def test_fast_music_is_danced_at_half_its_tempo_on_its_beats() -> None:
    beats = steady(172.0, 10.0)
    heard = hear(Pulse(), drums(beats))
    now = heard[-1]
    assert now.tempo == pytest.approx(86.0, rel=0.02)
    assert np.abs(now.times[1] - np.append(beats, beats[-1] + 60.0 / 172.0 * np.arange(1, 4))).min() < 0.03
    assert hear(Pulse(120.0, 200.0), drums(beats[:20]))[-1].tempo == pytest.approx(172.0, rel=0.02)


def test_a_step_of_the_tempo_is_followed() -> None:
    before = steady(112.0, 9.0)
    after = before[-1] + 60.0 / 121.0 * np.arange(1, 16)
    heard = hear(Pulse(), drums(np.append(before, after)))
    foretold = {now.first: now.times[1] for now in heard if after[4] < now.time < after[-1] - 0.5}
    assert np.abs(np.array(list(foretold.values()))[:, None] - after).min(axis=1).max() < 0.05


def test_another_machines_clock_leads_as_long_as_it_goes() -> None:
    pulse = Pulse()
    for tick in range(600):
        if tick < 400 and tick % 2 == 0:
            pulse.clocked(Clocked(pulse.time, tick / 48.0))
        now = pulse.hear(None)
        if tick == 399:
            assert now.tempo == pytest.approx(125.0, rel=0.005)
            assert np.abs(now.times[1] / 0.48 - round(now.times[1] / 0.48)) < 0.03
            assert now.positions[1] == round(now.times[1] / 0.48) % 4 + 1
            assert (now.hearing, now.confidence) == ("music", 1.0)
    assert now.hearing != "music"


def test_a_clock_that_says_nonsense_does_no_harm() -> None:
    pulse = Pulse()
    for time, beat in ((np.nan, 1.0), (0.0, np.inf), (1e300, 3.0), (-5.0, 2.0), (0.1, 1e300), (0.1, 5.0), (0.1, 5.0)):
        pulse.clocked(Clocked(time, beat))
        pulse.tap(time)
        now = pulse.hear(None)
    assert np.isfinite(now.times).all()
    assert (np.diff(now.times) > 0.0).all()


def test_three_taps_make_a_tempo_and_are_held() -> None:
    pulse = Pulse()
    for tick in range(400):
        now = pulse.hear(None)
        if tick in (100, 149, 201, 250):
            pulse.tap(pulse.time)
    assert now.tempo == pytest.approx(120.0, rel=0.03)
    assert now.hearing == "held"


def test_intensity_tells_loud_from_soft() -> None:
    sound = drums(steady(120.0, 18.0))
    sound[: 9 * EAR_RATE] *= 0.2
    heard = hear(Pulse(), sound)
    soft, loud = heard[880].intensity, heard[1300].intensity
    assert abs(soft) < 0.7
    assert loud > soft + 1.0


def test_the_same_sound_gives_the_same_bits() -> None:
    sound = drums(steady(120.0, 3.0))
    one, other = hear(Pulse(), sound)[-1], hear(Pulse(), sound)[-1]
    assert one.times.tolist() == other.times.tolist()
    assert (one.intensity, one.confidence, one.first) == (other.intensity, other.confidence, other.first)


def test_a_tick_of_another_length_and_a_wrong_range_are_refused() -> None:
    with pytest.raises(AudioError, match=r"shape \(440,\); expected \(441,\)"):
        Pulse().hear(np.zeros(440, np.float32))
    with pytest.raises(AudioError, match="140 to 70 beats"):
        Pulse(140.0, 70.0)
