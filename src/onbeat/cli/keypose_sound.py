"""The song of `onbeat keyposes --music` on the motion's clock, so that one hears whether a keypose is on its beat."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32
from onbeat.cli.keypose_input import BeatFlags
from onbeat.music.audio import audio_duration, read_stereo

RATE = 48000
"""Samples a second of the sound at most."""


def sound_of(flags: BeatFlags, duration: float) -> tuple[Float32, int] | None:
    """Samples (N, channels) from second 0 of a motion of ``duration`` seconds on, and their rate; None without a song.

    Before the song begins (``flags.song_at``) there is silence; what of it is before the motion is not heard.
    """
    if flags.music is None:
        return None
    early, late = max(-flags.song_at, 0.0), max(flags.song_at, 0.0)
    if late >= duration or early >= audio_duration(flags.music):
        return None
    samples, rate = read_stereo(flags.music, early, duration - late, RATE)
    silence = np.zeros((round(late * rate), samples.shape[1]), np.float32)
    return np.concatenate((silence, samples)), rate


def titled(name: str, flags: BeatFlags) -> str:
    """The name of a motion, with the song's where there is one.

    Examples
    --------
    >>> titled("folk", BeatFlags())
    'folk'
    """
    return name if flags.music is None else f"{name} · {flags.music.stem}"
