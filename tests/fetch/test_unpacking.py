"""Zips of others: nothing gets out of its folder, nothing swells, nothing is a link."""

from __future__ import annotations

import stat
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from onbeat.errors import FetchError
from onbeat.fetch.unpacking import unpack


def zipped(path: Path, write: Callable[[zipfile.ZipFile], object]) -> Path:
    with zipfile.ZipFile(path / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("good.bvh", "HIERARCHY")
        write(archive)
    return path / "a.zip"


def link(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name)
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return info


@pytest.mark.parametrize(
    ("write", "message"),
    [
        (lambda z: z.writestr("../out.bvh", "x"), "leads out of its folder"),
        (lambda z: z.writestr("a/../../out.bvh", "x"), "leads out of its folder"),
        (lambda z: z.writestr("/etc/out.bvh", "x"), "leads out of its folder"),
        (lambda z: z.writestr("C:\\out.bvh", "x"), "leads out of its folder"),
        (lambda z: z.writestr("a\\..\\out.bvh", "x"), "leads out of its folder"),
        (lambda z: z.writestr(link("link.bvh"), "/etc/passwd"), "a link or device"),
        (lambda z: z.writestr("fetched.json", "{}"), "a name that is not taken"),
        (lambda z: z.writestr("GOOD.bvh", "x"), "two files of one name"),
        (lambda z: z.writestr("bomb.bvh", bytes(70_000_000)), "far more than its size may hold"),
    ],
)
def test_a_hostile_zip_is_refused(write: Callable[[zipfile.ZipFile], object], message: str, tmp_path: Path):
    archive, folder = zipped(tmp_path, write), tmp_path / "deep" / "here"
    folder.mkdir(parents=True)
    with pytest.raises(FetchError, match=message):
        unpack(archive, folder, ["*"], lambda share: None)
    assert not list(folder.iterdir())


def test_only_what_is_wanted_is_taken(tmp_path: Path):
    def write(archive: zipfile.ZipFile) -> None:
        archive.writestr("__MACOSX/._good.bvh", "x")
        archive.writestr("set/Dance_1.BVH", "dance")
        archive.writestr("set/readme.pdf", "x")

    folder = tmp_path / "here"
    folder.mkdir()
    shares: list[float] = []
    unpacked = unpack(zipped(tmp_path, write), folder, ["*.bvh"], shares.append)
    assert [(path, size) for path, size, _ in unpacked] == [("good.bvh", 9), ("set/Dance_1.BVH", 5)]
    assert shares[-1] == 1.0
    with pytest.raises(FetchError, match=r"holds none of \*\.amc"):
        unpack(tmp_path / "a.zip", folder, ["*.amc"], shares.append)
