"""A song with a click on every beat, to hear whether they are right: downbeats higher and louder."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import soundfile

from onbeat._shapes import Float32
from onbeat.errors import OnbeatError
from onbeat.music.song import Song

BEAT_TONE, DOWNBEAT_TONE = 1000.0, 1600.0  # [Hz]
BEAT_LEVEL, DOWNBEAT_LEVEL = 0.28, 0.44  # of full scale
SONG_LEVEL = 0.55  # peak of the song under the clicks: with the loudest of them it stays below full scale
MOST_GAIN = 10.0  # by which a quiet song is made louder
LENGTH = 0.04  # [s]

Blocks = Iterable[tuple[Float32, int]]
"""Blocks of sound (N, channels), each with its rate."""


def click(tone: float, rate: int, level: float = 0.5) -> Float32:
    """One click: a tone that dies away within 40 ms; lower where the rate holds no such tone."""
    times = np.arange(round(LENGTH * rate)) / rate
    wave = np.sin(2.0 * np.pi * min(tone, 0.4 * rate) * times) * np.exp(-times / (LENGTH / 5.0))
    return (level * wave).astype(np.float32)


def song_gain(peak: float) -> float:
    """Factor that brings a song to its level under the clicks; silence stays as it is.

    >>> song_gain(1.1)
    0.5
    """
    return min(SONG_LEVEL / peak, MOST_GAIN) if peak > 0.0 else 1.0


def add_clicks(samples: Float32, rate: int, begin: int, song: Song, gain: float = 1.0) -> Float32:
    """A block (N, channels) times ``gain``, with the clicks that sound in it; its first sample is number ``begin``."""
    mixed = np.float32(gain) * samples
    tones = {
        False: click(BEAT_TONE, rate, BEAT_LEVEL),
        True: click(DOWNBEAT_TONE, rate, DOWNBEAT_LEVEL),
    }
    starts = np.round(song.beats * rate).astype(np.int64) - begin
    strong = np.isin(song.beats, song.downbeats)
    length = round(LENGTH * rate)
    for index in np.flatnonzero((starts > -length) & (starts < len(mixed))).tolist():
        start, tone = int(starts[index]), tones[bool(strong[index])]
        stretch = mixed[max(start, 0) : start + length]
        stretch += tone[max(-start, 0) :][: len(stretch), None]
    return np.clip(mixed, -1.0, 1.0)


def with_clicks(samples: Float32, rate: int, song: Song) -> Float32:
    """Samples (N, channels) with a click mixed in at every beat, never past full scale."""
    return add_clicks(samples, rate, 0, song, song_gain(float(np.abs(samples).max(initial=0.0))))


def write_with_clicks(path: str | os.PathLike[str], samples: Float32, rate: int, song: Song) -> None:
    """Write samples (N, channels) with their clicks; as :func:`stream_with_clicks`."""
    stream_with_clicks(path, lambda: [(samples, rate)], song)


def stream_with_clicks(path: str | os.PathLike[str], sound: Callable[[], Blocks], song: Song) -> None:
    """Write the song with its clicks as WAV, FLAC or Ogg, block by block, so that hours of it need no memory.

    Parameters
    ----------
    path : where to write; nobody ever sees half a file.
    sound : gives the blocks of the song; called twice, first to find its peak. More than two channels become one.
    song : its beats.

    Raises
    ------
    OnbeatError
        If the file cannot be written.
    """
    path = Path(path)
    gain = song_gain(max((float(np.abs(block).max(initial=0.0)) for block, _ in sound()), default=0.0))
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        os.close(handle)
        try:
            _write_blocks(temporary, path.suffix.lower(), sound(), song, gain)
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        finally:
            Path(temporary).unlink(missing_ok=True)
    except (OSError, soundfile.LibsndfileError) as error:
        reason = getattr(error, "strerror", None) or error
        raise OnbeatError(f"cannot write {path}: {reason}; choose another folder or another ending") from None


def _write_blocks(path: str, ending: str, blocks: Blocks, song: Song, gain: float) -> None:
    file: soundfile.SoundFile | None = None
    written = 0
    try:
        for block, rate in blocks:
            part = block if block.shape[1] <= 2 else block.mean(axis=1, keepdims=True, dtype=np.float32)
            if file is None:
                kind, subtype = {".flac": ("FLAC", "PCM_16"), ".ogg": ("OGG", "VORBIS")}.get(ending, ("WAV", "PCM_16"))
                file = soundfile.SoundFile(path, "w", rate, part.shape[1], subtype, format=kind)
            file.write(add_clicks(part, rate, written, song, gain))
            written += len(part)
    finally:
        if file is not None:
            file.close()
