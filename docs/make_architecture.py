"""Writes the table in ``ARCHITECTURE.md`` from what modules say of themselves: ``python docs/make_architecture.py``."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "ARCHITECTURE.md"
SOURCE = ROOT / "src" / "onbeat"
ROOMS = (
    "motion", "music", "fetch", "capture", "limits", "formats", "keyposes", "retime", "metrics", "examples", "moves",
    "recognition", "robots", "dance", "viewer", "live", "studio", "reproduce",
    "cli",
)  # fmt: skip
"""In the order of the floors."""
BEGIN, END = "<!-- modules: written by docs/make_architecture.py -->\n", "<!-- end of modules -->\n"


def first_sentence(path: Path) -> str:
    """What a module says it is: the first paragraph of its docstring, in Markdown."""
    paragraph = (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").partition("\n\n")[0]
    return re.sub(r":\w+:`([^`]*)`", r"`\1`", " ".join(paragraph.split())).replace("``", "`").replace("|", "\\|")


def rooms() -> Iterator[tuple[str, list[Path]]]:
    """Each room and its modules; the ground floor first, then rooms that ``ROOMS`` does not know last."""
    yield "", sorted(path for path in SOURCE.glob("*.py") if path.stem != "__init__")
    found = {path.parent.name for path in SOURCE.glob("*/__init__.py")}
    for room in [*(r for r in ROOMS if r in found), *sorted(found - set(ROOMS))]:
        yield room, sorted(path for path in (SOURCE / room).glob("*.py") if path.stem != "__init__")


def table() -> str:
    """The table as Markdown."""
    rows = ["| module | what it does |", "|---|---|"]
    for room, modules in rooms():
        if room:
            rows.append(f"| **`{room}/`** | **{first_sentence(SOURCE / room / '__init__.py')}** |")
        rows += [f"| `{path.relative_to(SOURCE).as_posix()}` | {first_sentence(path)} |" for path in modules]
        for inner in sorted((SOURCE / room).glob("*/__init__.py")) if room else ():
            rows.append(f"| *`{inner.parent.relative_to(SOURCE).as_posix()}/`* | *{first_sentence(inner)}* |")
            inside = sorted(path for path in inner.parent.glob("*.py") if path != inner)
            rows += [f"| `{path.relative_to(SOURCE).as_posix()}` | {first_sentence(path)} |" for path in inside]
    return "\n".join(rows) + "\n"


def renewed(page: str) -> str:
    """The page with the table as it is now."""
    head, _, rest = page.partition(BEGIN)
    return head + BEGIN + table() + END + rest.partition(END)[2]


if __name__ == "__main__":
    PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
