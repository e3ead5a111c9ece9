"""How well a live session follows, what it keeps to, what it costs, and what it survives.

Usage: ``python benchmarks/live.py [--only follow,endure,faults,pace] [--minutes 30] [--cast improvised,g1]``.
What it hears beside other trackers is in ``live_beats.py``.

*follow*: songs by the embedded band whose beats are known, at a steady tempo, with a ramp of ± 20 % over 20 s, and with
steps of ± 8 % every 15 s. The keyposes of the choreography (what it puts on beats) are looked at in the time in which
they are danced: the share within 60 ms of a true beat, from the first lock on, with no grace after a step; the same of
the stops of the hands that are found in the poses that left; and of both with the beats shifted at random, which is
chance. *endure*: half an hour of songs, silence, noise and changes of choreography: limits looked at a thousand times
a second, jumps, memory, and processor time. *faults*: what can go wrong with a source. *pace*: in real time.
"""

from __future__ import annotations

import argparse
import gc
import resource
import sys
import time
from collections.abc import Sequence

import numpy as np

from live_sessions import Came, run, session_named
from made_songs import RATE, made_song, ramp, steady, steps
from onbeat.live.protocol import Command
from onbeat.live.session import Session
from onbeat.motion.features import hand_features
from onbeat.motion.motion import Motion

NEAR = 0.06
SONGS = {
    "steady 96": steady(96),
    "steady 118": steady(118),
    "steady 132": steady(132),
    "ramp 100 +20 %": ramp(100, 0.2, 20, 20),
    "ramp 120 -20 %": ramp(120, -0.2, 20, 20),
    "steps 110 +8 %": steps(110, 0.08, 15),
    "steps 100 -8 %": steps(100, -0.08, 15),
}


def share_near(times: np.ndarray, beats: np.ndarray) -> float:
    """Of times, the share within ``NEAR`` of a beat."""
    if not len(times):
        return float("nan")
    return float((np.abs(times[:, None] - beats[None]).min(axis=1) <= NEAR).mean())


def chance(times: np.ndarray, beats: np.ndarray, rng: np.random.Generator) -> float:
    """The same with the beats shifted by any part of a beat."""
    shifts = rng.uniform(0, 1, 40) * np.median(np.diff(beats))
    return float(np.mean([share_near(times, beats + shift) for shift in shifts]))


def locked_at(said: np.ndarray, beats: np.ndarray) -> float:
    """When the fourth beat in a row is said within 70 ms of a true one."""
    row = 0
    for beat in said:
        row = row + 1 if np.abs(beats - beat).min() <= 0.07 else 0
        if row == 4:
            return float(beat)
    return float("inf")


def danced_anchors(session: Session, sound: np.ndarray) -> tuple[Came, np.ndarray, np.ndarray]:
    """What came, the music's seconds at which anchors were danced, and the beats that were said."""
    anchors: dict[float, None] = {}
    said: list[float] = []
    hear = session.pulse.hear

    def heard(samples):
        out = hear(samples)
        said.extend(beat.time for beat in out.said)
        for second in session.conductor.anchors.seconds.values():
            if second <= session.conductor.line.settled:
                anchors[second] = None
        return out

    session.pulse.hear = heard
    came = run(session, sound)
    music, own = np.array(came.clock).T
    seconds = np.array(sorted(anchors))
    return came, np.interp(seconds, own, music), np.array(said)


def stops_of(came: Came, session: Session) -> np.ndarray:
    """Seconds at which the hands come to rest in the poses that left."""
    first = came.poses[0]
    motion = Motion(
        session.dancer.skeleton,
        np.stack([pose.rotations for pose in came.poses]),
        np.stack([pose.root for pose in came.poses]),
        100.0,
    )
    return hand_features(motion).body_stops + first.time


