"""The page's server: what it gives, whom it refuses, and that clients who stall or send garbage harm nobody."""

from __future__ import annotations

import http.client
import json
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from live_poses import dancer, pose, status
from onbeat.errors import OnbeatError
from onbeat.live.page import clients, wire
from onbeat.live.page.http import Sound, welcome
from onbeat.live.page.server import PORTS, POSE_EVERY, Server
from onbeat.live.protocol import VERSION, Command, Note

WHO = dancer(20)
SOUND = Sound(bytes(range(256)) * 40, "audio/wav")


def hello() -> wire.HelloData:
    points = list(WHO.points)
    return wire.HelloData(VERSION, "live", WHO.name, WHO.kind, points, [], [0], 0.0, 0.0, 0.0, WHO.started, 1.5)


class Served:
    """A server on some free port, and what its clients wanted."""

    def __init__(self) -> None:
        self.commands: list[Command] = []
        self.server = Server(b"<title>live</title>", hello, self.commands.append, SOUND, port=0)
        self.server.open(WHO)
        self.place = urlsplit(self.server.address).netloc
        self.open = ExitStack()
        self.number = 0

    def get(self, path: str, **headers: str) -> http.client.HTTPResponse:
        asked = http.client.HTTPConnection(self.place, timeout=10)
        asked.request("GET", path, headers={name.replace("_", "-"): value for name, value in headers.items()})
        return asked.getresponse()

    def connect(self, **how) -> ClientConnection:
        client = self.open.enter_context(connect(f"ws://{self.place}/live", open_timeout=10, **how))
        assert json.loads(client.recv(10))["type"] == "hello"
        return client

    def dance(self, poses: int) -> None:
        for _ in range(poses):
            self.server.pose(pose(self.number, WHO))
            self.number += 1


@pytest.fixture
def served() -> Iterator[Served]:
    made = Served()
    with made.open:
        yield made
        made.server.close()


def until(condition, seconds: float = 10.0) -> bool:
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.005)
    return bool(condition())


def test_the_page_and_the_sound_are_given_and_nothing_else(served):
    page = served.get("/?a=b")
    assert (page.status, page.read()) == (200, b"<title>live</title>")
    assert page.headers["Content-Type"] == "text/html; charset=utf-8"
    sound = served.get("/sound")
    assert (sound.status, sound.read(), sound.headers["Content-Type"]) == (200, SOUND.data, "audio/wav")
    assert [served.get(path).status for path in ("/etc/passwd", "/../sound", "//", "/live/")] == [404] * 4


@pytest.mark.parametrize(
    ("wanted", "status", "part", "where"),
    [
        ("bytes=0-", 206, slice(0, None), "bytes 0-10239/10240"),
        ("bytes=300-399", 206, slice(300, 400), "bytes 300-399/10240"),
        ("bytes=-100", 206, slice(-100, None), "bytes 10140-10239/10240"),
        ("bytes=10000-99999", 206, slice(10000, None), "bytes 10000-10239/10240"),
        ("bytes=10240-", 416, slice(0, 0), "bytes */10240"),
        ("bytes=5-2", 416, slice(0, 0), "bytes */10240"),
        ("bytes=a-b", 200, slice(None), None),
        ("bytes=-", 200, slice(None), None),
    ],
)
def test_parts_of_the_sound_are_given(served, wanted, status, part, where):
    got = served.get("/sound", Range=wanted)
    assert (got.status, got.read(), got.headers["Content-Range"]) == (status, SOUND.data[part], where)


def test_other_sites_are_refused_whatever_name_they_use(served):
    port = served.place.partition(":")[2]
    assert served.get("/", Host="evil.example").status == 403
    assert served.get("/", Host=f"localhost:{port}").status == 200
    assert served.get("/sound", Origin="http://evil.example").status == 403
    for origin in ("http://evil.example", "null", f"https://{served.place}", "http://127.0.0.1:1"):
        with pytest.raises(InvalidStatus, match="403"):
            served.connect(origin=origin)
    served.connect(origin=f"http://{served.place}").close()


@pytest.mark.parametrize(
    ("host", "bound_to", "good"),
    [
        ("[::1]:80", "127.0.0.1", True),
        ("192.168.1.5:8740", "127.0.0.1", False),
        ("192.168.1.5:8740", "0.0.0.0", True),
        ("evil.example:8740", "0.0.0.0", False),
        (f"{socket.gethostname()}:8740", "0.0.0.0", True),
        ("stage.local", "stage.local", True),
        ("", "127.0.0.1", False),
        (None, "127.0.0.1", False),
    ],
)
def test_addresses_are_ours_and_names_only_if_they_are_this_machines(host, bound_to, good):
    assert welcome(host, None, bound_to) == good


