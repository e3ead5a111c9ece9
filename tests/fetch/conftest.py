"""What the tests of fetching share: a server, a data folder of their own, a source with two files."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

import pytest

from data_server import SPIN, WALK, DataServer, serving
from onbeat.fetch.sources import RemoteFile, Source


@pytest.fixture
def server() -> Iterator[DataServer]:
    with serving() as running:
        running.files = {"/walk.txt": WALK, "/spin.txt": SPIN}
        yield running


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ONBEAT_DATA", str(tmp_path / "data"))
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    return tmp_path / "data"


@pytest.fixture
def source(server: DataServer, data: Path) -> Source:
    return Source(
        "Two steps",
        "https://steps.example",
        "CC BY 4.0",
        "A. Dancer",
        genre="steps",
        performers={"walk*": "A. Dancer"},
        base=f"{server.url}/",
        sure=True,
        files=(
            RemoteFile("walk.txt", size=len(WALK), sha256=hashlib.sha256(WALK).hexdigest()),
            RemoteFile("spin.txt", size=len(SPIN), sha256=hashlib.sha256(SPIN).hexdigest()),
        ),
        name="two-steps",
    )
