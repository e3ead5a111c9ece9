"""The two insights of 2007 as numbers: details go in faster music, keyposes stay; each beside what chance would give.

    python benchmarks/observe.py [FOLDER] [--seed 1]

The embedded troupe dances its four dances five times at each of three speeds, like the paper's 15 takes. Insight 1 has
a control: the same dances merely *played* faster, with poses as early and late (in seconds, so more of a beat in faster
music) and the same noise. Layers are told whole and as what takes share; the latter falls in the control, too, as takes
that are late by more of a beat share less, so it is the whole that counts. Insight 2 is held against the same valleys
at a random phase. A folder holds real repetitions, ``NAME_1.bvh``, ``NAME_2.bvh`` …; without NAME_1.beats beside them
each take is eight even parts from its start to its end, which says nothing about speed.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import numpy as np

from onbeat.cli.keypose_input import NO_BEATS
from onbeat.cli.observe_input import TAKES, Dance, beside, embedded
from onbeat.cli.observe_score import all_valleys, valley_score
from onbeat.errors import OnbeatError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import DANCES, perform_dance
from onbeat.examples.performer import Performance
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.troupe import SPEEDS
from onbeat.formats import read_motion
from onbeat.music.beat_files import read_beats
from onbeat.retime.attenuation import Attenuation, attenuation
from onbeat.retime.observe import Observation, observe
from onbeat.retime.takes import Take, repetitions
from onbeat.retime.upper_body import upper_body

PARTS = 8


def played(clip: Performance, speed: float) -> Performance:
    """A performance as it is, only faster."""
    motion = clip.motion
    shown = np.arange(int(motion.times[-1] / speed * motion.fps) + 1) / motion.fps * speed
    frames = np.minimum(np.round(shown * motion.fps).astype(np.int64), len(motion) - 1)
    return replace(
        clip, motion=motion.at(shown), keyposes=clip.keyposes / speed, beats=clip.beats / speed,
        contacts=clip.contacts[frames],
    )  # fmt: skip


def merely_played(dance: str, seed: int) -> Dance:
    """As ``embedded``, but every take is a performance at speed 1 that is played at its speed."""
    takes, beats = list[Take](), sum(figure.beats for figure in DANCES[dance])
    for speed in SPEEDS:
        for number in range(TAKES):
            rng = np.random.default_rng([seed, round(100 * speed), number])
            clip = played(perform_dance(DANCERS[0], dance, 1.0, 1, rng), speed)
            on = clip.keyposes[0] + (clip.beats[1] - clip.beats[0]) * np.arange(beats + 1)
            takes.append(Take(rehearse(clip, rng).motion, on, speed))
    return Dance(dance, takes, None, beats)


def looked_at(dance: Dance, seed: int) -> tuple[Observation, Attenuation]:
    """The upper body's curves and energies."""
    every = repetitions(dance.takes, upper_body(dance.takes[0].motion.skeleton), dance.cycle)
    return observe(every), attenuation(every, np.random.default_rng(seed))


def slopes(of: Attenuation, kind: int) -> str:
    """Of all layers, with their intervals."""
    return "  ".join(f"{slope:+.2f} [{low:+.2f},{high:+.2f}]" for slope, low, high in of.slopes[kind].tolist())


def percent(values: np.ndarray) -> str:
    """Shares of each layer."""
    return " ".join(f"{value:4.0%}" for value in values)


def embedded_dances(seed: int) -> None:
    """Both insights on the troupe."""
    for dance in DANCES:
        danced = embedded(dance, seed)
        found, energies = looked_at(danced, seed)
        control = looked_at(merely_played(dance, seed), seed)[1]
        print(f"\n{dance}: {len(found.repetitions)} takes of {found.repetitions.beats[-1]:g} beats")
        for kind, name in enumerate(("whole", "shared")):
            for label, of in (("danced", energies), ("merely played", control)):
                left = " | ".join(
                    f"{s:g}x {percent(r)}" for s, r in zip(of.speeds[1:], of.ratios[kind][1:], strict=True)
                )
                print(f"  {name:6} {label:13} left of layers 1-5: {left}")
                print(f"  {'':6} {'':13} slopes {slopes(of, kind)}")
        common = all_valleys(found)[1]
        told = valley_score(found, common, danced.keyposes, np.random.default_rng(seed))
        print(
            f"  {len(common)} valleys of all curves, {len(told.keyposes)} keyposes: precision {told.precision:.2f}, "
            f"recall {told.recall:.2f}, F {told.f:.2f}; chance F {told.chance:.2f} ± {told.chance_deviation:.2f}, "
            f"shifted by whole beats F {told.beat_chance:.2f}"
        )
        print(f"  variance at keyposes by that at other times (1.0, 1.2, 1.5, all): {told.contrast}")


def many_dancers(seeds: range) -> None:
    """Insight 2 over dancers and seeds: is it a lucky one?"""
    print(f"\ninsight 2, {len(DANCERS)} dancers x {len(seeds)} seeds: F, chance F, how often F is over 95 % of chance")
    for dance in DANCES:
        scores = list[tuple[float, ...]]()
        for dancer in range(len(DANCERS)):
            for seed in seeds:
                danced = embedded(dance, seed, dancer=dancer)
                every = repetitions(danced.takes, upper_body(danced.takes[0].motion.skeleton), danced.cycle)
                found = observe(every)
                told = valley_score(found, all_valleys(found)[1], danced.keyposes, np.random.default_rng(seed))
                usual = told.chance + 1.64 * told.chance_deviation
                scores.append((told.precision, told.recall, told.f, told.chance, usual, told.beat_chance))
        table = np.array(scores)
        mean, over = table.mean(axis=0), float(np.mean(table[:, 2] > table[:, 4]))
        print(
            f"  {dance:14} precision {mean[0]:.2f} recall {mean[1]:.2f} F {mean[2]:.2f} "
            f"(worst {table[:, 2].min():.2f}), chance F {mean[3]:.2f}, over it in {over:.0%}; whole beats F "
            f"{mean[5]:.2f}, over it in {np.mean(table[:, 2] > table[:, 5]):.0%}"
        )


def real(folder: Path, seed: int) -> None:
    """Repetitions in files."""
    paths = sorted(folder.glob("*.bvh"))
    for name, group in groupby(paths, key=lambda path: re.sub(r"[ _-]*\d+$", "", path.stem)):
        files = list(group)
        if len(files) < 2:
            continue
        try:
            takes = [real_take(path) for path in files]
            found, energies = looked_at(Dance(name, takes, None), seed)
        except OnbeatError as error:
            print(f"{name}: {error}")
            continue
        shared = percent((energies.shared[0] / energies.rms[0]) ** 2)
        curve = found.all.pooled
        print(
            f"{name}: {len(takes)} takes; energy that they share, layers 1-5: {shared}; variance "
            f"{np.percentile(curve, 5):.1e} to {np.percentile(curve, 95):.1e}, {len(all_valleys(found)[1])} valleys"
        )


def real_take(path: Path) -> Take:
    """A file with its beats, or in even parts."""
    motion = read_motion(path)
    beats = beside(path, NO_BEATS).beats
    if beats is not None:
        return Take(motion.replace(name=path.name), read_beats(beats).times, 1.0)
    return Take(motion.replace(name=path.name), np.linspace(0.0, motion.times[-1], PARTS + 1), 1.0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dancers", action="store_true", help="insight 2 over all dancers and three seeds, too")
    given = parser.parse_args()
    embedded_dances(given.seed)
    if given.dancers:
        many_dancers(range(given.seed, given.seed + 3))
    if given.folder:
        print()
        real(given.folder, given.seed)
