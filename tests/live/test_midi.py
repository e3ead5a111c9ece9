"""MIDI clock follows the beats that are foretold, and another machine's clock is read without its jitter."""

from __future__ import annotations

import time
from types import SimpleNamespace

import numpy as np
import pytest

from live_poses import ROBOT, pose, status
from onbeat.errors import MissingExtraError, OnbeatError
from onbeat.live.mouths import midi_ports
from onbeat.live.mouths.midi import ClockOut
from onbeat.live.mouths.midi_in import ClockIn
from onbeat.live.mouths.pulses import PER_BEAT, Pulses
from onbeat.live.protocol import Clocked


def played(beats: np.ndarray, hearing=lambda _: "music", until: float = 18.0, meter: int = 4) -> list[tuple]:
    """Signals and their seconds, of a session that foretells four of these beats twenty times a second."""
    pulses, said = Pulses(), []
    for time_ in np.arange(0, until, 0.05):
        ahead = np.flatnonzero(beats > time_)[:4]
        position = int(ahead[0]) % meter + 1 if len(ahead) else 1
        state = hearing(time_)
        foretold = beats[ahead].tolist() if state != "nothing" else []
        said += [(time_, one) for one in pulses.foretell(status(time_, foretold, position, state))]
        while (at := pulses.next_at) is not None and at < time_ + 0.05:
            said += [(at, one) for one in pulses.take()]
    return said


def of(said: list[tuple], *kinds: str) -> list[tuple]:
    return [(at, one.kind, one.position) for at, one in said if one.kind in kinds]


def test_there_are_24_pulses_a_beat_each_beat_on_one_while_the_tempo_drifts():
    beats = 0.3 + np.cumsum(60 / np.linspace(120, 150, 45))
    said = played(beats)
    times = np.array([at for at, *_ in of(said, "clock")])
    on_beats = times[::PER_BEAT]
    assert np.abs(on_beats - beats[: len(on_beats)]).max() < 1e-3
    assert np.diff(times).min() > 0.9 * 60 / 150 / 24
    assert of(said, "start", "continue", "stop", "songpos") == [(beats[0], "start", 0)]


def test_it_starts_on_a_downbeat_stops_in_silence_and_goes_on_at_the_next_bar():
    beats = np.arange(0.5, 25, 0.5)
    said = played(beats, lambda at: "music" if at > 0.6 and not 6.1 < at < 9.1 else "nothing")
    start, stop, songpos, on = of(said, "start", "stop", "songpos", "continue")
    assert (start[1], start[0]) == ("start", 2.5), "the first downbeat that is heard"
    assert stop[1] == "stop"
    assert 6.0 < stop[0] < 6.2
    assert songpos[1:] == ("songpos", 32), "7.3 beats were played: two bars of 16 sixteenths"
    assert (on[1], on[0]) == ("continue", 10.5)


def test_a_break_that_is_held_through_stops_nothing():
    said = played(np.arange(0.5, 25, 0.5), lambda at: "held" if 5 < at < 9 else "music")
    assert [kind for _, kind, _ in of(said, "start", "stop", "continue")] == ["start"]


def test_a_prediction_that_moves_is_caught_up_with_no_pulse_left_out():
    early, late = np.arange(0.5, 8, 0.5), np.arange(8.2, 20, 0.4)
    said = played(np.concatenate([early, late]), until=15)
    times = np.array([at for at, *_ in of(said, "clock")])
    assert np.diff(times).min() >= 0.4 / 24 / 2 - 1e-9
    settled = late[(late > 10) & (late < 14.5)]
    nearest = np.abs(times[::PER_BEAT][:, None] - settled[None]).min(axis=0)
    assert nearest.max() < 1e-3


@pytest.mark.parametrize("beats", [[], [1.0], [1.0, 1.0], [float("nan")], [5.0, 4.0]])
def test_odd_predictions_are_lived_with(beats):
    pulses = Pulses()
    for second in range(5):
        pulses.foretell(status(float(second), beats, position=0))
        for _ in range(30):
            pulses.take()
    assert pulses.next_at is None or np.isfinite(pulses.next_at)


class Port:
    def __init__(self) -> None:
        self.said: list[tuple[str, float]] = []
        self.broken = self.closed = False

    def send(self, message) -> None:
        if self.broken:
            raise OSError("unplugged")
        self.said.append((message.type, time.monotonic()))

    def close(self) -> None:
        self.closed = True


