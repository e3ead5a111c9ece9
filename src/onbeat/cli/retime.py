"""``onbeat retime``: the same dance to faster or slower music, inside the body's limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import cyclopts
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.retime_input import Dance, dance_of, limits_for, read_source
from onbeat.cli.retime_output import write_all
from onbeat.cli.time_flags import NO_OWN, NO_TIME, OwnFlags, TimeFlags, When
from onbeat.errors import OnbeatError
from onbeat.limits.limits import Limits
from onbeat.retime.document import RetimeDocument, retime_document
from onbeat.retime.meeting import Meeting
from onbeat.retime.retime import Retimed, retime

Method = Literal["qp", "layers-qp", "layers2007", "pollard2002", "clamp", "uniform"]
Flag = Annotated[bool, cyclopts.Parameter(negative=())]
SHOWN = 8


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class LimitFlags:
    """Inside what the dance has to stay.

    Parameters
    ----------
    robot
        A robot's limits by name: g1, hrp4c, talos, h1, nao (``onbeat robots``).
    limits
        A file of limits (TOML, URDF, MJCF); or, for a character, motions or folders of them: as fast as each joint ever
        moves there. Without either as fast as each joint ever moves in the dance itself.
    margin
        Share of the speeds that is used: 0.9 leaves a tenth.
    joints
        Of a character the joints that are held inside limits; all above the legs without it.
    """

    robot: str | None = None
    limits: Annotated[list[Path], cyclopts.Parameter(negative=(), consume_multiple=True)] | None = None
    margin: float = 1.0
    joints: Annotated[list[str], cyclopts.Parameter(negative=(), consume_multiple=True)] | None = None


FREE = LimitFlags()


def retime_command(
    motion: Path,
    /,
    *,
    time: TimeFlags = NO_TIME,
    own: OwnFlags = NO_OWN,
    limits: LimitFlags = FREE,
    method: Method = "qp",
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("retimed"),
    fps: float | None = None,
    figure: str | None = None,
    json: Flag = False,
) -> None:
    """Play a dance faster or slower, or to other music, inside the body's limits; keyposes stay where they are.

    Example: ``onbeat retime dance.csv --robot g1 --speed 1.2 -o faster``

    Parameters
    ----------
    motion
        The dance: any motion file, a Unitree G1's CSV, or a table of joint angles (CSV with a heading).
    time
        The time that it is to be in.
    own
        Its own time.
    limits
        Inside what it has to stay.
    method
        qp: the nearest to the dance. layers-qp, layers2007: by the paper's layers. The others are what others do.
    output
        A folder for the motion, retime.json, two figures and retime.html; or the motion's file, the rest beside it.
    fps
        Frames a second of the retimed motion; as the dance without it.
    figure
        The joint that the figure shows; the one that is changed most without it.
    json
        Print retime.json on stdout instead of a table.
    """
    time.check()
    if time.speed is None and time.music is None:
        raise OnbeatError("give --speed, how much faster, or --music, the song to dance to")
    if fps is not None and not (math.isfinite(fps) and 1 <= fps <= 1000):
        raise OnbeatError(f"--fps {fps:g}: give 1 to 1000 frames a second")
    with warnings_as_lines():
        source = read_source(motion, own.source_fps, limits.joints)
        known = limits_for(source, limits.robot, limits.limits or []).scaled(limits.margin)
        dance = dance_of(source, own.beside(motion), time.music is not None)
        when = When.of(dance.beats, time)
        result = _retimed(dance, known, method, fps, when)
        document = retime_document(result)
        written = write_all(result, document, motion, output, when.music, figure)
    if json:
        Console(width=1 << 20, highlight=False).out(document.to_json().decode(), end="")
        return
    _print(result, document, when.met)
    print(f"written: {', '.join(str(path) for path in written)}")  # noqa: T201


def _retimed(dance: Dance, limits: Limits, method: str, fps: float | None, when: When) -> Retimed:
    with Stages() as stages:
        return retime(
            dance.source,
            when.warp,
            limits,
            dance.beats,
            dance.keyposes,
            method,
            fps,
            when.until,
            lambda share: stages(method, share),
        )


def _print(result: Retimed, document: RetimeDocument, met: Meeting | None) -> None:
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=240)
    table = Table(box=None, pad_edge=False, show_header=False)
    kept = document.violations
    rows = {
        "method": f"{document.method}, {len(document.joints)} joints inside {_whose(document.limits)}",
        "speed": f"{document.speed:.3g} ×" + _folded(met),
        "past limits": f"{kept.position} joints in position, {kept.velocity} in velocity (at 1 kHz)",
        "from the dance": f"{document.rms_deg:.2f}° rms, {document.keypose_error_deg:.2f}° at the worst keypose",
        "acceleration": f"{document.peak_acceleration:.0f} rad/s² at most",
    }
    if met is not None:
        late = result.warp.inverse(met.dance) - met.music
        rows["beats"] = (
            f"{len(late)} of the dance on the music's, {1000 * float(np.abs(late).max()):.1f} ms off at most"
        )
    for name, text in rows.items():
        table.add_row(Text(name), Text(text))
    screen.print(table)
    if not document.feasible:
        _print_missed(screen, document)


def _whose(name: str) -> str:
    return name if "limits" in name else f"the limits of {name}"


def _folded(met: Meeting | None) -> str:
    if met is None or met.fold == 1:
        return ""
    return f"; a beat of the dance lasts {met.fold:g} of the music's"


def _print_missed(screen: Console, document: RetimeDocument) -> None:
    """What cannot be done: by joint, when, and at which speed it could."""
    joints: dict[str, list[str]] = {}
    for one in document.missed:
        joints.setdefault(one.joint, []).append(
            f"{one.time:.2f} s ({one.error_deg:.1f}°{', range' if one.why == 'range' else ''})"
        )
    screen.print(Text(f"{len(document.missed)} keyposes are not kept; this is the nearest that can be done:"))
    for joint, times in sorted(joints.items(), key=lambda item: -len(item[1]))[:SHOWN]:
        more = f" and {len(times) - SHOWN} more" if len(times) > SHOWN else ""
        screen.print(Text(f"  {joint}: {', '.join(times[:SHOWN])}{more}"))
    if len(joints) > SHOWN:
        screen.print(Text(f"  and {len(joints) - SHOWN} more joints (retime.json has all)"))
    if document.speed_that_would_do is None:
        screen.print(Text("there is no speed from a fifth of this one on at which all joints had the time"))
    elif any(one.why == "speed" for one in document.missed):
        screen.print(Text(f"at speed {document.speed_that_would_do:.3g} all joints have the time"))
