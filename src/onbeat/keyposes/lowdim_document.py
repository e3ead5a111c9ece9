"""``lowdim.json``: what two spaces make of some people's dances."""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onbeat._shapes import Array
from onbeat.keyposes.decoding import decoded
from onbeat.keyposes.held_out import MEASURES, HeldOut
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.keyposes.space import KeyposeSpace

VERSION = 1

Said = msgspec.Meta


class PersonDocument(msgspec.Struct, frozen=True):
    """One person's motion and what of it taught."""

    name: Annotated[str, Said(description="of the motion's file")]
    body_size_m: Annotated[float, Said(description="an arm, a leg and the trunk, metres")]
    from_s: Annotated[float, Said(description="second at which the cycle that taught begins")]
    to_s: Annotated[float, Said(description="second at which it ends")]
    keyposes: Annotated[list[float], Said(description="seconds of its keyposes")]


class SpaceDocument(msgspec.Struct, frozen=True):
    """A space, and the points rebuilt in it, which no skeleton holds; motions that are written keep their bones."""

    space: Annotated[str, Said(description="`keyposes` or `uniform`")]
    cumulative: Annotated[list[float], Said(description="share of the variance in 1, 2, … dimensions (Eq. 9)")]
    through: Annotated[float, Said(description="as points: share of frames with a bone through another")]
    beyond: Annotated[float, Said(description="as points: share of frames with a joint beyond its range")]
    stretched: Annotated[float, Said(description="as points: share of frames with a bone's length off by a tenth")]
    length_change: Annotated[float, Said(description="as points: mean change of the bones' lengths, of them")]


class ErrorDocument(msgspec.Struct, frozen=True):
    """Errors on unseen poses, metres, in 1, 2, … dimensions."""

    unseen: Annotated[
        str,
        Said(
            description="`frames` of the same people, `between` the poses that taught where a dance is a single cycle, "
            "or `people` who did not teach"
        ),
    ]
    of: Annotated[str, Said(description="`all` frames, those at `rest`, or the `keyposes`")]
    keyposes: Annotated[list[float], Said(description="of the keypose space")]
    uniform: Annotated[list[float], Said(description="of uniform sampling, the mean over its phases")]
    uniform_least: Annotated[list[float], Said(description="at the phase at which it is least")]


class LowdimDocument(msgspec.Struct, frozen=True):
    """``lowdim.json``: motions in few dimensions, by keyposes and by uniform sampling."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    dims: Annotated[int, Said(description="dimensions of the motions that were written")]
    poses: Annotated[int, Said(description="how many poses made each space")]
    points: Annotated[list[str], Said(description="what a pose vector holds the places of")]
    people: Annotated[list[PersonDocument], Said(description="one for each motion")]
    spaces: Annotated[list[SpaceDocument], Said(description="`keyposes` and `uniform`")]
    errors: Annotated[list[ErrorDocument], Said(description="on unseen frames and unseen people")]

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "lowdim.json") -> LowdimDocument:
        """Read a document; a ``MetricError`` says what is wrong with it.

        Examples
        --------
        >>> LowdimDocument.from_json(b'{"version": 9}')
        Traceback (most recent call last):
        onbeat.errors.MetricError: lowdim.json: version 9; this onbeat reads version 1
        """
        return decoded(data, cls, VERSION, source, "what `onbeat lowdim` writes")


def document(found: LowDimensional) -> LowdimDocument:
    """What was found, as a document; metres to a micrometre."""
    people = [
        PersonDocument(
            one.person, round(one.vectors.size, 6), round(one.start, 6), round(one.end, 6), _listed(one.keyposes)
        )
        for one in found.taught
    ]
    errors = [
        *_errors("between" if found.between else "frames", found.frames),
        *([] if found.people is None else _errors("people", found.people)),
    ]
    spaces = [_space(found, name, found.spaces[name]) for name in SPACES]
    poses = sum(len(one.keyposes) for one in found.taught)
    return LowdimDocument(VERSION, found.dims, poses, list(found.vectors[0].points), people, spaces, errors)


def _space(found: LowDimensional, name: str, space: KeyposeSpace) -> SpaceDocument:
    shares = [found.unnatural(which, name).shares() for which in range(len(found.motions))]
    kinds = ("through", "beyond", "stretched", "length_change")
    mean = {kind: round(float(np.mean([one[kind] for one in shares])), 6) for kind in kinds}
    return SpaceDocument(name, _listed(space.cumulative), **mean)


def _errors(unseen: str, measured: HeldOut) -> list[ErrorDocument]:
    least = measured.uniform.min(axis=0)
    rows = zip(MEASURES, measured.keypose, measured.uniform_mean, least, strict=True)
    return [
        ErrorDocument(unseen, of, _listed(ours), _listed(mean), _listed(best))
        for of, ours, mean, best in rows
        if np.isfinite(ours).all()
    ]


def _listed(values: Array) -> list[float]:
    return [round(value, 6) for value in values.tolist()]
