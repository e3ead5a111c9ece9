"""The plan of the house holds: imports run downwards, files stay small, names say what they are."""

from __future__ import annotations

import ast
import re
import statistics
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "onbeat"
FILES = sorted(SOURCE.rglob("*.py"))

FLOORS = (
    {"errors", "_shapes", "files", "quadratic"},
    {"motion", "music", "fetch"},
    {"capture", "limits"},
    {"formats", "keyposes", "retime", "metrics", "examples"},
    {"moves", "recognition", "robots"},
    {"dance"},
    {"viewer"},
    {"live"},
    {"studio", "reproduce"},
    {"cli"},
)
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
ON_THE_GROUND = {"files": {"errors"}, "quadratic": {"_shapes"}}
"""The modules of the ground floor may know each other in this order only."""
VAGUE_NAMES = {"utils", "util", "helpers", "helper", "common", "manager", "misc", "tools", "process"}
LONGEST, MEDIAN, MEDIAN_FUNCTION = 400, 150, 12
NOT_BY_ITSELF = ("numba", "matplotlib", "scipy.signal", "scipy.ndimage", "rich", "cyclopts", "av")
"""What ``import onbeat`` must not import: each takes long, and many uses do without."""


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), name_of(path))


def room_of(path: Path) -> str:
    """The folder below ``onbeat``, or the module's own name; empty for the package itself."""
    inside = path.relative_to(SOURCE).with_suffix("").parts
    return "" if inside == ("__init__",) else inside[0]


def imported_rooms(path: Path) -> Iterator[tuple[int, str]]:
    """Line and room of every import of onbeat, wherever in the file it is; the room is empty for ``import onbeat``."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name_of(path)}:{node.lineno}: imports are absolute"
            module = node.module or ""
            names = [f"onbeat.{alias.name}" for alias in node.names] if module == "onbeat" else [module]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            # A command that is named by its path is imported when it is called.
            names = [node.value.partition(":")[0]] if re.fullmatch(r"onbeat(\.\w+)+:\w+", node.value) else []
        else:
            continue
        yield from ((node.lineno, [*name.split("."), ""][1]) for name in names if name.split(".")[0] == "onbeat")


def allowed(room: str, other: str) -> bool:
    """Whether a room may import another."""
    if room == "" or room == other:
        return True  # the public API gathers from all floors
    if other == "":
        return room == "cli"
    if FLOOR[room] == FLOOR[other] == 0:
        return other in ON_THE_GROUND.get(room, ())
    return FLOOR[other] < FLOOR[room]


def functions(path: Path) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    return (n for n in ast.walk(tree(path)) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef))


def lines_of(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines of a function without its docstring."""
    first = function.body[0]
    documented = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    docstring = first.end_lineno - first.lineno + 1 if documented else 0
    return function.end_lineno - function.lineno + 1 - docstring


def test_every_room_has_a_floor():
    rooms = {room_of(path) for path in FILES} - {"", "__main__"}
    assert rooms <= set(FLOOR), f"no floor is known for {sorted(rooms - set(FLOOR))}: give it one in FLOORS"


def test_imports_run_downwards():
    upwards = [
        f"{name_of(path)}:{line}: {room_of(path)} imports {other or 'onbeat itself'}"
        for path in FILES
        for line, other in imported_rooms(path)
        if not allowed(room_of(path), other.removesuffix(".py"))
    ]
    assert not upwards, "\n".join(upwards)


def test_inside_a_room_imports_never_run_in_circles_between_folders():
    arrows: dict[tuple[str, str], set[str]] = {}
    for path in FILES:
        room, *below = path.relative_to(SOURCE).with_suffix("").parts
        for node in ast.walk(tree(path)) if below else ():
            known = isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"onbeat.{room}.")
            if known and (other := node.module.split(".")[2]) != below[0]:
                arrows.setdefault((room, below[0]), set()).add(other)
    order = {room: TopologicalSorter({a: b for (r, a), b in arrows.items() if r == room}) for room, _ in arrows}
    for room, sorter in order.items():
        try:
            sorter.prepare()
        except CycleError as error:
            raise AssertionError(f"{room}: {' imports '.join(reversed(error.args[1]))}") from None


