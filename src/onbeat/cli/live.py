"""``onbeat live``: the sound feedback system: it hears music as it happens, and dances on it."""

from __future__ import annotations

import json as json_module
import shlex
from dataclasses import dataclass
from pathlib import Path

import cyclopts

from onbeat.cli.live_flags import NO_BODY, NO_HEAR, NO_SEND, BodyFlags, Flag, HearFlags, SendFlags
from onbeat.cli.live_show import Show
from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.swapped import looks_like_sound
from onbeat.errors import OnbeatError

PACES = (0.1, 100.0)


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class KeepFlags:
    """What is kept of it, and danced again.

    Parameters
    ----------
    record
        Keep what is heard and told in this folder.
    replay
        Dance again what a folder has kept, to the bit.
    """

    record: Path | None = None
    replay: Path | None = None


NOTHING_KEPT = KeepFlags()


def live_command(
    *motions: Path,
    hear: HearFlags = NO_HEAR,
    body: BodyFlags = NO_BODY,
    send: SendFlags = NO_SEND,
    keep: KeepFlags = NOTHING_KEPT,
    seconds: float | None = None,
    speed_up: float = 1.0,
    calibrate: Flag = False,
    inputs: Flag = False,
    json: Flag = False,
) -> None:
    """Hear music as it happens and dance on it: poses a hundred times a second, for a page, OSC, MIDI, a robot.

    Example: ``onbeat live --input mic --osc 127.0.0.1:9000``

    Parameters
    ----------
    motions
        Choreographies to follow, one after the other; without any the dance is made up from the embedded troupe's
        moves, or those of --moves.
    hear
        What is heard.
    body
        Who dances.
    send
        Where it goes.
    keep
        What is kept of it.
    seconds
        End after so many; by default when the song is over, or by Ctrl-C.
    speed_up
        Let time go so many times as fast, to try things (not with a microphone).
    calibrate
        Play clicks and hear them: how late sound is, out and in together.
    inputs
        List the inputs of the sound card.
    json
        Print how it went as JSON.
    """
    if inputs or calibrate:
        from onbeat.cli.live_card import tell_card

        tell_card(calibrate, json)
        return
    hear.check()
    send.check()
    _check(motions, hear, body, keep, seconds, speed_up)
    show = Show(send, speed_up, seconds, quiet=json)
    with warnings_as_lines():
        told = show.again(keep.replay) if keep.replay else show.live(motions, hear, body, keep.record)
    if json:
        print(json_module.dumps(told))  # noqa: T201


def _check(
    motions: tuple[Path, ...],
    hear: HearFlags,
    body: BodyFlags,
    keep: KeepFlags,
    seconds: float | None,
    speed_up: float,
) -> None:
    for path in motions:
        if looks_like_sound(path):
            raise OnbeatError(f"{path} is a song, no choreography; give `onbeat live --input {shlex.quote(str(path))}`")
    if seconds is not None and not 0 < seconds < float("inf"):
        raise OnbeatError(f"--seconds {seconds:g}: give more than 0")
    if not PACES[0] <= speed_up <= PACES[1]:
        raise OnbeatError(f"--speed-up {speed_up:g}: give {PACES[0]:g} to {PACES[1]:g}")
    if speed_up != 1 and hear.input == "mic":
        raise OnbeatError(f"--speed-up {speed_up:g}: the time of a microphone cannot go faster; give a song")
    told = motions or keep.record is not None or hear != NO_HEAR or body != NO_BODY
    if keep.replay is not None and told:
        raise OnbeatError("--replay dances again what was kept, as it was: give it without motions and other flags")