def follow(names: Sequence[str]) -> None:
    """Print the table."""
    rng = np.random.default_rng(0)
    print(f"\nfollow: share within {1000 * NEAR:.0f} ms of a true beat from the first lock on (chance)")
    print(f"{'cast':14}{'song':18}{'lock s':>8}{'keyposes':>18}{'median ms':>11}{'stops of hands':>20}")
    for name in names:
        for song, tempo in SONGS.items():
            sound, beats = made_song(tempo, 75.0, seed=len(song))
            session = session_named(name)
            came, keyed, said = danced_anchors(session, sound)
            lock = locked_at(said, beats)
            inside = (keyed > lock) & (keyed < beats[-1])
            late = np.abs(keyed[inside][:, None] - beats[None]).min(axis=1)
            keyed = keyed[inside]
            line = f"{name:14}{song:18}{lock:8.2f}"
            line += f"{share_near(keyed, beats):10.3f} ({chance(keyed, beats, rng):.2f})"
            line += f"{1000 * np.median(late):11.1f}"
            if came.poses[0].angles.size == 0:
                stops = stops_of(came, session)
                stops = stops[(stops > lock) & (stops < beats[-1])]
                line += f"{share_near(stops, beats):12.3f} ({chance(stops, beats, rng):.2f}) {len(stops)}"
            print(line, flush=True)


def endured(minutes: float, rng: np.random.Generator) -> np.ndarray:
    """Songs of changing tempo, silence, noise and breaks, so many minutes of them."""
    parts, seconds, seed = [], 0.0, 0
    while seconds < 60 * minutes:
        bpm = float(rng.uniform(84, 134))
        tempo = [steady(bpm), ramp(bpm, float(rng.choice([-0.2, 0.2])), 10, 20), steps(bpm, 0.08, 12)][seed % 3]
        sound = made_song(tempo, 55.0, seed)[0]
        quiet = np.zeros(round(float(rng.uniform(2, 14)) * RATE), np.float32)
        noise = (0.1 * rng.standard_normal(round(float(rng.uniform(2, 14)) * RATE))).astype(np.float32)
        parts += [sound, quiet if seed % 2 else noise]
        seconds += sum(len(part) for part in parts[-2:]) / RATE
        seed += 1
    return np.concatenate(parts)[: round(60 * minutes * RATE)]


def memory() -> float:
    """MB that the process holds now."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 1e6


def endure(names: Sequence[str], minutes: float) -> None:
    """Print the table."""
    sound = endured(minutes, np.random.default_rng(1))
    print(f"\nendure: {minutes:g} min of songs, tempo changes, silence, noise; a change asked for every 18 s")
    print(
        f"{'cast':14}{'past range':>12}{'speed':>8}{'accel.':>8}{'jump':>8}{'CPU':>7}{'slowest ms':>12}"
        f"{'MB 3 min / end':>18}"
    )
    for name in names:
        session = session_named(name)
        held, slowest, begun = [], 0.0, time.process_time()
        last = time.perf_counter()

        def each(k: int, held: list[float] = held) -> None:
            nonlocal slowest, last
            now = time.perf_counter()
            slowest = max(slowest, now - last) if k > 1000 else 0.0
            if k % 6000 == 0:
                gc.collect()
                held.append(memory())
            last = time.perf_counter()

        asked = lambda k: [Command("next")] if k % 1800 == 1799 else []  # noqa: E731
        came = run(session, sound, asked, keep=False, each=each)
        cpu = (time.process_time() - begun) / (len(sound) / RATE)
        checked = came.checked
        early = held[min(3, len(held) - 1)]
        print(
            f"{name:14}{checked.position:12.1e}{checked.speed:8.4f}{checked.acceleration:8.4f}{checked.jump:8.4f}"
            f"{cpu:7.1%}{1000 * slowest:12.0f}{early:10.0f} / {held[-1]:.0f}",
            flush=True,
        )
    print("range in rad past it (0 or less is inside), speed and acceleration in shares of what is allowed (1 is all);")
    print("jump: between two plans, in shares of a second at full speed")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="follow,endure,faults,pace")
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--cast", default="improvised,choreography,g1")
    given = parser.parse_args()
    names, only = given.cast.split(","), given.only.split(",")
    if "follow" in only:
        follow(names)
    if "endure" in only:
        endure(names, given.minutes)
    if "faults" in only:
        from live_faults import faults

        faults()
    if "pace" in only:
        from live_pace import pace

        pace(names)


if __name__ == "__main__":
    sys.exit(main())
