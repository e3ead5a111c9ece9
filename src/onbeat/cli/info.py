"""``onbeat info``: what is in a motion file."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import cyclopts
import msgspec
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.capture.template import marker_template
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.formats import read_file
from onbeat.formats.conventions import Up
from onbeat.formats.report import FileReport, describe
from onbeat.motion import Motion
from onbeat.motion.role_file import read_roles, role_template


def info_command(
    file: Path,
    /,
    *,
    fps: SourceRate = None,
    up: Annotated[Up | None, cyclopts.Parameter(name=["--up", "--source-up"], allow_leading_hyphen=True)] = None,
    unit: Annotated[str | None, cyclopts.Parameter(name=["--unit", "--source-unit"])] = None,
    roles: Path | None = None,
    roles_template: Annotated[bool, cyclopts.Parameter(negative=())] = False,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Say what is in a motion file: body, rate, unit, roles, contacts, and what is wrong with it.

    Parameters
    ----------
    file
        A motion file of any kind that onbeat reads.
    fps
        The rate of its frames, where it stores none or a wrong one.
    up
        The axis that points up, where the guess is wrong; -y where Y points down.
    unit
        The unit of length, where the guess is wrong: m, cm, mm, dm, in, ft or cmu.
    roles
        A roles file (TOML) that says which joint or marker is what.
    roles_template
        Print a roles file for this body to edit, instead.
    json
        Print everything as JSON.
    """
    told = None if roles is None else read_roles(roles)
    if roles_template:
        with warnings_as_lines():
            found = read_file(file, fps, up, unit, told)
            whole = role_template(found.skeleton) if isinstance(found, Motion) else marker_template(found.names)
            sys.stdout.write(whole)
        return
    with warnings_as_lines(), Console(stderr=True).status(Text(f"reading {file.name}")):
        report = describe(file, fps, up, unit, told)
    if json:
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(report), indent=2).decode() + "\n")
    else:
        _print(report)


def _print(report: FileReport) -> None:
    console = Console(highlight=False)
    facts = Table(box=None, show_header=False, pad_edge=False)
    for name, value in _facts(report):
        facts.add_row(name, Text(value))
    console.print(facts, soft_wrap=True)
    if report.roles:
        console.print()
        console.print(_roles_table(report))
    for problem in report.problems:
        console.print(Text(f"! {problem}"), soft_wrap=True)
    if not report.problems:
        console.print("no problems found")


def _facts(report: FileReport) -> Iterator[tuple[str, str]]:
    yield "file", f"{report.file} ({report.format})"
    yield "time", f"{report.frames} frames at {report.fps:.6g} a second, {report.duration:.2f} s"
    for m in report.markers:
        yield "markers", f"{len(m.labels)}, {m.seen:.1%} seen, {m.gaps} gaps, the longest {m.longest_gap:.2f} s"
        yield "", ", ".join(m.labels[:40]) + (" …" if len(m.labels) > 40 else "")
        if m.residual_mm >= 0:
            yield "fit", f"the markers of the fitted body are {m.residual_mm:.1f} mm off (RMS)"
    if report.joints:
        yield "body", f"{len(report.joints)} joints, {report.ends} ends of bones, {report.height:.2f} m tall"
        width, depth = report.ground
        feet = f", feet at {report.feet_at:+.3f} m" if report.contacts else ""
        yield "ground", f"{width:.2f} × {depth:.2f} m{feet}"
    for contact in report.contacts:
        yield f"{contact.side} foot", f"rests {contact.share:.0%} of the time, put down {contact.times} times"
    for guess in report.guesses:
        yield guess.about, f"{guess.taken} ({guess.why})"


def _roles_table(report: FileReport) -> Table:
    table = Table("role", "joint", "found by", box=None, pad_edge=False)
    for role in report.roles:
        if role.joint:
            table.add_row(role.role, Text(role.joint), role.how)
        elif role.needed:
            table.add_row(role.role, "missing", "")
    return table
