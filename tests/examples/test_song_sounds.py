"""Oscillators, strings, drums and the mixing desk."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.examples.drums import drum_kit
from onbeat.examples.mixing import CEILING, Desk, limiter_gain, reverberate
from onbeat.examples.synth import RATE, hertz, oscillate, pluck, swell, wave_table


def strongest(sound: np.ndarray, near: float) -> float:
    """Frequency of the strongest partial within a semitone of ``near`` [Hz]."""
    size = 1 << 19
    power = np.abs(np.fft.rfft(sound * np.hanning(len(sound)), size))
    frequencies = np.arange(len(power)) * RATE / size
    power[np.abs(np.log2(np.maximum(frequencies, 1.0) / near)) > 1 / 12] = 0.0
    return float(frequencies[power.argmax()])


@pytest.mark.parametrize("pitch", [48, 57, 69, 81, 93])
def test_plucked_strings_are_in_tune(pitch: int) -> None:
    sound = pluck(pitch, 1.2, 0.7, 1.5, np.random.default_rng(1))
    cents = 1200 * np.log2(strongest(sound[RATE // 10 :], hertz(pitch)) / hertz(pitch))
    assert abs(cents) < 2.0
    assert np.abs(sound).max() <= 1.0
    assert np.mean(sound[-RATE // 5 :] ** 2) < 0.05 * np.mean(sound[: RATE // 5] ** 2)


def test_oscillators_do_not_alias() -> None:
    sound = oscillate(wave_table(1975.5, 1.0), 1975.5, RATE)
    power = np.abs(np.fft.rfft(sound * np.hanning(RATE))) ** 2
    harmonic = np.zeros(len(power), dtype=bool)
    for order in range(1, 9):
        centre = round(1975.5 * order)
        harmonic[centre - 40 : centre + 41] = True
    assert power[~harmonic].sum() < 1e-5 * power.sum()


def test_drums_start_at_once_and_end_in_silence() -> None:
    for name, sound in drum_kit(np.random.default_rng(0)).items():
        assert np.abs(sound).max() <= 1.0, name
        assert abs(float(sound[-1])) < 1e-3, name
        assert np.flatnonzero(np.abs(sound) > 0.05)[0] < 0.012 * RATE, name
    kick = drum_kit(np.random.default_rng(0))["kick"]
    assert np.flatnonzero(np.abs(kick) > 0.05)[0] < 0.001 * RATE


def test_desk_places_and_cuts_sounds() -> None:
    desk = Desk(1000)
    desk.track("left", 1.0, -1.0, 0.0)
    desk.play("left", np.ones(10, dtype=np.float32), 100 / RATE, 0.5)
    desk.play("left", np.ones(10, dtype=np.float32), -5 / RATE)
    desk.play("left", np.ones(10, dtype=np.float32), 995 / RATE)
    desk.play("left", np.ones(10, dtype=np.float32), 2000 / RATE)
    mix = desk.mix(np.random.default_rng(0))
    assert mix[105, 0] == pytest.approx(0.5, abs=1e-4)
    assert np.abs(mix[:, 1]).max() < 1e-4
    assert np.flatnonzero(desk.listen("left")).tolist() == [*range(5), *range(100, 110), *range(995, 1000)]


def test_reverb_follows_and_fades() -> None:
    click = np.zeros((2, 2 * RATE), dtype=np.float32)
    click[:, 1000] = 1.0
    wet = reverberate(click, np.random.default_rng(0))
    assert np.abs(wet[:, :1000]).max() < 1e-6
    early, late = (float(np.mean(wet[:, at : at + RATE // 10] ** 2)) for at in (1000, RATE))
    assert late < 1e-3 * early
    assert abs(np.corrcoef(wet[0], wet[1]).item(1)) < 0.1


def test_limiter_holds_the_ceiling_without_jumps() -> None:
    peaks = np.full(RATE, 0.3, dtype=np.float32)
    peaks[20000:20010] = 3.0
    gain = limiter_gain(peaks)
    assert (peaks * gain).max() <= CEILING + 1e-6
    assert np.abs(np.diff(gain)).max() < 0.01
    assert gain[0] == gain[-1] == 1.0


def test_swell_is_closed_at_both_ends() -> None:
    envelope = swell(1000, 0.005, 0.005)
    assert envelope[0] == 0.0
    assert abs(envelope[-1]) < 1e-6
    assert envelope[500] == 1.0
