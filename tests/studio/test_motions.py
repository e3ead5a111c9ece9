"""Motion files that lack something: a rate that is said, a skeleton that comes before or after them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from studio_house import TestClient, house, project, settled

BVH = b"HIERARCHY\nROOT hips\n"


@pytest.fixture
def home(tmp_path: Path) -> Path:
    return tmp_path


@pytest.fixture
def client(home: Path) -> Iterator[TestClient]:
    with house(home) as client:
        settled(client)
        yield client


def packed(*names: str) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in names:
            archive.writestr(name, name)
    return buffer.getvalue()


def dropped(client: TestClient, name: str, data: bytes = BVH) -> dict[str, Any]:
    answer = client.post(f"/api/motions?name={name}", content=data)
    assert answer.status_code == 201, answer.text
    return answer.json()


def of(found: dict[str, Any], shelf: str, id: str) -> dict[str, Any]:
    return next(one for one in found[shelf] if one["id"] == id)


def names(items: list[dict[str, Any]]) -> list[str]:
    return [item["name"] for item in items]


def test_a_rate_is_kept_and_libraries_are_built_again_with_it(home: Path):
    with house(home) as client:
        walk, run = (dropped(client, name)["motions"][0]["id"] for name in ("walk.csv", "run.csv"))
        settled(client)
        library = client.post("/api/libraries", json={"name": "mine", "motions": [walk, run]}).json()["id"]
        settled(client)
        answer = client.put("/api/motions/rate", json={"motions": [walk], "fps": 60})
        assert answer.status_code == 200, answer.text
        told = answer.json()
        assert [(item["id"], item["rate"], item["state"]) for item in told["motions"]] == [(walk, 60.0, "waiting")]
        assert [(item["id"], item["state"]) for item in told["libraries"]] == [(library, "waiting")]
        assert of(settled(client), "libraries", library)["state"] == "ready"
    with house(home) as client:
        found = project(client)
        assert [of(found, "motions", id)["rate"] for id in (walk, run)] == [60.0, None]
        back = client.put("/api/motions/rate", json={"motions": [walk], "fps": None}).json()
        assert back["motions"][0]["rate"] is None
        settled(client)


def test_a_dance_waits_until_its_library_is_built_at_the_new_rate(client: TestClient, home: Path):
    walk = dropped(client, "walk.csv")["motions"][0]["id"]
    settled(client)
    library = client.post("/api/libraries", json={"name": "mine", "motions": [walk]}).json()["id"]
    settled(client)
    (home / "hold").touch()
    client.put("/api/motions/rate", json={"motions": [walk], "fps": 60})
    dance = client.post("/api/dances", json={"song": "song", "library": library}).json()
    again = client.put("/api/motions/rate", json={"motions": [walk], "fps": 50})
    assert again.status_code == 409
    assert "being looked at" in again.json()["error"]
    states = {job["kind"]: job["state"] for job in project(client)["jobs"] if job["state"] != "done"}
    assert states["build"] == states["dance"] == "waiting"
    (home / "hold").unlink()
    assert of(settled(client), "dances", dance["id"])["state"] == "ready"


@pytest.mark.parametrize(
    ("told", "status", "why"),
    [
        ({"motions": ["motion-99"], "fps": 60}, 404, "no 'motion-99'"),
        ({"motions": [], "fps": 60}, 422, "name a motion"),
        ({"motions": ["song"], "fps": 0}, 422, "give 1 to 1000"),
        ({"motions": ["song"], "fps": 1e9}, 422, "give 1 to 1000"),
        ({"motions": ["song"]}, 422, "fps"),
    ],
)
def test_a_rate_that_cannot_be_is_refused(client: TestClient, told: dict[str, Any], status: int, why: str):
    answer = client.put("/api/motions/rate", json=told)
    assert answer.status_code == status
    assert why in answer.json()["error"]


def test_a_library_that_is_being_built_is_not_pulled_away_from_under_its_builder(client: TestClient, home: Path):
    walk = dropped(client, "walk.csv")["motions"][0]["id"]
    settled(client)
    (home / "hold").touch()
    client.post("/api/libraries", json={"name": "mine", "motions": [walk]})
    while not any(job["kind"] == "build" and job["state"] == "running" for job in project(client)["jobs"]):
        pass
    answer = client.put("/api/motions/rate", json={"motions": [walk], "fps": 60})
    assert answer.status_code == 409
    assert "mine is being built" in answer.json()["error"]
    (home / "hold").unlink()
    settled(client)


def test_an_amc_waits_for_its_skeleton_and_is_read_when_it_comes(client: TestClient, home: Path):
    first = dropped(client, "05_01.amc", b"a")["motions"][0]
    assert (first["state"], first["job"]) == ("waiting", None)
    assert first["lacks"] == "waits for its skeleton 05.asf"
    dropped(client, "60.asf", b"another")
    second = dropped(client, "more.zip", packed("x/05_02.AMC", "walk.bvh"))["motions"]
    assert [bool(item["job"]) for item in second] == [True, False]
    found = settled(client)
    assert {item["name"]: item["state"] for item in found["motions"]} == {
        "05_01.amc": "waiting", "60.asf": "waiting", "walk.bvh": "ready", "05_02.AMC": "waiting",
    }  # fmt: skip
    taken = dropped(client, "05.asf", b"skeleton")
    assert names(taken["found"]) == ["05_01.amc", "05_02.AMC"]
    assert len({item["job"] for item in taken["found"]}) == 1
    assert taken["motions"][0]["lacks"].startswith("the skeleton of")
    found = settled(client)
    assert all(of(found, "motions", item["id"])["state"] == "ready" for item in taken["found"])
    folder = home / "project" / "motions" / first["id"]
    assert (folder / "05_01.asf").read_bytes() == b"skeleton"


def test_a_skeleton_that_came_first_is_found_by_all_that_come_later(client: TestClient, home: Path):
    skeleton = dropped(client, "05.asf", b"skeleton")["motions"][0]
    assert (skeleton["state"], skeleton["job"]) == ("waiting", None)
    for name in ("05_01.amc", "05_02.amc"):
        item = dropped(client, name, b"a")["motions"][0]
        assert item["job"]
        assert of(settled(client), "motions", item["id"])["state"] == "ready"
    (home / "project" / "motions" / skeleton["id"] / "05.asf").unlink()
    together = dropped(client, "pair.zip", packed("60.asf", "60_01.amc"))["motions"]
    assert names(together) == ["60_01.amc"]
    assert dropped(client, "60_02.amc", b"a")["motions"][0]["job"], "one that lies beside others is found, too"
    settled(client)


def test_skeletons_in_another_folder_of_an_archive_are_found(client: TestClient):
    taken = dropped(client, "all.zip", packed("skeletons/05.asf", "skeletons/60.asf", "trials/05_01.amc"))
    assert [(item["name"], bool(item["job"])) for item in taken["motions"]] == [
        ("05_01.amc", True), ("05.asf", False), ("60.asf", False),
    ]  # fmt: skip
    assert taken["passed_over"] == []
    settled(client)


def test_a_motion_is_not_read_with_the_skeleton_of_others(client: TestClient):
    taken = dropped(client, "all.zip", packed("05.asf", "05_01.amc", "60_01.amc"))["motions"]
    assert [(item["name"], item["lacks"]) for item in taken] == [
        ("05_01.amc", ""), ("60_01.amc", "waits for its skeleton 60.asf"),
    ]  # fmt: skip
    together = dropped(client, "other.zip", packed("body.asf", "walk.amc", "run.amc"))["motions"]
    assert [item["lacks"] for item in together] == ["", ""], "what comes together belongs together"
    settled(client)


def test_a_skeleton_of_another_name_is_chosen(client: TestClient, home: Path):
    walk = dropped(client, "walk.amc", b"a")["motions"][0]
    body = dropped(client, "body.asf", b"skeleton")
    assert body["found"] == []
    refused = client.put(f"/api/motions/{walk['id']}/skeleton", json={"skeleton": walk["id"]})
    assert (refused.status_code, refused.json()["field"]) == (422, "skeleton")
    chosen = client.put(f"/api/motions/{walk['id']}/skeleton", json={"skeleton": body["motions"][0]["id"]}).json()
    assert (chosen["state"], chosen["lacks"]) == ("waiting", "")
    assert of(settled(client), "motions", walk["id"])["state"] == "ready"
    assert (home / "project" / "motions" / walk["id"] / "walk.asf").read_bytes() == b"skeleton"
    again = client.put(f"/api/motions/{walk['id']}/skeleton", json={"skeleton": body["motions"][0]["id"]})
    assert again.status_code == 409


def test_what_waits_for_another_file_is_in_no_library_and_can_be_taken_away(client: TestClient, home: Path):
    items = [dropped(client, name, b"a")["motions"][0] for name in ("05_01.amc", "60.asf")]
    for item in items:
        answer = client.post("/api/libraries", json={"name": "mine", "motions": [item["id"]]})
        assert answer.status_code == 422
        assert item["lacks"] in answer.json()["error"]
        assert client.put("/api/motions/rate", json={"motions": [item["id"]], "fps": 60}).status_code == 409
        assert client.delete(f"/api/motions/{item['id']}").status_code == 204
        assert not (home / "project" / "motions" / item["id"]).exists()


def test_what_waits_for_another_file_still_waits_when_the_studio_is_opened_again(home: Path):
    with house(home) as client:
        item = dropped(client, "05_01.amc", b"a")["motions"][0]
    with house(home) as client:
        assert of(settled(client), "motions", item["id"])["lacks"] == item["lacks"]
        assert names(dropped(client, "05.asf", b"skeleton")["found"]) == ["05_01.amc"]
        settled(client)
