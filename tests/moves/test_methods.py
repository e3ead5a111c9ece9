"""What was made by other code is known by the digest of all code that it depends on."""

import ast
import fnmatch
from pathlib import Path

import pytest

from onbeat.moves import methods

ROOT = Path(methods.__file__).parents[1]
# what decides nothing of what is made: containers, transport, and what is told of recordings
NEUTRAL = {
    *(
        "moves/engine.py",
        "moves/engines/*.py",
        "moves/disk/index.py",
        "moves/disk/lock.py",
        "moves/methods.py",
        "moves/disk/shards.py",
        "moves/making/stock.py",
    ),
    *(
        "moves/disk/bodies.py",
        "moves/making/compact.py",
        "moves/making/generations.py",
        "moves/disk/graph_files.py",
        "moves/making/sweep.py",
    ),
    "moves/disk/undo.py",
}


def reached(file: Path, found: set[Path]) -> set[Path]:
    """A module and all of the rooms that are looked at which it imports, in whatever words."""
    found.add(file)
    for name in imported(file.read_text(encoding="utf-8")):
        other = ROOT.joinpath(*name.split(".")[1:]).with_suffix(".py")
        if name.startswith(("onbeat.moves.", "onbeat.motion.")) and other.exists() and other not in found:
            reached(other, found)
    return found


def imported(text: str) -> set[str]:
    """Names of all that may be a module in the imports of a program, wherever they stand."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}", *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    return names


@pytest.mark.parametrize(
    ("module", "names"),
    [
        ("making/placing", ("_READING", "_JOINING")),
        ("similarity", ("_JOINING",)),
        ("making/joining", ("_READING", "_JOINING")),
        ("making/publish", ("_READING", "_JOINING", "_REST")),
    ],
)
def test_every_module_that_is_used_is_in_the_digest(module, names):
    listed = {pattern for name in names for pattern in getattr(methods, name)} | NEUTRAL
    files = {path.relative_to(ROOT).as_posix() for path in reached(ROOT / "moves" / f"{module}.py", set())}
    missing = {file for file in files if not any(fnmatch.fnmatch(file, pattern) for pattern in listed)}
    assert not missing


def test_a_module_is_seen_however_it_is_imported():
    text = "from onbeat.moves import one\nimport onbeat.moves.two\ndef f():\n    from onbeat.moves.three import g"
    assert {"onbeat.moves.one", "onbeat.moves.two", "onbeat.moves.three"} <= imported(text)


def test_every_pattern_names_a_file():
    for pattern in (*methods._READING, *methods._JOINING, *methods._REST):
        assert list(ROOT.glob(pattern)), pattern
