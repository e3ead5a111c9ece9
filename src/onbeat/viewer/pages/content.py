"""What a page shows of a dance: motion, song, ``dance.json`` and sound as the page's document."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.errors import BodyError, OnbeatError
from onbeat.keyposes.extract import Keyposes
from onbeat.motion import Body, Motion
from onbeat.motion.body import body_frames, facing
from onbeat.motion.features import hand_features, intensity_component
from onbeat.music.song import Song
from onbeat.viewer.contract import (
    VERSION,
    AudioData,
    BodyData,
    CapsuleData,
    CurveData,
    KeyposeData,
    MoveData,
    PageData,
    pack_curve,
    pack_path,
)
from onbeat.viewer.figure import DRESSED, Colour, Figure, ground_height
from onbeat.viewer.pages import mp3
from onbeat.viewer.pages.metric_words import told
from onbeat.viewer.pages.steps import steps_of
from onbeat.viewer.shape import Capsule, capsules

MAX_FPS = 60.0
"""Frames per second above which the page would show no more."""
CURVE_RATE = 10.0
"""Values per second of the intensity curves."""


class DanceDocument(msgspec.Struct, frozen=True):
    """What the page reads of ``dance.json``; a page can also be made without one."""

    method: str = ""
    title: str = ""
    beats: list[float] | None = None
    stops: list[float] = []
    moves: list[MoveData] = []
    metrics: dict[str, Any] = {}


def page_data(
    motion: Motion,
    song: Song | None = None,
    document: Mapping[str, Any] | None = None,
    audio: tuple[Float32, int] | None = None,
    keyposes: Keyposes | None = None,
    numbers: Ints | None = None,
    shape: list[Capsule] | None = None,
) -> PageData:
    """What the page shows, by its contract; arguments and errors are those of
    :func:`onbeat.viewer.pages.page.render_page`.

    ``numbers`` are those of the keyposes where they are not 1, 2, 3, …; ``shape`` is what hangs on the joints where it
    is not a body.
    """
    dance = _document(document)
    moves = sorted(dance.moves, key=lambda move: move.at_s)
    body = _body(motion) if shape is None else None
    shape = capsules(motion.skeleton, body) if shape is None else shape
    every = thinning(motion)
    spine = _spine(body)
    joints = sorted({*spine, *(c.joint_a for c in shape), *(c.joint_b for c in shape)})
    positions = motion.positions[::every, joints]
    encoded, waveform = _sound(audio)
    return PageData(
        version=VERSION,
        title=dance.title or (song.title if song else "") or motion.name or "A dance",
        method=dance.method,
        duration=motion.duration,
        tempo=song.tempo if song else 0.0,
        fps=motion.fps / every,
        frames=len(positions),
        joints=[motion.skeleton.names[joint] for joint in joints],
        capsules=[_capsule(c, joints) for c in shape],
        path=pack_path(positions),
        spine=[joints.index(joint) for joint in spine],
        facing=_facing(motion, body),
        floor=ground_height(Figure.from_capsules(shape), motion),
        audio=encoded,
        waveform=waveform,
        beats=_beats(dance, song, keyposes),
        downbeats=_rounded(song.downbeats.tolist() if song else []),
        stops=_rounded(dance.stops),
        moves=moves,
        joins=_rounded([move.at_s for move in moves[1:]]),
        keyposes=_keyposes(keyposes, motion, numbers),
        energy=None,
        music_intensity=_music_intensity(motion, song),
        motion_intensity=_motion_intensity(motion, body),
        metrics=told(dance.metrics),
        steps=steps_of(motion, body),
    )


def thinning(motion: Motion) -> int:
    """The page shows every so manieth frame."""
    return int(np.ceil(motion.fps / MAX_FPS - 1e-9))


def body_data(
    motion: Motion,
    every: int,
    colour: str | None = None,
    shape: list[Capsule] | None = None,
    palette: Mapping[str, Colour] = DRESSED,
) -> BodyData:
    """A body on the stage, every so many frames of it.

    It is all in one colour, or in those of its groups; ``shape`` is what hangs on the joints where it is not a body.
    """
    body = _body(motion) if shape is None else None
    shape = capsules(motion.skeleton, body) if shape is None else shape
    spine = _spine(body)
    joints = sorted({*spine, *(c.joint_a for c in shape), *(c.joint_b for c in shape)})
    drawn = [_capsule(c, joints, palette) for c in shape]
    if colour is not None:
        drawn = [msgspec.structs.replace(capsule, colour=colour) for capsule in drawn]
    names = [motion.skeleton.names[joint] for joint in joints]
    return BodyData(names, drawn, pack_path(motion.positions[::every, joints]), [joints.index(j) for j in spine])


def _document(document: Mapping[str, Any] | None) -> DanceDocument:
    try:
        dance = msgspec.convert(dict(document or {}), DanceDocument)
        times = [*(dance.beats or []), *dance.stops, *(t for m in dance.moves for t in (m.from_s, m.to_s, m.at_s))]
        if not np.isfinite(times).all():
            raise ValueError("one of its times is not a finite number")
    except (msgspec.ValidationError, TypeError, ValueError) as error:
        raise OnbeatError(f"this is no dance document: {error}; give what `onbeat dance` wrote to dance.json") from None
    return dance


def _body(motion: Motion) -> Body | None:
    try:
        return Body.of(motion.skeleton)
    except BodyError:
        return None


def _sound(audio: tuple[Float32, int] | None) -> tuple[AudioData | None, CurveData]:
    if audio is None:
        return None, pack_curve(np.zeros(0), mp3.WAVEFORM_RATE)
    samples, rate = audio
    return mp3.encode(samples, rate), mp3.waveform(samples, rate)


def _spine(body: Body | None) -> list[int]:
    """The joints along the trunk, from the waist up."""
    if body is None:
        return [0]
    return list(dict.fromkeys(body[role] for role in ("hips", "chest", "neck") if role in body))


def _capsule(c: Capsule, joints: Sequence[int], palette: Mapping[str, Colour] = DRESSED) -> CapsuleData:
    """A capsule between joints of the page."""
    colour = "#" + bytes(palette[c.group]).hex()
    ends = joints.index(c.joint_a), joints.index(c.joint_b)
    return CapsuleData(
        *ends, round(c.radius_a, 4), round(c.radius_b, 4), c.group, colour, round(c.start, 4), round(c.end, 4)
    )


def _facing(motion: Motion, body: Body | None) -> float:
    """Yaw in radians to which the dancer faces at first; the camera stands there."""
    if body is None:
        return np.pi
    return float(facing(body_frames(motion[:1], body)[0])[0])


def _beats(dance: DanceDocument, song: Song | None, keyposes: Keyposes | None) -> list[float]:
    """The beats danced to, else those heard, else those the keyposes were found by."""
    if dance.beats is not None:
        return _rounded(dance.beats)
    if song is not None:
        return _rounded(song.beats.tolist())
    return [] if keyposes is None else _rounded(keyposes.song_beats.tolist())


def _keyposes(found: Keyposes | None, motion: Motion, numbers: Ints | None) -> list[KeyposeData]:
    return [] if found is None else keypose_data(motion, found.times, found.beats, found.sources, numbers)


def keypose_data(
    motion: Motion, times: Times, beats: Ints, sources: Sequence[str], numbers: Ints | None = None
) -> list[KeyposeData]:
    """Keyposes (K,) as the page has them: their seconds, their beats from 0, and what rests there.

    ``numbers`` are theirs where they are not 1, 2, 3, ….
    """
    if not len(times):
        return []
    body = _body(motion)
    numbers = np.arange(1, len(times) + 1) if numbers is None else numbers
    yaws = np.zeros(len(times)) if body is None else facing(body_frames(motion.at(times), body)[0])
    shown = np.minimum(times, motion.duration).round(4)
    columns = (shown.tolist(), numbers.tolist(), (beats + 1).tolist(), sources, yaws.round(3).tolist())
    return [KeyposeData(*row) for row in zip(*columns, strict=True)]


def distance_curve(distances: Array, motion: Motion) -> CurveData:
    """Root of the mean square of distances (frames, points) over time, the largest being 1; NaN counts as none.

    Each value is the largest of its tenth of a second, so that short peaks are not passed over.
    """
    mean = np.nan_to_num(np.sqrt(np.square(distances).mean(axis=1)))
    times = _curve_times(motion)
    values = mean[np.minimum(np.rint(times * motion.fps).astype(np.int64), len(mean) - 1)]
    np.maximum.at(values, np.minimum(np.rint(motion.times * CURVE_RATE).astype(np.int64), len(values) - 1), mean)
    return pack_curve(_to_unit(values), CURVE_RATE)


def _curve_times(motion: Motion) -> Array:
    return np.arange(int(motion.duration * CURVE_RATE) + 1) / CURVE_RATE


def _music_intensity(motion: Motion, song: Song | None) -> CurveData:
    values = song.intensity_at(_curve_times(motion)) if song else np.zeros(0)
    return pack_curve(_to_unit(values), CURVE_RATE)


def _motion_intensity(motion: Motion, body: Body | None) -> CurveData:
    """Eq. 2 of Shiratori 2006 over the dance, the highest being 1; empty without a body."""
    values = np.zeros(0)
    if body is not None:
        values = intensity_component(hand_features(motion, body), _curve_times(motion))
    return pack_curve(_to_unit(values), CURVE_RATE)


def _to_unit(values: Array) -> Array:
    return values / max(float(values.max(initial=0.0)), 1e-9)


def _rounded(times: Sequence[float]) -> list[float]:
    """Seconds to 0.1 ms, in order."""
    return sorted(round(float(time), 4) for time in times)
