"""A session in real time: whether poses leave when they are due, and what that costs."""

from __future__ import annotations

import gc
import io
import resource
import socket
import time
from collections.abc import Sequence

from live_sessions import cast_named
from onbeat.examples.song import demo_song
from onbeat.live.beat.pulse import Pulse
from onbeat.live.hearing import Hearing, Inbox
from onbeat.live.mouths.lines import Lines
from onbeat.live.mouths.osc import Osc
from onbeat.live.mouths.outputs import Outputs
from onbeat.live.page.server import Server
from onbeat.live.page.wire import HelloData
from onbeat.live.run import Runner
from onbeat.live.session import Session, warm_up
from onbeat.live.sound.array_source import ArraySource

SECONDS = 60.0


def pace(names: Sequence[str], seconds: float = SECONDS) -> None:
    """Print the table: OSC, the page's server and lines, all at once."""
    print(f"\npace: {seconds:g} s in real time, embedded song, OSC, page's server (nobody looks) and lines at once")
    print(
        f"{'cast':14}{'CPU':>7}{'mouth':>34}{'poses':>8}{'dropped':>9}{'within 10 ms':>14}{'p99.9 ms':>10}{'worst':>8}"
    )
    ear = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    ear.bind(("127.0.0.1", 0))
    song = demo_song(60.0)
    for name in names:
        cast = cast_named(name)
        source = ArraySource(song.samples, song.rate, loop=True, clock=time.perf_counter)
        session = Session(Pulse(), cast.conductor, cast.dancer)
        hello = HelloData(1, "t", "n", cast.who.kind, [], [], [], 0.0, 0.0, 0.0, 0.0, 0.0)
        mouths = [
            Osc("127.0.0.1", ear.getsockname()[1]),
            Server(b"", lambda hello=hello: hello, lambda command: None, port=0),
            Lines(io.BytesIO()),
        ]
        outputs = Outputs(mouths)
        outputs.open(cast.who)
        hearing = Hearing(source, Inbox())
        warm_up(session)
        gc.collect()
        hearing.start()
        ran = Runner(session, hearing, outputs).run(seconds)
        outputs.close()
        source.close()
        for k, one in enumerate(outputs.passed()):
            begin = f"{name:14}{ran.cpu / ran.seconds:7.1%}" if not k else " " * 21
            print(
                f"{begin}{one.name:>34}{one.sent:8}{one.dropped:9}{one.punctual:14.2%}{1000 * one.p999:10.1f}"
                f"{1000 * one.worst:8.1f}",
                flush=True,
            )
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000:.0f} MB")
