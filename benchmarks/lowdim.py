"""Motions in few dimensions: keyposes beside uniform sampling, on the embedded troupe and on recorded motions.

Each table has the mean distance in millimetres of rebuilt joints from the true ones, on poses that taught neither
space, at the same number of dimensions and of poses: of keyposes, of uniform sampling (the mean over eight phases), and
their ratio. Three kinds of unseen poses: all frames, the slower half of them, keyposes. Then the variance of each
space's own poses (Fig. 11) and the share of unnatural postures (Figs. 13 and 14).

Recorded motions: seven styles of a gesture, three takes each (they are not labelled by person: a style stands for one),
and takes of a dance. They have no music: where a motion has no pulse of its own, its keyposes are its rests, and where
it begins and ends.

    python benchmarks/lowdim.py
    python benchmarks/lowdim.py --data my_data
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from onbeat.errors import PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.formats import read_motion
from onbeat.keyposes.candidates import minima
from onbeat.keyposes.energy import energy_of
from onbeat.keyposes.extract import DEFAULT, find_keyposes
from onbeat.keyposes.held_out import PHASES, HeldOut, Taught, Unseen, held_out, spaces
from onbeat.keyposes.lessons import lesson
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.points import body_points
from onbeat.keyposes.unnatural import Natural
from onbeat.keyposes.vectors import pose_vectors
from onbeat.motion import Motion

DIMS = (1, 2, 3, 4, 5, 6, 8)
KINDS = ("through", "beyond", "length_change")
TASKS = ("raise-up-both-hands", "raise-up-left-hand", "wave-both-hands")
CMU = (("05", ("09", "10")), ("05", ("14", "15")), ("05", ("18", "19", "20")))

Lessons = list[tuple[Taught, Unseen]]


def troupe(speed: float, *, found: bool) -> tuple[Lessons, list[Motion]]:
    """The folk dance by eight dancers: the cycle in the middle of three teaches."""
    rng = np.random.default_rng(0)
    clips = [perform(dancer, [FOLK_DANCE], speed, 3, rng, 60.0) for dancer in DANCERS]
    vectors = pose_vectors([clip.motion for clip in clips])
    times = [find_keyposes(clip.motion, clip.beats).times if found else clip.keyposes for clip in clips]
    lessons = [
        lesson(clip.person, own, own_times, 8) for clip, own, own_times in zip(clips, vectors, times, strict=True)
    ]
    return lessons, [clip.motion for clip in clips]


def takes(groups: dict[str, list[Motion]]) -> tuple[Lessons, list[Motion]]:
    """The first take of each teaches, the others are unseen; keyposes are found, without music."""
    everything = [motion for motions in groups.values() for motion in motions]
    vectors = iter(pose_vectors(everything))
    lessons: Lessons = []
    for name, motions in groups.items():
        times = [rests(motion) for motion in motions]
        own = [next(vectors) for _ in motions]
        if len(times[0]) < 2:
            continue
        taught = Taught(name, own[0], times[0], 0.0, own[0].duration)
        lessons += [
            (taught, Unseen(name, other, ((0.0, other.duration),), at))
            for other, at in zip(own[1:], times[1:], strict=True)
        ]
    return lessons, everything


def rests(motion: Motion) -> np.ndarray:
    """Keyposes on the motion's own pulse; without one, all rests of the body, its first pose and its last."""
    try:
        return find_keyposes(motion, motion_beats(motion)).times
    except PlanError:
        found = minima(energy_of(body_points(motion)).local)
        deep = (found.values < DEFAULT.t1) | (found.rises > DEFAULT.t2)
        last = (len(motion) - 1) / motion.fps
        inner = found.times[deep & (found.times > 0.1) & (found.times < last - 0.1)]
        return np.concatenate(([0.0], inner, [last]))


def bandai(data: Path, task: str) -> dict[str, list[Motion]]:
    """A task in seven styles, three takes each."""
    groups: dict[str, list[Motion]] = {}
    for path in sorted((data / "bandai").glob(f"{task}_*.bvh")):
        groups.setdefault(path.stem.rsplit("_", 1)[0].rsplit("_", 1)[1], []).append(read_motion(path))
    return groups


