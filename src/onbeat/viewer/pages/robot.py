"""``robot.html``: a robot's dance beside the dancer's it was made of, on the clock of the music.

Both bodies have joints of their own, so nothing is measured between them: the robot is drawn as its model has it, the
dancer in clothes. A robot that ends before the dance, as one that falls does, stays as it is then, and is said to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Float32, Positions, Times
from onbeat.errors import OnbeatError
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.robots.model import Robot
from onbeat.viewer.contract import ComparedData, MoveData, PageData
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.keypose.rows import downbeats_among
from onbeat.viewer.pages.content import MAX_FPS, body_data, keypose_data, page_data
from onbeat.viewer.robot_shape import ROBOT, robot_shape
from onbeat.viewer.shape import Capsule

EARLY = 0.1
"""Seconds by which a robot may end before the dance without a word: two rates seldom end together."""
ROOM, FAR = 1.05, 2.6
"""Metres that both keep from each other, and by which they begin apart at most."""
CALM = 0.7
"""Seconds over which the dancer's way is smoothed before it is taken off."""
NONE: Times = np.zeros(0)
DANCES = "dances"
"""What is said of the robot while it does."""
KEPT, MISSED = "kept", "missed"
"""What is said of keyposes: those after the robot's end it does not come to."""


@dataclass(frozen=True)
class Ending:
    """When and how a robot's dance ends, where that is before the dancer's."""

    time: float
    fell: bool

    @property
    def words(self) -> str:
        """``falls at 12.3 s``."""
        return f"{'falls' if self.fell else 'ends'} at {self.time:.1f} s"


def robot_page_data(
    dancer: Motion,
    robot: Motion,
    song: Song | None = None,
    audio: tuple[Float32, int] | None = None,
    beats: Times = NONE,
    keyposes: Times = NONE,
    title: str = "",
    notes: Mapping[str, Any] | None = None,
    *,
    model: Robot | None = None,
    fell_at: float | None = None,
) -> PageData:
    """What the page shows, for ``onbeat.viewer.pages.page.write_filled``; the same for the same input.

    Parameters
    ----------
    dancer, robot : on the music's clock from the same moment on, at any rates.
    song : what is heard in the music; downbeats, tempo and intensity are shown of it.
    audio : samples (N, channels) in -1…1 of the music from that moment on and their rate in Hz; None for silence.
    beats, keyposes : (B,) and (K,) seconds.
    title : of the page; the dance's name without it.
    notes : what is listed about the dance: names and texts, numbers, or such mappings.
    model : the robot, drawn by its capsules; without it its body is drawn by its roles.
    fell_at : seconds at which it fell; where it ends early without it, it is only said to end.

    Raises
    ------
    OnbeatError
        If times are not finite, the samples are no sound, or the robot's motion is not of the model.
    """
    _check(beats, "beat")
    _check(keyposes, "keypose")
    _check(NONE if fell_at is None else np.array([fell_at]), "fall")
    ending = _ending(dancer, robot, fell_at)
    person, machine = together(dancer, robot)
    drawn, shape = (machine, None) if model is None else robot_shape(machine, model)
    name = "robot" if model is None else model.name
    document = {"title": title or dancer.name, "method": name, "beats": beats.tolist(), "metrics": _told(notes, ending)}
    page = page_data(machine, song, document, audio)
    page = _dressed(page, drawn, shape)
    caption = name if ending is None else f"{name}, {ending.words}"
    page = msgspec.structs.replace(page, compared=_beside(page, person, machine, caption))
    return _timed(page, machine, song, keyposes, ending)


def together(dancer: Motion, robot: Motion) -> tuple[Motion, Motion]:
    """Both at one rate, that of the one with more frames a second and 60 at most, and as long as the longer one.

    The one that ends first stays in its last pose.
    """
    fps = min(max(dancer.fps, robot.fps), MAX_FPS)
    times = np.arange(max(round(max(dancer.duration, robot.duration) * fps), 1)) / fps
    return dancer.at(times).replace(fps=fps), robot.at(times).replace(fps=fps)


