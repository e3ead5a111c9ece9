"""``retimed.html`` in a real browser: two dancers on the music's clock, named, and coloured by what is between them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from browser.pictures import Pictures
from onbeat.examples import embedded_song
from onbeat.limits.learned import learned_limits
from onbeat.motion import Motion
from onbeat.retime.lock import lock
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import source_of
from onbeat.viewer.pages.retime import on_music_clock, write_retime_page

pytestmark = pytest.mark.browser

BEATS = np.arange(8) * 0.5


@pytest.fixture(scope="module")
def made(swinger: Motion, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> tuple[Retimed, Any]:
    song, samples, rate = embedded_song(seconds=9.0)
    faster = song.beats[0] + np.arange(8) * 0.36
    result = retime(source_of(swinger), lock(faster, BEATS), learned_limits([swinger]), BEATS, BEATS[1::2])
    path = tmp_path_factory.mktemp("retimed") / "retimed.html"
    write_retime_page(path, result, swinger, song, (samples, rate), "Faster")
    return result, open_page(path)


def test_it_looks_as_it_did(made: tuple[Retimed, Any], pictures: Pictures):
    made[1].posed(1.5)
    pictures.look(made[1].page, "retimed", (900, 640))


def test_it_opens_without_a_word(made: tuple[Retimed, Any]):
    made[1].posed(1.0)
    assert made[1].complaints == []
    assert [url for url in made[1].requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_both_stand_where_the_music_has_them(made: tuple[Retimed, Any], swinger: Motion):
    result, opened = made
    retimed, wished = on_music_clock(result, swinger)
    for frame in (10, 70, 130):
        state = opened.posed(frame / retimed.fps)
        joints = [retimed.skeleton.index(name) for name in state["names"]]
        assert np.reshape(state["joints"], (-1, 3)) == pytest.approx(retimed.positions[frame, joints], abs=2e-3)
        assert np.reshape(state["other"], (-1, 3)) == pytest.approx(wished.positions[frame, joints], abs=2e-3)


def test_keyposes_are_stepped_to_and_the_original_goes_round_its_places(made: tuple[Retimed, Any]):
    result, opened = made
    opened.posed(0.0)
    opened.page.keyboard.press("n")
    assert opened.state()["time"] == pytest.approx(result.measures.keyposes[0], abs=1e-3)
    words = []
    for _ in range(3):
        words.append(opened.page.text_content("#master"))
        assert opened.state()["size"] == 1.0
        opened.page.keyboard.press("m")
        opened.posed(1.0)
    assert words == ["Original: beside", "Original: over", "Original: hidden"]
    assert opened.page.get_attribute("#master", "title").startswith("The original beside")
    assert opened.page.text_content("#heat figcaption") == "cm from the original (grey)"
    legend = opened.page.text_content("#legend")
    assert "keypose of the original; grey where it cannot be kept" in legend
    assert "mean distance from the original" in legend
    assert opened.complaints == []


def test_it_plays_to_the_music(made: tuple[Retimed, Any]):
    opened = made[1]
    opened.posed(0.0)
    opened.page.evaluate("window.onbeat.play()")
    opened.until("window.onbeat.state().time > 0.3")
    assert opened.state()["sound"]
    opened.page.evaluate("window.onbeat.pause()")
    assert opened.complaints == []
