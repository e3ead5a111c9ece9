"""What Python tells the page: one document, held inside the page as JSON.

The page's own view of it (``viewer-js/src/contract.ts``) is written from these classes by
:mod:`onbeat.viewer.typescript`; a test keeps the two equal. Metres, seconds, radians, right-handed, Z up. Arrays
travel as base64 of little-endian numbers, frames first.
"""

from __future__ import annotations

import base64

import msgspec
import numpy as np

from onbeat._shapes import Array, Positions

VERSION = 5
STEPS = 65535
"""Largest quantised coordinate."""


class CapsuleData(msgspec.Struct, frozen=True):
    """A tapering capsule between two joints of the page; see :mod:`onbeat.viewer.shape`."""

    a: int
    b: int
    radius_a: float
    radius_b: float
    group: str
    colour: str
    start: float
    end: float


class PathData(msgspec.Struct, frozen=True):
    """Joint positions: uint16 ``q`` (frames, joints, 3) in base64, ``metres = origin + step q``."""

    base64: str
    origin: list[float]
    step: float


class CurveData(msgspec.Struct, frozen=True):
    """Values 0…1 at a steady rate: uint8 ``q`` in base64, ``value = q / 255`` at time ``index / rate``."""

    base64: str
    rate: float


class AudioData(msgspec.Struct, frozen=True):
    """The song's sound: a data URI, its MIME type inside, and the seconds and Hz of what was encoded."""

    uri: str
    seconds: float
    rate: int


class MoveData(msgspec.Struct, frozen=True):
    """One stretch of one clip: shown from ``at_s`` on, seconds ``from_s`` to ``to_s`` of the clip."""

    clip: str
    from_s: float
    to_s: float
    at_s: float


class KeyposeData(msgspec.Struct, frozen=True):
    """A keypose at ``time``: its number and beat, both from 1, what rests there, and the yaw that the body faces."""

    time: float
    number: int
    beat: int
    source: str
    facing: float


class EnergyData(msgspec.Struct, frozen=True):
    """Global and local energy over time, 1 being the highest of both, and when candidates for keyposes lie on them."""

    world: CurveData
    local: CurveData
    world_candidates: list[float]
    local_candidates: list[float]


class MetricData(msgspec.Struct, frozen=True):
    """A figure of the dance, in words for people."""

    name: str
    value: str


class BodyData(msgspec.Struct, frozen=True):
    """A second body on the stage, as many frames as the first: its joints, its shape and its path."""

    joints: list[str]
    capsules: list[CapsuleData]
    path: PathData
    spine: list[int]


class HeatData(msgspec.Struct, frozen=True):
    """How far each joint is off: uint8 ``q`` (frames, joints) in base64, ``most q / 254`` cm; 255 where unknown.

    ``scale`` are the colours from 0 cm to ``most`` in even steps, ``unknown`` that of what is compared with nothing.
    """

    base64: str
    most: float
    scale: list[str]
    unknown: str


class ComparedData(msgspec.Struct, frozen=True):
    """The dancer held against another: how far off its joints are, and the other one's body in the same place.

    ``heat`` is none of bodies that have other joints. ``who`` is what the other is called on buttons; ``captions``
    stand under both, none for an empty list. Beside each other they begin ``apart`` metres, by the dancer's height
    where it is 0.
    """

    name: str
    heat: HeatData | None
    body: BodyData
    who: str = "master"
    captions: list[str] = []
    apart: float = 0.0


class StepData(msgspec.Struct, frozen=True):
    """A foot, ``left`` or ``right``, that stands: when, where its middle is, the yaw it points to, and how long it is.

    A foot that stands on its toe or heel alone is as long as what stands of it.
    """

    foot: str
    from_s: float
    to_s: float
    x: float
    y: float
    yaw: float
    length: float


class ClipData(msgspec.Struct, frozen=True):
    """A clip of the library: its name and its seconds."""

    name: str
    seconds: float


