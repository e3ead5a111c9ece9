"""The sound of M4A files and videos, by PyAV (the extra ``video``)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Float32
from onbeat.errors import AudioError, MissingExtraError

PACKED = frozenset({".m4a", ".aac", ".mp4", ".m4v", ".mov", ".mkv", ".webm", ".wma", ".avi", ".3gp"})


def _import_av(path: Path) -> Any:
    try:
        import av
    except ImportError:
        raise MissingExtraError(
            f"{path}: {path.suffix} needs PyAV: pip install 'onbeat[video]', or convert it to wav, flac, ogg or mp3"
        ) from None
    return av


class ContainerSource:
    """A container that PyAV reads: blocks of (N, channels) float32 from a start on."""

    def __init__(self, path: Path) -> None:
        self._av = _import_av(path)
        try:
            self._container: Any = self._av.open(str(path))
        except (self._av.FFmpegError, OSError) as error:
            reason = error.strerror or error
            raise AudioError(f"{path}: not a sound file that can be read ({reason})") from None
        if not self._container.streams.audio:
            raise AudioError(f"{path}: holds no sound track; expected a song")
        self._stream: Any = self._container.streams.audio[0]
        self.rate = int(self._stream.codec_context.sample_rate)
        self.channels = int(self._stream.codec_context.channels)
        length = self._stream.duration
        self.duration = (
            float(length * self._stream.time_base) if length else (self._container.duration or 0) / self._av.time_base
        )
        self.promised = self.duration

    def _decoded(self) -> Iterator[Float32]:
        """Decoded frames (N, channels) from the beginning; what is broken ends the iteration as RuntimeError."""
        resampler = self._av.AudioResampler(format="fltp", layout=self._stream.codec_context.layout, rate=self.rate)
        try:
            for frame in self._container.decode(self._stream):
                for part in resampler.resample(frame):
                    yield np.ascontiguousarray(part.to_ndarray().T, dtype=np.float32)
        except self._av.FFmpegError as error:
            raise RuntimeError(str(error)) from None
        finally:
            self._container.close()

    def blocks(self, start: float, frames: int) -> Iterator[Float32]:
        """Blocks of about ``frames`` samples from ``start`` seconds on."""
        skip = round(start * self.rate)
        held: list[Float32] = []
        count = 0
        for part in self._decoded():
            kept = part[skip:]
            skip -= len(part) - len(kept)
            if len(kept):
                held.append(kept)
                count += len(kept)
            if count >= frames:
                yield np.concatenate(held)
                held, count = [], 0
        if held:
            yield np.concatenate(held)
