"""A dance as an mp4 file with its song: H.264 and AAC, made frame by frame, in step, whole or not at all."""

from __future__ import annotations

import contextlib
import importlib
import os
import tempfile
from collections.abc import Callable, Generator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Float32, Times
from onbeat.errors import MissingExtraError, OnbeatError
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.viewer.figure import Figure
from onbeat.viewer.film.flashes import Flashes
from onbeat.viewer.film.in_order import in_order
from onbeat.viewer.film.scene import Scene
from onbeat.viewer.film.sound import SoundTrack
from onbeat.viewer.film.strip import Strip, loudness
from onbeat.viewer.render.camera import Size

STRIP = 0.1
"""The strip's part of the picture's height."""
SMALLEST, LARGEST = 16, 4096
"""Pixels of a side."""
SLOWEST, FASTEST = 0.01, 240.0
"""Pictures a second."""


def write_video(
    path: str | os.PathLike[str],
    motion: Motion,
    song: Song | None = None,
    audio: tuple[Float32, int] | None = None,
    *,
    fps: float = 30,
    size: Size = (1280, 720),
    stops: Times | None = None,
    marked: str = "stops",
    figure: Figure | None = None,
    flashes: Flashes | None = None,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write a dance as an mp4 that plays everywhere (yuv420p, index first), exactly as long as the dance.

    Frame ``i`` shows the dance at ``i / fps`` seconds and lasts until the next one. Sound begins with the first
    frame; where it is shorter than the dance, silence follows. Pictures are made by several threads while others are
    coded; the bytes are the same with any number. No more than a few pictures are in memory.

    Parameters
    ----------
    path : the file; an older one is replaced once the new one is whole.
    motion, song : what is danced, and what its strip shows.
    audio : ((N, channels) samples -1…1, samples a second), or None for a silent film.
    fps : frames a second, 0.01 to 240.
    size : width and height in pixels; even numbers from 16 to 4096.
    stops : seconds at which the dancer stops, marked in the strip.
    marked : what the strip calls these marks.
    figure : what the body looks like; as its joints' roles tell without it.
    flashes : rings that run over the floor on beats.
    progress : called with the part that is done, 0…1.

    Raises
    ------
    MissingExtraError
        If PyAV is not installed.
    OnbeatError
        If the file cannot be written, or the size is odd, or size or rate are out of bounds.
    """
    av = require_av()
    check_film(size, fps)
    with _whole_file(Path(path)) as temporary:
        looks = Figure.of(motion.skeleton) if figure is None else figure
        count = max(1, round(motion.duration * fps))
        level = None if audio is None else loudness(audio[0], size[0], count / fps, audio[1])
        times = np.zeros(0) if stops is None else stops
        strip = Strip.of(song, level, times, count / fps, max(4, int(size[1] * STRIP)), size[0], marked)
        scene = Scene.of(motion, looks, strip, fps, size, flashes)
        _encode(av, temporary, scene, count, fps, audio, progress)


def check_film(size: Size, fps: float) -> None:
    """Refuse with an ``OnbeatError`` what cannot be filmed: sizes and rates as :func:`write_video` has them."""
    if size[0] % 2 or size[1] % 2 or min(size) < SMALLEST or max(size) > LARGEST:
        raise OnbeatError(
            f"a video of {size[0]} x {size[1]} pixels cannot be coded; give even numbers from {SMALLEST} to {LARGEST}"
        )
    if not SLOWEST <= fps <= FASTEST:
        raise OnbeatError(f"a video of {fps:g} pictures a second cannot be made; give {SLOWEST:g} to {FASTEST:g}")


def require_av() -> Any:
    """PyAV, which is an extra; a ``MissingExtraError`` says how to get it."""
    try:
        return importlib.import_module("av")
    except ImportError:
        raise MissingExtraError(
            "writing a video needs PyAV, which is not installed; run: pip install 'onbeat[video]'"
        ) from None


@contextlib.contextmanager
def _whole_file(path: Path) -> Generator[Path]:
    """A file beside ``path`` that takes its name at the end, or is gone if anything (Ctrl-C too) went wrong."""
    temporary: Path | None = None
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        raise OnbeatError(f"cannot write {path}: {error.strerror or error}; choose another folder") from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _encode(
    av: Any,
    path: Path,
    scene: Scene,
    count: int,
    fps: float,
    audio: tuple[Float32, int] | None,
    progress: Callable[[float], None] | None,
) -> None:
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart", "fflags": "+bitexact"}) as container:
        video = _video_stream(container, fps, scene.size)
        sound = None if audio is None else SoundTrack(av, container, audio[0], audio[1], count / fps)
        with contextlib.closing(in_order(count, scene.planes)) as made:
            for number, planes in enumerate(made):
                frame = av.VideoFrame.from_ndarray(planes, format="yuv420p")
                frame.pts = number
                container.mux(video.encode(frame))
                if sound is not None:
                    sound.write_until((number + 1) / fps)
                if progress is not None:
                    progress((number + 1) / count)
        container.mux(video.encode(None))
        if sound is not None:
            sound.close()


def _video_stream(container: Any, fps: float, size: Size) -> Any:
    rate = Fraction(fps).limit_denominator(1001)
    # One thread, as the coder's bytes depend on how many it has; no macroblock tree and no weighted prediction, as
    # with them the bytes were seen to differ between runs.
    options = {"crf": "19", "preset": "veryfast", "threads": "1", "x264-params": "keyint=60:mbtree=0:weightp=0"}
    stream = container.add_stream("libx264", rate=rate, options=options)
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    # BT.709, limited range: told, or players guess by the picture's size.
    coded = stream.codec_context
    coded.colorspace = coded.color_primaries = coded.color_trc = coded.color_range = 1
    stream.time_base = stream.codec_context.time_base = 1 / rate
    return stream
