"""What can go wrong while a session runs, and what it does then."""

from __future__ import annotations

import asyncio
import threading
import time

import numpy as np

from live_sessions import TICK, Checked, cast_named
from made_songs import RATE, made_song, steady
from onbeat.live.beat.pulse import Pulse
from onbeat.live.protocol import Status
from onbeat.live.session import Session
from onbeat.live.sound.ears import Ears

BROKEN, WHOLE_AGAIN = 20.0, 32.0
"""Seconds of the song between which something is wrong with it."""


def blocks(kind: str, sound: np.ndarray) -> list[tuple[np.ndarray, int]]:
    """Blocks of 10 ms of a song that breaks in some way, and their rates."""
    rng, out = np.random.default_rng(0), []
    for k in range(len(sound) // TICK):
        block, rate = sound[k * TICK : (k + 1) * TICK, None], RATE
        if BROKEN <= k / 100 < WHOLE_AGAIN:
            if kind == "no blocks":
                out.append((block[:0], rate))
                continue
            if kind == "silence":
                block = np.zeros_like(block)
            elif kind == "NaN":
                block = np.where(rng.random(block.shape) < 0.3, np.nan, block)
            elif kind == "all NaN":
                block = np.full_like(block, np.nan)
            elif kind == "DC":
                block = block * 0.2 + 0.6
            elif kind == "clipping":
                block = np.clip(block * 30, -1, 1)
            elif kind == "noise":
                block = (0.2 * rng.standard_normal(block.shape)).astype(np.float32)
            elif kind in ("8 kHz", "96 kHz"):
                rate = 8000 if kind == "8 kHz" else 96000
                places = np.arange(rate // 100) * (RATE / rate)
                block = np.interp(places, np.arange(TICK), block[:, 0])[:, None].astype(np.float32)
            elif kind == "6 channels":
                block = np.hstack([block, np.zeros((TICK, 5), np.float32)])
            elif kind == "int16":
                block = (block * 32767).astype(np.int16)
        out.append((block, rate))
    return out


def faults() -> None:
    """Print the table."""
    sound, beats = made_song(steady(112), 60.0, 3)
    kinds = ["nothing", "no blocks", "silence", "NaN", "all NaN", "DC", "clipping", "noise", "8 kHz", "96 kHz"]
    kinds += ["6 channels", "int16"]
    print(
        f"\nfaults: between {BROKEN:g} and {WHOLE_AGAIN:g} s of a song at 112; right: share of beats said within 70 ms"
    )
    print(f"{'what':12}{'rests':>7}{'right while':>13}{'after':>7}{'back s':>8}{'past limits':>13}  said")
    for kind in kinds:
        cast = cast_named("choreography")
        session, ears = Session(Pulse(), cast.conductor, cast.dancer), Ears()
        checked, statuses, said, notes = Checked(), [], [], []
        for block, rate in blocks(kind, sound):
            if len(block):
                ears.take(block, rate)
            step = session.step(ears.tick())
            if step.poses:
                checked.look(session)
            statuses += [event for event in step.events if isinstance(event, Status)]
            said += [event.time for event in step.events if event.__class__.__name__ == "BeatSaid"]
            notes += ears.problems()
        rests = any(BROKEN < s.time < WHOLE_AGAIN + 3 and s.dancing == "resting" for s in statuses)
        heard = np.array(said)
        while_ = [b for b in beats if BROKEN + 2 < b < WHOLE_AGAIN]
        after = [b for b in beats if WHOLE_AGAIN + 6 < b < beats[-1]]
        right = [np.mean([np.abs(heard - b).min() <= 0.07 for b in some]) for some in (while_, after)]
        back = next((s.time - WHOLE_AGAIN for s in statuses if s.time > WHOLE_AGAIN and s.hearing == "music"), np.nan)
        past = max(checked.speed, checked.acceleration) > 1 + 1e-6 or checked.position > 1e-6
        print(
            f"{kind:12}{'yes' if rests else 'no':>7}{right[0]:13.2f}{right[1]:7.2f}{back:8.1f}"
            f"{'yes' if past else 'no':>13}  {'; '.join(dict.fromkeys(notes))}",
            flush=True,
        )
    clients()


def clients() -> None:
    """Two clients that watch, one that sends garbage, one that stops reading: who watches gets all."""
    from websockets.asyncio.client import connect

    from onbeat.live.mouths.outputs import Outputs
    from onbeat.live.page.server import Server
    from onbeat.live.page.wire import HelloData
    from onbeat.live.protocol import Pose, Who

    hello = HelloData(1, "t", "n", "character", ["a"], [], [0], 0.0, 0.0, 0.0, 0.0, 0.0)
    server = Server(b"page", lambda: hello, lambda command: None, port=0)
    outputs = Outputs([server])
    outputs.open(Who("n", "character", ("a",), (-1,), (), ("a",)))
    url = server.address.replace("http", "ws") + "live"
    got = {"first": 0, "second": 0}

    async def watch(name: str) -> None:
        async with connect(url) as socket:
            end = time.monotonic() + 6
            while time.monotonic() < end:
                message = await asyncio.wait_for(socket.recv(), 3)
                got[name] += isinstance(message, bytes)

    async def spoil() -> None:
        async with connect(url) as socket:
            for _ in range(30):
                await socket.send(b"\x00\xff" * 500)
                await socket.send("{not json")
                await asyncio.sleep(0.05)

    async def stall() -> None:
        async with connect(url, max_queue=1) as socket:
            socket.transport.pause_reading()
            await asyncio.sleep(6)

    async def all_() -> None:
        await asyncio.gather(watch("first"), watch("second"), spoil(), stall(), return_exceptions=True)

    thread = threading.Thread(target=lambda: asyncio.run(all_()))
    thread.start()
    begun, points = time.perf_counter(), np.zeros((60, 3), np.float32)
    for number in range(700):
        wait = begun + number / 100 - time.perf_counter()
        if wait > 0:
            time.sleep(wait)
        pose = Pose(number, number / 100, np.zeros(3), np.zeros((1, 4)), np.zeros(0), points)
        outputs.pose(pose, begun + number / 100)
    thread.join()
    (passed,) = outputs.passed()
    outputs.close()
    print(f"\nclients: of 50 poses a second for 6 s, beside one that sends garbage and one that stops reading: {got};")
    print(f"handed on: {passed.sent}, dropped {passed.dropped}, within 10 ms {passed.punctual:.2%}")


if __name__ == "__main__":
    faults()
