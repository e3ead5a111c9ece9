"""``robot.json``: how a robot dances a dance, as others read it."""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onbeat.retime.document import ViolationsDocument
from onbeat.robots.lateness import MET, lateness
from onbeat.robots.measured import HAIR, measured_margins
from onbeat.robots.model import Robot
from onbeat.robots.perform import Staged
from onbeat.robots.trial import Trial

VERSION = 1
Said = msgspec.Meta


class ZmpDocument(msgspec.Struct, frozen=True):
    """The zero-moment point of the dance as it is planned."""

    inside: Annotated[float, Said(description="share of the frames in which it is inside the soles' hull, 0…1")]
    worst_mm: Annotated[float, Said(description="mm by which it is inside at the least; below 0 outside")]
    margin_mm: Annotated[list[float], Said(description="mm, of each frame")]


class TrialDocument(msgspec.Struct, frozen=True):
    """The dance as it was simulated."""

    fell_at: Annotated[float | None, Said(description="second of the dance at which the robot fell; null if never")]
    why: Annotated[str | None, Said(description="how it fell")]
    rms_deg: Annotated[float, Said(description="degrees between the joints and what they were told")]
    worst_deg: Annotated[float, Said(description="degrees, the most")]
    saturated: Annotated[float, Said(description="share of the time in which the busiest motor gave all it has")]
    beats: Annotated[int, Said(description="of the dance within the simulated time")]
    beats_met: Annotated[int, Said(description="at which its pose was danced within 50 ms")]
    inside: Annotated[
        float | None,
        Said(
            description="share of the frames in which a foot touched the floor and the measured centre of pressure was "
            "inside the soles' hull, 0…1, as `zmp.inside` is planned; null if nothing touched"
        ),
    ] = None
    worst_mm: Annotated[
        float | None, Said(description="mm by which it was inside at the least, likewise; below 0 outside")
    ] = None


class RobotDocument(msgspec.Struct, frozen=True):
    """``robot.json``; times in seconds of the music where nothing else is said."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    robot: Annotated[str, Said(description="its name")]
    mass_kg: Annotated[float, Said(description="kilograms")]
    feet: Annotated[str, Said(description="`planted` or `stepping`")]
    speed: Annotated[float, Said(description="how much faster than the dance itself, on the whole")]
    start: Annotated[float, Said(description="second of the music at frame 0")]
    fps: Annotated[float, Said(description="frames a second")]
    duration: Annotated[float, Said(description="seconds")]
    joints: Annotated[list[str], Said(description="in the model's order")]
    violations: Annotated[ViolationsDocument, Said(description="how many joints are past a limit")]
    zmp: Annotated[ZmpDocument, Said(description="of the plan")]
    standing: Annotated[list[str], Said(description="of each frame the feet that stand: `LR`, `L` or `R`")]
    beats: Annotated[list[float], Said(description="at which the dance's beats are now")]
    keyposes: Annotated[list[float], Said(description="at which its keyposes are now")]
    source: Annotated[str, Said(description="where the robot's figures are from")]
    trial: Annotated[TrialDocument | None, Said(description="the simulation, where there was one")] = None

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"


def robot_document(robot: Robot, staged: Staged, trial: Trial | None, feet: str) -> RobotDocument:
    """The document of a staged dance, and of its trial."""
    motion, margin, measures = staged.motion, staged.balanced.margin, staged.limits
    ends = staged.start + np.array([0.0, (len(motion) - 1) / motion.fps])
    speed = float(np.diff(staged.retimed.warp(ends))[0] / max(ends[1] - ends[0], 1e-9))
    over = measures.violations
    return RobotDocument(
        version=VERSION,
        robot=robot.name,
        mass_kg=round(robot.mass, 3),
        feet=feet,
        speed=round(speed, 6),
        start=round(staged.start, 6),
        fps=round(motion.fps, 6),
        duration=round(motion.duration, 6),
        joints=list(robot.body.names),
        violations=ViolationsDocument(*over),
        zmp=ZmpDocument(
            round(float((margin >= 0).mean()), 6),
            round(1000 * float(margin.min()), 3),
            [round(1000 * value, 2) for value in margin.tolist()],
        ),
        standing=["".join(name for name, on in zip("LR", row, strict=True) if on) for row in staged.standing.tolist()],
        beats=[round(beat, 6) for beat in staged.beats.tolist()],
        keyposes=[round(time, 6) for time in staged.retimed.measures.keyposes.tolist()],
        source=robot.source,
        trial=None if trial is None else _tried(robot, staged, trial),
    )


def _tried(robot: Robot, staged: Staged, trial: Trial) -> TrialDocument:
    inside = staged.beats - staged.start
    end = trial.motion.duration if trial.fell_at is None else trial.fell_at
    inside = inside[(inside >= 0) & (inside < end)]
    margins = measured_margins(robot, trial)
    margins = margins[np.isfinite(margins)]
    return TrialDocument(
        fell_at=None if trial.fell_at is None else round(trial.fell_at, 3),
        why=trial.why,
        rms_deg=round(float(np.degrees(np.sqrt(np.square(trial.rms_error).mean()))), 3),
        worst_deg=round(float(np.degrees(trial.worst_error.max(initial=0.0))), 3),
        saturated=round(float(trial.saturated.max(initial=0.0)), 4),
        beats=len(inside),
        beats_met=int(np.sum(np.abs(lateness(robot, staged.motion, trial.motion, inside)) <= MET)),
        inside=round(float(np.mean(margins >= -HAIR)), 6) if len(margins) else None,
        worst_mm=round(1000 * float(margins.min()), 2) + 0.0 if len(margins) else None,
    )
