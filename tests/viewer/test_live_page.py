"""The live stage as a file: whole, asking nobody else, and said to be missing where it is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.viewer.pages import live as module
from onbeat.viewer.pages.live import live_page


def test_it_holds_all_it_needs():
    page = live_page().decode("ascii", "replace")
    assert "default-src 'none'" in page
    assert "<!--" not in page, "a slot that was not filled"
    assert not re.search(r"<(?:link|script|img|iframe|audio)[^>]+(?:src|href)=[\"']?(?:https?:)?//", page)
    assert not re.search(r"(?:fetch|import|WebSocket|Audio)\([\"'`](?:https?|wss?):", page)
    assert len(page) < 1_000_000


@pytest.mark.parametrize("left", [None, b"", b'<!doctype html><meta content="onbeat live"> cut off'])
def test_a_damaged_page_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, left: bytes | None):
    if left is not None:
        (tmp_path / "static").mkdir()
        (tmp_path / "static" / "live.html").write_bytes(left)
    monkeypatch.setattr(module.resources, "files", lambda _: tmp_path)
    with pytest.raises(OnbeatError, match=r"live\.html is missing or damaged; install onbeat again"):
        live_page()
