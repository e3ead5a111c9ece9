"""``keyposes.json``: the keyposes of a motion as others read them."""

from __future__ import annotations

from typing import Annotated

import msgspec

from onbeat.errors import PlanError
from onbeat.keyposes.decoding import decoded
from onbeat.keyposes.extract import Keyposes, Options

VERSION = 1

Said = msgspec.Meta


class ThresholdsDocument(msgspec.Struct, frozen=True):
    """The thresholds that were used, in units of the mean energy."""

    t1: Annotated[float, Said(description="a minimum under it is a candidate")]
    t2: Annotated[float, Said(description="a minimum beside which the energy rises by more is a candidate")]


class KeyposeDocument(msgspec.Struct, frozen=True):
    """One keypose."""

    time: Annotated[float, Said(description="second of the motion, finer than its frames")]
    frame: Annotated[int, Said(description="the nearest frame, from 0")]
    beat: Annotated[int, Said(description="index of its beat in `beats`, from 0")]
    source: Annotated[
        str, Said(description="`global` or `local`: the energy that rests there; `hands` by other methods")
    ]


class KeyposesDocument(msgspec.Struct, frozen=True):
    """``keyposes.json``: times in seconds on the clock of the motion."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    fps: Annotated[float, Said(description="frames a second of the motion")]
    thresholds: Annotated[ThresholdsDocument, Said(description="that were used")]
    keyposes: Annotated[list[KeyposeDocument], Said(description="in order")]
    beats: Annotated[list[float], Said(description="the beats that fall into the motion")] = []
    method: Annotated[str, Said(description="that found them")] = "energy"
    motion: Annotated[str, Said(description="the motion's name")] = ""
    energy: Annotated[str, Said(description="`rms`, `sum` or `paper`; empty where the method has none")] = ""
    order: Annotated[str, Said(description="whose rest counts first, likewise")] = ""
    weights: Annotated[str, Said(description="`uniform` or `mass`, likewise")] = ""

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "keyposes.json") -> KeyposesDocument:
        """Read a document; a ``PlanError`` says what is wrong with it.

        Examples
        --------
        >>> KeyposesDocument.from_json(b'{"version": 9}')
        Traceback (most recent call last):
        onbeat.errors.PlanError: keyposes.json: version 9; this onbeat reads version 1
        """
        return decoded(data, cls, VERSION, source, "a document of keyposes", PlanError)


def keyposes_document(keyposes: Keyposes, motion: str = "", options: Options | None = None) -> KeyposesDocument:
    """The document of some keyposes, times rounded to microseconds; ``options`` as they were found with."""
    looked = () if options is None else (options.kind, options.order, options.weights)
    rows = zip(
        keyposes.times.tolist(), keyposes.frames.tolist(), keyposes.beats.tolist(), keyposes.sources, strict=True
    )
    return KeyposesDocument(
        version=VERSION,
        fps=keyposes.fps,
        thresholds=ThresholdsDocument(*(float(value) for value in keyposes.thresholds)),
        keyposes=[KeyposeDocument(round(time, 6), frame, beat, source) for time, frame, beat, source in rows],
        beats=[round(beat, 6) for beat in keyposes.song_beats.tolist()],
        method=keyposes.method,
        motion=motion,
        **dict(zip(("energy", "order", "weights"), looked, strict=False)),
    )
