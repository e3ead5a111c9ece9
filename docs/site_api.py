"""Pages of the public Python names, room by room, from their docstrings."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import onbeat

ROOMS = {
    "motion": ("motion", "skeleton", "body", "markers", "features", "contacts", "edit", "retarget"),
    "music": ("listen", "song", "audio", "corrections", "causal"),
    "fetch": ("fetching",),
    "capture": ("fit", "gaps", "template"),
    "limits": ("limits", "named", "read", "learned"),
    "formats": ("read", "write", "registry", "report"),
    "keyposes": ("extract", "motion_tempo", "own", "segments"),
    "retime": ("retime", "meeting", "sources", "lock", "takes", "observe"),
    "metrics": ("evaluate", "beats", "feet", "intensity", "smoothness", "variety"),
    "examples": ("", "performer", "troupe"),
    "moves": ("library", "build", "cache", "store", "embedded"),
    "recognition": ("whole", "recogniser", "model_file", "labels", "pupil"),
    "robots": ("model", "on_robot", "perform", "simulate", "trial"),
    "dance": ("make", "wishes", "plan", "retimed"),
    "viewer": ("pages.page", "pages.dance", "pages.robot", "video", "sheet", "render.raster"),
    "live": ("rehearsed", "session", "cast"),
    "studio": ("serve", "app", "project"),
    "reproduce": ("run", "paper", "data", "result", "study.plans", "study.table"),
    "cli": ("commands",),
}
"""The modules that a program calls, by room, "" for the room's own; what else there is, ``ARCHITECTURE.md`` lists."""


def first_line(module: str) -> str:
    """What a module says of itself in its first sentence."""
    return (import_module(module).__doc__ or "").strip().split("\n", 1)[0]


def titled(text: str, line: str) -> str:
    """A heading of reStructuredText."""
    return f"{text}\n{line * len(text)}\n\n"


def own_names(module: str) -> list[str]:
    """The public functions, classes and documented values that are written in a module, in its order.

    Sphinx would find them itself, but it looks at all that is imported, too, and takes twice as long.
    """
    body = ast.parse(Path(inspect.getfile(import_module(module))).read_text(encoding="utf-8")).body
    found: list[str] = []
    for node, below in zip(body, [*body[1:], None], strict=True):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.append(node.name)
        elif isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            found += _assigned(node)
    return [name for name in found if not name.startswith("_")]


def _assigned(node: ast.stmt) -> Iterator[str]:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    for target in targets:
        yield from (name.id for name in ast.walk(target) if isinstance(name, ast.Name))


def room_page(room: str, modules: tuple[str, ...]) -> str:
    """The page of a room."""
    out = titled(room, "=") + first_line(f"onbeat.{room}") + "\n\n"
    for name in modules:
        module = f"onbeat.{room}.{name}".removesuffix(".")
        names = ", ".join(own_names(module))
        out += titled(module, "-") + f".. automodule:: {module}\n" + (f"   :members: {names}\n\n" if names else "\n")
    return out


def names_table() -> str:
    """What ``import onbeat`` gives: each name with its first sentence, where it is described behind it."""
    out = ".. list-table::\n   :widths: 30 70\n\n"
    for name in sorted(onbeat.__all__, key=str.lower):
        value = getattr(onbeat, name)
        if hasattr(value, "__module__"):
            role = "class" if isinstance(value, type) else "func"
            sentence = (value.__doc__ or "").strip().split("\n\n", 1)[0].replace("\n", " ").replace("|", r"\|")
            out += f"   * - :py:{role}:`{name} <{value.__module__}.{name}>`\n     - {sentence}\n"
    return out + "\n"


def front_page() -> str:
    """What ``import onbeat`` gives, and the rooms."""
    out = titled("Python names", "=") + "The API: what ``import onbeat`` gives (:doc:`examples <../python>`):\n\n"
    out += names_table() + "What is wrong and can be put right is one of these errors:\n\n"
    out += f".. automodule:: onbeat.errors\n   :members: {', '.join(own_names('onbeat.errors'))}\n\n"
    out += titled("Rooms", "-")
    out += "".join(f"- :doc:`{room}`: {first_line(f'onbeat.{room}')}\n" for room in ROOMS)
    return out + "\n.. toctree::\n   :hidden:\n   :caption: Rooms\n\n" + "".join(f"   {room}\n" for room in ROOMS)


def write_api(folder: Path) -> None:
    """Write the pages of all rooms into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "index.rst").write_text(front_page(), encoding="utf-8")
    for room, modules in ROOMS.items():
        (folder / f"{room}.rst").write_text(room_page(room, modules), encoding="utf-8")
