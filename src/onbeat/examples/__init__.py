"""The embedded default: a procedural dance troupe and a procedural song, with ground truth."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onbeat._shapes import Float32
from onbeat.music.song import Song

if TYPE_CHECKING:
    from onbeat.motion.motion import Motion


def embedded_motions(seed: int = 0) -> list[Motion]:
    """The clips of the embedded troupe that a dance is made of, named by dancer and figures."""
    from onbeat.examples.troupe import dance_library

    return [performance.motion for performance in dance_library(seed=seed)]


def embedded_song(seconds: float = 60.0, seed: int = 0) -> tuple[Song, Float32, int]:
    """The embedded song: what is true of it, its samples (N, 2) and their rate in Hz."""
    from onbeat.examples.song import demo_song, true_song

    song = demo_song(seconds=seconds, seed=seed)
    return true_song(song), song.samples, song.rate