def test_pulses_go_to_the_port_at_their_time():
    port = Port()
    clock = ClockOut("drums", lambda name: port)
    clock.open(ROBOT)
    begun = time.monotonic()
    clock.pose(pose(0))
    clock.say(status(0.0, [0.2, 0.6, 1.0]))
    time.sleep(0.9)
    clock.close()
    kinds = [kind for kind, _ in port.said]
    times = np.array([at for kind, at in port.said if kind == "clock"]) - begun
    assert (kinds[0], kinds[-1], port.closed) == ("start", "stop", True)
    assert 20 < len(times) < 60
    assert times[0] >= 0.199
    assert np.all(times >= 0.2 + np.arange(len(times)) * 0.4 / 24 - 0.002), "none comes before its time"
    assert np.median(times - 0.2 - np.arange(len(times)) * 0.4 / 24) < 0.05


def test_a_port_that_is_unplugged_is_said_to_who_speaks():
    port = Port()
    clock = ClockOut("drums", lambda name: port)
    clock.open(ROBOT)
    port.broken = True
    clock.pose(pose(0))

    def refused() -> str:
        try:
            clock.say(status(0.0, [0.01, 0.1]))
        except OnbeatError as error:
            return str(error)
        return ""

    end = time.monotonic() + 10
    while not (why := refused()) and time.monotonic() < end:
        time.sleep(0.01)
    assert why == "unplugged"
    clock.close()


def clocked(messages: list[tuple[float, str, int]]) -> list[Clocked]:
    """What ClockIn makes of messages (time, kind, position)."""
    heard: list[Clocked] = []
    now = [0.0]
    calls: list = []
    into = ClockIn("drums", heard.append, lambda: now[0], lambda name, call: calls.append(call) or Port())
    for now[0], kind, position in messages:
        calls[0](SimpleNamespace(type=kind, pos=position))
    into.close()
    return heard


def test_another_machines_clock_is_read_without_its_jitter():
    random = np.random.default_rng(0)
    true = np.arange(600) * 0.5 / 24
    came = np.sort(true + random.uniform(0, 0.006, 600))
    heard = clocked([(0.0, "start", 0), *((at, "clock", 0) for at in came)])
    assert [one.beat for one in heard] == pytest.approx(np.arange(600) / 24)
    told = np.array([one.time for one in heard])
    assert np.std((told - true)[100:]) < 0.4 * np.std((came - true)[100:])
    assert abs(np.mean((told - true)[100:]) - 0.003) < 0.001


def test_another_machines_tempo_step_is_followed_within_two_beats():
    came = np.concatenate([np.arange(200) * 0.5 / 24, 200 * 0.5 / 24 + np.arange(200) * 0.4 / 24])
    told = np.array([one.time for one in clocked([(at, "clock", 0) for at in came])])
    assert np.abs(told - came)[200 + 48 :].max() < 0.003


def test_stop_song_position_and_continue_are_understood():
    messages = [(0.0, "start", 0), (0.0, "clock", 0), (0.02, "stop", 0), (0.04, "clock", 0), (1.0, "songpos", 16)]
    messages += [(1.0, "continue", 0), (1.0, "clock", 0), (1.02, "clock", 0), (1.03, "note_on", 0)]
    assert [one.beat for one in clocked(messages)] == pytest.approx([0.0, 4.0, 4 + 1 / 24])


def test_ports_that_are_not_there_are_named_with_those_that_are(monkeypatch):
    class Backend:
        @staticmethod
        def get_output_names():
            return ["Keys 24:0", "Drums 20:0"]

        @staticmethod
        def open_output(name):
            return name

    monkeypatch.setattr(midi_ports, "midi", lambda: Backend)
    assert midi_ports.open_output("drums") == "Drums 20:0"
    with pytest.raises(OnbeatError, match="no MIDI port is called 'bass'; there are: 'Keys 24:0', 'Drums 20:0'"):
        midi_ports.open_output("bass")
    with pytest.raises(OnbeatError, match="more than one MIDI port is called '0'"):
        midi_ports.open_output("0")

    def nothing_to_play_on():
        raise ImportError("No module named 'rtmidi'")

    monkeypatch.setattr(Backend, "get_output_names", staticmethod(nothing_to_play_on))
    with pytest.raises(MissingExtraError, match="pip install python-rtmidi"):
        midi_ports.open_output("drums")
