"""The strip below the dancer: the song's waveform, its beats, the dance's stops, and a play head."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.music.song import Song

PAPER, INK, PLAYED, BEAT, DOWNBEAT, STOP, HEAD = (
    np.array(c, np.uint8)
    for c in (
        (250, 250, 249),
        (182, 192, 204),
        (72, 104, 148),
        (206, 212, 219),
        (150, 160, 172),
        (238, 92, 66),
        (40, 46, 56),
    )
)

ROOM = 40
"""Pixels of height from which on there is room for words."""


def loudness(samples: Float32, columns: int, duration: float, rate: float) -> Array:
    """(columns,) 0…1: the root mean square of each column's share of ``duration`` seconds, over the loudest."""
    edges = np.round(np.linspace(0.0, duration, columns + 1) * rate).astype(np.int64)
    level = np.zeros(columns)
    for column in range(columns):
        part = samples[edges[column] : max(edges[column + 1], edges[column] + 1)]
        level[column] = float(np.sqrt(np.mean(np.square(part, dtype=np.float64)))) if len(part) else 0.0
    return level / max(float(level.max()), 1e-9)


@dataclass(frozen=True, eq=False)
class Strip:
    """The strip before (``coming``) and after (``played``) the play head has passed, (H, W, 3) uint8."""

    coming: np.ndarray
    played: np.ndarray
    duration: float

    @classmethod
    def of(
        cls,
        song: Song | None,
        level: Array | None,
        stops: Times,
        duration: float,
        height: int,
        width: int,
        marked: str = "stops",
    ) -> Strip:
        """Draw a strip for ``duration`` seconds; what is not known (song, level) is left out.

        ``marked`` says what the marks at ``stops`` are, where the strip has room for words.
        """
        pictures = [_draw(song, level, stops, duration, height, width, ink) for ink in (INK, PLAYED)]
        if len(stops) and height >= ROOM and width >= 8 * ROOM:
            for picture in pictures:
                _name_marks(picture, marked)
        return cls(pictures[0], pictures[1], duration)

    @property
    def height(self) -> int:
        """Pixels."""
        return self.coming.shape[0]

    def draw(self, picture: np.ndarray, time: float) -> None:
        """Put the strip at the foot of a picture, the play head at ``time`` seconds."""
        height, width = self.coming.shape[:2]
        foot = picture[-height:]
        at = int(np.clip(time / self.duration * width, 0, width - 1))
        foot[:] = self.coming
        foot[:, :at] = self.played[:, :at]
        thick = max(1, height // 30)
        foot[:, max(at - thick // 2, 0) : at + thick - thick // 2] = HEAD


def _draw(
    song: Song | None, level: Array | None, stops: Times, duration: float, height: int, width: int, ink: np.ndarray
) -> np.ndarray:
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = PAPER
    middle, half = 0.5 * (height - 1), 0.36 * height
    if song is not None:
        for times, colour, long in ((song.beats, BEAT, 0.42), (song.downbeats, DOWNBEAT, 0.47)):
            reach = max(int(long * height), 1)
            _ticks(picture, times, duration, int(middle) - reach, int(middle) + reach + 1, colour, 1)
    thin = max(1, height // 40)
    if level is None:
        picture[int(middle) - thin // 2 :][:thin] = ink
    else:
        off = np.abs(np.arange(height) - middle)[:, None]
        cover = np.clip(level * half - off + 0.8, 0.0, 1.0)[..., None]
        picture[:] = np.round(picture * (1 - cover) + ink * cover).astype(np.uint8)
    tall = max(2, height // 7)
    _ticks(picture, stops, duration, height - tall, height, STOP, max(1, height // 24))
    return picture


def _name_marks(picture: np.ndarray, words: str) -> None:
    """In the corner, over the waveform: a mark, and what it means."""
    from onbeat.viewer.render.lettering import write_text

    height = max(picture.shape[0] // 6, 9)
    ground = picture[: round(1.4 * height), : round((1.5 + 0.62 * len(words)) * height)]
    ground[:] = PAPER
    tall = max(2, picture.shape[0] // 7)
    thick = max(2, picture.shape[0] // 24)
    ground[: tall + 2][2:, height // 2 : height // 2 + thick] = STOP
    write_text(ground, words, height, 0, height, (90, 96, 104))


def _ticks(
    picture: np.ndarray, times: Times, duration: float, top: int, bottom: int, colour: np.ndarray, thick: int
) -> None:
    """Upright marks at times."""
    width = picture.shape[1]
    for time in np.asarray(times).tolist():
        if 0 <= time < duration:
            left = int(time / duration * width) - thick // 2
            picture[max(top, 0) : bottom, max(left, 0) : left + thick] = colour
