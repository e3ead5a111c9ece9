"""What 2007 claims of its method and of the robot (Sec. IV), and whether it holds on the robot here."""

from __future__ import annotations

import numpy as np

from onbeat.reproduce.p2_methods import OURS, PUBLISHED, SLACK, SPEEDS
from onbeat.reproduce.p2_stage import margins
from onbeat.reproduce.p2_tried import Tried
from onbeat.reproduce.result import Claim
from onbeat.retime.measures import Measures

FILTER = "pollard2002"
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
        return tuple(Claim(said, None, f"not tried: {why}") for said in SAID)
    return (
        _limits(found),
        _details(found),
        _plateaus(found),
        _keyposes(found),
        _accelerations(found),
        *(_robot(found, place) for place in range(len(SPEEDS))),
    )


def _of(found: Tried, method: str, *, captured: bool = True) -> Measures:
    """At the original speed, as captured unless it is told otherwise: the setting of Fig. 8."""
    return found.asked[captured, SPEEDS[0]].scaled[method].measures


def _degrees(radians: float) -> str:
    return f"{np.degrees(radians):.1f}°"


def _limits(found: Tried) -> Claim:
    over = {
        method: [sum(one.scaled[method].measures.violations) for one in found.asked.values()]
        for method in (PUBLISHED, OURS, FILTER)
    }
    told = ", ".join(f"{method} {', '.join(map(str, counts))}" for method, counts in over.items())
    where = "as captured at 1.0× and 1.2×, as planned at 1.0× and 1.2×, looked at 1,000 times a second"
    return Claim(SAID[0], not any(over[PUBLISHED]), f"joints past a limit, {where}: {told}")


def _details(found: Tried) -> Claim:
    asked = found.asked[True, SPEEDS[0]]
    own, other, ours = (asked.scaled[method].detail for method in (PUBLISHED, FILTER, OURS))
    if not np.isfinite([own, other]).all():
        return Claim(SAID[1], None, "there is no detail away from limits")
    told = (
        f"of the detail away from limits {PUBLISHED} keeps {own:.0%}, {FILTER} {other:.0%} with the stiffness used "
        f"here, which errs least, and {asked.slack:.0%} with {SLACK:.0f} 1/s², {OURS} {ours:.0%}; the paper does not "
        "tell its gains"
    )
    more = own > other, own > asked.slack
    return Claim(SAID[1], more[0] if more[0] == more[1] else None, told + ", and they decide it" * (more[0] != more[1]))


def _plateaus(found: Tried) -> Claim:
    each = {name: 60 * float(_of(found, name).plateaus.mean()) for name in (PUBLISHED, FILTER, OURS)}
    told = ", ".join(f"{name} {seconds:.1f}" for name, seconds in each.items())
    return Claim(SAID[2], each[PUBLISHED] < 0.5 * each[FILTER], f"seconds a minute at full speed: {told}")


def _keyposes(found: Tried) -> Claim:
    worst = {name: float(np.degrees(_of(found, name).worst_keypose)) for name in (PUBLISHED, FILTER, OURS)}
    mean = {name: float(np.degrees(_of(found, name).keypose_errors.mean())) for name in worst}
    told = ", ".join(f"{name} {worst[name]:.1f}° and {mean[name]:.1f}°" for name in worst)
    holds = worst[PUBLISHED] < worst[FILTER] and mean[PUBLISHED] < mean[FILTER]
    planned = ", ".join(f"{name} {_degrees(_of(found, name, captured=False).worst_keypose)}" for name in worst)
    why = "" if holds else ". A layer is lowered for all of a segment between beats, and takes its keyposes along"
    found_so = f"off at the worst keypose in reach, and on the mean of all: {told}; the worst as planned: {planned}"
    return Claim(SAID[3], holds, found_so + why)


def _accelerations(found: Tried) -> Claim:
    each = {name: float(_of(found, name).peak_acceleration.mean()) for name in (PUBLISHED, FILTER, OURS)}
    told = ", ".join(f"{name} {peak:.0f} rad/s²" for name, peak in each.items())
    return Claim(SAID[4], each[PUBLISHED] < each[FILTER], f"mean of the joints' peaks: {told}")


def _robot(found: Tried, place: int) -> Claim:
    said, speed = SAID[5 + place], SPEEDS[place]
    if speed not in found.danced:
        return Claim(said, None, f"not simulated: {found.why}")
    own, ours = found.danced[speed][:2]
    told = "; ".join(
        f"{one.method} {one.fell}, its planned zero-moment point inside {one.document.zmp.inside:.1%} of the time, the "
        f"measured one clear of the soles' edge {np.mean(margins(found.robot, one) > 0):.1%}"
        for one in (own, ours)
    )
    good = own.trial.upright and (speed == SPEEDS[0] or own.document.zmp.inside == 1.0)
    return Claim(said, good, f"{told}. On another robot, in simulation")
