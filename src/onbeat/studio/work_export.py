"""The job of an export: a dance as a file to take away."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import msgspec

from onbeat._shapes import Float32
from onbeat.files import write_atomically
from onbeat.formats.gmr import write_gmr
from onbeat.formats.joint_table import write_joint_table
from onbeat.formats.robot_csv import write_robot_csv
from onbeat.formats.tracking import write_tracking
from onbeat.formats.write import write_motion
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.joint_angles import JointAngles
from onbeat.music.audio import read_stereo
from onbeat.studio.dance_folder import SCENE, SHOWN, StoredDance
from onbeat.studio.stretch import stretched
from onbeat.studio.tasks import Done, ExportTask
from onbeat.studio.telling import Tell
from onbeat.viewer.contract import PageData
from onbeat.viewer.pages.mp3 import encode, waveform
from onbeat.viewer.pages.page import filled

PARTS = {"writing": 1.0}
SOUND = 48000


def exported(task: ExportTask, tell: Tell) -> Done:
    """Write a dance in a format."""
    tell = tell.of(PARTS)
    tell("writing", 0.0)
    path = Path(task.out) / task.file
    dance = StoredDance.read(Path(task.folder))
    if task.format in _COPIED:
        write_atomically(path, (Path(task.folder) / _COPIED[task.format]).read_bytes())
    else:
        _WRITERS.get(task.format, _motion)(task, dance, path, tell)
    return Done(seconds=dance.motion.duration)


_COPIED = {"json": SHOWN[1], "song": SHOWN[2]}
"""Formats that lie in the dance's folder as they are."""


def _motion(task: ExportTask, dance: StoredDance, path: Path, tell: Tell) -> None:
    write_motion(dance.motion, path)


def _joints(task: ExportTask, dance: StoredDance, path: Path, tell: Tell) -> None:
    from onbeat.robots.model import robot_named

    body = robot_named(task.robot or "").body
    angles = hinge_angles(body, dance.motion)
    write_joint_table(JointAngles(body.names, angles, dance.motion.fps, dance.motion.name), path)


def _mcap(task: ExportTask, dance: StoredDance, path: Path, tell: Tell) -> None:
    from onbeat.robots.model import robot_named
    from onbeat.robots.sequences.mcap import write_mcap

    write_mcap(robot_named(task.robot or ""), dance.motion, path)


def _page(task: ExportTask, dance: StoredDance, path: Path, tell: Tell) -> None:
    samples, rate = _sound(task, dance)
    tell("writing", 0.3)
    scene = msgspec.json.decode((Path(task.folder) / SCENE).read_bytes(), type=PageData)
    title = dance.motion.name or scene.title
    page = msgspec.structs.replace(scene, title=title, audio=encode(samples, rate), waveform=waveform(samples, rate))
    write_atomically(path, filled(page))


def _film(task: ExportTask, dance: StoredDance, path: Path, tell: Tell) -> None:
    import numpy as np

    from onbeat.viewer.film.flashes import Flashes
    from onbeat.viewer.video import write_video

    motion, figure, film = dance.motion, None, task.film
    if task.robot is not None:
        from onbeat.robots.model import robot_named
        from onbeat.viewer.figure import Figure
        from onbeat.viewer.robot_shape import ROBOT, robot_shape

        motion, shape = robot_shape(motion, robot_named(task.robot))
        figure = Figure.from_capsules(shape, ROBOT)
    write_video(
        path, motion, dance.song, _sound(task, dance), fps=film.fps, size=(film.width, film.height),
        stops=np.array(dance.document.stops), figure=figure,
        flashes=Flashes.on(dance.song.beats, dance.song.downbeats) if film.flash else None,
        progress=lambda share: tell("writing", share),
    )  # fmt: skip


def _sound(task: ExportTask, dance: StoredDance) -> tuple[Float32, int]:
    """What is heard during the dance, as fast as it is danced."""
    samples, rate = read_stereo(Path(task.sound), task.start, dance.motion.duration * task.speed, highest=SOUND)
    return stretched(samples, rate, task.speed), rate


_WRITERS: dict[str, Callable[[ExportTask, StoredDance, Path, Tell], None]] = {
    "csv": _joints,
    "g1csv": lambda task, dance, path, tell: write_robot_csv(dance.motion, path),
    "tracking": lambda task, dance, path, tell: write_tracking(dance.motion, path),
    "gmr": lambda task, dance, path, tell: write_gmr(dance.motion, path),
    "mcap": _mcap,
    "html": _page,
    "mp4": _film,
}
"""Of each format what writes it, where that is not its ending alone."""
