"""Real dances as joint angles, with their beats and keyposes, on the tables of three robots.

``g1_moves/*.csv`` are dances on the Unitree G1: all 29 joints on the G1's own table, and the joints of the arms on
those of HRP-4C and TALOS. Other robots have other zeros: their ranges keep their widths and are moved so that their
middles are the dance's. ``hrp4c_dance`` is HRP-4C's authored dance on its own table. Beats are the pulse that a motion
keeps by itself, keyposes are found with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hrp4c_poses import SONG_AT, TEMPO, read_dance
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.unitree_g1 import G1
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Demand
from onbeat.retime.lock import lock

PARTS = ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_roll", "wrist_pitch", "wrist_yaw")
HRP4C = ("SHOULDER_P", "SHOULDER_R", "SHOULDER_Y", "ELBOW_P", "WRIST_Y", "WRIST_R", "WRIST_R")
FPS = 60.0


@dataclass(frozen=True)
class Dance:
    """Angles (F, n) of joints on the dance's own clock, and the seconds of its beats and keyposes."""

    name: str
    joints: tuple[str, ...]
    angles: np.ndarray
    fps: float
    beats: np.ndarray
    keyposes: np.ndarray

    def of(self, joints: list[str]) -> Dance:
        """Some of the joints."""
        at = [self.joints.index(joint) for joint in joints]
        return Dance(self.name, tuple(joints), self.angles[:, at], self.fps, self.beats, self.keyposes)

    def demand(self, limits: Limits, speed: float, fps: float = FPS) -> Demand:
        """The dance so much faster, on a body's limits that are its joints' in this order."""
        curve = Spline.through(self.angles, self.fps)
        times = np.arange(int(np.floor(curve.knots.end / speed * fps + 1e-9)) + 1) / fps
        wish = Spline.through(curve(times * speed), fps)
        rhythm = lock(self.beats / speed, np.arange(len(self.beats), dtype=np.float64))
        bounds = (limits.low, limits.high, limits.speed, limits.acceleration, limits.jerk)
        return Demand(wish, *bounds, self.keyposes / speed, rhythm)


def g1_dances(folder: Path) -> Iterator[Dance]:
    """The dances on the G1."""
    for path in sorted(folder.glob("*.csv")):
        motion = read_motion(path, fps=FPS)
        beats = motion_beats(motion)
        keyposes = np.asarray(find_keyposes(motion, beats).times)
        yield Dance(path.stem, G1.names, hinge_angles(G1, motion), FPS, beats, keyposes)


def hrp4c_dance(folder: Path) -> Dance:
    """Turn to the Future, with its authored key poses."""
    read = read_dance(folder)
    last = (len(read.angles) - 1) / read.motion.fps
    beats = SONG_AT + np.arange(int((last - SONG_AT) * TEMPO / 60) + 1) * 60 / TEMPO
    return Dance("Turn to the Future", read.body.names, read.angles, read.motion.fps, beats, np.unique(read.key_poses))


def arms(dance: Dance) -> Dance:
    """The joints of a G1's arms."""
    return dance.of([name for name in dance.joints if any(part in name for part in PARTS)])


def foreign(dance: Dance, robot: str) -> Limits:
    """The limits of another robot's arms for a G1's, in the dance's order."""
    table = robot_limits(robot)
    theirs = [_theirs(robot, name) for name in dance.joints]
    found = [table.of([name]) for name in theirs]
    width = np.array([float(one.high[0] - one.low[0]) for one in found])
    middle = (dance.angles.min(axis=0) + dance.angles.max(axis=0)) / 2
    speed = np.array([float(one.speed[0]) for one in found])
    return Limits(table.name, dance.joints, middle - width / 2, middle + width / 2, speed)


def _theirs(robot: str, name: str) -> str:
    side = "left" if name.startswith("left") else "right"
    part = next(k for k, part in enumerate(PARTS) if part in name)
    return f"{side[0].upper()}_{HRP4C[part]}" if robot == "hrp4c" else f"arm_{side}_{part + 1}_joint"


def base_limits(dance: Dance, share: float = 1.45) -> Limits:
    """Limits as METHODS measured with: so many times the highest velocity of the layer whose knots are the beats."""
    from onbeat.retime.hierarchy import decompose

    curve = Spline.through(dance.angles, dance.fps)
    rhythm = lock(dance.beats, np.arange(len(dance.beats), dtype=np.float64))
    coarse = decompose(curve, rhythm, rhythm(dance.keyposes))
    times = np.arange(0, curve.knots.end, 1 / 240)
    rates = coarse(rhythm(times), 1)[0] * rhythm(times, 1)[:, None]
    free = np.full(len(dance.joints), np.inf)
    return Limits("1.45 × base layer", dance.joints, -free, free, share * np.abs(rates).max(axis=0))
