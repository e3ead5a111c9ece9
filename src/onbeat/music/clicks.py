"""A song with a click on every beat, to hear whether they are right: downbeats higher and louder."""

from __future__ import annotations

import io
import os

import numpy as np
import soundfile

from onbeat._shapes import Float32
from onbeat.files import write_atomically
from onbeat.music.song import Song

BEAT_TONE, DOWNBEAT_TONE = 1000.0, 1600.0  # [Hz]
LENGTH = 0.04  # [s]
DUCK = 0.6  # of the song's level under the clicks


def click(tone: float, rate: int, level: float = 0.5) -> Float32:
    """One click: a tone that dies away within 40 ms."""
    times = np.arange(round(LENGTH * rate)) / rate
    return (level * np.sin(2.0 * np.pi * tone * times) * np.exp(-times / (LENGTH / 5.0))).astype(np.float32)


def with_clicks(samples: Float32, rate: int, song: Song) -> Float32:
    """Samples (N, channels) with a click mixed in at every beat, never past full scale."""
    mixed = DUCK * samples
    tones = {False: click(BEAT_TONE, rate), True: click(DOWNBEAT_TONE, rate, 0.7)}
    downbeats = set(song.downbeats.tolist())
    for beat in song.beats.tolist():
        begin = round(beat * rate)
        stretch = mixed[begin : begin + round(LENGTH * rate)]
        stretch += tones[beat in downbeats][: len(stretch), None]
    return np.clip(mixed, -1.0, 1.0)


def write_with_clicks(path: str | os.PathLike[str], samples: Float32, rate: int, song: Song) -> None:
    """Write the song with its clicks as a WAV file."""
    buffer = io.BytesIO()
    soundfile.write(buffer, with_clicks(samples, rate, song), rate, format="WAV", subtype="PCM_16")
    write_atomically(path, buffer.getvalue())
