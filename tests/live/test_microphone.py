"""An input that goes and comes back."""

from __future__ import annotations

import builtins
import time
from typing import Any

import numpy as np
import pytest

from fake_card import FakeCard
from onbeat.errors import AudioError, MissingExtraError
from onbeat.live.sound import sound_card as its_module
from onbeat.live.sound.microphone import Microphone, inputs

DESK = ("Desk", 8, 48000)
USB = ("USB mic", 1, 44100)


class Clock:
    def __init__(self) -> None:
        self.now = 10.0

    def __call__(self) -> float:
        return self.now


def started(card: FakeCard, device: str | int | None = None) -> tuple[Microphone, Clock]:
    clock = Clock()
    microphone = Microphone(device, card=card, clock=clock)
    microphone.start(watch=False)
    return microphone, clock


def watch(microphone: Microphone, clock: Clock, card: FakeCard, seconds: float, giving: bool) -> None:
    for _ in range(round(seconds / 0.1)):
        clock.now += 0.1
        if giving and card.streams[-1].active:
            card.streams[-1].give()
        microphone.look()


def test_blocks_come_as_they_were_given_and_the_latency_is_told():
    card = FakeCard(DESK)
    microphone, _ = started(card)
    assert (microphone.state, microphone.read()) == ("waiting", [])
    for value in (0.25, -0.5):
        card.streams[0].give(value, age=0.025)
    (first, rate), (second, _) = microphone.read()
    assert (first.shape, rate, microphone.state) == ((480, 2), 48000, "sound")
    assert np.array_equal(np.unique(first), [0.25])
    assert np.array_equal(np.unique(second), [-0.5])
    for _ in range(300):
        card.streams[0].give(age=0.045)
    assert microphone.latency == pytest.approx(0.035, abs=0.001)
    microphone.close()
    assert (card.streams[0].closed, microphone.state) == (True, "ended")


def test_a_device_that_stops_is_lost_and_comes_back_under_another_number_each_said_once():
    card = FakeCard(DESK, USB)
    microphone, clock = started(card, "usb")
    watch(microphone, clock, card, 1.0, giving=True)
    card.plugged, card.streams[0].active = [], False
    watch(microphone, clock, card, 5.0, giving=True)
    assert microphone.state == "lost"
    [note] = microphone.notes()
    assert "USB mic is lost" in note
    card.plugged = [("Other", 2, 44100), DESK, USB]
    watch(microphone, clock, card, 2.0, giving=True)
    assert card.streams[-1].asked["device"] == 2
    assert (microphone.state, microphone.notes()) == ("sound", ["the input USB mic is back"])
    assert microphone.read()


def test_a_sound_system_that_is_down_for_a_while_is_asked_again():
    card = FakeCard(USB)
    microphone, clock = started(card)
    card.streams[0].give()
    card.streams[0].active, card.down = False, True
    watch(microphone, clock, card, 5.0, giving=True)
    assert microphone.state == "lost"
    card.down = False
    watch(microphone, clock, card, 2.0, giving=True)
    assert (microphone.state, card.begun, len(microphone.notes())) == ("sound", 1, 2)


def test_a_device_that_falls_silent_without_a_word_is_lost_too():
    card = FakeCard(USB)
    microphone, clock = started(card)
    card.streams[0].give()
    watch(microphone, clock, card, 0.4, giving=False)
    assert microphone.state == "sound"
    card.rude = True  # and it does not let go either
    watch(microphone, clock, card, 8.0, giving=False)
    assert microphone.state == "lost"
    assert ["no sound comes from it" in note for note in microphone.notes()] == [True]
    card.streams[0].give()  # a late block of the stream that was given up
    assert microphone.state == "lost"
    watch(microphone, clock, card, 2.0, giving=True)
    assert (microphone.state, microphone.notes()) == ("sound", ["the input USB mic is back"])


def test_where_the_default_input_changes_the_new_one_is_heard():
    card = FakeCard(USB, DESK)
    microphone, clock = started(card)
    card.streams[0].give()
    card.plugged, card.streams[0].active = [DESK], False
    watch(microphone, clock, card, 2.0, giving=True)
    assert microphone.notes()[1:] == ["the input Desk is heard now, instead of USB mic"]
    assert [rate for _, rate in microphone.read()][-1] == 48000


def test_its_own_thread_finds_a_device_again():
    card = FakeCard(USB)
    microphone = Microphone(card=card)
    microphone.start()
    card.streams[0].give()
    card.streams[0].active = False
    limit = time.monotonic() + 20.0
    while len(card.streams) < 2 and time.monotonic() < limit:
        time.sleep(0.02)
    while not card.streams[-1].active and time.monotonic() < limit:
        time.sleep(0.02)
    card.streams[-1].give()
    assert microphone.state == "sound"
    assert [note.split(" (")[0] for note in microphone.notes()] == [
        "the input USB mic is lost",
        "the input USB mic is back",
    ]
    microphone.close()
    assert all(stream.closed for stream in card.streams)


def test_what_is_lost_by_a_busy_machine_and_a_muted_input_are_said_once():
    card = FakeCard(USB)
    microphone, _ = started(card)
    for _ in range(2500):
        card.streams[0].give(0.0, overflow=True)
        microphone.read()
    assert [note.split(":")[0] for note in microphone.notes()] == [
        "the machine is too busy",
        "the input USB mic gives only zeros",
    ]


@pytest.mark.parametrize(
    ("device", "expected"),
    [(None, "USB mic"), ("1", "Desk"), (1, "Desk"), ("desk", "Desk")],
)
def test_inputs_are_chosen_by_number_or_name(device: str | int | None, expected: str):
    card = FakeCard(USB, DESK)
    started(card, device)
    assert card.known[card.streams[0].asked["device"]][0] == expected


@pytest.mark.parametrize("device", [7, -1, "nothing", "e", 2])
def test_an_input_that_is_not_there_is_refused_and_those_that_are_named(device: str | int):
    with pytest.raises(AudioError, match=r"no input .*the inputs are: 0: USB mic \(ALSA, 1 channels, 44100 Hz\); 1: D"):
        started(FakeCard(USB, ("Desk e", 8, 48000), ("Loudspeaker", 0, 44100)), device)


def test_without_any_input_it_says_what_to_do():
    with pytest.raises(AudioError, match="no default input: there is no sound input; plug one in, or play a file"):
        started(FakeCard())
    assert inputs(FakeCard()) == []


def test_an_input_that_another_uses_is_refused_and_let_go():
    card = FakeCard(USB)
    card.busy = True
    with pytest.raises(AudioError, match=r"USB mic cannot be opened.*another program"):
        started(card)
    with pytest.raises(AudioError, match="9 channels; it has 1"):
        Microphone(channels=9, card=FakeCard(USB)).start(watch=False)


@pytest.mark.parametrize(
    ("missing", "line"),
    [
        (ImportError("No module"), r'pip install "onbeat\[live\]"'),
        (OSError("not found"), "sudo apt install libportaudio2"),
    ],
)
def test_what_is_not_installed_is_named(missing: Exception, line: str, monkeypatch: pytest.MonkeyPatch):
    real = builtins.__import__

    def without(name: str, *args: Any) -> Any:
        if name == "sounddevice":
            raise missing
        return real(name, *args)

    monkeypatch.setattr(builtins, "__import__", without)
    its_module.sound_card.cache_clear()
    with pytest.raises(MissingExtraError, match=line):
        Microphone().start()
    with pytest.raises(MissingExtraError, match=line):
        inputs()
