"""What is too large, of a wrong kind, or means ill is refused clearly, and nothing of it stays."""

from __future__ import annotations

import io
import re
import stat
import struct
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from starlette.requests import Request

from onbeat.errors import OnbeatError
from onbeat.studio.archives import unpacked
from onbeat.studio.project import Project
from onbeat.studio.uploads import TooLargeError, received
from own_loop import run
from studio_house import TestClient, house, logged, project, settled

BVH = b"HIERARCHY\nROOT hips\n"


def packed(*files: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, data in files:
            archive.writestr(name, data)
    return buffer.getvalue()


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("uploads")


@pytest.fixture(scope="module")
def client(home: Path) -> Iterator[TestClient]:
    with house(home) as client:
        settled(client)
        yield client


def left(home: Path) -> list[str]:
    """Files of uploads that were not kept."""
    return [path.name for path in (home / "project" / "incoming").rglob("*")]


def test_a_file_that_says_it_is_too_large_is_refused_before_a_byte_of_it_is_read(tmp_path: Path):
    project = Project(tmp_path / "p")

    async def receive() -> dict[str, object]:
        raise AssertionError("it was read")

    headers = [(b"content-length", str(2 << 30).encode())]
    request = Request({"type": "http", "method": "POST", "headers": headers}, receive)
    with pytest.raises(TooLargeError, match="larger than 1000 MB"):
        run(received(request, project, 10**9))
    assert not list((project.folder / "incoming").iterdir())
    project.close()


def test_a_file_whose_sender_goes_away_leaves_nothing(tmp_path: Path):
    project = Project(tmp_path / "p")
    messages = [{"type": "http.request", "body": b"half", "more_body": True}, {"type": "http.disconnect"}]

    async def receive() -> dict[str, object]:
        return messages.pop(0)

    request = Request({"type": "http", "method": "POST", "headers": []}, receive)
    with pytest.raises(OnbeatError, match="ended after 4 bytes"):
        run(received(request, project, 10**9))
    assert not list((project.folder / "incoming").iterdir())
    project.close()


def test_a_body_that_does_not_say_how_long_it_is_is_cut_off(client: TestClient, home: Path):
    def endless() -> Iterator[bytes]:
        for _ in range(64):
            yield bytes(1 << 16)

    answer = client.post("/api/songs?name=long.wav", content=endless())
    assert answer.status_code == 413
    assert "larger than 1 MB" in answer.json()["error"]
    assert not left(home)
    assert len(project(client)["songs"]) == 1


def test_an_empty_file_is_refused(client: TestClient, home: Path):
    answer = client.post("/api/songs?name=empty.mp3", content=b"")
    assert answer.status_code == 422
    assert "empty" in answer.json()["error"]
    assert not left(home)


def test_a_users_file_name_is_shown_and_never_a_path(client: TestClient, home: Path):
    name = "../../../tmp/évil\x00.mp3"
    song = client.post("/api/songs", params={"name": name}, content=b"sound").json()
    assert song["name"] == "../../../tmp/évil.mp3"
    kept = [path for path in home.rglob("original*") if path.is_file()]
    assert kept[-1] == home / "project" / "songs" / song["id"] / "original.mp3"
    motion = client.post("/api/motions", params={"name": "../../walk.bvh"}, content=BVH).json()["motions"][0]
    assert (home / "project" / "motions" / motion["id"] / "_.._walk.bvh").is_file()
    assert {path.name for path in home.iterdir()} <= {"project", "log"}
    settled(client)


def test_a_motion_of_no_known_kind_is_refused(client: TestClient, home: Path):
    for name, why in (("cat.png", ".bvh"), ("roles.toml", "drop it together"), ("limits.toml", "called roles.toml")):
        answer = client.post(f"/api/motions?name={name}", content=b"\x89PNG")
        assert answer.status_code == 422
        assert why in answer.json()["error"]
    assert not left(home)


def test_an_archive_becomes_a_motion_of_each_file_and_one_job(client: TestClient, home: Path):
    archive = packed(
        ("dances/05.asf", b"skeleton"), ("dances/05_01.amc", b"a"), ("dances/05_02.AMC", b"b"), ("readme.txt", b"no"),
        ("__MACOSX/05_01.amc", b"junk"), ("walk ü.bvh", BVH), ("limits.toml", b""), ("roles.toml", b""),
        ("dances/05_03.roles.toml", b""), ("table.csv", b"1,2"),
    )  # fmt: skip
    taken = client.post("/api/motions?name=all.zip", content=archive).json()
    items = taken["motions"]
    assert taken["passed_over"] == ["dances/05_03.roles.toml", "limits.toml", "readme.txt", "table.csv"]
    assert [item["name"] for item in items] == ["05_01.amc", "05_02.AMC", "walk ü.bvh"]
    assert len({item["job"] for item in items}) == 1
    folder = home / "project" / "motions" / items[0]["id"]
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    assert files == ["dances/05.asf", "dances/05_01.amc", "dances/05_02.amc", "roles.toml", "walk__.bvh"]
    found = settled(client)
    assert [m["state"] for m in found["motions"] if m["id"] in {item["id"] for item in items}] == ["ready"] * 3
    for item in items[:2]:
        assert client.delete(f"/api/motions/{item['id']}").status_code == 204
    assert sorted(path.name for path in folder.rglob("*.*")) == ["05.asf", "roles.toml", "walk__.bvh"]
    client.delete(f"/api/motions/{items[2]['id']}")
    assert not folder.exists()


def linked() -> bytes:
    entry = zipfile.ZipInfo("walk.bvh")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(entry, "/etc/passwd")
    return buffer.getvalue()


def lying() -> bytes:
    """An archive that says its file is 4 bytes long, which unpacks to 4 MB."""
    data = packed(("walk.bvh", bytes(4 << 20)))
    return data.replace(struct.pack("<I", 4 << 20), struct.pack("<I", 4))


EVIL = {
    "up": (packed(("../walk.bvh", BVH)), "leads out"),
    "up in the middle": (packed(("a/../../walk.bvh", BVH)), "leads out"),
    "backwards": (packed(("..\\walk.bvh", BVH)), "leads out"),
    "absolute": (packed(("/etc/walk.bvh", BVH)), "leads out"),
    "a drive": (packed(("C:/walk.bvh", BVH)), "leads out"),
    "a link": (linked(), "a link"),
    "a bomb": (packed(("walk.bvh", bytes(11 << 20))), "too large|grows more than"),
    "many small bombs": (packed(*((f"{n}.bvh", bytes(1 << 18)) for n in range(8))), "too large"),
    "too many files": (packed(*((f"{n}.bvh", b"") for n in range(2001)), method=zipfile.ZIP_STORED), "more than 2000"),
    "a lie": (lying(), "cannot be read"),
    "deep": (packed(("a/" * 30 + "walk.bvh", BVH)), "folders in folders"),
    "no motion": (packed(("song.mp3", b"x")), "no motion files"),
    "cut off": (packed(("walk.bvh", BVH))[:-10], "cannot be read"),
    "nothing": (b"PK\x05\x06" + bytes(18), "no motion files"),
    "a great table": (b"PK\x03\x04" + b"PK\x05\x06" + bytes(8) + struct.pack("<I", 99 << 20) + bytes(6), "contents"),
}


@pytest.mark.parametrize("kind", EVIL)
def test_an_archive_that_means_ill_is_refused(client: TestClient, home: Path, kind: str):
    data, why = EVIL[kind]
    before = len(project(client)["motions"])
    answer = client.post("/api/motions?name=dances.zip", content=data)
    assert answer.status_code == 422, answer.text
    assert re.search(why, answer.json()["error"]), answer.json()["error"]
    assert len(project(client)["motions"]) == before
    assert not left(home)
    assert {path.name for path in home.iterdir()} <= {"project", "log"}


def test_a_file_that_grows_out_of_nothing_is_stopped_on_the_way(tmp_path: Path):
    path = tmp_path / "bomb.zip"
    path.write_bytes(packed(("walk.bvh", bytes(11 << 20))))
    (tmp_path / "out").mkdir()
    with pytest.raises(OnbeatError, match="grows more than 200 times"):
        unpacked(path, tmp_path / "out", 1 << 30)
    assert (tmp_path / "out" / "walk.bvh").stat().st_size <= (10 << 20) + (1 << 16)


def test_files_that_cannot_be_read_fail_in_their_job_and_say_why(client: TestClient, home: Path):
    song = client.post("/api/songs?name=bad.mp3", content=b"\x89PNG no sound").json()
    found = settled(client)
    item = next(one for one in found["songs"] if one["id"] == song["id"])
    assert (item["state"], item["error"]) == ("failed", "bad.mp3 cannot be")
    assert client.get(f"/api/songs/{song['id']}").status_code == 409
    assert "bad.mp3" in logged(home, "begin")
