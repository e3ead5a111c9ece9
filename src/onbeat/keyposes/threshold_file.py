"""``thresholds.json``: what was learned from marked dances, and with which energy."""

from __future__ import annotations

from typing import Annotated

import msgspec

from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.decoding import decoded
from onbeat.keyposes.extract import DEFAULT, Options

VERSION = 1

Said = msgspec.Meta


class LearnedDocument(msgspec.Struct, frozen=True):
    """Thresholds, and how keyposes were looked for when they were learned."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    t1: Annotated[float, Said(description="a rest with less energy is a keypose; in units of the mean energy")]
    t2: Annotated[float, Said(description="a rest beside which the energy is higher by more is a keypose")]
    energy: Annotated[str, Said(description="`rms`, `sum` or `paper`")] = "rms"
    order: Annotated[str, Said(description="whose rest counts first")] = "global-local"
    weights: Annotated[str, Said(description="`uniform` or `mass`")] = "uniform"
    window: Annotated[float, Said(description="share of a beat within which a rest belongs to it")] = 0.5
    held_out_f: Annotated[float, Said(description="F on dances not learned from; 0 where not known")] = 0.0
    plateau_t1: Annotated[list[float], Said(description="from where to where T1 may go")] = []
    plateau_t2: Annotated[list[float], Said(description="from where to where T2 may go")] = []
    examples: Annotated[int, Said(description="dances that were learned from")] = 0

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    def options(self) -> Options:
        """As the methods take them."""
        return Options(self.energy, self.order, self.weights, Thresholds(self.t1, self.t2), self.window)


def read_thresholds(data: bytes, source: str = "thresholds.json") -> LearnedDocument:
    """Read the document; a ``MetricError`` says what is wrong with it.

    Examples
    --------
    >>> read_thresholds(b'{"version": 9}')
    Traceback (most recent call last):
    onbeat.errors.MetricError: thresholds.json: version 9; this onbeat reads version 1
    """
    return decoded(data, LearnedDocument, VERSION, source, "what `onbeat keyposes learn -o` writes")


DEFAULTS = LearnedDocument(VERSION, *DEFAULT)
"""What holds where nothing was learned."""
