"""The flags of a video: whether, how large, how many pictures a second, with flashes or without."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

import cyclopts

from onbeat.errors import OnbeatError

Flag = Annotated[bool, cyclopts.Parameter(negative="")]
SIZE, FPS = "1280x720", 30.0


class Film(NamedTuple):
    """A video that is wanted: pixels across and down, pictures a second, and whether the floor flashes on beats."""

    size: tuple[int, int]
    fps: float
    flash: bool


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class VideoFlags:
    """A video; any of these flags asks for one.

    Parameters
    ----------
    video
        Write a video with sound, an mp4 (needs the extra ``video``).
    video_flash
        Let a ring run over the video's floor on every beat, a stronger one on downbeats.
    video_size
        Pixels across and down, even numbers: 1920x1080, 1080x1920; asks for a video, too.
    video_fps
        Pictures a second.
    """

    video: Flag = False
    video_flash: Flag = False
    video_size: str = SIZE
    video_fps: float = FPS

    def film(self) -> Film | None:
        """The video that is wanted, or None; what cannot be made, or not without an extra, is refused."""
        if self == NO_VIDEO:
            return None
        from onbeat.viewer.video import check_film, require_av

        across, by, down = self.video_size.lower().partition("x")
        if not (by and across.isdecimal() and down.isdecimal() and max(len(across), len(down)) < 6):
            raise OnbeatError(f"--video-size {self.video_size}: give pixels across and down, as {SIZE}")
        size = (int(across), int(down))
        check_film(size, self.video_fps)
        require_av()
        return Film(size, self.video_fps, self.video_flash)


NO_VIDEO = VideoFlags()
