"""Robots that dance: balance, limits, upright or fallen in simulation, and under disturbances.

Usage: ``python benchmarks/robot.py DATA [--only retarget,balance,steps,robust,hrp4c] [--workers 2]``. The folder holds
``g1_moves``, ``cmu`` and ``hrp4c_dance``, which are no part of onbeat; the troupe is.

*Untreated* is the dance on planted feet as its legs come out, played by the servos alone; *compensation* shifts the
hips, without feedback; *ours* does both and feels by sensors that are late and noisy. Everything is in one run.
"""

from __future__ import annotations

import argparse
import multiprocessing
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion import Motion
from onbeat.retime.lock import TimeMap
from onbeat.robots.balance import balanced
from onbeat.robots.model import robot_named
from onbeat.robots.perform import Staged, kept_limits, stage
from onbeat.robots.simulate import Options, simulate
from onbeat.robots.simulation.disturb import pushes
from robot_retarget import retargeting

PARTS = ("retarget", "balance", "steps", "robust", "hrp4c")
LONGEST = 30.0  # [s] of a dance that is simulated
WIDTHS = (9, 7, 8, 4, 5, 9, 12, 9, 9)
CMU = ("05_02", "05_09", "05_13", "131_01")


@dataclass(frozen=True)
class Dance:
    """A dance and its own beats and keyposes, in seconds."""

    name: str
    motion: Motion
    beats: np.ndarray
    keyposes: np.ndarray


def dances(folder: Path) -> Iterator[Dance]:
    """Eight on the G1, dancers of CMU, and two of the troupe."""
    for path in sorted((folder / "g1_moves").glob("*.csv")):
        yield known(path.stem, read_motion(path, fps=60))
    for name in CMU:
        path = next(p for p in (folder / "cmu" / f"{name}.amc", folder / "cmu" / f"{name}.bvh") if p.is_file())
        yield known(f"CMU {name}", read_motion(path, fps=120 if path.suffix == ".amc" else None))
    for k, dance in enumerate(("harvest dance", "festival dance")):
        clip = perform_dance(DANCERS[k], dance, 1.0, 2, np.random.default_rng(k))
        yield Dance(f"troupe, {dance}", clip.motion, clip.beats, clip.keyposes)


def known(name: str, motion: Motion) -> Dance:
    """A motion with the beats that it keeps by itself, and its keyposes."""
    motion = motion[: int(LONGEST * motion.fps)]
    beats = motion_beats(motion)
    return Dance(name, motion, beats, np.asarray(find_keyposes(motion, beats).times))


def staged(dance: Dance, speed: float, feet: str, robot: str = "g1") -> Staged:
    return stage(dance.motion, robot_named(robot), TimeMap.steady(speed), dance.beats, dance.keyposes, feet)


def fell(motion: Motion, options: Options, robot: str = "g1", seed: int = 0) -> tuple[float | None, float]:
    """When it fell, and seconds of computing a second of the dance."""
    began = time.perf_counter()
    trial = simulate(robot_named(robot), motion, options, rng=np.random.default_rng(seed))
    spent = (time.perf_counter() - began) / (trial.fell_at or motion.duration)
    return trial.fell_at, spent


def spread(work: Callable, calls: Sequence[tuple], workers: int) -> list:
    """The results of calls, worked out by so many processes."""
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as pool:
        return [future.result() for future in [pool.submit(work, *call) for call in calls]]


def row(dance: Dance, speed: float, feet: str) -> dict[str, object]:
    """One dance at one speed, all ways."""
    warnings.simplefilter("ignore")
    robot = robot_named("g1")
    began = time.perf_counter()
    made = staged(dance, speed, feet)
    spent = (time.perf_counter() - began) / made.motion.duration
    before = made.legs
    plain = balanced(before, robot, made.standing, bound=1e-9)
    over = kept_limits(made.motion, robot).violations
    return {
        "dance": dance.name,
        "seconds": made.motion.duration,
        "inside": [float((one >= 0).mean()) for one in (plain.margin, made.balanced.margin)],
        "worst": float(made.balanced.margin.min()),
        "over": over,
        "fell": [
            fell(before, Options(feedback="none"))[0],
            fell(made.motion, Options(feedback="none"))[0],
            fell(made.motion, Options(feedback="truth"))[0],
            fell(made.motion, Options(feedback="estimate"))[0],
        ],
        "spent": spent,
    }


