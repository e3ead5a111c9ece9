"""The picture of a song."""

from __future__ import annotations

from pathlib import Path

from matplotlib.image import imread

from onbeat.music import listen_samples
from onbeat.music.picture import write_picture
from sounds import click_track


def test_a_picture_is_drawn_the_same_every_time(tmp_path: Path) -> None:
    _, audio = click_track(120, 6.0)
    song = listen_samples(audio)
    for name in ("one.png", "two.png"):
        write_picture(tmp_path / name, audio, song)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
    pixels = imread(tmp_path / "one.png")
    assert pixels.shape[1] > 1200
    assert pixels[..., :3].std() > 0.05
