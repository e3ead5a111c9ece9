"""Compiles what the tests call, ahead of them: what numba makes is kept beside the sources.

Otherwise each worker of pytest, and each program that a test starts, would compile the same while the others wait for
a core. Nothing is checked here: what goes wrong goes wrong in a test, too.
"""

from __future__ import annotations

import os
import tempfile
import threading
from pathlib import Path

import numpy as np

import onbeat

LONGEST = 240.0
"""Seconds after which the tests need not wait any longer."""


def call_all(folder: Path) -> None:
    """A dance of each kind, as short as can be: on one body, in pictures, live, on a robot."""
    song, samples, rate = onbeat.embedded_song(seconds=6)
    onbeat.embedded_library()  # made; the second time it is opened, and arrays of files are compiled for apart
    library = onbeat.embedded_library()
    dance = onbeat.make_dance(song, library, fps=30)
    onbeat.contact_sheet(dance.motion, np.array([1.0]), size=(160, 160))
    onbeat.write_video(folder / "dance.mp4", dance.motion[:3], song, (samples, rate), size=(320, 180))
    onbeat.find_keyposes(dance.motion, song.beats)
    onbeat.dance_live(samples[: 2 * rate], rate, library)
    staged = onbeat.dance_on_robot(dance.motion[:60], "g1", beats=song.beats)
    onbeat.simulate(onbeat.robot_named("g1"), staged.motion[:30])


if __name__ == "__main__":
    end = threading.Timer(LONGEST, os._exit, (1,))
    end.daemon = True
    end.start()
    with tempfile.TemporaryDirectory(prefix="onbeat-ahead-") as made:
        os.environ["ONBEAT_CACHE"] = made
        call_all(Path(made))
