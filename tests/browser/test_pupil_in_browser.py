"""``pupil.html`` in a real browser: the body takes the colours of its distance, the master stands beside or over it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.recognition.ghost import Beside, beside
from onbeat.viewer.pages.pupil import write_pupil_page
from onbeat.viewer.plots.heat import scale_end

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def found() -> Beside:
    pupil, master = (clip.motion for clip in dancers(2))
    return beside(pupil, master, [(1.0, 5.0)], [(1.0, 5.0)], np.arange(32.0)[None])


@pytest.fixture(scope="module")
def opened_page(found: Beside, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> Any:
    path = tmp_path_factory.mktemp("pupil") / "pupil.html"
    write_pupil_page(path, found, master="Aiko", title="Bruno beside Aiko", told=[("left wrist", "12 cm, +0.10 s")])
    return open_page(path)


def test_it_opens_without_a_word(opened_page: Any):
    opened_page.posed(1.0)
    assert opened_page.complaints == []
    assert [url for url in opened_page.requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_the_body_has_the_levels_of_its_moment(opened_page: Any, found: Beside):
    most = scale_end(100.0 * found.errors) / 100.0
    number = {name: joint for joint, name in enumerate(found.pupil.skeleton.names)}
    for frame in (0, 40, 110):
        state = opened_page.posed(frame / found.pupil.fps)
        wanted = found.joint_errors()[frame, [number[name] for name in state["names"]]] / most
        assert state["heat"] == pytest.approx(np.minimum(wanted, 1.0).tolist(), abs=0.01)


def test_the_master_stands_where_the_pupil_does_and_goes_round_its_places(opened_page: Any):
    state = opened_page.posed(2.0)
    assert np.shape(state["other"]) == np.shape(state["joints"])
    assert state["other"] != state["joints"]
    places = [state["master"]]
    for _ in range(3):
        opened_page.page.keyboard.press("m")
        places.append(opened_page.state()["master"])
        opened_page.posed(2.0)
    assert places == ["beside", "over", "hidden", "beside"]
    opened_page.page.click("#master")
    assert opened_page.state()["master"] == "over"
    assert opened_page.page.text_content("#master") == "Master: over"
    assert opened_page.complaints == []


def test_the_legend_tells_centimetres(opened_page: Any, found: Beside):
    assert opened_page.page.text_content("#heat figcaption") == "cm from Aiko (grey)"
    assert opened_page.page.text_content("#heat p").endswith(f"{scale_end(100.0 * found.errors):g}+")
    assert "gradient" in opened_page.page.evaluate(
        "getComputedStyle(document.querySelector('#heat i')).backgroundImage"
    )
    assert opened_page.page.text_content("#metrics dd") == "12 cm, +0.10 s"
