"""Digests of the code that makes a library: what other code made is not mixed with what this code makes."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

_ROOT = Path(__file__).parents[1]
_READING = (
    *("formats/*.py", "formats/*/*.py", "motion/*.py", "keyposes/*.py", "moves/disk/layout.py"),
    *(f"moves/making/{name}.py" for name in ("clips", "placing", "stretches")),
    *(f"moves/{name}.py" for name in ("graph", "lazy", "library", "poses", "recordings")),
)
_JOINING = (
    *("moves/pairs/*.py", "moves/similarity.py", "moves/library.py"),
    *(f"moves/making/{name}.py" for name in ("groups", "joining")),
)
_REST = ("moves/graph.py", *(f"moves/making/{name}.py" for name in ("compose", "publish", "steps", "taken", "twins")))


@cache
def reading_method() -> str:
    """A digest of the code that reads motion and makes clips of it."""
    return _digest(_READING)


@cache
def joining_method() -> str:
    """A digest of the code that finds close pairs of frames."""
    return _digest(_JOINING)


@cache
def method_digest() -> str:
    """A digest of all code that a library depends on."""
    return _digest((*_READING, *_JOINING, *_REST))


def _digest(patterns: tuple[str, ...]) -> str:
    total = hashlib.sha256(version("onbeat").encode())
    for pattern in patterns:
        for file in sorted(_ROOT.glob(pattern)):
            total.update(file.read_bytes())
    return total.hexdigest()[:16]