class JoinData(msgspec.Struct, frozen=True):
    """A join of the motion graph: out of one of its clips, by number, at a second of it, into another."""

    clip: int
    from_s: float
    next_clip: int
    to_s: float


class GraphData(msgspec.Struct, frozen=True):
    """The motion graph: clips danced and a sample of others, joins between them, and how many of both there are."""

    clips: list[ClipData]
    joins: list[JoinData]
    clip_count: int
    join_count: int


class WarpData(msgspec.Struct, frozen=True):
    """The time warp: at ``times`` of the dance is shown what was at ``before`` without it; linear between them."""

    times: list[float]
    before: list[float]


class PageData(msgspec.Struct, frozen=True):
    """Everything the page shows.

    ``spine`` are the joints from the waist up to the neck, or the root alone where the body has no roles; the camera
    follows the first. ``steps`` are where feet stand, in the order in which they begin to.
    """

    version: int
    title: str
    method: str
    duration: float
    tempo: float
    fps: float
    frames: int
    joints: list[str]
    capsules: list[CapsuleData]
    path: PathData
    spine: list[int]
    facing: float
    floor: float
    audio: AudioData | None
    waveform: CurveData
    beats: list[float]
    downbeats: list[float]
    stops: list[float]
    moves: list[MoveData]
    joins: list[float]
    keyposes: list[KeyposeData]
    energy: EnergyData | None
    music_intensity: CurveData
    motion_intensity: CurveData
    metrics: list[MetricData]
    compared: ComparedData | None = None
    steps: list[StepData] = []
    graph: GraphData | None = None
    warp: WarpData | None = None


STRUCTS = (
    CapsuleData, PathData, CurveData, AudioData, MoveData, KeyposeData, EnergyData, MetricData, BodyData, HeatData,
    ComparedData, StepData, ClipData, JoinData, GraphData, WarpData, PageData,
)  # fmt: skip
"""All classes of the contract, parts before the whole."""


def pack_path(positions: Positions) -> PathData:
    """Quantise positions (frames, joints, 3) in metres to 16 bits over their largest extent.

    The error is at most half a step: 0.05 mm on a stage of 6 m.

    Examples
    --------
    >>> path = pack_path(np.array([[[0.0, 0.0, 0.0]], [[1.0, 2.0, 0.5]]]))
    >>> np.allclose(unpack_path(path, 1), [[[0, 0, 0]], [[1, 2, 0.5]]], atol=path.step)
    True
    """
    origin = positions.min(axis=(0, 1))
    step = max(float((positions.max(axis=(0, 1)) - origin).max()), 1e-6) / STEPS
    quantised = np.rint((positions - origin) / step).clip(0, STEPS).astype("<u2")
    return PathData(_base64(quantised.tobytes()), [float(value) for value in origin], step)


def unpack_path(path: PathData, joints: int) -> Positions:
    """The positions (frames, joints, 3) in metres that the page will see."""
    quantised = np.frombuffer(base64.b64decode(path.base64), "<u2").reshape(-1, joints, 3)
    return np.array(path.origin) + path.step * quantised


def pack_heat(centimetres: Array, most: float, scale: list[str], unknown: str) -> HeatData:
    """Distances (frames, joints) in cm as 8 bits each, the step ``most / 254``; NaN is unknown."""
    levels = np.rint(np.nan_to_num(np.clip(centimetres / most, 0, 1)) * 254)
    quantised = np.where(np.isnan(centimetres), 255, levels).astype(np.uint8)
    return HeatData(_base64(quantised.tobytes()), most, scale, unknown)


def pack_curve(values: Array, rate: float) -> CurveData:
    """Values (N,), clipped to 0…1, as 8 bits each."""
    return CurveData(_base64(np.rint(np.clip(values, 0, 1) * 255).astype(np.uint8).tobytes()), float(rate))


def unpack_curve(curve: CurveData) -> Array:
    """The values (N,) that the page will see."""
    return np.frombuffer(base64.b64decode(curve.base64), np.uint8) / 255.0


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