def cmu(data: Path) -> dict[str, list[Motion]]:
    """Figures of a ballet and modern dance, two or three takes of each."""
    return {
        f"{subject}_{numbers[0]}": [read_motion(data / "cmu" / f"{subject}_{n}.amc", 120.0) for n in numbers]
        for subject, numbers in CMU
    }


def table(title: str, lessons: Lessons, motions: Iterable[Motion], *, strangers: bool = True) -> None:
    """Print what a set of dances gives."""
    taught = list({id(one[0]): one[0] for one in lessons}.values())
    unseen = [one[1] for one in lessons]
    print(f"\n{title}: {len(taught)} teach with {sum(len(one.keyposes) for one in taught)} poses, {len(unseen)} unseen")
    rows = [("unseen frames", held_out(taught, unseen, max(DIMS)))]
    if strangers and len({one.person for one in taught}) > 1:
        rows.append(("unseen people", held_out(taught, unseen, max(DIMS), strangers=True)))
    print(f"{'':16s}{'K':>3s}" + "".join(f"{name:>27s}" for name in ("all frames", "at rest", "keyposes")))
    for name, found in rows:
        errors(name, found)
    ours, theirs = spaces(taught)
    for which, made in (("variance, keyposes", [ours]), ("variance, uniform", theirs)):
        shares = [np.mean([space.cumulative[min(dims, len(space)) - 1] for space in made]) for dims in DIMS]
        print(f"{which:20s}" + "".join(f"{share:8.3f}" for share in shares))
    postures(taught, {id(m): m for m in motions}.values())


def errors(name: str, found: HeldOut) -> None:
    for dims in DIMS:
        if dims <= len(found.dims):
            at = dims - 1
            cells = "".join(
                f"{1000 * ours:8.1f}{1000 * theirs:8.1f}{ratio:7.2f}    "
                for ours, theirs, ratio in zip(
                    found.keypose[:, at], found.uniform_mean[:, at], found.ratio[:, at], strict=True
                )
            )
            print(f"{name:16s}{dims:3d}    {cells}")


def postures(taught: list[Taught], motions: Iterable[Motion]) -> None:
    vectors = pose_vectors(list(motions))
    originals = {one.name: motion for one, motion in zip(vectors, motions, strict=True)}
    natural = Natural.of(vectors)
    ours, theirs = spaces(taught)
    for which, made in (("keyposes", [ours]), ("uniform", theirs[:: max(1, PHASES // 4)])):
        rows = [
            [
                _shares(natural, space.reduced(one.vectors.values[::2], dims), one, originals)
                for space in made
                for one in taught
            ]
            for dims in DIMS
        ]
        for number, kind in enumerate(KINDS):
            means = np.mean([[shares[number] for shares in row] for row in rows], axis=1)
            print(f"{kind + ', ' + which:24s}" + "".join(f"{mean:8.4f}" for mean in means))


def _shares(natural: Natural, poses: np.ndarray, one: Taught, originals: dict[str, Motion]) -> list[float]:
    shares = natural.judge(poses, one.vectors, originals[one.vectors.name]).shares()
    return [shares[kind] for kind in KINDS]


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="a folder with bandai/ and cmu/")
    parser.add_argument("--speeds", nargs="+", type=float, default=[1.0, 1.5])
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    for speed in given.speeds:
        table(f"troupe, {speed:g}x, true keyposes", *troupe(speed, found=False))
    table("troupe, 1x, found keyposes", *troupe(1.0, found=True))
    if given.data:
        for task in TASKS:
            table(f"bandai, {task}", *takes(bandai(given.data, task)))
        table("cmu, figures of 05", *takes(cmu(given.data)), strangers=False)
        dance = read_motion(given.data / "bandai" / "dance-short_normal_001.bvh")
        table("bandai, one dance", [lesson(dance.name, pose_vectors([dance])[0], rests(dance))], [dance])


if __name__ == "__main__":
    main()
