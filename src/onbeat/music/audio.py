"""Reading sound: any file, any rate, any number of channels, in blocks, so that hours of it fit in memory.

Wave, FLAC, Ogg and MP3 are read by libsndfile; M4A and the sound of videos by PyAV, an extra. Samples are
mixed down to mono and resampled as they stream by.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import soundfile
import soxr

from onbeat._shapes import Float32
from onbeat.errors import AudioError
from onbeat.music.containers import PACKED, ContainerSource
from onbeat.music.mono import Mono
from onbeat.music.promised import promised_share
from onbeat.music.undertone import unheard

RATE = 22050  # [Hz], enough for beats and harmony
BLOCK_SECONDS = 20.0
PART = 8192  # samples decoded at once: what a break in the data costs
NEAR_END = 0.1  # seconds before the end of a file from which on a stretch is meant to reach it
USABLE_SECONDS = 1.0  # of a damaged file, below which nothing is worth using


class AudioWarning(UserWarning):
    """A file that is damaged or odd, of which what is of use is used."""


@dataclass(frozen=True)
class Audio:
    """Mono sound.

    Parameters
    ----------
    samples : (N,) float32, full scale ±1.
    rate : samples per second.
    """

    samples: Float32
    rate: int

    @property
    def duration(self) -> float:
        """Length in seconds."""
        return len(self.samples) / self.rate


class _Stream(soundfile.SoundFile):
    """A file whose MP3s are read forwards: soundfile seeks after each read, at which their decoder stumbles."""

    def seekable(self) -> bool:
        """Whether soundfile may seek by itself."""
        return self.format != "MP3" and super().seekable()


class _FileSource:
    """A file that libsndfile reads: blocks of (N, channels) float32 from a start on."""

    def __init__(self, path: Path) -> None:
        try:
            with unheard():
                self._file = _Stream(_encodable(path))
        except (soundfile.LibsndfileError, RuntimeError, TypeError) as error:
            raise AudioError(
                f"{path}: not a sound file that can be read ({_reason(error)}); expected wav, flac, ogg or mp3"
            ) from None
        self.rate: int = self._file.samplerate
        self.channels: int = self._file.channels
        self.duration = self._file.frames / self.rate
        self.promised = self.duration * promised_share(path)

    def blocks(self, start: float, frames: int) -> Iterator[Float32]:
        """Blocks of about ``frames`` samples from ``start`` seconds on; raises RuntimeError where the data break."""
        held: list[Float32] = []
        try:
            for part in self._parts(start):
                held.append(part)
                if PART * len(held) >= frames:
                    yield np.concatenate(held)
                    held = []
        except soundfile.LibsndfileError:
            if held:
                yield np.concatenate(held)
            raise
        if held:
            yield np.concatenate(held)

    def _parts(self, start: float) -> Iterator[Float32]:
        with self._file as file:
            if start > 0.0:
                with unheard():
                    file.seek(min(round(start * self.rate), file.frames))
            while len(part := self._part()):
                yield part

    def _part(self) -> Float32:
        with unheard():
            return np.asarray(self._file.read(PART, dtype="float32", always_2d=True), dtype=np.float32)


def _reason(error: Exception) -> str:
    """Why libsndfile cannot open a file that is there; where it says that it is not, its content is no sound."""
    reason = str(getattr(error, "error_string", error)).rstrip(".")
    return "there is no sound in it" if reason.startswith("File does not exist") else reason


def _encodable(path: Path) -> Any:
    """A path as libsndfile takes it: as bytes where its name is not text."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return os.fsencode(path)
    return str(path)


def _open(path: str | os.PathLike[str]) -> _FileSource | ContainerSource:
    path = Path(path)
    if not path.exists():
        raise AudioError(f"{path}: no such file; give the path of a song")
    if path.is_dir():
        raise AudioError(f"{path}: is a folder; give one song in it")
    try:
        if path.stat().st_size == 0:
            raise AudioError(f"{path}: the file is empty (0 bytes); expected a song")
        with path.open("rb"):
            pass
    except OSError as error:
        raise AudioError(f"{path}: cannot be read: {error.strerror or error}") from None
    return ContainerSource(path) if path.suffix.lower() in PACKED else _FileSource(path)


def _usable(path: str | os.PathLike[str], read: float, expected: float, reason: object) -> None:
    """Say that a damaged file is used as far as it goes, or refuse it where that is too little."""
    if read < USABLE_SECONDS:
        raise AudioError(f"{path}: damaged after {read:.1f} s ({reason}); use a whole copy of the song")
    warnings.warn(
        f"{path}: damaged or cut off: {read:.1f} s of {expected:.1f} s can be read and are used",
        AudioWarning,
        stacklevel=4,
    )