def balance(found: Sequence[Dance], workers: int, feet: str, speeds: Sequence[float]) -> None:
    """ZMP and upright, for all dances."""
    for speed in speeds:
        rows = spread(row, [(dance, speed, feet) for dance in found], workers)
        print(f"\nG1, feet {feet}, {speed:g} ×")
        print(f"  {'':30} {'ZMP inside, %':^24} {'past limits':^12} {'upright, or when it fell':^42}")
        heads = ("untreated", "ours", "worst mm", "pos.", "vel.", "untreated", "compensation", "truth", "ours")
        print(f"  {'':24} {'s':>5} " + " ".join(f"{head:>{w}}" for head, w in zip(heads, WIDTHS, strict=True)))
        for one in rows:
            told = ["upright" if at is None else f"{at:.1f} s" for at in one["fell"]]
            cells = [
                *(f"{100 * share:.2f}" for share in one["inside"]),
                f"{1000 * one['worst']:.0f}",
                *map(str, one["over"]),
                *told,
            ]
            line = " ".join(f"{cell:>{w}}" for cell, w in zip(cells, WIDTHS, strict=True))
            print(f"  {one['dance'][:24]:24} {one['seconds']:5.1f} {line}")
        counts = [sum(one["fell"][k] is None for one in rows) for k in range(4)]
        ways = ("untreated", "compensation", "by the truth", "ours, by sensors")
        told = ", ".join(f"{way} {count}" for way, count in zip(ways, counts, strict=True))
        print(f"  upright of {len(rows)}: {told}")
        print(f"  planning takes {np.median([one['spent'] for one in rows]):.2f} s a second of dance")


def robust(found: Sequence[Dance], workers: int) -> None:
    """Upright under disturbances, at 1.0 and 1.2 times the speed, by sensors' feedback."""
    rng = np.random.default_rng(1)
    cases: dict[str, Options] = {
        "as planned": Options(),
        "10 % heavier": Options(mass_scale=1.1),
        "10 % lighter": Options(mass_scale=0.9),
        "friction 0.6": Options(friction=0.6),
        "10 ms later": Options(delay=0.02),
        "pushes of 40 N, 0.1 s": Options(pushes=tuple(pushes(4, 40.0, 20.0, rng))),
        "no feedback": Options(feedback="none"),
    }
    print("\nUpright under disturbances (G1, feet planted, our feedback by sensors)")
    plans = [(dance, speed, staged(dance, speed, "planted").motion) for dance in found for speed in (1.0, 1.2)]
    for name, options in cases.items():
        ends = spread(fell, [(motion, options) for _, _, motion in plans], workers)
        first = [at for (_, speed, _), (at, _) in zip(plans, ends, strict=True) if speed == 1.0]
        second = [at for (_, speed, _), (at, _) in zip(plans, ends, strict=True) if speed == 1.2]
        told = ", ".join(f"{sum(at is None for at in some)} of {len(some)}" for some in (first, second))
        print(f"  {name:24} 1.0 × and 1.2 ×: {told}")


def hrp4c(folder: Path) -> None:
    """The authored dance of HRP-4C, on its own body."""
    from hrp4c_poses import SONG_AT, TEMPO, read_dance

    read = read_dance(folder / "hrp4c_dance")
    motion, robot = read.motion, robot_named("hrp4c")
    beats = SONG_AT + np.arange(int((motion.duration - SONG_AT) * TEMPO / 60) + 1) * 60 / TEMPO
    print("\nHRP-4C, Turn to the Future, song at 1.6 s")
    for feet in ("planted", "stepping"):
        for speed in (1.0, 1.2):
            warp = TimeMap.steady(speed)
            made = stage(motion, robot, warp, beats, np.unique(read.key_poses), feet, fps=60)
            at, _ = fell(made.motion, Options(), "hrp4c")
            over = made.limits.violations
            print(
                f"  {feet:9} {speed:g} ×: past limits {over[0]}, {over[1]}; ZMP inside "
                f"{100 * float((made.balanced.margin >= 0).mean()):.2f} %, "
                f"{'upright to the end' if at is None else f'fell at {at:.1f} s'} of {made.motion.duration:.1f} s"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--speeds", default="1.0,1.2")
    flags = parser.parse_args()
    warnings.simplefilter("ignore")
    parts, speeds = flags.only.split(","), [float(word) for word in flags.speeds.split(",")]
    found = list(dances(flags.folder)) if {"retarget", "balance", "steps", "robust"} & {*parts} else []
    runs: dict[str, Callable[[], None]] = {
        "balance": lambda: balance(found, flags.workers, "planted", speeds),
        "steps": lambda: balance(found, flags.workers, "stepping", [1.0]),
        "robust": lambda: robust(found[:8], flags.workers),
        "retarget": lambda: retargeting([(dance.name, dance.motion) for dance in found[8:]]),
        "hrp4c": lambda: hrp4c(flags.folder),
    }
    for part in parts:
        runs[part]()


if __name__ == "__main__":
    main()
