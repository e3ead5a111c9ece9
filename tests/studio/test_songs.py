"""Songs as the page shows them, with the beats that the user put right."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import numpy as np
import pytest

from onbeat.music.song import Song
from onbeat.studio.song_view import Curves
from onbeat.viewer.contract import pack_curve
from studio_house import TestClient, house, settled

BEATS = np.arange(1.0, 11.0, 0.5)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("songs")


@pytest.fixture(scope="module")
def client(home: Path):
    with house(home) as client:
        settled(client)
        folder = home / "project" / "songs" / "song"
        change = np.linspace(0, 1, len(BEATS))
        heard = Song(12.0, 120.0, 4, BEATS, BEATS[::4], change, np.array([0.0, 12.0]), np.array([0.2, 0.8]))
        (folder / "song.json").write_bytes(heard.to_json())
        curve = pack_curve(np.linspace(0, 1, 5), 10.0)
        (folder / "curves.json").write_bytes(msgspec.json.encode(Curves(curve, curve)))
        (folder / "sound.wav").write_bytes(b"RIFF0123456789")
        yield client


def test_a_song_is_shown_as_it_was_heard(client: TestClient):
    shown = client.get("/api/songs/song").json()
    assert shown["beats"] == BEATS.tolist()
    assert shown["downbeats"] == BEATS[::4].tolist()
    assert shown["edited"] is False
    assert shown["waveform"]["rate"] == 10.0
    assert len(shown["chord_change"]) == len(BEATS)


def test_beats_that_were_put_right_are_kept_until_what_was_heard_is_wanted_again(client: TestClient, home: Path):
    told = {"beats": [2.0, 1.0, 3.02, 4.0, 5.0, 6.0], "downbeats": [1.0, 4.0]}
    shown = client.put("/api/songs/song/beats", json=told).json()
    assert shown["beats"] == sorted(told["beats"])
    assert (shown["edited"], shown["meter"]) == (True, 3)
    assert shown["heard_beats"] == BEATS.tolist()
    assert shown["tempo"] == pytest.approx(60, abs=1)
    assert shown["chord_change"][2] == pytest.approx(4 / 19, abs=1e-3)  # that of the beat heard at 3.0 s
    assert client.get("/api/songs/song").json() == shown
    assert client.get("/api/project").json()["songs"][0]["edited"] is True
    back = client.delete("/api/songs/song/beats").json()
    assert (back["beats"], back["edited"], back["meter"], back["tempo"]) == (BEATS.tolist(), False, 4, 120.0)
    assert not (home / "project" / "songs" / "song" / "beats.json").exists()


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ('{"beats": [1.0]}', "1 beats; from 2"),
        ('{"beats": [1.0, 99.0]}', "99 s is outside of the song, which lasts 12.00 s"),
        ('{"beats": [-1.0, 2.0]}', "-1 s is outside"),
        ('{"beats": [1.0, 1.01, 2.0]}', "10 ms apart"),
        ('{"beats": [1.0, 2.0], "downbeats": [1.5]}', "1.500 s is on no beat"),
        ('{"beats": [1.0, NaN]}', "not the JSON that is expected"),
        ('{"beats": [1.0, 1e999]}', "out of range"),
        ('{"beats": "all"}', "beats: Expected `array`"),
        ('{"beats": [1.0, 2.0], "color": 3}', "color"),
        ("[" * 50000, "not the JSON"),
        ("", "not the JSON"),
    ],
)
def test_beats_that_cannot_be_are_refused_in_a_sentence(client: TestClient, body: str, why: str):
    answer = client.put("/api/songs/song/beats", content=body)
    assert answer.status_code == 422
    assert re.search(why, answer.json()["error"]), answer.json()
    assert client.get("/api/songs/song").json()["edited"] is False


def test_a_sound_is_played_from_anywhere(client: TestClient):
    part = client.get("/api/songs/song/sound", headers={"Range": "bytes=4-7"})
    assert (part.status_code, part.content, part.headers["content-type"]) == (206, b"0123", "audio/wav")
    assert client.get("/api/songs/../song/sound").status_code == 404
    assert client.get("/api/songs/..%2Fsong/sound").status_code == 404


def test_a_file_that_somebody_took_away_is_named(client: TestClient, home: Path):
    song = client.post("/api/songs?name=gone.mp3", content=b"sound").json()
    settled(client)  # our process makes no files
    for path in (f"/api/songs/{song['id']}", f"/api/songs/{song['id']}/sound"):
        answer = client.get(path)
        assert answer.status_code == 500
        assert answer.json()["error"].startswith(f"songs/{song['id']}/so")
        assert str(home) not in answer.text


def test_the_embedded_song_and_the_troupe_stay(client: TestClient):
    assert client.delete("/api/songs/song").status_code == 409
    assert client.delete("/api/libraries/troupe").status_code == 409
