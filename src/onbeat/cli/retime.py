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

from onbeat.cli.keypose_input import BeatFlags
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.retime_input import Dance, Music, limits_for, read_dance_of, read_music, read_source
from onbeat.cli.retime_output import write_all
from onbeat.errors import OnbeatError
from onbeat.limits.limits import Limits
from onbeat.retime.document import RetimeDocument, retime_document
from onbeat.retime.lock import TimeMap
from onbeat.retime.meeting import Meeting, meet
from onbeat.retime.retime import Retimed, retime

Method = Literal["qp", "layers-qp", "layers2007", "pollard2002", "clamp", "uniform"]
Flag = Annotated[bool, cyclopts.Parameter(negative=())]
SPEEDS = (0.1, 10.0)
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
    speed: float | None = None,
    music: Path | None = None,
    first_beat: int | None = None,
    limits: LimitFlags = FREE,
    method: Method = "qp",
    output: Annotated[Path, cyclopts.Parameter(name=["-o", "--output"])] = Path("retimed"),
    danced_to: Path | None = None,
    beats: Path | None = None,
    song_at: float = 0.0,
    keyposes: Path | None = None,
    fps: float | None = None,
    source_fps: float | None = None,
    figure: str | None = None,
    json: Flag = False,
) -> None:
    """Play a dance faster or slower, or to other music, inside the body's limits; keyposes stay where they are.

    Example: ``onbeat retime dance.csv --robot g1 --speed 1.2 -o faster``

    Parameters
    ----------
    motion
        The dance: any motion file, a Unitree G1's CSV, or a table of joint angles (CSV with a heading).
    speed
        How much faster.
    music
        The song to dance to, or its beats (song.json or a list); beat by beat, through changes of tempo.
    first_beat
        The music's beat, from 0, on which the dance's first is; the first downbeat without it.
    limits
        Inside what it has to stay.
    method
        qp: the nearest to the dance. layers-qp, layers2007: by the paper's layers. The others are what others do.
    output
        A folder for the motion, retime.json, retime.png and retime.html; or the motion's file, with the rest beside it.
    danced_to
        The song that the dance was danced to; its beats are heard. Without it and --beats the motion's own pulse.
    beats
        The beats of the dance: a file with a time a line, or a song.json.
    song_at
        Second of the motion at which --danced-to or --beats begin.
    keyposes
        A keyposes.json; without it they are found.
    fps
        Frames a second of the retimed motion; as the dance without it.
    source_fps
        Frames a second of a dance that stores none.
    figure
        The joint that the figure shows; the one that is changed most without it.
    json
        Print retime.json on stdout instead of a table.
    """
    if (speed is None) == (music is None):
        raise OnbeatError("give --speed, how much faster, or --music, the song to dance to, one of them")
    if speed is not None and not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise OnbeatError(f"--speed {speed:g}: give {SPEEDS[0]:g} to {SPEEDS[1]:g}; 1.2 is a fifth faster")
    if fps is not None and not (math.isfinite(fps) and 1 <= fps <= 1000):
        raise OnbeatError(f"--fps {fps:g}: give 1 to 1000 frames a second")
    with warnings_as_lines():
        source = read_source(motion, source_fps, limits.joints)
        known = limits_for(source, limits.robot, limits.limits or []).scaled(limits.margin)
        flags = BeatFlags(danced_to, beats, song_at, source_fps)
        dance = read_dance_of(source, flags, keyposes)
        song = None if music is None else read_music(music, first_beat)
        met = None if song is None else meet(dance.beats, song.beats, song.first)
        result = _retimed(dance, known, method, fps, speed, song, met)
        document = retime_document(result)
        written = write_all(result, document, motion, output, song, figure)
    if json:
        Console(width=1 << 20, highlight=False).out(document.to_json().decode(), end="")
        return
    _print(result, document, met)
    print(f"written: {', '.join(str(path) for path in written)}")  # noqa: T201


def _retimed(
    dance: Dance,
    limits: Limits,
    method: str,
    fps: float | None,
    speed: float | None,
    song: Music | None,
    met: Meeting | None,
) -> Retimed:
    warp = TimeMap.steady(speed or 1.0) if met is None else met.warp
    until = np.inf if song is None else song.until
    with Stages() as stages:
        return retime(
            dance.source,
            warp,
            limits,
            dance.beats,
            dance.keyposes,
            method,
            fps,
            until,
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
