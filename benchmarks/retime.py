"""Retiming inside limits, every method on the same demands in one run.

Usage: ``python benchmarks/retime.py DATA [--only limits,choices,paper,sync,timing,streaming]``. The folder holds
``g1_moves`` and ``hrp4c_dance``, which are no part of onbeat.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from onbeat.errors import PlanError
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.retime.demand import Demand
from onbeat.retime.layers2007 import literal
from onbeat.retime.measures import measure
from onbeat.retime.methods import METHODS
from retime_dances import Dance, arms, base_limits, foreign, g1_dances, hrp4c_dance
from retime_more import choices, paper, streaming, sync, timing

TO_SPEED = 0.05  # [s] from rest to full speed: the acceleration limit where a table has none

PARTS = ("limits", "choices", "paper", "sync", "timing", "streaming")
SETS = ("G1 on g1", "G1's arms on talos", "G1's arms on hrp4c")
Case = tuple[Dance, Limits]


def cases(folder: Path) -> dict[str, list[Case]]:
    """Dances on tables, by the table."""
    on_g1 = list(g1_dances(folder / "g1_moves"))
    authored = hrp4c_dance(folder / "hrp4c_dance")
    on_arms = [arms(dance) for dance in on_g1]
    return {
        "G1 on g1": [(dance, robot_limits("g1").of(dance.joints)) for dance in on_g1],
        "HRP-4C's dance on hrp4c": [(authored, robot_limits("hrp4c").of(authored.joints))],
        "G1's arms on hrp4c": [(dance, foreign(dance, "hrp4c")) for dance in on_arms],
        "G1's arms on talos": [(dance, foreign(dance, "talos")) for dance in on_arms],
        "G1's arms, 1.45 × base layer": [(dance, base_limits(dance)) for dance in on_arms],
    }


def table(name: str, found: Sequence[Case], speeds: Sequence[float]) -> None:
    """Every method on some dances; figures over all joints that are past a limit in the wish."""
    for speed in speeds:
        demands = [dance.demand(limits.with_acceleration(TO_SPEED), speed) for dance, limits in found]
        past = [demand.violated(demand.wish.controls, derivatives=False).any(axis=0) for demand in demands]
        print(f"\n{name}, {speed:g} ×: {sum(p.sum() for p in past)} of {sum(len(p) for p in past)} joints past a limit")
        heads = ("past limits", "rms °", "keypose °", "peak acc.", "at full speed", "CPU s")
        under = ("pos., vel. joints", "", "worst, all", "rad/s²", "% of time", "")
        for words in (heads, under):
            print("  " + " " * 16 + "".join(f"{w:>{n}}" for w, n in zip(words, (18, 7, 17, 11, 15, 7), strict=True)))
        for method, make in {**METHODS, "2007, as printed": literal}.items():
            row(method, demands, past, make)
        wish = [np.abs(demand.wish.differences(2)).max(axis=0)[p] for demand, p in zip(demands, past, strict=True)]
        print(f"  {'the wish':16} {'':>16} {'':>7} {'':>16} {np.concatenate(wish).mean():10.0f}")


def row(method: str, demands: Sequence[Demand], past: Sequence[np.ndarray], make: Callable) -> None:
    """One method's line."""
    begin = time.process_time()
    try:
        answers = [make(demand, lambda share: None) for demand in demands]
    except PlanError as error:
        print(f"  {method:16} {error}")
        return
    spent = time.process_time() - begin
    found = [measure(demand, answer.trajectory) for demand, answer in zip(demands, answers, strict=True)]
    over = np.sum([one.violations for one in found], axis=0)

    def mean(key: str) -> float:
        return float(np.concatenate([getattr(one, key)[p] for one, p in zip(found, past, strict=True)]).mean())

    worst = np.degrees(max(one.worst_keypose for one in found))
    every = np.degrees(max(float(one.keypose_errors.max(initial=0.0)) for one in found))
    print(
        f"  {method:16} {over[0]:8d} {over[1]:7d} {np.degrees(mean('rms')):7.2f} {worst:8.2f} {every:7.1f} "
        f"{mean('peak_acceleration'):10.0f} {100 * mean('plateaus'):14.2f} {spent:6.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="words, with commas, of the parts to run: " + ", ".join(PARTS))
    parser.add_argument("--speeds", default="1.0,1.2,1.5")
    flags = parser.parse_args()
    warnings.simplefilter("ignore")
    speeds = [float(word) for word in flags.speeds.split(",")]
    parts = [word for word in flags.only.split(",") if word] or list(PARTS)
    found = cases(flags.folder)
    on_g1, on_talos, on_hrp4c = (
        [(d, limits.with_acceleration(TO_SPEED)) for d, limits in found[name]] for name in SETS
    )
    if "limits" in parts:
        for name, some in found.items():
            table(name, some, speeds)
    if "choices" in parts:
        choices([*found[SETS[2]], *found["G1's arms, 1.45 × base layer"]])
    if "paper" in parts:
        paper(on_hrp4c + on_talos)
    if "sync" in parts:
        sync(on_g1 + on_talos)
    if "timing" in parts:
        timing(*on_talos[5])
    if "streaming" in parts:
        streaming("G1, 29 joints", on_g1)
        streaming("G1's arms on TALOS, 14 joints", on_talos)


if __name__ == "__main__":
    main()
