"""What is in a motion file: everything a person wants to know of it before using it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np

from onbeat.errors import BodyError
from onbeat.formats.conventions import Up
from onbeat.formats.notes import Note, noted
from onbeat.formats.read import fitted, read_file
from onbeat.formats.registry import reading
from onbeat.motion import Body, Markers, Motion
from onbeat.motion.contacts import SIDES, foot_contacts, runs
from onbeat.motion.edit import stature
from onbeat.motion.problems import problems
from onbeat.motion.retarget import floor_height
from onbeat.motion.role_file import Roles
from onbeat.motion.roles import role_report

VERSION = 1

Said = msgspec.Meta


class Role(msgspec.Struct):
    """A role and the joint that plays it."""

    role: Annotated[str, Said(description="what the joint is to the body")]
    joint: Annotated[str, Said(description="its name; empty where none was found")]
    how: Annotated[str, Said(description="`told` by a roles file, by `name`, by place in the `tree`, or a `guess`")]
    needed: Annotated[bool, Said(description="whether no body can dance without it")]


class Guess(msgspec.Struct):
    """What the file leaves open."""

    about: Annotated[str, Said(description="`unit`, `up`, `fps`, …")]
    taken: Annotated[str, Said(description="what it was taken for")]
    why: Annotated[str, Said(description="the reason")]


class Contact(msgspec.Struct):
    """How one foot stands on the floor."""

    side: Annotated[str, Said(description="`left` or `right`")]
    share: Annotated[float, Said(description="part of the time it rests")]
    times: Annotated[int, Said(description="how often it is put down")]


class MarkersReport(msgspec.Struct):
    """The markers of a file."""

    labels: Annotated[list[str], Said(description="of all markers")]
    seen: Annotated[float, Said(description="part of all frames and markers that is seen")]
    gaps: Annotated[int, Said(description="how many stretches are missing")]
    longest_gap: Annotated[float, Said(description="seconds")]
    residual_mm: Annotated[
        float, Said(description="root mean square distance of the fitted body's markers; -1 where none could be fitted")
    ] = -1.0


class FileReport(msgspec.Struct):
    """What is in a motion file."""

    version: Annotated[int, Said(description="of this document")]
    file: Annotated[str, Said(description="its name")]
    format: Annotated[str, Said(description="what it was read as")]
    frames: Annotated[int, Said(description="how many there are")]
    fps: Annotated[float, Said(description="frames a second")]
    duration: Annotated[float, Said(description="seconds")]
    guesses: Annotated[list[Guess], Said(description="what was taken for granted, and why")]
    problems: Annotated[list[str], Said(description="what is wrong with it, a line each")]
    joints: Annotated[list[str], Said(description="names, without ends of bones; none where there is no body")] = []
    ends: Annotated[int, Said(description="how many ends of bones there are besides")] = 0
    height: Annotated[float, Said(description="metres from the lowest to the highest joint when it stands tallest")] = (
        0.0
    )
    ground: Annotated[list[float], Said(description="metres, width and depth of the ground that the root covers")] = []
    feet_at: Annotated[float, Said(description="metres, the height of the lowest joint of standing feet")] = 0.0
    roles: Annotated[list[Role], Said(description="what each joint is to the body")] = []
    contacts: Annotated[list[Contact], Said(description="of both feet, where they are known")] = []
    markers: Annotated[list[MarkersReport], Said(description="one where the file holds markers")] = []


def describe(
    path: str | os.PathLike[str],
    fps: float | None = None,
    up: Up | None = None,
    unit: str | None = None,
    roles: Roles | None = None,
) -> FileReport:
    """Read a file and say what is in it; to markers a body is fitted, if one can be.

    Raises
    ------
    FormatError
        If the file cannot be read.
    """
    path = Path(path)
    with noted() as notes:
        found = read_file(path, fps, up, unit, roles)
        motion, markers, wrong = (found, None, []) if isinstance(found, Motion) else _of_markers(found, path, roles)
    report = FileReport(
        VERSION,
        path.name,
        reading(path).title,
        len(found),
        found.fps,
        found.duration,
        [Guess(*note) for note in _each_once(notes) if note.taken],
        [*wrong, *(note.why for note in notes if not note.taken)],
        markers=[] if markers is None else [markers],
    )
    return report if motion is None else _of_body(report, motion)


def _each_once(notes: list[Note]) -> list[Note]:
    return list(dict.fromkeys(notes))


def _of_markers(markers: Markers, path: Path, roles: Roles | None) -> tuple[Motion | None, MarkersReport, list[str]]:
    """The fitted body, if one can be, the markers' report, and why no body could be fitted."""
    gaps = markers.gaps()
    longest = max((end - first for _, first, end in gaps), default=0) / markers.fps
    report = MarkersReport(list(markers.names), float(markers.seen.mean()), len(gaps), longest)
    try:
        fit = fitted(markers, path, roles)
    except BodyError as error:
        return None, report, [str(error)]
    report.residual_mm = round(fit.residual_mm, 3)
    return fit.motion, report, []


def _of_body(report: FileReport, motion: Motion) -> FileReport:
    skeleton = motion.skeleton
    ends = skeleton.end_sites
    report.joints = [name for name, end in zip(skeleton.names, ends, strict=True) if not end]
    report.ends = int(ends.sum())
    report.height = round(stature(motion), 4)
    width, depth = np.ptp(motion.root_positions[:, :2], axis=0).tolist()
    report.ground = [round(width, 4), round(depth, 4)]
    report.roles = [Role(r.role, r.joint or "", r.how or "", r.needed) for r in role_report(skeleton)]
    report.problems = [*report.problems, *problems(motion)]
    try:
        body = Body.of(skeleton)
    except BodyError:
        return report
    report.feet_at = round(floor_height(motion, body), 4)
    feet = foot_contacts(motion, body).feet
    report.contacts = [
        Contact(side, round(float(feet[:, k].mean()), 4), len(runs(feet[:, k]))) for k, side in enumerate(SIDES)
    ]
    return report
