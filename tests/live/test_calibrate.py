"""How late sound is heard, in rooms that are made here."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.live.sound.calibrate import LENGTH, calibrate, chirp, clicks_to_play, delays, through_card


def room(sound: np.ndarray, rate: int, late: float, ringing: float, noise: float, gain: float) -> np.ndarray:
    """What a microphone hears: sound that comes later, echoes of it as strong as itself, noise and a hum."""
    rng = np.random.default_rng(7)
    size = 2 * len(sound)
    turned = np.exp(-2j * np.pi * np.fft.rfftfreq(size, 1 / rate) * late)
    times = np.arange(round(max(ringing, 0.01) * rate)) / rate
    echoes = rng.standard_normal(len(times)) * 10 ** (-3 * times / max(ringing, 0.01)) * (times > 0.004)
    echoes *= (ringing > 0) / np.sqrt((echoes**2).sum())
    echoes[0] = 1.0
    heard = np.fft.irfft(np.fft.rfft(sound, size) * turned * np.fft.rfft(echoes, size), size)[: len(sound) + rate]
    hum = 0.05 * np.sin(2 * np.pi * 50 * np.arange(len(heard)) / rate)
    return (gain * heard + noise * rng.standard_normal(len(heard)) + hum).astype(np.float32)


@pytest.mark.parametrize("rate", [8000, 48000])
@pytest.mark.parametrize("late", [0.0, 0.01234, 0.5])
@pytest.mark.parametrize(("ringing", "noise", "gain"), [(0.0, 0.0, 0.001), (0.6, 0.02, 0.3), (1.2, 0.05, 1.0)])
def test_the_delay_is_found_below_a_tenth_of_a_millisecond(
    rate: int, late: float, ringing: float, noise: float, gain: float
):
    def play_and_record(sound: np.ndarray, its: int) -> np.ndarray:
        return room(sound, its, late, ringing, noise, gain if ringing else 1.0)

    found = calibrate(play_and_record, clicks=6, rate=rate)
    assert found.seconds == pytest.approx(late, abs=1e-4)
    assert found.spread < 1e-4
    assert (found.heard, found.clicks) == (6, 6)


def test_clicks_that_are_drowned_are_not_counted():
    times, sound = clicks_to_play(10, 44100)
    for time in times[[2, 5, 6]]:
        sound[round(time * 44100) : round((time + LENGTH) * 44100)] = 0.0
    sound += 0.001 * np.random.default_rng(0).standard_normal(len(sound)).astype(np.float32)
    found = delays(times, np.concatenate((np.zeros(441, np.float32), sound)), 44100)
    assert (found.heard, found.clicks) == (7, 10)
    assert found.seconds == pytest.approx(0.01, abs=1e-4)


def test_an_echo_that_is_louder_is_not_the_direct_sound():
    times, sound = clicks_to_play(6, 44100)
    heard = np.zeros(len(sound) + 4000, np.float32)
    for late, gain in ((0, 0.8), (400, 1.0), (900, -0.9)):
        heard[late : late + len(sound)] += gain * sound
    assert delays(times, heard, 44100).seconds == pytest.approx(0.0, abs=1e-4)


def test_a_beat_in_the_room_is_not_taken_for_the_clicks():
    times, sound = clicks_to_play(8, 44100)
    other = np.zeros(len(sound), np.float32)
    for time in np.arange(0.2, times[-1], 0.5):  # somebody else's clicks, evenly apart
        other[round(time * 44100) :][: len(chirp(44100))] += chirp(44100)
    with pytest.raises(AudioError, match="clicks are heard"):
        delays(times, other, 44100)


@pytest.mark.parametrize("heard", ["noise", "silence", "nothing", "not a number", "too late"])
def test_where_no_clicks_are_heard_it_says_what_to_do(heard: str):
    times, sound = clicks_to_play(6, 44100)
    recording = {
        "noise": 0.1 * np.random.default_rng(1).standard_normal(len(sound)),
        "silence": np.zeros(len(sound)),
        "nothing": np.zeros(0),
        "not a number": np.full(len(sound), np.nan),
        "too late": np.concatenate((np.zeros(44100), sound)),
    }[heard]
    with pytest.raises(AudioError, match=r"of 6 clicks are heard.*--latency"):
        delays(times, recording, 44100)


@pytest.mark.parametrize(
    ("times", "recording", "rate"),
    [
        (np.zeros(0), np.zeros(9), 8000),
        (np.array([np.nan]), np.zeros(9), 8000),
        (np.array([-1.0]), np.zeros(9), 8000),
        (np.zeros(1), np.zeros((9, 2)), 8000),
        (np.zeros(1), np.zeros(9, int), 8000),
        (np.zeros(1), np.zeros(9), 7),
    ],
)
def test_what_is_no_recording_is_refused(times: np.ndarray, recording: np.ndarray, rate: int):
    with pytest.raises(AudioError, match="expected"):
        delays(times, recording, rate)


class Card:
    """What ``sounddevice.playrec`` gives on a card whose output is wired to its input."""

    class PortAudioError(Exception):
        pass

    there = True

    def playrec(self, sound: np.ndarray, samplerate: int, channels: int, **_: object) -> np.ndarray:
        if not self.there:
            raise self.PortAudioError("Error querying device -1")
        assert channels == 1
        return np.concatenate((np.zeros((samplerate // 20, 1), np.float32), sound))[: len(sound)]

    def wait(self) -> None:
        pass


def test_the_sound_card_plays_and_records():
    assert calibrate(through_card(Card()), clicks=3).seconds == pytest.approx(0.05, abs=1e-4)


def test_without_an_output_or_an_input_it_says_so():
    card = Card()
    card.there = False
    with pytest.raises(AudioError, match="an output and an input are needed"):
        calibrate(through_card(card))
    with pytest.raises(AudioError, match="expected 1 or more"):
        calibrate(through_card(card), clicks=0)
