"""What 2007 claims of its method and of the robot (Sec. IV), and whether it holds on the robot here."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat.reproduce.p2.methods import OURS, PUBLISHED, SLACK, SPEEDS
from onbeat.reproduce.p2.stage import margins
from onbeat.reproduce.p2.tried import EXPERIMENTS, WISHES, Tried
from onbeat.reproduce.result import Claim
from onbeat.retime.measures import Measures

FILTER = "pollard2002"
TRIALS = tuple(f"{EXPERIMENTS[speed][1]}, {wish}" for speed in SPEEDS for wish in WISHES.values())
"""The tables of all methods: at both speeds, both wishes."""
SAID = (
    "The method keeps the limits of angle and of angular velocity (Eqs. 13 and 14)",
    "The method keeps more details than Pollard's filter (Fig. 8, b.1)",
    "Where limits are past, Pollard's filter runs at one constant speed; the method does not (Fig. 8, b.2)",
    "The method reproduces keyposes that Pollard's filter cannot clearly reproduce",
    "Pollard's filter accelerates more sharply, by which a robot may fall",
    "At the original speed the robot imitates the dance stably (Fig. 7)",
    "At 1.2× the zero-moment point stays inside and the robot dances to the end, in simulation (Fig. 9)",
)


def tried_claims(found: Tried | None, why: str = "") -> tuple[Claim, ...]:
    """The claims of Sec. IV; ``why`` says why they cannot be told where nothing could be tried."""
    if found is None:
        return tuple(Claim(said, None, f"Not tried: {why}.") for said in SAID)
    return (
        _limits(found),
        _details(found),
        _plateaus(found),
        _keyposes(found),
        _accelerations(found),
        *(_robot(found, place) for place in range(len(SPEEDS))),
    )


def _of(found: Tried, method: str) -> Measures:
    """At the original speed, as captured: the setting of Fig. 8."""
    return found.asked[True, SPEEDS[0]].scaled[method].measures


def _limits(found: Tried) -> Claim:
    over = {
        method: [sum(one.scaled[method].measures.violations) for one in found.asked.values()]
        for method in (PUBLISHED, FILTER, OURS)
    }
    told = ", ".join(f"{_joints(counts)} by {method}" for method, counts in over.items())
    return Claim(SAID[0], not any(over[PUBLISHED]), f"Past a limit in {len(found.asked)} trials: {told}.", TRIALS)


def _joints(counts: Sequence[int]) -> str:
    """How many joints, from the least to the most of some trials."""
    low, high = min(counts), max(counts)
    if not high:
        return "no joint"
    return f"{high} joint{'s' if high > 1 else ''}" if low == high else f"{low} to {high} joints"


def _details(found: Tried) -> Claim:
    asked = found.asked[True, SPEEDS[0]]
    own, other = (asked.scaled[method].detail for method in (PUBLISHED, FILTER))
    if not np.isfinite([own, other]).all():
        return Claim(SAID[1], None, "There is no detail away from limits.")
    more = own > other, own > asked.slack
    told = (
        f"{PUBLISHED} keeps {own:.0%} of the detail away from limits, {FILTER} {other:.0%} with the stiffness that "
        f"errs least and {asked.slack:.0%} with {SLACK:.0f} 1/s². The paper does not tell its gains"
    )
    decides = "" if more[0] == more[1] else ", and they decide it"
    return Claim(SAID[1], more[0] if more[0] == more[1] else None, f"{told}{decides}.", TRIALS[:1])


def _plateaus(found: Tried) -> Claim:
    each = {name: 60 * float(_of(found, name).plateaus.mean()) for name in (PUBLISHED, FILTER)}
    told = f"Joints run at full speed for {each[PUBLISHED]:.1f} s of a minute by {PUBLISHED}, {each[FILTER]:.1f} s by "
    return Claim(SAID[2], each[PUBLISHED] < 0.5 * each[FILTER], f"{told}{FILTER}.", TRIALS[:1])


def _keyposes(found: Tried) -> Claim:
    worst = {name: float(np.degrees(_of(found, name).worst_keypose)) for name in (PUBLISHED, FILTER)}
    mean = {name: float(np.degrees(_of(found, name).keypose_errors.mean())) for name in worst}
    told = " and ".join(f"{worst[name]:.1f}° ({name})" for name in worst)
    means = " and ".join(f"{mean[name]:.1f}°" for name in worst)
    holds = worst[PUBLISHED] < worst[FILTER] and mean[PUBLISHED] < mean[FILTER]
    why = "" if holds else ". A layer is lowered for all of a segment between beats, and takes its keyposes along"
    found_so = f"The worst keypose that is in reach is off by {told}, the mean of all by {means}"
    return Claim(SAID[3], holds, f"{found_so}{why}.", TRIALS[:2])


def _accelerations(found: Tried) -> Claim:
    each = {name: float(_of(found, name).peak_acceleration.mean()) for name in (PUBLISHED, FILTER)}
    told = " and ".join(f"{peak:.0f} rad/s² by {name}" for name, peak in each.items())
    return Claim(SAID[4], each[PUBLISHED] < each[FILTER], f"The joints' peaks are {told}, in the mean.", TRIALS[:1])


def _robot(found: Tried, place: int) -> Claim:
    said, speed = SAID[5 + place], SPEEDS[place]
    if speed not in found.danced:
        return Claim(said, None, f"Not simulated: {found.why}.")
    own, ours = found.danced[speed][:2]
    clear = float(np.mean(margins(found.robot, own) > 0))
    told = (
        f"By {own.method} {own.fell}, its planned zero-moment point inside {own.document.zmp.inside:.1%} of the time "
        f"and the measured one clear of the soles' edge {clear:.1%}; by {ours.method} {ours.fell}. On another robot, "
        "in simulation."
    )
    good = own.trial.upright and (speed == SPEEDS[0] or own.document.zmp.inside == 1.0)
    return Claim(said, good, told, (f"{EXPERIMENTS[speed][0]}, numbers",))
