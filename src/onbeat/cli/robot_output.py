"""What ``onbeat robot`` writes: the dance in robots' formats, ``robot.json``, a figure, a page and a video."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np

from onbeat._shapes import Float32
from onbeat.cli.progress import Stages
from onbeat.cli.time_flags import Music
from onbeat.cli.video_flags import Film
from onbeat.files import make_folder, write_atomically
from onbeat.formats.gmr import write_gmr
from onbeat.formats.joint_table import write_joint_table
from onbeat.formats.robot_csv import write_robot_csv
from onbeat.formats.tracking import write_tracking
from onbeat.formats.write import write_motion
from onbeat.motion import Motion
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.joint_angles import JointAngles
from onbeat.music.audio import read_stereo
from onbeat.music.song import Song
from onbeat.robots.document import RobotDocument
from onbeat.robots.legs.contacts import sole_corners
from onbeat.robots.legs.ik import Legs
from onbeat.robots.measured import measured_margins, pressed_at
from onbeat.robots.model import Robot
from onbeat.robots.perform import Staged
from onbeat.robots.sequences.hrpsys import write_hrpsys
from onbeat.robots.sequences.mcap import write_mcap
from onbeat.robots.state import configurations
from onbeat.robots.trial import Trial
from onbeat.viewer.figure import Figure
from onbeat.viewer.film.flashes import Flashes
from onbeat.viewer.pages.page import write_filled
from onbeat.viewer.pages.robot import robot_page_data
from onbeat.viewer.plots.robot import Measured, write_robot_figure
from onbeat.viewer.robot_shape import ROBOT, robot_shape
from onbeat.viewer.video import write_video

SOUND = 48000


def write_robot(
    output: Path,
    source: Path,
    dance: Motion,
    robot: Robot,
    staged: Staged,
    trial: Trial | None,
    document: RobotDocument,
    music: Music | None,
    film: Film | None,
    stages: Stages,
) -> list[Path]:
    """Write everything; the paths of what was written."""
    folder = make_folder(output)
    stages("write", 0.0)
    written = _exports(folder, source.stem, robot, staged)
    report, drawn, page = (folder / name for name in ("robot.json", "robot.png", "robot.html"))
    write_atomically(report, document.to_json())
    _figure(drawn, robot, staged, trial)
    song = None if music is None else music.song
    sound = None if music is None or song is None else _sound(music, staged)
    shown = staged.motion if trial is None else trial.motion
    dancer = dance.at(np.clip(staged.retimed.warp(staged.start + staged.motion.times), 0.0, dance.duration))
    beats, keyposes = staged.beats - staged.start, staged.retimed.measures.keyposes - staged.start
    told = robot_page_data(
        dancer.replace(fps=staged.motion.fps), shown, audio=sound, beats=beats, keyposes=keyposes, title=source.stem,
        model=robot, fell_at=None if trial is None else trial.fell_at,
    )  # fmt: skip
    write_filled(page, told)
    written += [report, drawn, page]
    if film:
        written.append(folder / "robot.mp4")
        _film(written[-1], robot, staged, shown, song, sound, film, stages)
    return written


def _film(
    path: Path,
    robot: Robot,
    staged: Staged,
    shown: Motion,
    song: Song | None,
    sound: tuple[Float32, int] | None,
    film: Film,
    stages: Stages,
) -> None:
    """The video: below it the beats that are danced to and the keyposes; the song's downbeats where there is one."""
    dressed, shape = robot_shape(shown, robot)
    beats, length = staged.beats - staged.start, shown.duration
    downbeats = (np.zeros(0) if song is None else song.downbeats) - staged.start
    none = np.zeros(2)
    danced = Song(length, 0.0, 4, beats, downbeats, np.zeros(len(beats)), np.array([0.0, length]), none)
    write_video(
        path, dressed, danced, sound, fps=film.fps, size=film.size, figure=Figure.from_capsules(shape, ROBOT),
        stops=staged.retimed.measures.keyposes - staged.start, marked="keyposes",
        flashes=Flashes.on(beats, downbeats) if film.flash else None,
        progress=lambda share: stages("video", share),
    )  # fmt: skip


def _exports(folder: Path, name: str, robot: Robot, staged: Staged) -> list[Path]:
    """The dance in the formats that the robot's players read."""
    motion = staged.motion
    written = [folder / f"{name}.{ending}" for ending in ("joints.csv", "glb")]
    write_joint_table(JointAngles(robot.body.names, hinge_angles(robot.body, motion), motion.fps, name), written[0])
    write_motion(motion, written[1])
    written += write_hrpsys(robot, motion, staged.balanced.zmp, folder / name)
    if robot.name == "g1":
        paths = [folder / f"{name}.{ending}" for ending in ("csv", "tracking.npz", "gmr.npz")]
        write_robot_csv(motion, paths[0])
        write_tracking(motion, paths[1])
        write_gmr(motion, paths[2])
        written += paths
    if importlib.util.find_spec("rosbags") is None:
        print('no JointTrajectory (.mcap): pip install "onbeat[ros]"', file=sys.stderr)  # noqa: T201
    else:
        written.append(folder / f"{name}.mcap")
        write_mcap(robot, motion, written[-1])
    return written


def _figure(path: Path, robot: Robot, staged: Staged, trial: Trial | None) -> None:
    motion = staged.motion
    corners = sole_corners(Legs.of(robot), configurations(robot, motion))[..., :2]
    measured = None if trial is None else _measured(robot, trial)
    write_robot_figure(
        path,
        motion.times,
        staged.balanced.margin,
        staged.balanced.zmp,
        corners,
        staged.standing,
        measured=measured,
        fell_at=None if trial is None else trial.fell_at,
        beats=staged.beats - staged.start,
        title=f"{motion.name} · {robot.body.name}",
    )


def _measured(robot: Robot, trial: Trial) -> Measured:
    """What the simulation measured at the dance's frames; the margin where a foot touches the floor."""
    motion = trial.motion
    at = np.minimum(np.searchsorted(trial.times, motion.times), len(trial.times) - 1)
    error = np.degrees(np.sqrt(np.square(trial.error[at]).mean(axis=1)))
    return Measured(motion.times, measured_margins(robot, trial), error, zmp=pressed_at(trial))


def _sound(music: Music, staged: Staged) -> tuple[Float32, int]:
    return read_stereo(music.path, staged.start, staged.motion.duration, highest=SOUND)
