"""Robots that dance to music whose tempo changes: limits, feet, balance, and the time it takes.

Usage: ``python benchmarks/live_robot.py DATA [--seconds 60] [--only NAME,…]``. The folder holds ``g1_moves`` and
``hrp4c_dance``, which are no part of onbeat; the troupe is.

The music begins at a dance's own tempo, rises by 20 % over 20 s, falls back, and then steps by 8 % down and up again.
Beats are predicted from the last two alone, as if each beat were only just heard. A *medley* goes from dance to dance
every 8 beats. Limits are looked at 1000 times a second: how often a hinge is past its range, its speed, and 80 rad/s²
(400 in the legs). Robots are simulated in MuJoCo and balance by sensors that are late and noisy.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.formats.read import read_motion
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.live.protocol import RATE, Pose
from onbeat.live.robot.bounds import bounds_of
from onbeat.live.robot.dance import STANCE, RobotDance, prepare
from onbeat.live.robot.line import RobotLine
from onbeat.live.robot.rest import resting
from onbeat.live.robot.simulation import Simulation
from onbeat.retime.stream import Follower
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot, robot_named

FINE = 1000  # looks a second at limits
LONGEST = 30.0  # [s] of a dance
NONE = np.zeros((0, 3), np.float32)


@dataclass
class Music:
    """Beats of a tempo that changes, and which of them are heard when."""

    tempo: float
    seconds: float
    beats: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        now, beats = 1.0, []
        while now < self.seconds + 5:
            beats.append(now)
            now += 60 / (self.tempo * self.pace(now))
        self.beats = np.array(beats)

    def pace(self, now: float) -> float:
        """How much faster than at first."""
        if now < 40:
            return 1.0 + 0.2 * (now / 20 if now < 20 else 2 - now / 20)
        return 0.92 if now < 50 else 1.0

    def predicted(self, now: float) -> tuple[int, np.ndarray]:
        """The number of the last beat but one, and from it on heard and predicted beats."""
        heard = max(int(np.searchsorted(self.beats, now)), 2)
        last, before = self.beats[heard - 1], self.beats[heard - 2]
        return heard - 2, np.concatenate(([before], last + (last - before) * np.arange(12)))


@dataclass
class Lined:
    """A line as channels."""

    line: RobotLine

    def values(self, own: np.ndarray, near: np.ndarray) -> np.ndarray:
        return self.line.angles(own)


def planned(robot: Robot, dances: Sequence[RobotDance], period: float, seconds: float) -> tuple[RobotLine, np.ndarray]:
    """A line of pieces of 8 beats (of the whole dance where there is one alone), and its beats."""
    line, beats, k = RobotLine([resting(robot), *dances], robot), [], 0
    line.add(0, 0.0, 1.0)
    cursor = [0] * len(dances)
    while line.end < 1.2 * seconds + 10:
        which = k % len(dances)
        own = dances[which].beats
        own = own[(own >= 0) & (own <= dances[which].duration)]
        first = cursor[which] if cursor[which] + 8 < len(own) else 0
        last = min(first + (8 if len(dances) > 1 else len(own)), len(own) - 1)
        rate = min((np.median(np.diff(own)) / period * fold for fold in (0.5, 1, 2)), key=lambda r: abs(np.log(r)))
        start = line.end
        line.add(1 + which, float(own[first]), float(own[last]), float(rate))
        # A dance at half or double time has as many beats as the music where they are counted in the music's.
        count = round((own[last] - own[first]) / rate / period)
        beats.extend(start + np.arange(count) * (line.end - start) / max(count, 1))
        cursor[which], k = last, k + 1
    return line, np.array(beats)


@dataclass
class Result:
    """Shares past range, speed and acceleration; millimetres, milliseconds, falls; CPU of the line and of MuJoCo."""

    past: list[float]
    feet_mm: float
    late_ms: float
    falls: list[str]
    shares: list[float]


def danced(robot: Robot, dances: Sequence[RobotDance], tempo: float, seconds: float) -> Result:
    music = Music(tempo, seconds)
    line, own_beats = planned(robot, dances, 60 / tempo, seconds)
    bounds, legs = bounds_of(robot), Legs.of(robot)
    places, _ = STANCE.feet(legs)
    follower = Follower(Lined(line), bounds, line.angles(np.zeros(1))[0])
    first = np.concatenate((*(part[0] for part in line.root(np.zeros(1))), line.angles(np.zeros(1))[0]))
    simulation = Simulation(robot, first)
    fine, told, at_beats, notes, spent = [], [], [], [], np.zeros(3)
    for lump in range(round(seconds * 10)):
        now = lump / 10
        began = time.process_time()
        number, beats = music.predicted(now)
        follower.push(beats, own_beats[number : number + len(beats)])
        times = now + np.arange(FINE // 10) / FINE
        values = follower.pull(times)
        own = follower.own(times)
        roots, turns = line.root(own[::10])
        line.settle(float(own[-1]))
        line.forget(float(own[0]) - 4)
        spent[0] += time.process_time() - began
        fine.append(values)
        poses = [
            Pose(10 * lump + k, now + k / RATE, roots[k], turns[k : k + 1], values[10 * k], NONE) for k in range(10)
        ]
        told += [np.concatenate((p.root, p.rotations[0], p.angles)) for p in poses]
        inside = music.beats[(music.beats >= times[0]) & (music.beats < times[0] + 0.1)]
        for beat in inside:
            at_beats.append(float(np.interp(beat, times, own)) - own_beats[int(np.searchsorted(music.beats, beat))])
        began = time.process_time()
        step = simulation.step(poses)
        spent[1] += time.process_time() - began
        notes += [
            f"{note.time:.1f} s: {note.text.removeprefix('the robot fell: ').split(';')[0]}"
            for note in step.events
            if "fell" in note.text
        ]
    path = np.concatenate(fine)
    speed, acceleration = np.diff(path, axis=0) * FINE, np.diff(path, 2, axis=0) * FINE**2
    past = [
        float(((path < bounds.low - 1e-9) | (path > bounds.high + 1e-9)).mean()),
        float((np.abs(speed) > bounds.speed * (1 + 1e-6)).mean()),
        float((np.abs(acceleration) > bounds.acceleration * (1 + 1e-3)).mean()),
    ]
    feet = legs.feet(np.array(told))[0]
    away = feet - places
    return Result(
        past,
        1000 * float(np.linalg.norm(away, axis=-1).max()),
        1000 * float(np.percentile(np.abs(at_beats), 95)),
        notes,
        (spent[:2] / seconds).tolist(),
    )


def own_tempo(dance: RobotDance) -> float:
    tempo = 60 / float(np.median(np.diff(dance.beats)))
    return tempo * 2 if tempo < 70 else tempo / 2 if tempo > 140 else tempo


def casts(folder: Path, only: Sequence[str]) -> Iterator[tuple[str, Robot, list[RobotDance]]]:
    """Names, robots and what they dance."""
    g1, prepared = robot_named("g1"), []
    wanted = [
        path
        for path in sorted((folder / "g1_moves").glob("*.csv"))
        if _asked(path.stem, only) or _asked("medley", only)
    ]
    for path in wanted:
        motion = read_motion(path, fps=60)[: int(LONGEST * 60)]
        prepared.append(prepare(motion, g1, motion_beats(motion), np.zeros(0)))
        yield path.stem, g1, prepared[-1:]
    for k, name in enumerate(("harvest dance", "festival dance")):
        if _asked(name, only) or _asked("medley", only):
            clip = perform_dance(DANCERS[k], name, 1.0, 2, np.random.default_rng(k))
            prepared.append(prepare(clip.motion, g1, clip.beats, clip.keyposes))
            yield f"troupe, {name}", g1, prepared[-1:]
    yield "medley", g1, prepared
    if _asked("hrp4c", only):
        from hrp4c_poses import SONG_AT, TEMPO, read_dance

        read, robot = read_dance(folder / "hrp4c_dance"), robot_named("hrp4c")
        beats = SONG_AT + np.arange(int((read.motion.duration - SONG_AT) * TEMPO / 60) + 1) * 60 / TEMPO
        yield "hrp4c, Turn to the Future", robot, [prepare(read.motion, robot, beats, np.unique(read.key_poses))]


def _asked(name: str, only: Sequence[str]) -> bool:
    return not only or any(word.lower() in name.lower() for word in only)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--only", default="")
    flags = parser.parse_args()
    warnings.simplefilter("ignore")
    only = [word for word in flags.only.split(",") if word]
    print(f"{'':26} {'tempo':>5} {'past limits, %':^20} {'feet mm':>8} {'beats ms':>8} {'CPU, %':^11}")
    print(f"{'':26} {'':>5} {'range':>6} {'speed':>6} {'accel.':>6} {'most':>8} {'95 %':>8} {'line':>5} {'sim.':>5}")
    for name, robot, dances in casts(flags.folder, only):
        if not _asked(name, only):
            continue
        tempo = own_tempo(dances[0]) if len(dances) == 1 else 110.0
        found = danced(robot, dances, tempo, flags.seconds)
        past, shares = [100 * share for share in found.past], [100 * share for share in found.shares]
        print(
            f"{name[:26]:26} {tempo:5.0f} {past[0]:6.3f} {past[1]:6.3f} {past[2]:6.3f} {found.feet_mm:8.1f} "
            f"{found.late_ms:8.0f} {shares[0]:5.1f} {shares[1]:5.1f}  "
            + ("upright" if not found.falls else f"{len(found.falls)} falls: {'; '.join(found.falls[:3])}"),
            flush=True,
        )


if __name__ == "__main__":
    main()
