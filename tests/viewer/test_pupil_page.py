"""A pupil's page and figure: the colours are those of the distances, and the same input gives the same bytes."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.errors import OnbeatError
from onbeat.recognition.ghost import Beside, beside
from onbeat.viewer.pages.pupil import write_pupil_page
from onbeat.viewer.plots.heat import colours, hex_scale, scale_end
from onbeat.viewer.plots.pupil import worst, write_pupil_figure


@pytest.fixture(scope="module")
def found() -> Beside:
    pupil, master = (clip.motion for clip in dancers(2))
    spans = [(1.0, 2.5), (3.5, 5.0)]
    return beside(pupil, master, spans, spans, np.tile(np.arange(32.0), (2, 1)))


def data_of(path: Path) -> dict[str, Any]:
    text = path.read_text(encoding="utf-8")
    return json.loads(text.split('<script type="application/json" id="data">')[1].split("</script>")[0])


def test_the_page_has_a_level_for_each_joint_and_frame(found: Beside, tmp_path: Path) -> None:
    write_pupil_page(tmp_path / "a.html", found, master="Aiko <b>", title="Bruno")
    write_pupil_page(tmp_path / "b.html", found, master="Aiko <b>", title="Bruno")
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    page = data_of(tmp_path / "a.html")
    heat = page["compared"]["heat"]
    levels = np.frombuffer(base64.b64decode(heat["base64"]), np.uint8).reshape(page["frames"], len(page["joints"]))
    outside = np.isnan(found.errors).any(axis=1)
    assert outside.any()
    assert ((levels == 255).all(axis=1) == outside).all()
    wrist = page["joints"].index("LeftHand")
    mine = 100 * found.joint_errors()[:, found.pupil.skeleton.index("LeftHand")]
    there = levels[~outside, wrist] * heat["most"] / 254
    assert np.abs(there - np.minimum(mine[~outside], heat["most"])).max() <= heat["most"] / 254
    assert page["compared"]["name"] == "Aiko <b>"
    assert len(page["compared"]["body"]["joints"]) > 10


def test_the_scale_is_ordered_in_grey_and_ends_at_a_round_number() -> None:
    grey = colours(np.linspace(0, 1, 65)) @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(grey) < 0).all()
    assert 30 < grey[-1] < grey[0] < 225  # neither end is lost on black or white
    assert len(set(hex_scale())) == 17
    assert scale_end(np.array([np.nan, 31.0])) == 40.0
    assert scale_end(np.array([np.nan])) == 5.0
    assert scale_end(np.array([1e9])) == 400.0


def test_the_worst_moments_are_apart_and_inside_of_segments(found: Beside) -> None:
    frames = worst(found)
    assert len(frames) == 3
    assert np.isfinite(found.errors[frames]).all()
    assert min(np.diff(frames)) > 5


def test_the_figure_is_the_same_each_time(found: Beside, tmp_path: Path) -> None:
    centimetres = 100 * np.sqrt(np.nanmean(np.square(found.errors), axis=0))
    for name in ("a.png", "b.png"):
        write_pupil_figure(tmp_path / name, found, found.elements, centimetres, "Bruno")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with pytest.raises(OnbeatError, match="cannot draw"):
        write_pupil_figure(tmp_path / "a.gif", found, found.elements, centimetres)
