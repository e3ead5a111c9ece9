"""Fetching: whole or not at all, on from where it stopped, checked, with licence and receipt."""

from __future__ import annotations

import errno
import hashlib
import io
import json
import socket
import zipfile
from pathlib import Path

import msgspec
import pytest

from data_server import SPIN, WALK, DataServer
from onbeat.errors import FetchError
from onbeat.fetch import Source, fetch, receipt_above, receipt_of
from onbeat.fetch.fetching import _working
from onbeat.fetch.sources import RemoteFile


def changed(source: Source, **fields: object) -> Source:
    return msgspec.structs.replace(source, **fields)


def place(data: Path) -> Path:
    return data / "moves" / "two-steps"


def inside(folder: Path) -> list[str]:
    """All that is in a folder, hidden or not."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())


def test_it_lies_there_whole_with_licence_and_receipt(source: Source, server: DataServer, data: Path):
    shares: list[float] = []
    receipt = fetch(source, when="2026-01-02T03:04:05+00:00", step=lambda what, share, detail: shares.append(share))
    assert inside(data) == [
        f"moves/two-steps/{name}" for name in ("LICENCE.txt", "fetched.json", "spin.txt", "walk.txt")
    ]
    assert (place(data) / "walk.txt").read_bytes() == WALK
    assert receipt_of(place(data)) == receipt
    assert receipt_above(place(data) / "walk.txt") == receipt
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    licence = (place(data) / "LICENCE.txt").read_text()
    assert all(word in licence for word in ("CC BY 4.0", "A. Dancer", "https://steps.example", "2026-01-02"))
    walk, spin = receipt.files
    assert (walk.url, walk.held_against) == (f"{server.url}/walk.txt", "publisher")
    assert spin.sha256 == hashlib.sha256(SPIN).hexdigest()
    assert (receipt.performer_of("walk.txt"), receipt.performer_of("spin.txt")) == ("A. Dancer", None)


def test_what_is_there_is_checked_and_not_loaded_again(source: Source, server: DataServer, data: Path):
    first = fetch(source, when="then")
    server.asked.clear()
    assert fetch(source, when="later") == first
    assert server.asked == []
    (place(data) / "spin.txt").write_bytes(b"spun")
    told: list[str] = []
    assert fetch(source, when="later", tell=told.append).when == "later"
    assert "1 of 2 files are not as they came (spin.txt)" in told[0]
    assert (place(data) / "spin.txt").read_bytes() == SPIN


def test_a_broken_connection_goes_on_where_it_broke(source: Source, server: DataServer):
    server.breaks["/walk.txt"] = [70_000, 50_000]
    fetch(source)
    ranges = [wanted for path, wanted in server.asked if path == "/walk.txt"]
    assert ranges[0] is None
    assert all(wanted.startswith("bytes=") for wanted in ranges[1:])
    assert len(ranges) == 3


def test_a_download_that_was_stopped_goes_on_when_it_is_run_again(source: Source, server: DataServer, data: Path):
    def stop(what: str, share: float, detail: str) -> None:
        if share > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fetch(source, step=stop)
    assert not place(data).exists()
    fetch(source)
    assert server.asked[1][1] is not None
    assert int(server.asked[1][1].removeprefix("bytes=").rstrip("-")) > 65_000
    assert (place(data) / "walk.txt").read_bytes() == WALK
    assert not (place(data).parent / ".two-steps.part").exists()


def test_the_rest_of_another_version_is_not_joined_to_a_part(source: Source, server: DataServer, data: Path):
    server.breaks["/walk.txt"] = [70_000, 0, 0, 0, 0]
    with pytest.raises(FetchError, match=r"the connection broke after 65,536 bytes.*run it again: it goes on"):
        fetch(source)
    new = b"run! " * 40_000
    server.files["/walk.txt"], server.tags["/walk.txt"] = new, '"2"'
    trusting = changed(source, sure=False, files=(RemoteFile("walk.txt"),))
    fetch(trusting)
    assert (place(data) / "walk.txt").read_bytes() == new


def test_a_part_that_is_whole_is_not_loaded_again(source: Source, server: DataServer, data: Path):
    def stop(what: str, share: float, detail: str) -> None:
        if detail.endswith("walk.txt") and share > 0.97:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fetch(source, step=stop)
    fetch(source)
    assert server.asked[1] == ("/walk.txt", f"bytes={len(WALK)}-")
    assert (place(data) / "walk.txt").read_bytes() == WALK


def test_parts_that_do_not_fit_are_loaded_from_the_beginning(source: Source, server: DataServer, data: Path):
    server.files["/walk.txt"], server.breaks["/walk.txt"] = b"lies " * 40_000, [70_000, 0, 0, 0, 0]
    with pytest.raises(FetchError, match="run it again"):
        fetch(source)
    server.files["/walk.txt"] = WALK  # of the same version, the server says
    fetch(source)
    assert [wanted is None for path, wanted in server.asked[-3:] if path == "/walk.txt"] == [False, True]
    assert (place(data) / "walk.txt").read_bytes() == WALK


def test_another_file_than_the_publishers_is_refused(source: Source, server: DataServer, data: Path):
    server.files["/spin.txt"] = b"SPIN " * 1000
    with pytest.raises(
        FetchError, match=r"spin\.txt is not the file that its publisher made known: its SHA-256 is \w{12}…"
    ):
        fetch(source)
    assert not place(data).exists()
    server.files["/spin.txt"] = SPIN
    server.asked.clear()
    fetch(source)
    assert [path for path, _ in server.asked] == ["/spin.txt"]  # the good one was kept


def test_what_came_first_is_trusted_and_held_against(source: Source, server: DataServer, data: Path):
    unsure = changed(source, sure=False, files=(RemoteFile("walk.txt"), RemoteFile("spin.txt", sha256="0" * 64)))
    told: list[str] = []
    first = fetch(unsure, tell=told.append)
    assert {got.held_against for got in first.files} == {"first seen now"}
    assert "no publisher tells a checksum of 2 of 2 files" in told[0]
    assert "1 of them (spin.txt) are not as onbeat was tested with" in told[1]
    assert json.loads((data / "known.json").read_text())["moves/two-steps/spin.txt"] == hashlib.sha256(SPIN).hexdigest()
    server.files["/spin.txt"] = b"SPIN " * 1000
    (place(data) / "spin.txt").unlink()
    with pytest.raises(FetchError, match=r"not the file that came the first time.*--renew"):
        fetch(unsure)
    fetch(unsure, renew=True)
    assert (place(data) / "spin.txt").read_bytes() == server.files["/spin.txt"]


def test_a_mirror_is_asked_first_and_done_without(source: Source, server: DataServer):
    server.files["/mirror/moves/two-steps/walk.txt"] = WALK
    server.files["/mirror/moves/two-steps/spin.txt"] = b"an old one"
    told: list[str] = []
    receipt = fetch(source, mirror=f"{server.url}/mirror/", tell=told.append)
    assert [got.url for got in receipt.files] == [
        f"{server.url}/mirror/moves/two-steps/walk.txt",
        f"{server.url}/spin.txt",
    ]
    assert len(told) == 1
    assert told[0].endswith(f"now {server.url}/spin.txt is tried")


PAGE = b"<!DOCTYPE html><html><body>Please log in</body></html>"


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"answers": {"/walk.txt": 404}}, r"walk\.txt is not there \(answer 404\)"),
        ({"answers": {"/walk.txt": 503}}, r"busy or out of order \(answer 503\).*try again later"),
        ({"answers": {"/walk.txt": 407}}, r"wants a name and password"),
        ({"files": {"/walk.txt": PAGE}}, r"a web page instead of data"),
        ({"files": {"/walk.txt": WALK}, "kinds": {"/walk.txt": "text/html; charset=utf-8"}}, r"a web page instead"),
        ({"files": {"/walk.txt": b"version https://git-lfs.github.com/spec/v1\n"}}, r"pointer of Git LFS"),
        ({"files": {"/walk.txt": WALK * 3}}, r"600,000 bytes long, expected were 200,000"),
    ],
)
def test_what_is_no_data_is_refused(
    wrong: dict[str, dict[str, object]], message: str, source: Source, server: DataServer, data: Path
):
    for name, value in wrong.items():
        setattr(server, name, value)
    with pytest.raises(FetchError, match=message):
        fetch(source)
    assert not place(data).exists()


@pytest.mark.parametrize(
    ("base", "message"),
    [
        ("http://127.0.0.1:9/", r"cannot reach 127\.0\.0\.1:9 .*is there a network"),
        ("ftp://127.0.0.1/", r"no address of the web"),
    ],
)
def test_a_place_that_is_not_reached_is_told(base: str, message: str, source: Source, data: Path):
    with pytest.raises(FetchError, match=message):
        fetch(changed(source, base=base))
    assert not inside(data)


def test_a_server_that_says_nothing_is_not_waited_for(source: Source, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("onbeat.fetch.downloading.SILENCE", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        with pytest.raises(FetchError, match=r"nothing came for 0 s after 0 bytes"):
            fetch(changed(source, base=f"http://127.0.0.1:{silent.getsockname()[1]}/"))
        silent.settimeout(5)
        silent.accept()[0].close()
        silent.settimeout(0)
        with pytest.raises(BlockingIOError):
            silent.accept()  # it was asked once


def test_a_full_disk_leaves_nothing_half(source: Source, data: Path, monkeypatch: pytest.MonkeyPatch):
    def full(*places: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("onbeat.fetch.fetching.receipt_for", full)
        with pytest.raises(FetchError, match=r"cannot keep data in .*two-steps: No space left on device; make room"):
            fetch(source)
    assert not place(data).exists()
    huge = changed(source, files=(RemoteFile("walk.txt", size=10**18),))
    with pytest.raises(FetchError, match=r"takes 1,000,000,000,000,000,000 bytes"):
        fetch(huge)


def test_two_at_once_are_one_too_many(source: Source, data: Path):
    data.mkdir()
    (data / "moves").mkdir()
    with _working(place(data)), pytest.raises(FetchError, match="is being fetched by another process"):
        fetch(source)


def test_files_of_others_are_not_touched(source: Source, tmp_path: Path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "diary.txt").write_text("dear diary")
    with pytest.raises(FetchError, match=r"holds other files \(diary\.txt\)"):
        fetch(source, tmp_path / "mine")
    with pytest.raises(FetchError, match="is a file; choose a folder"):
        fetch(source, tmp_path / "mine" / "diary.txt")


def test_a_zip_is_unpacked_and_a_damaged_one_loaded_again(source: Source, server: DataServer, data: Path):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("set/dance1.bvh", WALK)
        archive.writestr("set/run1.bvh", SPIN)
    server.files["/steps.zip"] = packed.getvalue()[:-30]
    zipped = changed(source, sure=False, files=(RemoteFile("steps.zip", unpack=True, keep=("dance*.bvh",)),))
    with pytest.raises(FetchError, match=r"steps\.zip is no zip that can be unpacked"):
        fetch(zipped)
    server.files["/steps.zip"] = packed.getvalue()
    receipt = fetch(zipped)
    assert inside(place(data)) == ["LICENCE.txt", "fetched.json", "set/dance1.bvh"]
    assert [got.path for got in receipt.archives] == ["steps.zip"]
    assert receipt.files[0].sha256 == hashlib.sha256(WALK).hexdigest()
    assert fetch(zipped) == receipt


def test_what_only_a_person_may_get_says_how(source: Source):
    with pytest.raises(FetchError, match=r"two-steps cannot be fetched by one word: ask at https://steps\.example"):
        fetch(changed(source, by_hand="ask at {page}"))


def test_a_damaged_receipt_is_told(source: Source, data: Path):
    fetch(source)
    (place(data) / "fetched.json").write_text('{"format": "onbeat fetched", "version": 1}')
    with pytest.raises(FetchError, match=r"fetched\.json is damaged .*fetch it again"):
        fetch(source)
    (place(data) / "fetched.json").write_text('{"of": "others"}')
    assert receipt_of(place(data)) is None
