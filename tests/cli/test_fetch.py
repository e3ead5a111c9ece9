"""Motion sets and songs by one word: licence first, then the data, then a dance with their names."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from data_server import DataServer, serving
from onbeat.examples.troupe import dance_library
from onbeat.fetch import all_sources
from onbeat.formats import write_motion
from onbeat.moves.cache import build_or_open
from onbeat.moves.recordings import find_recordings
from persons import AMC, ASF

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")

SOURCES = """
[moves.three-steps]
title = "Three steps"
page = "https://steps.example"
licence = "CC BY-NC 4.0"
licence_url = "https://creativecommons.org/licenses/by-nc/4.0/"
credit = "A. Dancer"
genre = "steps"
performers = {{ "a.*" = "A. Dancer" }}
body = "a person"
mind = ["not for commercial use"]
base = "{url}/"
files = [{{ path = "a.npz" }}, {{ path = "b.npz" }}]

[moves.rateless]
title = "No rate"
page = "https://steps.example"
licence = "CC0"
credit = "C. Dancer"
fps = 60.0
fps_stored = false
base = "{url}/"
files = [{{ path = "b.asf" }}, {{ path = "b.amc" }}]

[moves.asked-for]
title = "To be asked for"
page = "https://ask.example"
licence = "by its own terms"
credit = "B. Dancer"
by_hand = "ask at {{page}}"

[songs.tune]
title = "A tune"
page = "https://tune.example"
licence = "public domain"
credit = "a band"
base = "{url}/"
files = [{{ path = "tune.wav", url = "old%20tune.wav", also = ["{url}/tune.wav"] }}]
"""


@pytest.fixture
def server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[DataServer]:
    """A server of what is listed above, and a list of that alone."""
    monkeypatch.setenv("ONBEAT_DATA", str(tmp_path / "data"))
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.delenv("ONBEAT_MIRROR", raising=False)
    with serving() as running:
        monkeypatch.setattr("onbeat.fetch.sources._text", lambda: SOURCES.format(url=running.url))
        all_sources.cache_clear()
        yield running
    all_sources.cache_clear()


def test_what_was_fetched_is_danced_with_by_its_name(
    onbeat: Callable, server: DataServer, song: Path, out: Path, tmp_path: Path, cache: Path
):
    for name, performance in zip("ab", dance_library(fps=30.0), strict=False):
        write_motion(performance.motion[:150], tmp_path / f"{name}.npz")
        server.files[f"/{name}.npz"] = (tmp_path / f"{name}.npz").read_bytes()
    server.files["/tune.wav"] = song.read_bytes()
    status, printed, said = onbeat("moves", "fetch", "three-steps")
    folder = tmp_path / "data" / "moves" / "three-steps"
    assert (status, printed) == (0, f"{folder}\n")
    assert said.index("CC BY-NC 4.0 (https://creativecommons.org/licenses/by-nc/4.0/)") < said.index(
        "no publisher tells"
    )
    assert all(
        word in said for word in ("credit   A. Dancer", "mind     not for commercial use", "--moves three-steps")
    )

    status, printed, said = onbeat("songs", "fetch", "tune")
    assert (status, printed) == (0, f"{tmp_path / 'data' / 'songs' / 'tune' / 'tune.wav'}\n")
    assert "old%20tune.wav is not there" in said

    status, _, said = onbeat("dance", "song:tune", "--moves", "three-steps", "-o", out)
    assert status == 0, said
    assert "three-steps is CC BY-NC 4.0; credit: A. Dancer" in said
    assert "tune is public domain; credit: a band" in said
    library = build_or_open(folder)
    told = {clip.source: clip.about for clip in library.clips}
    assert {about.licence for about in told.values()} == {"CC BY-NC 4.0"}
    assert [told[name].performer for name in sorted(told)] == ["A. Dancer", None]


def test_the_rate_that_files_do_not_store_is_told_by_the_receipt(
    onbeat: Callable, server: DataServer, tmp_path: Path, recwarn: pytest.WarningsRecorder
):
    server.files = {"/b.asf": ASF.encode(), "/b.amc": AMC.encode()}
    onbeat("moves", "fetch", "rateless")
    (recording,) = find_recordings([tmp_path / "data" / "moves" / "rateless"])
    assert recording.read().fps == 60.0
    assert not [warning for warning in recwarn if "AMC" in str(warning.message)]


def test_the_list_says_what_is_here_and_what_is_to_be_got_by_hand(onbeat: Callable, server: DataServer):
    server.files = {"/a.npz": b"a", "/b.npz": b"b"}
    onbeat("moves", "fetch", "three-steps")
    status, printed, _ = onbeat("moves", "fetch", "--list")
    lines = printed.splitlines()
    assert status == 0
    assert lines[0].split() == ["three-steps", "?", "here", "CC", "BY-NC", "4.0"]
    assert lines[4].split()[:4] == ["asked-for", "?", "by", "hand"]
    _, printed, _ = onbeat("songs", "--json")
    assert [(row["name"], row["fetched"]) for row in json.loads(printed)] == [("tune", False)]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["dance", "--moves", "three-steps"], "three-steps is not fetched yet"),
        (["dance", "--moves", "three-steps"], "run onbeat moves fetch three-steps"),
        (["dance", "song:tune"], "run onbeat songs fetch tune"),
        (["listen", "song:tuna"], "no songs are known as 'tuna'; did you mean tune?"),
        (
            ["moves", "build", "asked-for", "-o", "lib"],
            "asked-for cannot be fetched by one word: ask at https://ask.example",
        ),
        (["moves", "fetch", "asked-for"], "asked-for cannot be fetched by one word"),
        (["moves", "fetch", "three-steps"], "a.npz is not there (answer 404)"),
        (["moves", "fetch", "--to", "x"], "--to and --renew are of something to fetch"),
    ],
)
def test_what_cannot_be_is_one_line(words: list[str], message: str, onbeat: Callable, server: DataServer):
    status, printed, said = onbeat(*words)
    assert (status, printed) == (1, "")
    assert message in said.splitlines()[-1]
    assert "Traceback" not in said


def test_a_mirror_is_named_by_a_variable(
    onbeat: Callable, server: DataServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    server.files = {f"/m/moves/three-steps/{name}.npz": b"x" for name in "ab"}
    monkeypatch.setenv("ONBEAT_MIRROR", f"{server.url}/m")
    status, printed, _ = onbeat("moves", "fetch", "three-steps", "--to", tmp_path / "there", "--json")
    assert status == 0
    assert [got["url"] for got in json.loads(printed)["files"]] == [f"{server.url}{path}" for path in server.files]
    assert (tmp_path / "there" / "a.npz").read_bytes() == b"x"
