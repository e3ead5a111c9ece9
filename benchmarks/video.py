"""How long a video takes: seconds for one of a minute at 30 pictures a second and 1280 x 720, and of what.

    python benchmarks/video.py [--seconds 60] [--size 1280x720] [--fps 30] [--motion dance.bvh] [--flash]

One of the troupe stands in for the dance where no motion is given: what is filmed makes little difference. CPU seconds
are told beside the seconds that pass, as others may be at work on the same machine; on two idle cores it takes about
half of their sum, as long as the coder's part is less than that.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from onbeat.examples import embedded_motions, embedded_song
from onbeat.formats.read import read_motion
from onbeat.motion import Motion
from onbeat.viewer import video
from onbeat.viewer.film.flashes import Flashes
from onbeat.viewer.film.in_order import usable_cores
from onbeat.viewer.film.scene import Scene
from onbeat.viewer.film.sound import SoundTrack

SPENT: dict[str, float] = defaultdict(float)


def watched(name: str, inner: Callable[..., Any]) -> Callable[..., Any]:
    """The same function, whose thread's CPU seconds are added up under a name."""

    def outer(*words: Any, **named: Any) -> Any:
        before = time.thread_time()
        try:
            return inner(*words, **named)
        finally:
            SPENT[name] += time.thread_time() - before

    return outer


def for_seconds(motion: Motion, seconds: float) -> Motion:
    """A motion danced again and again until it has lasted for so long."""
    return motion.at(np.arange(round(seconds * motion.fps)) % len(motion) / motion.fps)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--fps", type=float, default=30.0)
    parser.add_argument("--motion", type=Path)
    parser.add_argument("--flash", action="store_true")
    flags = parser.parse_args()
    across, down = map(int, flags.size.split("x"))
    motion = for_seconds(embedded_motions()[0] if flags.motion is None else read_motion(flags.motion), flags.seconds)
    song, samples, rate = embedded_song(flags.seconds)
    flashes = Flashes.on(song.beats, song.downbeats) if flags.flash else None
    Scene.of = watched("pose and camera", Scene.of)  # type: ignore[method-assign]
    Scene.planes = watched("raster", Scene.planes)  # type: ignore[method-assign]
    SoundTrack.write_until = watched("sound", SoundTrack.write_until)  # type: ignore[method-assign]
    with tempfile.TemporaryDirectory() as folder:
        for part in (for_seconds(motion, 0.2), motion):  # the first time it may have to be compiled
            SPENT.clear()
            passed, used, own = time.perf_counter(), time.process_time(), time.thread_time()
            video.write_video(
                Path(folder) / "dance.mp4", part, song, (samples, rate), fps=flags.fps, size=(across, down),
                flashes=flashes,
            )  # fmt: skip
            passed, used, own = time.perf_counter() - passed, time.process_time() - used, time.thread_time() - own
        size = (Path(folder) / "dance.mp4").stat().st_size
    SPENT["coding and muxing"] = own - SPENT["pose and camera"] - SPENT["sound"]
    pictures = round(motion.duration * flags.fps)
    for name, seconds in SPENT.items():
        print(f"{name:18} {seconds:7.2f} s of CPU, {1000 * seconds / pictures:5.1f} ms a picture")
    print(
        f"{'all':18} {used:7.2f} s of CPU, {passed:.1f} s passed, {usable_cores()} cores; {used / 2:.0f} s on two idle"
    )
    print(f"{pictures} pictures of {across} x {down}, {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
