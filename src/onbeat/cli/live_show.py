"""One live show: a session set up, run with its mouths, kept if wanted, and told about."""

from __future__ import annotations

import contextlib
import signal
import time
from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from types import FrameType
from typing import Any

import msgspec

import onbeat
from onbeat.cli.live_cast import Settings, cast_of
from onbeat.cli.live_flags import BodyFlags, HearFlags, SendFlags
from onbeat.cli.live_mouths import listening, mouths_of
from onbeat.cli.live_screen import Screen, summary, words
from onbeat.cli.live_sound import Played, source_of
from onbeat.cli.progress import Stages
from onbeat.live.beat.pulse import Pulse
from onbeat.live.cast import Cast
from onbeat.live.hearing import Hearing, Inbox
from onbeat.live.mouths.outputs import Outputs
from onbeat.live.protocol import Event, Note
from onbeat.live.record import Digest, Recording, Replay
from onbeat.live.recorded import Recorded
from onbeat.live.run import Runner, Ticks
from onbeat.live.session import Session, warm_up


class Show:
    """What all shows have in common.

    Parameters
    ----------
    send : where it goes.
    speed_up : how much faster time goes.
    seconds : when it ends at the latest.
    quiet : whether nothing is printed but at the end, by the caller.
    """

    def __init__(self, send: SendFlags, speed_up: float, seconds: float | None, quiet: bool) -> None:
        self._send, self._speed_up, self._quiet = send, speed_up, quiet
        self._seconds = float("inf") if seconds is None else seconds
        begun = time.perf_counter()
        self._clock: Callable[[], float] = (
            time.perf_counter if speed_up == 1 else lambda: begun + (time.perf_counter() - begun) * speed_up
        )

    def live(self, motions: tuple[Path, ...], hear: HearFlags, body: BodyFlags, record: Path | None) -> dict[str, Any]:
        """Hear, and dance."""
        settings = Settings.of(motions, hear, body)
        self._ready()
        recording = None if record is None else Recording(record, msgspec.to_builtins(settings))
        with _kept(recording):
            cast = self._cast(settings)
            source, inbox = source_of(hear, self._clock), Inbox()
            with contextlib.closing(source.listener):
                ticks = Hearing(source.listener, inbox)
                return self._run(cast, settings, source.played, ticks, inbox, recording, hear.midi_in)

    def again(self, folder: Path) -> dict[str, Any]:
        """Dance a recording again, and say whether it is the same."""
        replay = Replay(folder)
        settings = Settings.read(replay.kept.settings, folder)
        digest, inbox = Digest(), Inbox()
        ticks = Recorded(replay, self._clock)
        told = self._run(self._cast(settings), settings, Played(folder.name), ticks, inbox, digest, None)
        whole = told["ticks"] == len(replay)
        told["same"] = digest.hexdigest() == replay.kept.poses if whole and replay.kept.poses else None
        if not self._quiet:
            Screen.say(f"{told['poses']} poses, {_compared(told['same'], replay.kept.poses, settings)}")
        return told

    def _ready(self) -> None:
        """Say that all is made ready: that takes seconds, on a busy computer half a minute."""
        if not self._quiet:
            Screen.say("getting ready: who dances, and what is heard")

    def _cast(self, settings: Settings) -> Cast:
        with Stages() as stages:
            return cast_of(settings, stages)

    def _run(
        self,
        cast: Cast,
        settings: Settings,
        played: Played,
        ticks: Ticks,
        inbox: Inbox,
        keeper: Recording | Digest | None,
        midi_in: str | None,
    ) -> dict[str, Any]:
        session = Session(Pulse(*settings.tempi), cast.conductor, cast.dancer, settings.latency, cast.tried)
        mouths = mouths_of(self._send, cast, played, session, inbox)
        outputs = Outputs(mouths.all)
        counted = _Counted(keeper)
        runner = Runner(session, ticks, outputs, counted, self._clock, lambda s: time.sleep(s / self._speed_up))
        screen = Screen(silent=self._quiet or self._send.lines is not None)

        def each(events: Sequence[Event]) -> None:
            screen.each([*events, *counted.notes()])
            if mouths.ended:
                runner.stop()

        mouths.open(outputs)
        try:
            with listening(self._send, midi_in, inbox, runner), _ended_by_signals(runner):
                warm_up(session)
                ticks.start()
                screen.begin(cast.who.name, played.name, mouths)
                ran = runner.run(self._seconds, each)
        finally:
            screen.end()
            outputs.close()
        told = summary(ran, outputs.passed(), counted.poses, self._speed_up)
        if not self._quiet:
            Screen.say(words(told))
        return told


def _compared(same: bool | None, poses: str, settings: Settings) -> str:
    if not poses:
        return "to be compared with none: the session did not end well"
    if same is None:
        return "not danced to its end"
    other = f"kept by onbeat {settings.onbeat}, this is {onbeat.__version__}"
    return "the same to the bit" if same else f"other poses than then ({other})"


class _Counted:
    """Hands ticks on to who keeps them, and counts poses."""

    def __init__(self, keeper: Recording | Digest | None) -> None:
        self._keeper, self.poses = keeper, 0
        self._told = False

    def add(self, samples: Any, told: Any, poses: Any) -> None:
        self.poses += len(poses)
        if self._keeper is not None:
            self._keeper.add(samples, told, poses)

    def notes(self) -> list[Note]:
        """That nothing more is kept, once."""
        failed = getattr(self._keeper, "failed", "")
        if not failed or self._told:
            return []
        self._told = True
        return [Note(0.0, failed)]


@contextlib.contextmanager
def _ended_by_signals(runner: Runner) -> Generator[None]:
    """Ctrl-C is how a show ends: after the present tick. A second one does not wait for that."""

    def end(number: int, frame: FrameType | None) -> None:
        runner.stop()
        restore()

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    names = ("SIGINT", "SIGTERM", "SIGHUP")  # also a closed terminal, and who stops services
    numbers = [signal.Signals[name] for name in names if name in signal.Signals.__members__]
    before = {number: signal.signal(number, end) for number in numbers}
    try:
        yield
    finally:
        restore()


@contextlib.contextmanager
def _kept(recording: Recording | None) -> Generator[None]:
    """A recording gets its name in the end, however that comes; one of nothing is dropped."""
    try:
        yield
    finally:
        if recording is not None and recording.ticks:
            Screen.say(f"kept in {recording.close()}")
        elif recording is not None:
            recording.drop()