@pytest.mark.parametrize(
    ("room", "other", "good"),
    [
        ("dance", "moves", True),
        ("moves", "dance", False),
        ("motion", "music", False),
        ("formats", "metrics", False),
        ("viewer", "live", False),
        ("motion", "", False),
        ("cli", "", True),
        ("files", "errors", True),
        ("errors", "files", False),
    ],
)
def test_the_rule_of_the_floors(room: str, other: str, good: bool):
    assert allowed(room, other) is good


def test_files_are_small():
    lengths = {name_of(path): len(path.read_text(encoding="utf-8").splitlines()) for path in FILES}
    long = {name: length for name, length in lengths.items() if length >= LONGEST}
    assert not long, f"longer than {LONGEST} lines; give each idea a file of its own: {long}"
    assert statistics.median(lengths.values()) <= MEDIAN


def test_functions_are_small():
    assert statistics.median(lines_of(function) for path in FILES for function in functions(path)) <= MEDIAN_FUNCTION


def test_folders_are_at_most_two_deep():
    deep = [name_of(path) for path in FILES if len(path.relative_to(SOURCE).parts) > 3]
    assert not deep


def test_names_say_what_they_are():
    vague = [
        name_of(path) for path in FILES if VAGUE_NAMES & set(re.split(r"[/_.]", path.relative_to(SOURCE).as_posix()))
    ]
    assert not vague, f"name them after what they do: {vague}"


def documented_names(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, ast.stmt, bool]]:
    """Public functions, classes and their methods, and whether they have a docstring."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield prefix + node.name, node, ast.get_docstring(node) is not None
            if isinstance(node, ast.ClassDef):
                yield from documented_names(node.body, f"{node.name}.")


def test_every_public_name_is_documented():
    silent = [
        f"{name_of(path)}:{node.lineno}: {name}"
        for path in FILES
        for name, node, documented in documented_names(tree(path).body)
        if not documented
    ]
    assert not silent, "without a docstring:\n" + "\n".join(silent)


def test_every_file_says_what_it_is():
    silent = [name_of(path) for path in FILES if len(ast.get_docstring(tree(path)) or "") < 16]
    assert not silent, f"without a docstring that says something: {silent}"


def test_nothing_is_unpickled():
    unsafe = re.compile(r"import pickle\b|\bpickle\.|allow_pickle=True|\bjoblib\.load|\bshelve\b")
    assert not [name_of(path) for path in FILES if unsafe.search(path.read_text(encoding="utf-8"))]


def test_no_paths_of_one_machine():
    home = re.compile(r"(?<![\w.~])/(?:home|Users|root|work|mnt)/\w")
    kept = [*FILES, *(ROOT / "tests").rglob("*.py"), *(ROOT / "docs").rglob("*.*"), *ROOT.glob("*.md")]
    kept += [
        *(ROOT / "benchmarks").rglob("*.py"),
        ROOT / "pyproject.toml",
        ROOT / ".ci" / "run",
        ROOT / "scripts" / "check",
    ]
    text = [path for path in kept if path.suffix not in (".gif", ".png", ".pyc", ".webp")]
    assert not [name_of(path) for path in text if home.search(path.read_text(encoding="utf-8"))]


def test_importing_onbeat_is_quick():
    code = "import onbeat, sys; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not set(NOT_BY_ITSELF) & set(loaded), "import these where they are used, or onbeat's names on demand"


def test_tests_mirror_the_source():
    beside = {"blender", "browser", "fuzz", "golden", "laws", "gallery"}
    rooms = {path.name for path in SOURCE.iterdir() if path.is_dir() and path.name != "__pycache__"}
    tests = {path.parent.relative_to(ROOT / "tests").parts[0] for path in (ROOT / "tests").rglob("*/test_*.py")}
    assert tests <= rooms | beside, f"tests of rooms that are not: {sorted(tests - rooms - beside)}"
    assert rooms <= tests, f"rooms without tests: {sorted(rooms - tests)}"