def apart(robot: Array, dancer: Array, facing: float) -> float:
    """Metres by which a dancer has to begin aside so that two paths (F, 2) on the ground keep :data:`ROOM`.

    Examples
    --------
    >>> still = np.zeros((2, 2))
    >>> apart(still, still, 0.0), apart(still, np.array([[0, 0], [-0.5, 0.1]]), 0.0)
    (1.05, 1.55)
    """
    aside = np.array([np.cos(facing), np.sin(facing)])
    way = dancer - robot
    along, across = way @ aside, np.abs(way @ [-aside[1], aside[0]])
    need = np.where(across < ROOM, ROOM - along, 0.0)
    return round(min(max(float(need.max()), ROOM), FAR), 3)


def _check(times: Times, what: str) -> None:
    bad = ~np.isfinite(times)
    if bad.any():
        at = int(np.argmax(bad))
        raise OnbeatError(f"{what} {at + 1} of {len(times)} is at {times[at]} s; seconds are needed")


def _ending(dancer: Motion, robot: Motion, fell_at: float | None) -> Ending | None:
    if fell_at is not None:
        return Ending(fell_at, True)
    return Ending(robot.duration, False) if robot.duration < dancer.duration - EARLY else None


def _told(notes: Mapping[str, Any] | None, ending: Ending | None) -> dict[str, Any]:
    """What is listed, the robot's end first."""
    return ({} if ending is None else {"the robot": ending.words}) | dict(notes or {})


def _dressed(page: PageData, robot: Motion, shape: list[Capsule] | None) -> PageData:
    """With the robot as the page's dancer."""
    body = body_data(robot, 1, None, shape, ROBOT)
    figure = Figure.of(robot.skeleton) if shape is None else Figure.from_capsules(shape, ROBOT)
    return msgspec.structs.replace(
        page,
        joints=body.joints,
        capsules=body.capsules,
        path=body.path,
        spine=body.spine,
        floor=ground_height(figure, robot),
    )


def _beside(page: PageData, dancer: Motion, robot: Motion, caption: str) -> ComparedData:
    """The dancer, kept at the robot's side and on the floor it stands on."""
    moved = dancer.replace(root_positions=kept_beside(dancer, robot, page.floor))
    room = apart(robot.root_positions[:, :2], moved.root_positions[:, :2], page.facing)
    name = dancer.name or "the dancer"
    return ComparedData(name, None, body_data(moved, 1), "dancer", [caption, "dancer"], room)


def kept_beside(dancer: Motion, robot: Motion, floor: float) -> Positions:
    """(F, 3) metres: the dancer's root where it goes with the robot, and the dancer stands on the floor.

    A robot's steps are shorter, and it may not go at all where people do: how far the dancer gets ahead of it, calmly
    (over :data:`CALM` seconds), is taken off, and steps and sways remain.
    """
    ahead = (dancer.root_positions - robot.root_positions)[:, :2]
    drift = gaussian_filter1d(ahead, CALM * dancer.fps, axis=0, mode="nearest")
    stands = ground_height(Figure.of(dancer.skeleton), dancer)
    return dancer.root_positions - np.column_stack((drift, np.full(len(drift), stands - floor)))


def _timed(page: PageData, robot: Motion, song: Song | None, keyposes: Times, ending: Ending | None) -> PageData:
    """With keyposes, bars and tempo of the beats danced to, and with the robot's end as a band below."""
    beats = np.array(page.beats)
    down = beats[downbeats_among(beats, song.downbeats)].tolist() if song is not None and len(beats) else []
    tempo = song.tempo if song is not None else 60.0 / float(np.median(np.diff(beats))) if len(beats) > 1 else 0.0
    times = np.sort(keyposes[(keyposes >= 0) & (keyposes <= page.duration)])
    nearest = np.zeros(len(times), np.int64)
    if len(beats):
        nearest = np.abs(times[:, None] - beats).argmin(axis=1)
    end = np.inf if ending is None else ending.time
    shown = keypose_data(robot, times, nearest, [KEPT if time <= end else MISSED for time in times.tolist()])
    moves = [] if ending is None else _bands(ending, page.duration)
    return msgspec.structs.replace(page, keyposes=shown, downbeats=down, tempo=tempo, moves=moves)


def _bands(ending: Ending, duration: float) -> list[MoveData]:
    end = float(np.clip(ending.time, 0.0, duration))
    told = f"{'fell' if ending.fell else 'ended'} at {ending.time:.1f} s"
    return [MoveData(DANCES, 0.0, end, 0.0), MoveData(told, end, duration, round(end, 4))]