def native_blocks(
    path: str | os.PathLike[str], start: float = 0.0, seconds: float | None = None
) -> Iterator[tuple[Float32, int]]:
    """Blocks (N, channels) and their rate, as they are in the file; arguments and errors as :func:`read_blocks`."""
    source = _open(path)
    if start < 0.0 or (seconds is not None and seconds <= 0.0):
        stretch = f"start {start:g} s" if seconds is None else f"start {start:g} s, length {seconds:g} s"
        raise AudioError(f"{path}: {stretch}: expected a start of 0 or more and a length above 0")
    if start > 0.0 and start >= source.duration:
        raise AudioError(f"{path}: is {source.duration:.1f} s long; a start of {start:g} s lies behind its end")
    expected = max(source.duration - start, 0.0)
    wanted = round((expected if seconds is None else min(seconds, expected)) * source.rate)
    left = wanted if seconds is not None else np.iinfo(np.int64).max
    to_end = seconds is None or start + seconds > source.duration - NEAR_END
    whole = wanted + (round((source.promised - source.duration) * source.rate) if to_end else 0)
    read = 0
    blocks = source.blocks(start, round(BLOCK_SECONDS * source.rate))
    try:
        for block in blocks:
            block = block[: max(left - read, 0)]
            if not len(block):
                break
            if not np.isfinite(block).all():
                at = start + (read + int(np.argmin(np.isfinite(block).all(axis=1)))) / source.rate
                raise AudioError(f"{path}: holds a sample that is not a number at {at:.2f} s; export the song anew")
            yield block, source.rate
            read += len(block)
    except (RuntimeError, OSError) as error:
        _usable(path, read / source.rate, wanted / source.rate, error)
        return
    if read == 0:
        raise AudioError(f"{path}: holds no sound (0 samples); expected a song")
    if read < 0.98 * whole - source.rate:
        _usable(path, read / source.rate, whole / source.rate, "the data end early")


def read_blocks(
    path: str | os.PathLike[str], start: float = 0.0, seconds: float | None = None, rate: int = RATE
) -> Iterator[Float32]:
    """Mono blocks (N,) float32 at ``rate``, one after the other; only one is in memory at a time.

    They are the mean of the channels; where these cancel each other out, one of them, which is warned of.

    Raises
    ------
    AudioError
        If the file is missing, a folder, empty, not sound, or holds samples that are not numbers.
    """
    stream: soxr.ResampleStream | None = None
    mix = Mono()
    for block, native in native_blocks(path, start, seconds):
        mono = mix(block)
        if native == rate:
            yield mono
            continue
        stream = stream or soxr.ResampleStream(native, rate, 1, dtype="float32")
        if len(resampled := stream.resample_chunk(mono)):
            yield resampled
    if stream is not None and len(rest := stream.resample_chunk(np.zeros(0, np.float32), last=True)):
        yield rest
    if mix.one is not None:
        warnings.warn(
            f"{path}: its channels cancel each other out, as where one is the other upside down: "
            f"channel {mix.one + 1} is heard alone",
            AudioWarning,
            stacklevel=2,
        )


def read_audio(
    path: str | os.PathLike[str], start: float = 0.0, seconds: float | None = None, rate: int = RATE
) -> Audio:
    """Read a stretch of a song as mono at ``rate``.

    Parameters
    ----------
    path : wav, flac, ogg, mp3; with the extra ``video`` also m4a, mp4 and other containers.
    start, seconds : the stretch, in seconds; all of it by default.
    rate : samples per second of what is given back.

    Raises
    ------
    AudioError
        One clear sentence for whatever is wrong with the file.
    MissingExtraError
        If the file needs PyAV and it is not installed.
    """
    return Audio(np.concatenate(list(read_blocks(path, start, seconds, rate))), rate)


def read_stereo(
    path: str | os.PathLike[str], start: float = 0.0, seconds: float | None = None, highest: int | None = None
) -> tuple[Float32, int]:
    """Samples (N, 1 or 2) as they are in the file and their rate; more channels are mixed to mono.

    Rates above ``highest`` are brought down to it as the sound streams by, so that long songs fit in memory.
    """
    parts: list[Float32] = []
    rate, stream = 0, None
    for block, native in native_blocks(path, start, seconds):
        part = block if block.shape[1] <= 2 else block.mean(axis=1, keepdims=True, dtype=np.float32)
        rate = native if highest is None else min(native, highest)
        if rate < native:
            stream = stream or soxr.ResampleStream(native, rate, part.shape[1], dtype="float32")
            part = stream.resample_chunk(np.ascontiguousarray(part))
        parts.append(part)
    if stream is not None:
        parts.append(stream.resample_chunk(np.zeros((0, parts[0].shape[1]), np.float32), last=True))
    return np.concatenate(parts), rate


def audio_duration(path: str | os.PathLike[str]) -> float:
    """Length of a song in seconds, from its header."""
    return _open(path).duration
