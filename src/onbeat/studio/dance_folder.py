"""The folder of a dance: what is shown, and the character's dance at the song's own speed that it was made of.

``dance.npz``, ``dance.json`` and ``song.json`` are as it is shown, times on its own clock; ``scene.json`` is what the
page shows of it; ``root.npz``, ``root.json`` and ``root_song.json`` are the dance it was made of, from which it is
retimed and put on robots.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from onbeat.dance.document import DanceDocument, MoveDocument
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.formats.npz import read_npz, write_npz
from onbeat.keyposes.extract import Keyposes, find_keyposes
from onbeat.motion import Motion
from onbeat.music.song import Section, Song
from onbeat.viewer.contract import GraphData, PageData

SCENE = "scene.json"
SHOWN, ROOT = ("dance.npz", "dance.json", "song.json"), ("root.npz", "root.json", "root_song.json")


@dataclass(frozen=True, eq=False)
class StoredDance:
    """A dance as it is kept: the motion, ``dance.json`` and the song, all on one clock."""

    motion: Motion
    document: DanceDocument
    song: Song

    @classmethod
    def read(cls, folder: Path, names: tuple[str, str, str] = SHOWN) -> StoredDance:
        """What is in a folder; an ``OnbeatError`` says what is damaged."""
        motion, document, song = (folder / name for name in names)
        try:
            told = DanceDocument.from_json(document.read_bytes(), names[1])
            return cls(read_npz(motion), told, Song.from_json(song.read_bytes(), names[2]))
        except OSError as error:
            raise OnbeatError(f"the dance is damaged: {error.strerror or error}; dance it again") from None

    @property
    def keyposes(self) -> Keyposes | None:
        """Its keyposes on the beats it dances to; None where it is too short to have any."""
        try:
            return find_keyposes(self.motion, self.song.beats)
        except OnbeatError:
            return None

    def write(self, folder: Path, names: tuple[str, str, str] = SHOWN) -> None:
        """Write it into a folder."""
        write_npz(self.motion, folder / names[0])
        write_atomically(folder / names[1], self.document.to_json())
        write_atomically(folder / names[2], self.song.to_json())


def write_scene(folder: Path, page: PageData) -> None:
    """Write what the page shows."""
    write_atomically(folder / SCENE, msgspec.json.encode(page))


class _Drawn(msgspec.Struct, frozen=True):
    """Of a scene the motion graph."""

    graph: GraphData | None = None


def graph_of(folder: Path) -> GraphData | None:
    """The motion graph that the dance in a folder goes through; None where it was drawn without."""
    try:
        return msgspec.json.decode((folder / SCENE).read_bytes(), type=_Drawn).graph
    except (OSError, msgspec.DecodeError):
        return None


def faster_song(song: Song, speed: float) -> Song:
    """A song played so many times as fast.

    Examples
    --------
    >>> song = Song(4.0, 60.0, 4, [1.0, 2.0, 3.0], [1.0], [0, 0, 0], [0, 4], [0.2, 0.8])
    >>> faster_song(song, 2.0).beats.tolist(), faster_song(song, 2.0).tempo
    ([0.5, 1.0, 1.5], 120.0)
    """
    return replace(
        song,
        duration=song.duration / speed,
        tempo=song.tempo * speed,
        beats=song.beats / speed,
        downbeats=song.downbeats / speed,
        intensity_times=song.intensity_times / speed,
        sections=[Section(part.start / speed, part.end / speed, part.kind, part.novelty) for part in song.sections],
    )


def faster_document(document: DanceDocument, speed: float, duration: float, stops: list[float]) -> DanceDocument:
    """``dance.json`` of a dance played so many times as fast; what was measured is to be measured anew."""
    moves = [MoveDocument(m.clip, m.from_s, m.to_s, round(m.at_s / speed, 4)) for m in document.moves]
    return msgspec.structs.replace(
        document,
        duration=round(duration, 4),
        beats=[round(beat / speed, 4) for beat in document.beats],
        stops=stops,
        moves=[move for move in moves if move.at_s < duration],
        joins=[
            msgspec.structs.replace(join, from_s=round(join.from_s / speed, 4), to_s=round(join.to_s / speed, 4))
            for join in document.joins
        ],
        metrics={},
    )
