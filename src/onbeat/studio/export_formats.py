"""The formats that a dance is exported in: what each is for, for whom, and which package it needs."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Literal, NamedTuple

from onbeat.errors import OnbeatError
from onbeat.studio.project import Project
from onbeat.studio.wire import DanceItem, ExportItem, FormatItem

G1 = "g1"
"""The robot that has formats of its own."""
FILM = "mp4"
"""The format of videos, which may be had in other sizes and with flashes."""


class ExportFormat(NamedTuple):
    """A format: its name, the ending of its files, what it is, who can be written in it, and what it needs."""

    name: str
    ending: str
    title: str
    who: Literal["all", "characters", "robots", "g1"] = "all"
    module: str = ""
    extra: str = ""


FORMATS = (
    ExportFormat("glb", ".glb", "GLB: Blender, Unity, web"),
    ExportFormat("bvh", ".bvh", "BVH: any animation program"),
    ExportFormat(FILM, ".mp4", "MP4: a video with the song", module="av", extra="video"),
    ExportFormat("html", ".html", "HTML: the page with the song, to send to others"),
    ExportFormat("npz", ".npz", "NPZ: onbeat's own, exact to the last bit"),
    ExportFormat("usd", ".usdc", "USD: Omniverse, Houdini, Maya", module="pxr", extra="usd"),
    ExportFormat("angles", ".angles.csv", "CSV: joint angles, for spreadsheets", "characters"),
    ExportFormat("csv", ".joints.csv", "CSV: the hinges' angles", "robots"),
    ExportFormat("g1csv", ".csv", "CSV as Unitree has it", G1),
    ExportFormat("tracking", ".tracking.npz", "NPZ for whole-body tracking", G1),
    ExportFormat("gmr", ".gmr.npz", "NPZ as GMR has it", G1),
    ExportFormat("mcap", ".mcap", "MCAP: JointTrajectory for ROS 2", "robots", "rosbags", "ros"),
    ExportFormat("json", ".json", "JSON: how the dance was put together, and its figures"),
    ExportFormat("song", ".song.json", "JSON: the song's beats, bars and intensity"),
)
"""All formats, those first that most ask for."""


def format_items() -> list[FormatItem]:
    """The formats as the page sees them."""
    return [FormatItem(known.name, known.title, known.who, _missing(known)) for known in FORMATS]


def format_for(name: str, dance: DanceItem) -> ExportFormat:
    """The format of a name, which has to suit the dance.

    Raises
    ------
    OnbeatError
        If there is none, it does not suit, or a package is missing for it.
    """
    found = next((known for known in FORMATS if known.name == name), None)
    if found is None:
        raise OnbeatError(f"no format {name!r}; there are {', '.join(known.name for known in FORMATS)}")
    suits = {"all": True, "characters": dance.robot is None, "robots": dance.robot is not None, G1: dance.robot == G1}
    if not suits[found.who]:
        raise OnbeatError(f"{found.title} is for {found.who}; {dance.name} is of {dance.robot or 'a character'}")
    if missing := _missing(found):
        raise OnbeatError(f"{found.title} needs a package that is not installed: pip install 'onbeat[{missing}]'")
    return found


def exported_file(project: Project, item: ExportItem) -> Path:
    """Where an export lies: its name there is none of the user's."""
    return project.place("exports", item.id) / kept_name(item.format)


def kept_name(name: str) -> str:
    """The name of a file of a format in its export's folder.

    Examples
    --------
    >>> kept_name("csv")
    'dance.joints.csv'
    """
    return "dance" + next(known.ending for known in FORMATS if known.name == name)


def _missing(known: ExportFormat) -> str:
    return known.extra if known.module and importlib.util.find_spec(known.module) is None else ""
