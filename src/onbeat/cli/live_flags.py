"""Flags of ``onbeat live``: what is heard, who dances, and where it goes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import cyclopts

from onbeat.cli.source_rate import SourceRate
from onbeat.errors import OnbeatError
from onbeat.music.tempo import FASTEST, SLOWEST

Flag = Annotated[bool, cyclopts.Parameter(negative=())]
LONGEST_LATENCY = 2000.0


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class HearFlags:
    """What is heard.

    Parameters
    ----------
    input
        mic: a microphone or any input of the sound card; or a song file, played at its own pace. Without it the
        embedded song.
    device
        Of mic: the input's number, or a part of its name (--inputs lists them).
    loop
        Begin a song file again at its end.
    latency
        Milliseconds from a sound until the pose that is on it is seen; --calibrate measures a part of it.
    midi_in
        A MIDI port whose clock gives the beats.
    tempo
        Slowest and fastest tempo to dance in, beats per minute: 70-140; from 40 to 240.
    """

    input: str | None = None
    device: str | None = None
    loop: Flag = False
    latency: float = 0.0
    midi_in: str | None = None
    tempo: str = "70-140"

    def check(self) -> None:
        """Refuse what cannot be, before anything is opened."""
        if not 0 <= self.latency <= LONGEST_LATENCY:
            raise OnbeatError(f"--latency {self.latency:g}: give 0 to {LONGEST_LATENCY:g} milliseconds")
        _ = self.tempi
        if self.input not in (None, "mic") and not Path(self.input).is_file():
            raise OnbeatError(f"--input {self.input}: no such file; give a song, or mic for the sound card")
        if self.device is not None and self.input != "mic":
            raise OnbeatError(f"--device {self.device}: it is an input of the sound card; give --input mic with it")

    @property
    def tempi(self) -> tuple[float, float]:
        """Slowest and fastest."""
        try:
            low, high = (float(part) for part in self.tempo.split("-"))
        except ValueError:
            raise OnbeatError(f"--tempo {self.tempo}: give two numbers, such as 70-140") from None
        if not SLOWEST <= low < high <= FASTEST:
            raise OnbeatError(f"--tempo {self.tempo}: give two rising numbers from {SLOWEST:g} to {FASTEST:g}")
        return low, high


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class BodyFlags:
    """Who dances.

    Parameters
    ----------
    moves
        A motion library, or motion files to make one of: the dance is made up from them.
    robot
        A robot dances, inside its limits: g1, hrp4c, talos, or a file (extra ``robots``).
    simulate
        Show the robot in MuJoCo as it really moves, with motors, friction and falls.
    beats
        The beats of the one choreography that is given: a file with a time a line, or a song.json.
    song_at
        Second of it at which --beats begin.
    fps
        Frames a second of choreographies that store none, as AMC and tables of angles.
    """

    moves: Path | None = None
    robot: str | None = None
    simulate: Flag = False
    beats: Path | None = None
    song_at: float = 0.0
    fps: SourceRate = None


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class SendFlags:
    """Where it goes.

    Parameters
    ----------
    page
        Serve the live stage; --no-page for none.
    host
        The address to serve it at; others than 127.0.0.1 let others in.
    port
        Its port; by default the first free one from 8740 on.
    osc
        Send OSC to HOST:PORT.
    osc_in
        Hear OSC commands at this port: /onbeat/next, /onbeat/play, /onbeat/rest, /onbeat/dance, /onbeat/tap.
    midi_out
        A MIDI port that gets a clock on the beats.
    lines
        Write poses to stdout: csv, or trajectory (JointTrajectory as JSON, robots alone).
    """

    page: bool = True
    host: str = "127.0.0.1"
    port: int | None = None
    osc: str | None = None
    osc_in: int | None = None
    midi_out: str | None = None
    lines: Literal["csv", "trajectory"] | None = None

    def check(self) -> None:
        """Refuse what cannot be, before anything is opened."""
        ports = {"--port": self.port, "--osc-in": self.osc_in, "--osc": (self.osc_address or ("", None))[1]}
        for flag, port in ports.items():
            if port is not None and not (flag != "--port") <= port < 65536:
                raise OnbeatError(f"{flag}: {port} is no port; give 1 to 65535")

    @property
    def osc_address(self) -> tuple[str, int] | None:
        """Host and port to send OSC to."""
        if self.osc is None:
            return None
        host, _, port = self.osc.rpartition(":")
        if not host or not port.isdecimal():
            raise OnbeatError(f"--osc {self.osc}: give HOST:PORT, such as 127.0.0.1:9000")
        return host.strip("[]"), int(port)


NO_HEAR, NO_BODY, NO_SEND = HearFlags(), BodyFlags(), SendFlags()
