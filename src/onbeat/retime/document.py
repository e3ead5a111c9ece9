"""``retime.json``: what a retiming did, as others read it."""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onbeat.retime.feasible import Missed, missed, speed_that_would_do
from onbeat.retime.retime import Retimed

VERSION = 1
Said = msgspec.Meta


class ViolationsDocument(msgspec.Struct, frozen=True):
    """How many joints are ever past a limit, looked at a thousand times a second."""

    position: Annotated[int, Said(description="joints")]
    velocity: Annotated[int, Said(description="joints")]


class MissedDocument(msgspec.Struct, frozen=True):
    """A keypose that a joint does not get to."""

    joint: Annotated[str, Said(description="its name")]
    time: Annotated[float, Said(description="second of the music")]
    error_deg: Annotated[float, Said(description="degrees from where it was to be")]
    why: Annotated[str, Said(description="`range`: it is out of the joint's range; `speed`: there is no time for it")]


class RetimeDocument(msgspec.Struct, frozen=True):
    """``retime.json``; times in seconds of the music, joints in one order throughout."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    method: Annotated[str, Said(description="`qp`, `layers-qp`, `layers2007`, `pollard2002`, `clamp` or `uniform`")]
    speed: Annotated[float, Said(description="how much faster than the dance itself, on the whole")]
    joints: Annotated[list[str], Said(description="that are inside limits")]
    violations: Annotated[ViolationsDocument, Said(description="how many joints are past a limit")]
    rms_deg: Annotated[float, Said(description="degrees from the dance as it was, over all joints")]
    keypose_error_deg: Annotated[float, Said(description="degrees, the worst at a keypose that could be kept")]
    peak_acceleration: Annotated[float, Said(description="rad/s²")]
    solve_s: Annotated[float, Said(description="CPU seconds; all else is the same for the same input")]
    feasible: Annotated[bool, Said(description="whether all keyposes are kept, to half a degree")] = True
    missed: Annotated[list[MissedDocument], Said(description="keyposes that are not, in order of time")] = []
    speed_that_would_do: Annotated[
        float | None, Said(description="at which none is missed for want of time; none where that is under a fifth")
    ] = None
    start: Annotated[float, Said(description="second of the music at frame 0")] = 0.0
    fps: Annotated[float, Said(description="frames a second")] = 0.0
    beats: Annotated[list[float], Said(description="at which the dance's beats are now")] = []
    keyposes: Annotated[list[float], Said(description="at which its keyposes are now")] = []
    joint_rms_deg: Annotated[list[float], Said(description="degrees, of each joint")] = []
    limits: Annotated[str, Said(description="the body whose limits they are")] = ""
    dance: Annotated[str, Said(description="the dance's name")] = ""

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"


def retime_document(result: Retimed) -> RetimeDocument:
    """The document of a retiming.

    Angles of a joint that turns freely are the lengths of its vectors: over its three channels, squares are added.
    """
    measures, size, names = result.measures, result.source.size, result.source.joints
    squares = np.square(measures.rms).reshape(-1, size).sum(axis=1)
    over = [
        (e > 1e-6).reshape(-1, size).any(axis=1).sum() for e in (measures.position_excess, measures.velocity_excess)
    ]
    found = missed(result.demand, measures)
    share = speed_that_would_do(result.demand, found)
    knots = result.demand.wish.knots
    speed = float(np.diff(result.warp(np.array([knots.start, knots.end])))[0] / (knots.end - knots.start))
    return RetimeDocument(
        version=VERSION,
        method=result.method,
        speed=round(speed, 6),
        joints=list(names),
        violations=ViolationsDocument(int(over[0]), int(over[1])),
        rms_deg=round(float(np.degrees(np.sqrt(squares.mean()))), 4),
        keypose_error_deg=round(float(np.degrees(measures.worst_keypose)), 4),
        peak_acceleration=round(float(measures.peak_acceleration.max()), 3),
        solve_s=round(result.seconds, 3),
        feasible=not found,
        missed=_missed(found, names, size),
        speed_that_would_do=None if share is None else round(speed * share, 3),
        start=round(result.start, 6),
        fps=round(1 / knots.step, 6),
        beats=[round(beat, 6) for beat in result.beats.tolist()],
        keyposes=[round(time, 6) for time in measures.keyposes.tolist()],
        joint_rms_deg=[round(float(rms), 4) for rms in np.degrees(np.sqrt(squares))],
        limits=result.limits.name,
        dance=result.source.name,
    )


def _missed(found: list[Missed], names: tuple[str, ...], size: int) -> list[MissedDocument]:
    """One of each joint and time: the worst of its channels."""
    worst: dict[tuple[float, int], Missed] = {}
    for one in found:
        key = (one.time, one.channel // size)
        if key not in worst or one.error > worst[key].error:
            worst[key] = one
    return [
        MissedDocument(
            names[joint], round(time, 6), round(float(np.degrees(one.error)), 3), "range" if one.range else "speed"
        )
        for (time, joint), one in sorted(worst.items(), key=lambda item: item[0])
    ]
