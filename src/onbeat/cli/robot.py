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

from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.robot_output import write_robot
from onbeat.cli.time_flags import NO_OWN, NO_TIME, OwnFlags, TimeFlags, When
from onbeat.cli.video_flags import NO_VIDEO, VideoFlags
from onbeat.errors import OnbeatError
from onbeat.formats.read import read_motion
from onbeat.retime.meeting import Meeting
from onbeat.robots.document import RobotDocument, robot_document
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot, robot_from, robot_named
from onbeat.robots.perform import Staged, stage
from onbeat.robots.simulate import Options, simulate
from onbeat.robots.trial import Trial

Flag = Annotated[bool, cyclopts.Parameter(negative=())]
FILES = (".urdf", ".xml", ".mjcf", ".toml")


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
    time: TimeFlags = NO_TIME,
    own: OwnFlags = NO_OWN,
    feet: Literal["planted", "stepping"] = "planted",
    trial: TrialFlags = NOT_TRIED,
    video: VideoFlags = NO_VIDEO,
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("robot"),
    json: Flag = False,
) -> None:
    """Put a dance on a humanoid robot: retargeted, on the music, inside its limits, balanced; simulated and exported.

    Example: ``onbeat robot dance.bvh --robot g1 --speed 1.2 --simulate -o out``

    Parameters
    ----------
    motion
        The dance: any motion file, or one of the robot itself.
    robot
        g1, hrp4c or talos, or a file: URDF, MJCF, or TOML as docs/robot.md has it.
    time
        The time that it is to be in; its own without --speed and --music.
    own
        Its own time.
    feet
        planted: both feet stay where they are. stepping: it steps where the dancer steps.
    trial
        How the dance is tried.
    video
        A video, robot.mp4.
    output
        A folder for everything.
    json
        Print robot.json on stdout instead of a table.
    """
    time.check()
    if trial.seed < 0:
        raise OnbeatError(f"--seed {trial.seed}: give 0 or more")
    film = video.film()
    engine()  # what is missing is said before anything is done
    with warnings_as_lines(), Stages() as stages:
        model = read_robot(robot)
        dance = read_motion(motion, fps=own.source_fps)
        beats, keyposes = own.beside(motion).of(dance)
        when = When.of(beats, time)
        staged = stage(dance, model, when.warp, beats, keyposes, feet, until=when.until, progress=stages)
        tried = _tried(model, staged, trial, stages) if trial.simulate else None
        document = robot_document(model, staged, tried, feet)
        written = write_robot(output, motion, dance, model, staged, tried, document, when.music, film, stages)
    if json:
        Console(width=1 << 20, highlight=False).out(document.to_json().decode(), end="")
        return
    _print(document, when.met)
    print(f"written: {', '.join(str(path) for path in written)}")  # noqa: T201


def read_robot(robot: str) -> Robot:
    """A robot by its name, or from a file."""
    if Path(robot).suffix.lower() in FILES:
        return robot_from(Path(robot))
    return robot_named(robot)


def _tried(model: Robot, staged: Staged, flags: TrialFlags, stages: Stages) -> Trial:
    options = Options(feedback=flags.feedback, friction=flags.friction, mass_scale=flags.mass)
    rng = np.random.default_rng(flags.seed)
    return simulate(model, staged.motion, options, rng=rng, progress=lambda share: stages("simulate", share))


def _print(document: RobotDocument, met: Meeting | None) -> None:
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=240)
    table = Table(box=None, pad_edge=False, show_header=False)
    zmp, kept = document.zmp, document.violations
    rows = {
        "robot": f"{document.robot}, {document.mass_kg:.1f} kg, feet {document.feet}",
        "speed": f"{document.speed:.3g} ×, {document.duration:.1f} s",
        "past limits": f"{kept.position} joints in position, {kept.velocity} in velocity (at 1 kHz)",
        "balance": f"planned: zero-moment point {_inside(zmp.inside, zmp.worst_mm)}",
    }
    if met is not None:
        rows["beats"] = f"{len(met.dance)} of the dance on the music's"
    if document.trial is not None:
        tried = document.trial
        fell = f"it fell at {tried.fell_at:.2f} s: {tried.why}" if tried.fell_at is not None else "upright to the end"
        rows["simulated"] = (
            f"{fell}; joints {tried.rms_deg:.1f}° off (rms), {tried.beats_met} of {tried.beats} beats met"
        )
        if tried.inside is not None and tried.worst_mm is not None:
            rows[""] = f"measured: centre of pressure {_inside(tried.inside, tried.worst_mm)}"
    for name, text in rows.items():
        table.add_row(Text(name), Text(text))
    screen.print(table)


def _inside(share: float, least: float) -> str:
    """How much of the time, and how far at the least; what is not always is not 100 %."""
    told = f"{share:.0%}" if share == 1 else f"{min(share, 0.999):.1%}"
    return f"inside the soles {told} of the time, {least:z.0f} mm at least"
