"""Pages of the public Python names, room by room, from their docstrings."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import onbeat

ROOMS = {
    "motion": ("motion", "skeleton", "body", "markers", "features", "contacts", "edit", "retarget"),
    "music": ("listen", "song", "corrections", "causal"),
    "fetch": ("fetching",),
    "formats": ("read", "write", "registry", "report"),
    "limits": ("limits", "named", "read", "learned"),
    "keyposes": ("extract", "motion_tempo", "segments"),
    "retime": ("retime", "sources", "lock"),
    "metrics": ("beats", "feet", "intensity", "smoothness", "variety"),
    "examples": ("performer", "troupe"),
    "moves": ("library", "build", "embedded"),
    "recognition": ("recogniser", "labels", "pupil"),
    "robots": ("model", "perform", "simulate"),
    "dance": ("make", "wishes", "plan"),
    "viewer": ("dance_page", "video", "sheet", "raster"),
    "live": ("session", "cast"),
}
"""The modules that a program calls, by room; what else there is, ``ARCHITECTURE.md`` lists."""


def first_line(module: str) -> str:
    """What a module says of itself in its first sentence."""
    return (import_module(module).__doc__ or "").strip().split("\n", 1)[0]


def titled(text: str, line: str) -> str:
    """A heading of reStructuredText."""
    return f"{text}\n{line * len(text)}\n\n"


def room_page(room: str, modules: tuple[str, ...]) -> str:
    """The page of a room."""
    out = titled(room, "=") + first_line(f"onbeat.{room}") + "\n\n"
    for name in modules:
        module = f"onbeat.{room}.{name}"
        out += titled(module, "-") + f".. automodule:: {module}\n   :members:\n\n"
    return out


def front_page() -> str:
    """What ``import onbeat`` gives, and the rooms."""
    out = titled("Python names", "=") + "What ``import onbeat`` gives, and where it is described:\n\n"
    for name in onbeat.__all__:
        value = getattr(onbeat, name)
        if hasattr(value, "__module__"):
            role = "class" if isinstance(value, type) else "func"
            out += f"- :py:{role}:`onbeat.{name} <{value.__module__}.{name}>`\n"
    out += "\nErrors that a user can put right:\n\n.. automodule:: onbeat.errors\n   :members:\n\n"
    return out + ".. toctree::\n   :caption: Rooms\n\n" + "".join(f"   {room}\n" for room in ROOMS)


def write_api(folder: Path) -> None:
    """Write the pages of all rooms into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "index.rst").write_text(front_page(), encoding="utf-8")
    for room, modules in ROOMS.items():
        (folder / f"{room}.rst").write_text(room_page(room, modules), encoding="utf-8")
