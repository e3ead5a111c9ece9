"""``onbeat robot``: a dance on a humanoid robot: retargeted, on the music, inside limits, balanced, simulated."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import cyclopts
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.keypose_input import BeatFlags, beats_of
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.retime_input import Music, read_music, told_keyposes
from onbeat.cli.robot_output import write_robot
from onbeat.errors import OnbeatError
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.retime.lock import TimeMap
from onbeat.retime.meeting import Meeting, meet
from onbeat.robots.document import RobotDocument, robot_document
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.perform import Staged, stage
from onbeat.robots.simulate import Options, simulate
from onbeat.robots.trial import Trial

Flag = Annotated[bool, cyclopts.Parameter(negative=())]
SPEEDS = (0.1, 10.0)
FILES = (".urdf", ".xml", ".mjcf")


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class TrialFlags:
    """How the dance is tried.

    Parameters
    ----------
    simulate
        Let the robot dance it in MuJoCo: motors with their greatest torques, friction, sensors.
    feedback
        What its balance is kept by: estimate (its own sensors, late and noisy), truth, or none.
    friction
        Of the soles on the floor.
    mass
        How much heavier the robot is than its controller thinks: 1.1.
    seed
        Of the sensors' noise.
    """

    simulate: Flag = False
    feedback: Literal["estimate", "truth", "none"] = "estimate"
    friction: float | None = None
    mass: float = 1.0
    seed: int = 0


NOT_TRIED = TrialFlags()


def robot_command(
    motion: Path,
    /,
    *,
    robot: str = "g1",
    speed: float | None = None,
    music: Path | None = None,
    first_beat: int | None = None,
    feet: Literal["planted", "stepping"] = "planted",
    trial: TrialFlags = NOT_TRIED,
    video: Flag = False,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("robot"),
    danced_to: Path | None = None,
    beats: Path | None = None,
    song_at: float = 0.0,
    keyposes: Path | None = None,
    source_fps: float | None = None,
    json: Flag = False,
) -> None:
    """Put a dance on a humanoid robot: retargeted, on the music, inside its limits, balanced; simulated and exported.

    Example: ``onbeat robot dance.bvh --robot g1 --speed 1.2 --simulate -o out``

    Parameters
    ----------
    motion
        The dance: any motion file, or one of the robot itself.
    robot
        g1, hrp4c or talos, or a file: URDF or MJCF.
    speed
        How much faster; 1 without it and without --music.
    music
        The song to dance to, or its beats (song.json or a list).
    first_beat
        The music's beat, from 0, on which the dance's first is; the first downbeat without it.
    feet
        planted: both feet stay where they are. stepping: it steps where the dancer steps.
    trial
        How the dance is tried.
    video
        Write robot.mp4 (extra ``video``).
    output
        A folder for everything.
    danced_to
        The song that the dance was danced to; its beats are heard. Without it and --beats the motion's own pulse.
    beats
        The beats of the dance: a file with a time a line, or a song.json.
    song_at
        Second of the motion at which --danced-to or --beats begin.
    keyposes
        A keyposes.json; without it they are found.
    source_fps
        Frames a second of a dance that stores none.
    json
        Print robot.json on stdout instead of a table.
    """
    if speed is not None and music is not None:
        raise OnbeatError("give --speed, how much faster, or --music, the song to dance to, not both")
    if speed is not None and not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise OnbeatError(f"--speed {speed:g}: give {SPEEDS[0]:g} to {SPEEDS[1]:g}; 1.2 is a fifth faster")
    engine()  # what is missing is said before anything is done
    model = read_robot(robot)
    with warnings_as_lines(), Stages() as stages:
        dance = read_motion(motion, fps=source_fps)
        own, _ = beats_of(dance, BeatFlags(danced_to, beats, song_at, source_fps))
        keys = np.asarray(find_keyposes(dance, own).times) if keyposes is None else told_keyposes(keyposes)
        song = None if music is None else read_music(music, first_beat)
        met = None if song is None else meet(own, song.beats, song.first)
        warp = TimeMap.steady(speed or 1.0) if met is None else met.warp
        until = np.inf if song is None else song.until
        staged = stage(dance, model, warp, own, keys, feet, until=until, progress=stages)
        tried = _tried(model, staged, trial, stages) if trial.simulate else None
        document = robot_document(model, staged, tried, feet)
        written = write_robot(output, motion, dance, model, staged, tried, document, song, video, stages)
    if json:
        Console(width=1 << 20, highlight=False).out(document.to_json().decode(), end="")
        return
    _print(document, met, song)
    print(f"written: {', '.join(str(path) for path in written)}")  # noqa: T201


def read_robot(robot: str) -> Robot:
    """A robot by its name, or from a file."""
    if Path(robot).suffix.lower() in FILES:
        from onbeat.robots.model import robot_from

        return robot_from(Path(robot))
    return robot_named(robot)


def _tried(model: Robot, staged: Staged, flags: TrialFlags, stages: Stages) -> Trial:
    options = Options(feedback=flags.feedback, friction=flags.friction, mass_scale=flags.mass)
    rng = np.random.default_rng(flags.seed)
    return simulate(model, staged.motion, options, rng=rng, progress=lambda share: stages("simulate", share))


def _print(document: RobotDocument, met: Meeting | None, song: Music | None) -> None:
    del song
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=240)
    table = Table(box=None, pad_edge=False, show_header=False)
    zmp, kept = document.zmp, document.violations
    rows = {
        "robot": f"{document.robot}, {document.mass_kg:.1f} kg, feet {document.feet}",
        "speed": f"{document.speed:.3g} ×, {document.duration:.1f} s",
        "past limits": f"{kept.position} joints in position, {kept.velocity} in velocity (at 1 kHz)",
        "balance": f"zero-moment point inside the soles {zmp.inside:.1%} of the time, {zmp.worst_mm:.0f} mm at least",
    }
    if met is not None:
        rows["beats"] = f"{len(met.dance)} of the dance on the music's"
    if document.trial is not None:
        tried = document.trial
        fell = f"it fell at {tried.fell_at:.2f} s: {tried.why}" if tried.fell_at is not None else "upright to the end"
        rows["simulated"] = (
            f"{fell}; joints {tried.rms_deg:.1f}° off (rms), {tried.beats_met} of {tried.beats} beats met"
        )
    for name, text in rows.items():
        table.add_row(Text(name), Text(text))
    screen.print(table)
