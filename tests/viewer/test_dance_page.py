"""The page of a dance that was just made tells where it comes from."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from onbeat.dance.make import make_dance
from onbeat.examples import embedded_song
from onbeat.moves.library import MoveLibrary
from onbeat.viewer.pages.dance import write_dance_page


def test_the_page_holds_the_graph_and_the_warp(troupe: MoveLibrary, tmp_path: Path) -> None:
    dance = make_dance(embedded_song(seconds=8.0)[0], troupe, fps=30)
    write_dance_page(tmp_path / "dance.html", dance, troupe)
    found = re.search(rb'id="data">(.*?)</script>', (tmp_path / "dance.html").read_bytes(), re.DOTALL)
    assert found
    page = json.loads(found[1])
    names = [clip["name"] for clip in page["graph"]["clips"]]
    assert {move["clip"] for move in page["moves"]} <= set(names)
    assert page["graph"]["join_count"] == troupe.graph.join_count
    assert dance.warp is not None
    told = np.interp(3.21, page["warp"]["times"], page["warp"]["before"])
    assert told == pytest.approx(float(dance.warp(np.array([3.21]))[0]), abs=1e-3)
    assert {step["foot"] for step in page["steps"]} == {"left", "right"}
