"""The list of what can be fetched: complete, consistent, with a licence for everything."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath
from urllib.parse import urlsplit

import pytest

from onbeat.errors import FetchError
from onbeat.fetch.sources import KINDS, Source, all_sources, read_sources, source_named

ALL = [source for kind in KINDS for source in all_sources(kind).values()]


@pytest.mark.parametrize("source", ALL, ids=lambda source: source.name)
def test_a_source_tells_all_that_has_to_be_known(source: Source):
    assert all((source.title, source.page, source.licence, source.credit, source.genre))
    assert source.kind == "songs" or (source.body and source.fps)
    assert bool(source.files) != bool(source.by_hand)
    assert "NC" not in source.licence or any("not for commercial use" in line for line in source.mind)
    for file in source.files:
        path = PurePosixPath(file.path)
        assert not path.is_absolute()
        assert ".." not in path.parts
        assert all(urlsplit(url).scheme in ("http", "https") and " " not in url for url in source.addresses(file))
        assert file.sha256 is None or re.fullmatch(r"[0-9a-f]{64}", file.sha256)
        assert file.sha256 or not source.sure
    assert len({file.path for file in source.files}) == len(source.files)
    assert len({url for file in source.files for url in source.addresses(file)[:1]}) == len(source.files)


def test_the_page_about_them_names_every_one():
    page = (Path(__file__).resolve().parents[2] / "docs" / "fetch.md").read_text(encoding="utf-8")
    named = re.findall(r"^\| `([\w-]+)` \|", page, re.MULTILINE)
    assert named == [source.name for source in ALL]


def test_amc_files_have_their_skeleton_and_a_rate():
    for source in all_sources("moves").values():
        names = {file.path for file in source.files}
        amc = [name for name in names if name.endswith(".amc")]
        assert all(f"{name.split('_')[0]}.asf" in names for name in amc)
        assert not amc or not source.fps_stored


def test_a_name_that_is_not_known_gets_one_that_is_alike():
    with pytest.raises(
        FetchError, match=r"no moves are known as 'cmu-danse'; did you mean cmu-dance\? There are cmu-dance,"
    ):
        source_named("moves", "cmu-danse")
    with pytest.raises(FetchError, match=r"no songs are known as '\.\./x'; there are sugar-plum-fairy,"):
        source_named("songs", "../x")


@pytest.mark.parametrize("text", ["moves = 3", "[moves.a]\ntitle = 'x'\n[songs]", "[moves"])
def test_a_list_that_is_none_is_told(text: str):
    with pytest.raises(FetchError, match="the list of sources cannot be read"):
        read_sources(text)
