"""What ``onbeat retime`` reads: the dance, its beats and keyposes, and the limits."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from onbeat._shapes import Times
from onbeat.cli.keypose_input import told_beats
from onbeat.cli.time_flags import OwnFlags
from onbeat.errors import OnbeatError
from onbeat.formats.joint_table import is_joint_table, read_joint_table
from onbeat.formats.read import motion_files, read_motion
from onbeat.formats.robot_csv import is_robot_csv
from onbeat.limits.learned import learned_limits
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.limits.read import read_limits
from onbeat.retime.sources import Character, Robot, Source, Table, source_of
from onbeat.robots.description.toml import described_robots

MODELS = (".toml", ".urdf", ".xml", ".mjcf")
STEADY = 0.5  # s; beats of a table of angles that has none: only the layers' knots are on them


@dataclass(frozen=True)
class Dance:
    """A dance as it was: what moves, and its beats and keyposes in seconds of its own."""

    source: Source
    beats: Times
    keyposes: Times


def read_source(path: Path, fps: float | None, joints: list[str] | None) -> Source:
    """The dance in a file: a table of angles, a robot's motion, or a character's."""
    if path.suffix.lower() == ".csv" and is_joint_table(path) and not is_robot_csv(path):
        return source_of(read_joint_table(path, fps=fps), joints)
    return source_of(read_motion(path, fps=fps), joints)


def dance_of(source: Source, own: OwnFlags, locked: bool) -> Dance:
    """The dance with its beats and keyposes, told or its own; ``locked`` where its beats are to be on a music's.

    Raises
    ------
    OnbeatError
        If a table of angles, which has no body to read a pulse off, is to be on a music's beats and has none told.
    """
    if not isinstance(source, Table):
        return Dance(source, *own.of(source.motion))
    if own.beats or own.danced_to:
        return Dance(source, told_beats(own.flags), own.told_keyposes)
    if locked:
        raise OnbeatError(f"{source.name}: the beats of a table of angles are not found; give --beats or --danced-to")
    end = source.curve.knots.end
    print(f"no beats given: every {STEADY:g} s is taken for one", file=sys.stderr)  # noqa: T201
    return Dance(source, np.arange(0.0, end + 2 * STEADY, STEADY), own.told_keyposes)


def limits_for(source: Source, robot: str | None, paths: list[Path]) -> Limits:
    """The limits of a robot by name, of a file that tells them, or learned from motions, at last from the dance's own.

    Raises
    ------
    OnbeatError
        If both a robot and files are given, or a table of angles has neither.
    """
    if robot and paths:
        raise OnbeatError(f"--robot {robot} and --limits {paths[0]}: give one of them")
    if robot:
        return _of_robot(robot, source)
    if paths and paths[0].suffix.lower() in MODELS:
        if len(paths) > 1:
            raise OnbeatError(f"{len(paths)} files of limits; one of them is needed: {paths[0]}")
        return read_limits(paths[0])
    if isinstance(source, Character):
        examples = [source.motion] if not paths else [read_motion(path) for path in _motions(paths)]
        return learned_limits(examples, skeleton=source.motion.skeleton)
    if isinstance(source, Robot) and not paths:
        return robot_limits("g1")
    raise OnbeatError("the limits of a robot are not learned from motions; give --robot NAME or --limits FILE.toml")


def _of_robot(robot: str, source: Source) -> Limits:
    """A robot's limits; a character that has none of its joints is no robot, and is told what is meant."""
    limits = robot_limits(robot)
    if not isinstance(source, Character) or not set(source.joints).isdisjoint(limits.joints):
        return limits
    known = ", ".join(described_robots())
    raise OnbeatError(
        f"{source.name} is a character's motion and has no joint of {limits.name}: `onbeat robot` puts it on a robot "
        f"({known}), faster or to other music, too; without --robot the character keeps to its own speeds"
    )


def _motions(paths: list[Path]) -> list[Path]:
    out = list[Path]()
    for path in paths:
        out += motion_files(path) if path.is_dir() else [path]
    if not out:
        raise OnbeatError(f"no motion files found in {', '.join(map(str, paths))}")
    return out
