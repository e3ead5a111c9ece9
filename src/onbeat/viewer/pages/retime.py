"""``retimed.html``: a retimed dance beside the original on one clock, in step with the music.

The original is shown as it would be had the body no limits: at each second of the music it is where its own time is
then. What lies between both bodies, joint by joint in colour, is what the limits cost.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from onbeat._shapes import Array, Bools, Float32
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.retime.retime import Retimed
from onbeat.viewer.contract import ComparedData, CurveData, KeyposeData, MetricData, PageData, pack_heat
from onbeat.viewer.keypose.rows import downbeats_among
from onbeat.viewer.pages.content import body_data, distance_curve, keypose_data, page_data, thinning
from onbeat.viewer.pages.page import filled
from onbeat.viewer.pages.pupil import MASTER
from onbeat.viewer.plots.heat import UNKNOWN, hex_scale, scale_end
from onbeat.viewer.plots.retime_curves import joint_told, over_limits, speed_told

KEPT, LOST = "kept", "out of reach"
"""What is said of keyposes."""


def write_retime_page(
    path: Path,
    result: Retimed,
    original: Motion,
    song: Song | None = None,
    audio: tuple[Float32, int] | None = None,
    title: str = "",
) -> None:
    """Write the page to a file, whole or not at all; arguments and errors as :func:`retime_page`."""
    write_atomically(path, retime_page(result, original, song, audio, title))


def retime_page(
    result: Retimed,
    original: Motion,
    song: Song | None = None,
    audio: tuple[Float32, int] | None = None,
    title: str = "",
) -> bytes:
    """The page as bytes of HTML, one file without a server or a network; the same bytes for the same input.

    Parameters
    ----------
    result : the retimed dance, a motion.
    original : the motion it was made of, on its own clock.
    song : what is heard in the music; downbeats, tempo and intensity are shown of it.
    audio : samples (N, channels) in -1…1 of the music from its second 0 on and their rate in Hz; None for silence.
    title : of the page; the dance's name without it.

    Raises
    ------
    OnbeatError
        If the result is a table of angles, which has no body to show, or its joints are not the original's.
    """
    retimed, wished = on_music_clock(result, original)
    distances = 100.0 * np.linalg.norm(retimed.positions - wished.positions, axis=2)
    page = page_data(retimed, song, {"title": title or result.dance.name, "method": result.method}, audio)
    every = thinning(retimed)
    number = {name: joint for joint, name in enumerate(retimed.skeleton.names)}
    shown = distances[::every][:, [number[name] for name in page.joints]]
    heat = pack_heat(shown, scale_end(distances), hex_scale(), "#" + bytes(UNKNOWN).hex())
    captions = [f"retimed ({result.method})", "original"]
    compared = ComparedData("the original", heat, body_data(wished, every, MASTER), "original", captions)
    page = msgspec.structs.replace(page, compared=compared, keyposes=_keyposes(result, retimed))
    page = msgspec.structs.replace(page, metrics=_told(result, retimed, distances))
    return filled(_beaten(page, result, song, distance_curve(distances, retimed)))


def on_music_clock(result: Retimed, original: Motion) -> tuple[Motion, Motion]:
    """The retimed motion from second 0 of the music on, and the original on the same clock as if it had no limits.

    Raises
    ------
    OnbeatError
        See :func:`retime_page`.
    """
    dance = result.dance
    if not isinstance(dance, Motion):
        raise OnbeatError(
            f"{dance.name or 'the dance'} is a table of angles and has no body to show; a page can be made of a "
            "motion, a figure of both"
        )
    if dance.skeleton.names != original.skeleton.names:
        raise OnbeatError(
            f"{original.name or 'the original'} has {len(original.skeleton)} joints and the retimed dance "
            f"{len(dance.skeleton)}, or others; give the motion that was retimed"
        )
    times = np.arange(round(result.start * dance.fps) + len(dance)) / dance.fps
    held = np.maximum(times, result.start)
    return dance.at(held - result.start), original.at(result.warp(held)).replace(fps=dance.fps)


def _keyposes(result: Retimed, retimed: Motion) -> list[KeyposeData]:
    times = result.measures.keyposes
    beats = np.zeros(len(times), np.int64)
    if len(result.beats):
        beats = np.abs(times[:, None] - result.beats).argmin(axis=1)
    inside: Bools = np.asarray(result.measures.feasible.all(axis=1))
    return keypose_data(retimed, times, beats, [KEPT if each else LOST for each in inside.tolist()])


def _beaten(page: PageData, result: Retimed, song: Song | None, curve: CurveData) -> PageData:
    """With the dance's beats as they are now, and the distance from the original as the dance's curve."""
    beats = result.beats[(result.beats >= 0) & (result.beats <= page.duration)].round(4)
    down = beats[downbeats_among(beats, song.downbeats)].tolist() if song is not None else []
    tempo = song.tempo if song is not None else 60.0 / float(np.median(np.diff(beats))) if len(beats) > 1 else 0.0
    return msgspec.structs.replace(page, beats=beats.tolist(), downbeats=down, tempo=tempo, motion_intensity=curve)


def _told(result: Retimed, retimed: Motion, distances: Array) -> list[MetricData]:
    """What is listed about the dance."""
    measures, count = result.measures, len(result.source.joints)
    knots = result.demand.wish.knots
    frame, joint = np.unravel_index(int(distances.argmax()), distances.shape)
    farthest = joint_told(retimed.skeleton.names[int(joint)])
    wished, kept = (int(over_limits(result, curve).sum()) for curve in (result.demand.wish, result.answer.trajectory))
    reached, asked = int(measures.feasible.all(axis=1).sum()), len(measures.keyposes)
    rows = [
        ("speed", speed_told(result, knots.start, knots.end)),
        ("limits", result.limits.name),
        ("joints over limits, original", f"{wished} of {count}"),
        ("joints over limits, retimed", f"{kept} of {count}"),
        ("mean distance", f"{10 * distances.mean():.1f} mm"),
        ("farthest off", f"{farthest}, {distances.max():.1f} cm"),
        ("at", f"{frame / retimed.fps:.2f} s"),
        ("keyposes inside the limits", f"{reached} of {asked}"),
        ("worst of these", f"{np.degrees(measures.worst_keypose):.2f}°"),
    ]
    return [MetricData(name, value) for name, value in rows]
