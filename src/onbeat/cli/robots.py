"""``onbeat robots``: the robots onbeat knows, and what the joints of one of them, or of a file, can do."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import cyclopts
import msgspec
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import warnings_as_lines
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits, robot_names
from onbeat.limits.read import read_limits
from onbeat.robots.description.toml import described, described_robots

VERSION = 1
_WIDE = 160
"""Characters of a line where no screen bounds it."""
_COLUMNS = ("joint", "low", "high", "speed", "acceleration", "jerk")


def robots_command(
    name: str | None = None,
    /,
    *,
    soft: Annotated[bool, cyclopts.Parameter(negative=())] = False,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """List the robots that are known by name, or what the joints of one can do: how far, how fast.

    Example: ``onbeat robots g1``

    Parameters
    ----------
    name
        One of the robots, or a file: URDF, MJCF, or TOML as docs/limits.md describes it.
    soft
        Of a URDF take the soft limits of its safety controllers.
    json
        Print JSON, in radians and seconds, instead of a table.
    """
    if name is None:
        _print_robots({robot: robot_limits(robot) for robot in robot_names()}, json)
        return
    with warnings_as_lines():
        limits = read_limits(name, soft) if _is_file(name) else robot_limits(name)
    _print_joints(name, limits, json)


def _is_file(name: str) -> bool:
    """A name with a folder or a suffix is a file's, whether it is there or not."""
    return bool(Path(name).suffix) or len(Path(name).parts) > 1 or Path(name).is_file()


def _print_robots(robots: Mapping[str, Limits], json: bool) -> None:
    rows = [_robot(name, limits) for name, limits in robots.items()]
    if json:
        _print_json({"version": VERSION, "robots": rows})
        return
    table = Table(box=None, pad_edge=False)
    for head in ("name", "robot", "joints", "slowest rad/s", "fastest rad/s", "model", "source"):
        table.add_column(head, justify="right" if head == "joints" else "left", overflow="fold")
    for row in rows:
        ends = (f"{row[end]['speed']:.4g} {row[end]['joint']}" for end in ("slowest", "fastest"))
        model = f"{row['model']['mass']:.1f} kg, to {row['model']['torque']:g} N·m" if row["model"] else "–"
        table.add_row(*map(Text, (row["name"], row["robot"], str(row["joints"]), *ends, model, row["source"])))
    _screen().print(table)


def _robot(name: str, limits: Limits) -> dict[str, Any]:
    """A robot in a line."""
    ends = {"slowest": int(limits.speed.argmin()), "fastest": int(limits.speed.argmax())}
    told = {end: {"joint": limits.joints[n], "speed": _number(limits.speed[n])} for end, n in ends.items()}
    model = _model(name)
    return {"name": name, "robot": limits.name, "joints": len(limits), **told, "model": model, "source": limits.source}


def _model(name: str) -> dict[str, float] | None:
    """Mass in kg and the largest torque in N·m of a robot of which there is a whole model, which can be simulated."""
    if name not in described_robots():
        return None
    links = described(name).links.values()
    return {"mass": _number(described(name).mass) or 0.0, "torque": max(link.torque for link in links)}


def _print_joints(name: str, limits: Limits, json: bool) -> None:
    arrays = (limits.low, limits.high, limits.speed, limits.acceleration, limits.jerk)
    rows = list(zip(limits.joints, *(array.tolist() for array in arrays), strict=True))
    if json:
        joints = [dict(zip(_COLUMNS, (row[0], *map(_number, row[1:])), strict=True)) for row in rows]
        _print_json({"version": VERSION, "name": name, "robot": limits.name, "source": limits.source, "joints": joints})
        return
    screen = _screen()
    screen.print(Text(f"{limits.name}: {len(limits)} joints"), Text(limits.source), sep="\n", soft_wrap=True)
    table = Table(box=None, pad_edge=False)
    heads = ("joint", "low rad", "high rad", "speed rad/s", "acceleration rad/s²", "jerk rad/s³")
    shown = [n for n in range(len(heads)) if n < 4 or any(math.isfinite(row[n]) for row in rows)]
    for n in shown:
        table.add_column(heads[n], justify="right" if n else "left")
    for row in rows:
        table.add_row(*(Text(_cell(row[n])) for n in shown))
    screen.print(table)


def _cell(value: str | float) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.4g}" if math.isfinite(value) else "–"


def _number(value: float) -> float | None:
    """JSON knows no infinity."""
    return round(float(value), 9) if math.isfinite(value) else None


def _screen() -> Console:
    """Stdout; tables that go to a file are not cut to a screen's width."""
    screen = Console(highlight=False)
    return screen if screen.is_terminal else Console(width=_WIDE, highlight=False)


def _print_json(document: dict[str, Any]) -> None:
    sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n")
