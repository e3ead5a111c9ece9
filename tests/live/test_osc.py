"""OSC as others' parsers read it, and what they may send."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator

import numpy as np
import pytest
from pythonosc.osc_bundle import OscBundle
from pythonosc.osc_message_builder import build_msg

from live_poses import ROBOT, dancer, pose, status
from onbeat.errors import OnbeatError
from onbeat.live.mouths.osc import Osc
from onbeat.live.mouths.osc_in import OscIn
from onbeat.live.mouths.osc_packets import AT_ONCE, LARGEST, bundles, message
from onbeat.live.protocol import BeatSaid, Command, Note


@pytest.fixture
def ear() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        bound.bind(("127.0.0.1", 0))
        bound.settimeout(5)
        yield bound


def heard(ear: socket.socket, count: int) -> list[OscBundle]:
    return [OscBundle(ear.recv(65536)) for _ in range(count)]


def messages(*packets: OscBundle) -> dict[str, list]:
    return {one.address: one.params for packet in packets for one in packet}


@pytest.fixture
def mouth(ear):
    opened: list[Osc] = []

    def make(who, **how) -> Osc:
        osc = Osc("127.0.0.1", ear.getsockname()[1], **how)
        osc.open(who)
        opened.append(osc)
        return osc

    yield make
    for osc in opened:
        osc.close()


def test_a_robots_pose_is_its_root_and_its_hinges_at_its_time(ear, mouth):
    osc = mouth(ROBOT)
    osc.pose(pose(150))
    who, packet = heard(ear, 2)
    assert messages(who)["/onbeat/who"] == ["arm", "robot", 1, 100, pytest.approx(0.1)]
    assert packet.timestamp == pytest.approx(ROBOT.started + 1.5, abs=1e-5)
    told = messages(packet)
    assert list(told) == ["/onbeat/pose", "/onbeat/root", "/onbeat/hinge/shoulder", "/onbeat/hinge/elbow"]
    assert told["/onbeat/pose"] == [150, pytest.approx(1.5)]
    assert told["/onbeat/root"] == pytest.approx([1.5, 2, 3, 0, 0, 0, 1])
    assert told["/onbeat/hinge/elbow"] == pytest.approx([1.15])


def test_a_large_body_is_split_into_packets_that_any_network_carries_whole(ear, mouth):
    who = dancer(60)
    osc = mouth(who, points=True)
    osc.pose(pose(7, who))
    ear.recv(2000)
    packets, told = [], {}
    while len(told) < 2 + 60 + 60:
        packets.append(ear.recv(65536))
        told |= messages(OscBundle(packets[-1]))
    assert max(len(packet) for packet in packets) <= LARGEST
    assert len(packets) <= 1 + sum(len(packet) for packet in packets) // (LARGEST - 100)
    assert told["/onbeat/joint/joint_59"] == [0, 0, 0, 1]
    assert told["/onbeat/joint/joint_30"] == [1, 0, 0, 0]
    assert told["/onbeat/point/joint_59"] == [7, 7, 7]


def test_beats_and_how_things_are_have_addresses_of_their_own(ear, mouth):
    osc = mouth(ROBOT, stamped=False)
    osc.say(BeatSaid(12.5, 3, 0.75, 12.4))
    osc.say(status(2.0, [2.25, 2.75], position=4))
    osc.say(Note(3.0, "the input is back"))
    _, beat, how, note = heard(ear, 4)
    assert messages(beat) == {"/onbeat/beat": [12.5, 3, 0.75]}
    told = messages(how)
    assert told["/onbeat/tempo"] == pytest.approx([120.0, 0.9])
    assert told["/onbeat/hearing"] == ["music"]
    assert told["/onbeat/ahead"] == [4, 4, 0.25, 0.75]
    assert told["/onbeat/dancing"] == ["waltz", 1.0]
    assert messages(note) == {"/onbeat/note": ["the input is back"]}


def test_who_dances_is_said_again_for_those_who_came_later(ear, mouth):
    osc = mouth(ROBOT)
    for number in range(200):
        osc.pose(pose(number))
    assert [next(iter(messages(packet))) for packet in heard(ear, 202)].count("/onbeat/who") == 2


def test_a_host_that_is_none_is_said():
    with pytest.raises(OnbeatError, match=r"no host 'no\.such"):
        Osc("no.such.host.invalid", 9000).open(ROBOT)
    with pytest.raises(OnbeatError, match="port 70000"):
        Osc("127.0.0.1", 70000).open(ROBOT)


def nested(depth: int) -> bytes:
    packet = bundles(AT_ONCE, [message("/onbeat/tap")])[0]
    for _ in range(depth):
        packet = bundles(AT_ONCE, [packet])[0]
    return packet


def test_commands_are_heard_and_garbage_is_said_once():
    commands: list[Command] = []
    notes: list[str] = []
    into = OscIn(commands.append, notes.append, port=0)
    random = np.random.default_rng(0)
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.connect(("127.0.0.1", into.port))
            for size in (0, 1, 3, 4, 16, 700):
                sender.send(random.bytes(size))
            sender.send(nested(60))
            sender.send(build_msg("/onbeat/quit", []).dgram)
            sender.send(build_msg("/onbeat/play", [3]).dgram)
            sender.send(build_msg("/other/tap", []).dgram)
            sender.send(build_msg("/onbeat/rest", [0.0]).dgram)
            sender.send(build_msg("/onbeat/play", ["waltz"]).dgram)
            sender.send(bundles(AT_ONCE, [message("/onbeat/tap"), message("/onbeat/next", 1)])[0])
            end = time.monotonic() + 10
            while Command("next") not in commands and time.monotonic() < end:
                time.sleep(0.01)
    finally:
        into.close()
    assert [one for one in commands if one.do != "tap"] == [Command("play", "waltz"), Command("next")]
    assert commands.count(Command("tap")) == 2
    assert len(notes) == 2
    assert "no OSC" in notes[0]
    assert "'/onbeat/quit' is not known" in notes[1]


def test_a_port_that_is_taken_is_said(ear):
    with pytest.raises(OnbeatError, match="choose another port"):
        OscIn(print, print, port=ear.getsockname()[1])
