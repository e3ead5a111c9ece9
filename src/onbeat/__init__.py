"""onbeat puts motion on the beat: motion capture and a song in, a dance on the music out.

What a program calls is here, by its own name; ``docs/python.md`` has an example of each. What each part is made of is
in the rooms (``onbeat.motion``, ``onbeat.music``, …), whose names are never among these.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from onbeat.errors import OnbeatError

if TYPE_CHECKING:
    from onbeat.dance.make import Dance, make_dance
    from onbeat.dance.retimed import retime_motion
    from onbeat.dance.wishes import Kept, Wishes
    from onbeat.examples import embedded_motions, embedded_song
    from onbeat.formats import motion_files, read_markers, read_motion, write_markers, write_motion
    from onbeat.keyposes.extract import Keyposes, find_keyposes
    from onbeat.limits.learned import learned_limits
    from onbeat.limits.limits import Limits
    from onbeat.limits.named import robot_limits
    from onbeat.limits.read import read_limits
    from onbeat.live.rehearsed import dance_live, live_session
    from onbeat.live.session import Session
    from onbeat.metrics.evaluate import evaluate_motion
    from onbeat.motion import Body, Markers, Motion, Skeleton
    from onbeat.moves.build import build_library
    from onbeat.moves.cache import build_or_open
    from onbeat.moves.embedded import embedded_library
    from onbeat.moves.library import MoveLibrary
    from onbeat.moves.store import open_library
    from onbeat.music import Song, listen
    from onbeat.music.audio import read_stereo
    from onbeat.recognition.model_file import load_recogniser, save_recogniser
    from onbeat.recognition.recogniser import Recogniser
    from onbeat.recognition.whole import recognise, train_recogniser
    from onbeat.retime.observe import Observation, observe_takes
    from onbeat.retime.retime import Retimed
    from onbeat.retime.takes import Take
    from onbeat.robots.model import Robot, robot_from, robot_named
    from onbeat.robots.on_robot import dance_on_robot
    from onbeat.robots.perform import Staged
    from onbeat.robots.simulate import simulate
    from onbeat.viewer.pages.dance import write_dance_page
    from onbeat.viewer.pages.page import write_page
    from onbeat.viewer.sheet import contact_sheet
    from onbeat.viewer.video import write_video

__all__ = [
    "Body",
    "Dance",
    "Kept",
    "Keyposes",
    "Limits",
    "Markers",
    "Motion",
    "MoveLibrary",
    "Observation",
    "OnbeatError",
    "Recogniser",
    "Retimed",
    "Robot",
    "Session",
    "Skeleton",
    "Song",
    "Staged",
    "Take",
    "Wishes",
    "__version__",
    "build_library",
    "build_or_open",
    "contact_sheet",
    "dance_live",
    "dance_on_robot",
    "embedded_library",
    "embedded_motions",
    "embedded_song",
    "evaluate_motion",
    "find_keyposes",
    "learned_limits",
    "listen",
    "live_session",
    "load_recogniser",
    "make_dance",
    "motion_files",
    "observe_takes",
    "open_library",
    "read_limits",
    "read_markers",
    "read_motion",
    "read_stereo",
    "recognise",
    "retime_motion",
    "robot_from",
    "robot_limits",
    "robot_named",
    "save_recogniser",
    "simulate",
    "train_recogniser",
    "write_dance_page",
    "write_markers",
    "write_motion",
    "write_page",
    "write_video",
]
__version__ = "0.1.0"

_ROOMS = {
    "dance.make": ("Dance", "make_dance"),
    "dance.retimed": ("retime_motion",),
    "dance.wishes": ("Kept", "Wishes"),
    "examples": ("embedded_motions", "embedded_song"),
    "formats": ("motion_files", "read_markers", "read_motion", "write_markers", "write_motion"),
    "keyposes.extract": ("Keyposes", "find_keyposes"),
    "limits.learned": ("learned_limits",),
    "limits.limits": ("Limits",),
    "limits.named": ("robot_limits",),
    "limits.read": ("read_limits",),
    "live.rehearsed": ("dance_live", "live_session"),
    "live.session": ("Session",),
    "metrics.evaluate": ("evaluate_motion",),
    "motion": ("Body", "Markers", "Motion", "Skeleton"),
    "moves.build": ("build_library",),
    "moves.cache": ("build_or_open",),
    "moves.embedded": ("embedded_library",),
    "moves.library": ("MoveLibrary",),
    "moves.store": ("open_library",),
    "music": ("Song", "listen"),
    "music.audio": ("read_stereo",),
    "recognition.model_file": ("load_recogniser", "save_recogniser"),
    "recognition.recogniser": ("Recogniser",),
    "recognition.whole": ("recognise", "train_recogniser"),
    "retime.observe": ("Observation", "observe_takes"),
    "retime.retime": ("Retimed",),
    "retime.takes": ("Take",),
    "robots.model": ("Robot", "robot_from", "robot_named"),
    "robots.on_robot": ("dance_on_robot",),
    "robots.perform": ("Staged",),
    "robots.simulate": ("simulate",),
    "viewer.pages.dance": ("write_dance_page",),
    "viewer.pages.page": ("write_page",),
    "viewer.sheet": ("contact_sheet",),
    "viewer.video": ("write_video",),
}
_ON_DEMAND = {name: f"onbeat.{module}" for module, names in _ROOMS.items() for name in names}
"""Imported when first asked for, so that ``import onbeat`` stays quick."""


def __getattr__(name: str) -> Any:
    if name not in _ON_DEMAND:
        raise AttributeError(f"module 'onbeat' has no attribute {name!r}")
    return getattr(import_module(_ON_DEMAND[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
