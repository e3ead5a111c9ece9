"""The flags of a video."""

from __future__ import annotations

import pytest

from onbeat.cli.video_flags import NO_VIDEO, Film, VideoFlags
from onbeat.errors import OnbeatError


def test_no_flag_no_video() -> None:
    assert NO_VIDEO.film() is None
    assert VideoFlags().film() is None


def test_any_of_the_flags_asks_for_a_video() -> None:
    pytest.importorskip("av")
    assert VideoFlags(video=True).film() == Film((1280, 720), 30.0, False)
    assert VideoFlags(video_flash=True).film() == Film((1280, 720), 30.0, True)
    assert VideoFlags(video_size="1080X1920", video_fps=25.0).film() == Film((1080, 1920), 25.0, False)


@pytest.mark.parametrize(
    "size", ["", "720", "x", "1280x", "-1280x720", "1e3x720", "9999999999x720", "1279x720", "1280x8"]
)
def test_sizes_that_cannot_be(size: str) -> None:
    with pytest.raises(OnbeatError, match=r"--video-size|cannot be coded"):
        VideoFlags(video_size=size).film()


@pytest.mark.parametrize("fps", [0.0, -5.0, float("nan"), float("inf"), 1000.0])
def test_rates_that_cannot_be(fps: float) -> None:
    with pytest.raises(OnbeatError, match="pictures a second"):
        VideoFlags(video_fps=fps).film()
