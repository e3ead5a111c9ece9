"""``dance.json``: how a dance was put together and how good it is."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from msgspec import UNSET, UnsetType

from onbeat.errors import PlanError
from onbeat.keyposes.decoding import decoded

VERSION = 1

Said = msgspec.Meta


class MoveDocument(msgspec.Struct, frozen=True):
    """One stretch of one clip; a join lies at the beginning of every move but the first."""

    clip: Annotated[str, Said(description="name of the clip in the library")]
    from_s: Annotated[float, Said(description="second of the clip at which it is entered")]
    to_s: Annotated[float, Said(description="second of the clip at which it is left")]
    at_s: Annotated[float, Said(description="second of the dance at which the move begins")]


class JoinDocument(msgspec.Struct, frozen=True):
    """The blend from one move to the next."""

    from_s: Annotated[float, Said(description="second of the dance at which it begins")]
    to_s: Annotated[float, Said(description="second of the dance at which it ends")]
    link_error_deg: Annotated[float, Said(description="mean angle between the links of the two poses joined, degrees")]


class DanceDocument(msgspec.Struct, frozen=True):
    """``dance.json``: times in seconds on the clock of the dance, which begins with the song."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    fps: Annotated[float, Said(description="frames a second of dance.bvh and dance.glb")]
    duration: Annotated[float, Said(description="seconds, those of the song")]
    seed: Annotated[int, Said(description="that of `--seed`")]
    method: Annotated[str, Said(description="the method of the search")]
    beats: Annotated[list[float], Said(description="seconds of the beats danced to")]
    stops: Annotated[list[float], Said(description="seconds at which a hand comes to rest")]
    moves: Annotated[list[MoveDocument], Said(description="in order, without gaps")]
    metrics: Annotated[dict[str, Any], Said(description="names and values as `onbeat evaluate --json` gives them")]
    title: Annotated[str, Said(description="the song's name")] = ""
    joins: Annotated[list[JoinDocument], Said(description="one for each move but the first")] = []
    heard_bpm: Annotated[
        float | UnsetType,
        Said(description="tempo that is heard, beats a minute; told where half or double of it is danced to"),
    ] = UNSET
    warp: Annotated[
        list[float] | UnsetType,
        Said(description="seconds of the plan at even steps of the dance; told where stretches were kept"),
    ] = UNSET

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "dance.json") -> DanceDocument:
        """Read a document; a ``PlanError`` says what is wrong with it.

        Examples
        --------
        >>> DanceDocument.from_json(b'{"version": 9}')
        Traceback (most recent call last):
        onbeat.errors.PlanError: dance.json: version 9; this onbeat reads version 1
        """
        return decoded(data, cls, VERSION, source, "a dance document, as `onbeat dance` writes it", PlanError)
