"""The picture of a song."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

from onbeat.music import Song, listen_samples
from onbeat.music.audio import Audio
from onbeat.music.picture import MOST_LINES, Envelope, _draw, line_edges, write_picture
from sounds import click_track


@cache
def heard() -> tuple[Song, Audio]:
    _, audio = click_track(120, 30.0)
    song = listen_samples(audio)
    rich = {
        "confidence": np.linspace(0, 1, len(song.beats)),
        "chord_root": [("A:min", "F#:maj", "Bb:min", "N")[index // 2 % 4] for index in range(len(song.beats))],
    }
    return replace(song, **rich), audio


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_a_picture_is_drawn_the_same_every_time(tmp_path: Path, ending: str) -> None:
    song, audio = heard()
    for name in ("one", "two"):
        write_picture(tmp_path / f"{name}.{ending}", [audio.samples], audio.rate, song)
    assert (tmp_path / f"one.{ending}").read_bytes() == (tmp_path / f"two.{ending}").read_bytes()
    if ending == "png":
        pixels = imread(tmp_path / "one.png")
        assert pixels.shape[1] == 1500
        assert pixels[..., :3].std() > 0.05


def test_names_and_numbers_do_not_overlap() -> None:
    song, audio = heard()
    figure = Figure(dpi=100)
    _draw(figure, Envelope.of([audio.samples], audio.rate), song)
    figure.canvas.draw()
    for axes in figure.axes:
        for colour in {text.get_color() for text in axes.texts}:  # bar numbers, chords, names of sections: a row each
            row = [text.get_window_extent() for text in axes.texts if text.get_color() == colour]
            assert all(after.x0 >= before.x1 for before, after in pairwise(sorted(row, key=lambda box: box.x0)))
    assert {text.get_text() for axes in figure.axes for text in axes.texts} >= {"Am", "F♯", "Bbm", "–", "1", "2"}


def test_lines_are_few_however_long_the_song() -> None:
    for duration in (2.0, 24.0, 25.0, 180.0, 5000.0, 20000.0):
        edges = line_edges(duration)
        assert len(edges) - 1 <= MOST_LINES
        assert edges[0] == 0.0
        assert edges[-2] < duration <= edges[-1]


def test_a_song_without_beats_and_with_an_odd_name_is_drawn(tmp_path: Path) -> None:
    song = Song(5.0, 0.0, 4, [], [], [], [0.0, 5.0], [0.5, 0.5], "m", "$x_{$ \\frac \x07 " + "long " * 40)
    write_picture(tmp_path / "a.png", [np.zeros(22050 * 5, np.float32)], 22050, song)
    assert imread(tmp_path / "a.png").shape[1] == 1500


def test_an_envelope_keeps_the_extremes_in_any_blocks() -> None:
    samples = np.random.default_rng(0).uniform(-1, 1, 22050).astype(np.float32)
    whole = Envelope.of([samples], 22050)
    parts = Envelope.of([samples[i : i + 777] for i in range(0, len(samples), 777)], 22050)
    np.testing.assert_array_equal(whole.lowest, parts.lowest)
    times, low, high = whole.within(0.2, 0.7)
    assert times[0] == pytest.approx(0.2, abs=0.01)
    assert times[-1] == pytest.approx(0.7, abs=0.02)
    assert (low <= high).all()
    assert max(map(len, whole.within(0.0, 5.0))) <= 2402