def test_a_client_hears_who_dances_then_how_things_are_then_poses_in_order(served):
    served.server.say(status(1.0, [1.5]))
    client = served.connect()
    assert json.loads(client.recv(10)) | {"dancing": "waltz"} == json.loads(wire.text(status(1.0, [1.5])))
    assert until(lambda: served.server.listeners == 1)
    served.server.say(Note(1.2, "it clips"))
    served.dance(10)
    assert json.loads(client.recv(10)) == {"type": "note", "time": 1.2, "text": "it clips"}
    numbers = [wire.unpacked(client.recv(10))[1] for _ in range(10 // POSE_EVERY)]
    assert numbers == list(range(0, 10, POSE_EVERY))
    client.send('{"type":"command","do":"play","value":"waltz"}')
    assert until(lambda: served.commands == [Command("play", "waltz")])
    client.close()
    assert until(lambda: served.server.listeners == 0)


def test_garbage_is_answered_once_then_its_sender_is_let_go_and_others_dance_on(served):
    good, bad, huge = served.connect(), served.connect(), served.connect()
    assert until(lambda: served.server.listeners == 3)
    huge.send("x" * (wire.LONGEST + 1))
    for _ in range(clients.WRONG + 1):
        bad.send(b"\x00garbage")
    assert "not a command" in json.loads(bad.recv(10))["text"]
    for gone, code in ((bad, 1008), (huge, 1009)):
        with pytest.raises(ConnectionClosed) as closed:
            gone.recv(10)
        assert closed.value.rcvd.code == code
    served.dance(2)
    assert wire.unpacked(good.recv(10))[1] == 0
    good.close()


def test_bytes_that_are_no_requests_leave_the_page_where_it_is(served):
    random = np.random.default_rng(0)
    for garbage in (b"", b"\r\n\r\n", b"GET / HTTP/9\r\n\r\n", b"A" * 20000, random.bytes(5000)):
        with socket.create_connection(tuple(served.place.split(":"))) as sender:
            sender.sendall(garbage)
    twice = b"GET / HTTP/1.1\r\nHost: %b\r\nHost: evil.example\r\n\r\n" % served.place.encode()
    with socket.create_connection(tuple(served.place.split(":"))) as sender:
        sender.sendall(twice)
        assert sender.recv(100).startswith(b"HTTP/1.1 403")
    assert served.get("/").status == 200


def test_a_flood_of_commands_is_cut(served):
    client = served.connect()
    for _ in range(200):
        client.send('{"type":"command","do":"tap"}')
    client.send("last")
    client.recv(10)
    assert clients.COMMANDS <= len(served.commands) < 190
    client.close()


def test_twenty_clients_hear_the_same(served):
    all_ = [served.connect() for _ in range(20)]
    assert until(lambda: served.server.listeners == 20)
    served.dance(20)
    heard = [[wire.unpacked(client.recv(10))[1] for _ in range(20 // POSE_EVERY)] for client in all_]
    assert heard == [list(range(0, 20, POSE_EVERY))] * 20


def test_a_client_that_stops_reading_is_let_go_and_nobody_else_waits(served, monkeypatch):
    monkeypatch.setattr(clients, "PATIENCE", 0.3)
    stalled = socket.socket()
    stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    host, port = served.place.split(":")
    stalled.connect((host, int(port)))
    stalled.sendall(
        f"GET /live HTTP/1.1\r\nHost: {served.place}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    good = served.connect()
    assert until(lambda: served.server.listeners == 2)
    end = time.monotonic() + 20
    while served.server.listeners == 2 and time.monotonic() < end:
        served.dance(20)
        for _ in range(20 // POSE_EVERY):
            number = wire.unpacked(good.recv(10))[1]
    assert served.server.listeners == 1
    assert number == served.number - POSE_EVERY
    stalled.close()
    good.close()


def test_a_port_that_is_taken_is_said_or_passed_by(served, monkeypatch):
    taken = int(served.place.partition(":")[2])
    with pytest.raises(OnbeatError, match=f"port {taken} of 127.0.0.1 is taken; choose another"):
        Server(b"", hello, print, port=taken).open(WHO)
    with pytest.raises(OnbeatError, match="expected an address of this machine"):
        Server(b"", hello, print, host="203.0.113.7", port=0).open(WHO)
    monkeypatch.setattr("onbeat.live.page.server.PORTS", (taken, 0))
    second = Server(b"", hello, print)
    second.open(WHO)
    assert f"port {taken} is taken" in second.note
    second.close()
    assert len(PORTS) == 10


def test_it_ends_at_once_with_clients_that_do_not_answer(served):
    with socket.create_connection(tuple(served.place.split(":"))) as silent:
        silent.sendall(b"GET / HT")
        client = served.connect()
        begun = time.monotonic()
        served.server.close()
        assert time.monotonic() - begun < 3.0
        with pytest.raises(ConnectionClosed):
            client.recv(10)


def test_the_documents_example_hears_the_session(served):
    document = (Path(__file__).resolve().parents[2] / "docs" / "live_protocol.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", document, re.DOTALL)
    assert len(example.strip().splitlines()) <= 20
    code = example.replace("127.0.0.1:8740", served.place)
    assert code != example
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as listener:
        assert until(lambda: served.server.listeners == 1)
        served.server.say(status(1.0, [1.5]))
        served.dance(1)
        served.server.close()
        said = listener.communicate(timeout=20)[0].splitlines()
    assert said == ["hello ", "status 120.0", "pose 0 at 0.00 s: (0.0, 0.0, 0.0)"]
    assert listener.returncode == 0


def test_a_page_of_another_origin_is_let_in_if_it_is_named():
    friend = "http://localhost:5173"
    assert welcome("127.0.0.1:8740", friend, "127.0.0.1", [friend])
    assert not welcome("evil.example", friend, "127.0.0.1", [friend])
