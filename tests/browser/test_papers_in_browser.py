"""The page of a paper as somebody reads it: ours beside theirs, in a light and in a dark room."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from browser.pictures import Pictures
from made_results import RESULT
from onbeat.reproduce.page import paper_page

pytestmark = pytest.mark.browser


def test_it_looks_as_it_did(tmp_path: Path, open_page: Any, pictures: Pictures) -> None:
    path = tmp_path / "p1.html"
    path.write_bytes(paper_page(replace(RESULT, title="Dance to the music"), ["P1", "P2"]))
    opened = open_page(path)
    pictures.look(opened.page, "paper", (900, 640))
    pictures.look(opened.page, "paper_phone", (390, 700), dark=True)
    assert opened.complaints == []
