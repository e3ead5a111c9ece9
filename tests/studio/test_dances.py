"""Orders of dances, libraries and exports: each wrong field is named, and nothing wrong becomes a job."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from onbeat.studio.clip_list import ClipList
from studio_house import TestClient, house, project, settled


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("dances")


@pytest.fixture(scope="module")
def client(home: Path):
    with house(home) as client:
        settled(client)
        ClipList([("bow", 4.0), ("turn", 5.0)], ["broken.bvh: is empty"]).write(
            home / "project" / "libraries" / "troupe"
        )
        yield client


@pytest.fixture(scope="module")
def dance(client: TestClient) -> dict[str, Any]:
    made = client.post("/api/dances", json={"song": "song", "start": 2.0, "seconds": 8.0}).json()
    return next(one for one in settled(client)["dances"] if one["id"] == made["id"])


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("song", "song-99"), ("song", "../song"), ("library", "none"), ("start", -1.0), ("start", 12.5),
        ("start", 11.5), ("seconds", 0.1), ("seconds", 1e9), ("method", "magic"), ("seed", -1),
        ("intensity_weight", 9.0), ("robot", "r2d2"), ("speed", 0.01), ("start", "soon"), ("colour", "red"),
        ("keep", [{"dance": "dance-99", "from_s": 0.0, "to_s": 1.0}]),
    ],
)  # fmt: skip
def test_an_order_that_cannot_be_names_its_field(client: TestClient, field: str, value: object):
    before = project(client)["revision"]
    answer = client.post("/api/dances", json={"song": "song", field: value})
    assert answer.status_code == 422
    told = answer.json()
    assert told["field"] in (field, "")
    assert field in told["error"] or told["field"] == field
    assert "/" not in told["error"].replace("../song", "")  # no path of this machine
    assert project(client)["revision"] == before


def test_a_dance_is_named_after_its_song_and_moves(dance: dict[str, Any]):
    assert (dance["name"], dance["kind"], dance["seconds"]) == ("the embedded song, the troupe", "danced", 12.0)
    assert (dance["start"], dance["speed"], dance["song"]) == (2.0, 1.0, "song")


def test_dances_of_one_song_and_library_are_numbered(client: TestClient, dance: dict[str, Any]):
    def named(path: str, **told: object) -> str:
        return client.post(path, json=told).json()["name"]

    names = [named("/api/dances", song="song") for _ in range(2)]
    assert names == [f"{dance['name']} 2", f"{dance['name']} 3"]
    assert named("/api/dances", song="song", name=dance["name"]) == dance["name"]  # as the user will
    faster = [named(f"/api/dances/{dance['id']}/retimed", speed=1.5) for _ in range(2)]
    assert faster == [f"{dance['name']}, 1.5 ×", f"{dance['name']}, 1.5 × 2"]
    ready = {one["name"]: one["id"] for one in settled(client)["dances"]}
    assert named(f"/api/dances/{ready[faster[1]]}/retimed", speed=0.8) == f"{dance['name']}, 0.8 ×"
    settled(client)


@pytest.mark.parametrize(
    ("start", "stretch", "why"),
    [
        (0.0, (1.0, 2.0), "begins elsewhere"),
        (2.0, (3.0, 2.0), "no stretch"),
        (2.0, (3.0, 99.0), "no stretch"),
    ],
)
def test_a_stretch_is_kept_of_a_dance_that_fits(
    client: TestClient, dance: dict[str, Any], start: float, stretch: tuple[float, float], why: str
):
    keep = [{"dance": dance["id"], "from_s": stretch[0], "to_s": stretch[1]}]
    answer = client.post("/api/dances", json={"song": "song", "start": start, "keep": keep})
    assert answer.status_code == 422
    assert why in answer.json()["error"]
    assert answer.json()["field"] == "keep"


def test_a_dance_is_retimed_put_on_a_robot_and_both(client: TestClient, dance: dict[str, Any]):
    faster = client.post(f"/api/dances/{dance['id']}/retimed", json={"speed": 1.2}).json()
    assert (faster["kind"], faster["speed"], faster["start"], faster["source"]) == ("retimed", 1.2, 2.0, dance["id"])
    assert client.post(f"/api/dances/{faster['id']}/robot", json={"robot": "g1"}).status_code == 409  # not yet ready
    settled(client)
    robot = client.post(f"/api/dances/{faster['id']}/robot", json={"robot": "g1", "name": "Uni"}).json()
    assert (robot["kind"], robot["speed"], robot["robot"], robot["name"]) == ("robot", 1.2, "g1", "Uni")
    settled(client)
    slower = client.post(f"/api/dances/{robot['id']}/retimed", json={"speed": 0.9}).json()
    assert (slower["speed"], slower["robot"]) == (0.9, "g1")
    settled(client)
    assert client.post(f"/api/dances/{dance['id']}/retimed", json={"speed": "fast"}).json()["field"] == "speed"
    assert client.post(f"/api/dances/{dance['id']}/robot", json={"robot": "c3po"}).json()["field"] == "robot"


def test_an_export_has_the_dances_name_and_lies_under_none_of_the_users(client: TestClient, home: Path):
    made = client.post("/api/dances", json={"song": "song", "name": "../../a/b:\n<c>"}).json()
    settled(client)
    export = client.post(f"/api/dances/{made['id']}/exports", json={"format": "glb"}).json()
    assert export["file"] == "a b c.glb"
    wrong = client.post(f"/api/dances/{made['id']}/exports", json={"format": "g1csv"}).json()
    assert wrong["field"] == "format"
    assert "character" in wrong["error"]
    settled(client)
    assert client.get(f"/api/exports/{export['id']}").status_code == 409  # our process made no file
    assert {path.name for path in home.iterdir()} <= {"project", "log"}
    assert client.delete(f"/api/dances/{made['id']}").status_code == 204
    assert export["id"] not in [one["id"] for one in project(client)["exports"]]
    assert not (home / "project" / "dances" / made["id"]).exists()


@pytest.mark.parametrize(
    ("order", "why"),
    [
        ({"format": "mp4", "film": {"width": 1281}}, "even numbers"),
        ({"format": "mp4", "film": {"fps": 0}}, "pictures a second"),
        ({"format": "glb", "film": {}}, "format mp4"),
    ],
)
def test_a_video_that_cannot_be_is_refused(client: TestClient, dance: dict[str, Any], order: dict[str, Any], why: str):
    told = client.post(f"/api/dances/{dance['id']}/exports", json=order).json()
    assert told["field"] == "film"
    assert why in told["error"]


def test_a_video_is_kept_as_it_was_ordered_and_named_after_it(client: TestClient, dance: dict[str, Any]):
    film = {"width": 1080, "height": 1920, "fps": 30.0, "flash": True}
    made = client.post(f"/api/dances/{dance['id']}/exports", json={"format": "mp4", "film": film}).json()
    assert (made["film"], made["file"]) == (film, f"{dance['name']}, 1080x1920, flashes.mp4")
    usual = client.post(f"/api/dances/{dance['id']}/exports", json={"format": "mp4"}).json()
    assert usual["file"] == f"{dance['name']}.mp4"


def test_clips_are_marked_and_unmarked(client: TestClient):
    shown = client.get("/api/libraries/troupe").json()
    assert [clip["name"] for clip in shown["clips"]] == ["bow", "turn"]
    assert shown["problems"] == ["broken.bvh: is empty"]
    marked = client.put("/api/libraries/troupe/marks", json={"bow": "forbidden", "turn": "favourite"}).json()
    assert [clip["mark"] for clip in marked["clips"]] == ["forbidden", "favourite"]
    assert client.put("/api/libraries/troupe/marks", json={"jump": "forbidden"}).status_code == 422
    assert client.put("/api/libraries/troupe/marks", json={"bow": "loved"}).status_code == 422
    after = client.put("/api/libraries/troupe/marks", json={"bow": None}).json()
    assert [clip["mark"] for clip in after["clips"]] == [None, "favourite"]


def test_a_library_is_built_of_motions_of_the_project(client: TestClient):
    assert client.post("/api/libraries", json={"name": "mine", "motions": []}).json()["field"] == "motions"
    assert client.post("/api/libraries", json={"name": "mine", "motions": ["motion-99"]}).status_code == 404
    walk = client.post("/api/motions?name=walk.bvh", content=b"HIERARCHY").json()["motions"][0]
    made = client.post("/api/libraries", json={"name": " mine\n", "motions": [walk["id"], walk["id"]]}).json()
    assert (made["name"], made["motions"]) == ("mine", [walk["id"]])
    ready = next(one for one in settled(client)["libraries"] if one["id"] == made["id"])
    assert (ready["state"], ready["clips"]) == ("ready", 3)
    assert client.delete(f"/api/libraries/{made['id']}").status_code == 204


def test_a_dance_gets_another_name(client: TestClient, dance: dict[str, Any]):
    assert client.patch(f"/api/dances/{dance['id']}", json={"name": "Csárdás"}).json()["name"] == "Csárdás"
    assert client.patch(f"/api/dances/{dance['id']}", json={"name": "\n"}).json()["field"] == "name"
    assert client.patch("/api/dances/none", json={"name": "x"}).status_code == 404
