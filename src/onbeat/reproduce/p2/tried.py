"""Secs. III and IV of 2007 done again: a dance on a robot's upper body by all methods, and the robot in simulation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.motion import Motion
from onbeat.reproduce.data import Data
from onbeat.reproduce.p2.curves import curve_figure, drawn_joint, looked_at, lowered
from onbeat.reproduce.p2.methods import (
    METHODS,
    OURS,
    PRINTED,
    PUBLISHED,
    ROBOT,
    SLACK,
    SPEEDS,
    Asked,
    ask,
)
from onbeat.reproduce.p2.stage import WAYS, Danced, dance_on
from onbeat.reproduce.p2.stage_figure import stage_figure
from onbeat.reproduce.p2.takes import Solo, real_solo, troupe_solo
from onbeat.reproduce.p2.wish import on_robot, upper_table, why_not
from onbeat.reproduce.result import FigureResult, Part, Row, TableResult
from onbeat.retime.measures import Measures
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.perform import Feet
from onbeat.viewer.plots.files import figure_bytes
from onbeat.viewer.plots.retime import retime_figure

WISHES = MappingProxyType({True: "as captured", False: "as planned"})
"""How the angles are found that are wished: with no thought of the hinges' speeds, or with a price on them."""
COLUMNS = ("", "paper", f"ours: {PUBLISHED}", PRINTED, OURS, "pollard2002", "uniform", "")
EXPERIMENTS = MappingProxyType({1.0: ("Fig. 7", "Sec. IV-A"), 1.2: ("Fig. 9", "Sec. IV-B")})
SHOWN: tuple[tuple[bool, str, Feet], ...] = (*((True, way, "stepping") for way in WAYS), (False, OURS, "planted"))
"""What is danced in simulation: on angles as captured or not, by which method, with which feet."""
FOUND = 0.25
"""Share of the work that finds the robot's angles."""
OTHERS = 3
"""More dancers that are tried in simulation."""
_ORDER = (PUBLISHED, PRINTED, *METHODS[1:])


@dataclass(frozen=True, eq=False)
class Tried:
    """A dance on a robot.

    Parameters
    ----------
    robot, solo : who dances what.
    asked : what all methods make of it, by whether it is as captured, and by speed.
    danced : in simulation, by speed; empty where MuJoCo is not there.
    others : more dancers of the troupe in simulation at the higher speed, by name: is one lucky?
    why : why it is not, or None.
    """

    robot: Robot
    solo: Solo
    asked: Mapping[tuple[bool, float], Asked]
    danced: Mapping[float, tuple[Danced, ...]]
    others: Mapping[str, tuple[Danced, ...]]
    why: str | None


def tried(data: Data, step: Callable[[float, str], None]) -> Tried:
    """The first real dance, or one of the troupe's, on the robot: by all methods, and in simulation.

    Raises
    ------
    OnbeatError
        If the dance cannot be read, or cannot be the robot's.
    """
    robot = robot_named(ROBOT)
    if data.embedded:
        solo = troupe_solo(0, data.seed, 1 if data.quick else 2)
    else:
        solo = real_solo(data.motion_files()[0], data.fps)
    own = angles_of(solo, robot, step)
    tables = {captured: upper_table(robot, own[captured]) for captured in WISHES}
    asked = dict[tuple[bool, float], Asked]()
    for captured, speed in ((captured, speed) for captured in WISHES for speed in SPEEDS):
        step(FOUND + 0.1 * len(asked) / 4, f"inside the robot's limits, by all methods, at {speed:g}×")
        asked[captured, speed] = ask(tables[captured], solo, speed)
    why, danced = why_not(), dict[float, tuple[Danced, ...]]()
    for place, speed in enumerate(SPEEDS if why is None else ()):
        ways = list[Danced]()
        for captured, method, feet in SHOWN:
            step(0.35 + 0.2 * (place + len(ways) / len(SHOWN)), f"in simulation at {speed:g}×, {method}, {feet}")
            ways.append(dance_on(robot, own[captured], solo, speed, method, feet, data.seed))
        danced[speed] = tuple(ways)
    many = range(1, 1 + OTHERS) if danced and data.embedded and not data.quick else range(0)
    return Tried(robot, solo, asked, danced, _others(robot, many, data.seed, step), why)


def angles_of(solo: Solo, robot: Robot, step: Callable[[float, str], None]) -> dict[bool, Motion]:
    """The dance as the robot's angles, by whether it is as captured."""
    own = dict[bool, Motion]()
    for captured, said in WISHES.items():
        begun, words = len(own) / len(WISHES), f"finding {robot.body.name}'s angles, {said}"

        def told(share: float, begun: float = begun, words: str = words) -> None:
            step(FOUND * (begun + share / len(WISHES)), words)

        told(0.0)
        own[captured] = on_robot(solo, robot, captured=captured, progress=told)
    return own


def _others(
    robot: Robot, dancers: range, seed: int, step: Callable[[float, str], None]
) -> Mapping[str, tuple[Danced, ...]]:
    out = dict[str, tuple[Danced, ...]]()
    for place, dancer in enumerate(dancers):
        name = DANCERS[dancer].name
        step(0.75 + 0.25 * place / len(dancers), f"{name} in simulation")
        solo = troupe_solo(dancer, seed)
        own = on_robot(solo, robot, captured=True)
        out[name] = tuple(dance_on(robot, own, solo, SPEEDS[-1], method, "stepping", seed) for method in WAYS)
    return out


def tried_parts(found: Tried) -> tuple[Part, ...]:
    """Figures and tables of Secs. III and IV, in the paper's order."""
    tables = [_table(found.asked[captured, speed], captured) for speed in SPEEDS for captured in WISHES]
    robots = [part for speed in found.danced for part in (_stage(found, speed), _stage_table(found, speed))]
    first, second = (robots[:2], robots[2:]) if robots else ([], [])
    more = (_others_table(found),) if found.others else ()
    return (_figure_6(found), *first, _figure_8(found), *tables[:2], *second, *more, *tables[2:])


def _figure_6(found: Tried) -> FigureResult:
    result = found.asked[True, SPEEDS[0]].scaled[PUBLISHED].result
    assert result is not None
    look, share = looked_at(result), lowered(result)
    return FigureResult(
        "Fig. 6",
        "Layers are lowered, the finest first, until the limits are kept",
        figure_bytes(retime_figure([result], drawn_joint(result), (look.start, look.end)), "svg"),
        "A drawing of the method: where a joint is past its limit the weights of its layers are lowered from the "
        "finest on; all layers coarser than the one that is being lowered keep weight 1, all finer ones have 0.",
        f"The same on a real joint, {drawn_joint(result)} at {SPEEDS[0]:g}×: its angle, its velocity, and the weights "
        "of seven layers from four beats to 1/16 beat.",
        f"Over the upper body, a layer is lowered in {share[0]:.0%} of the time, and a finer layer never has more "
        "weight than a coarser one."
        if share[1] == 0
        else f"In {share[1]:.2%} of the time a finer layer has more weight than a coarser one.",
    )


def _figure_8(found: Tried) -> FigureResult:
    asked = found.asked[True, SPEEDS[0]]
    results = [one for name in ("pollard2002", OURS, PUBLISHED) if (one := asked.scaled[name].result) is not None]
    drawn = drawn_joint(results[0])
    return FigureResult(
        "Fig. 8",
        "A joint at the original speed: the captured motion, the paper's method, Pollard's filter, and ours",
        figure_bytes(curve_figure(results), "svg"),
        "The left shoulder's yaw on HRP-2 at 1.0×: captured (red), by Pollard's filter (green) and by the paper's "
        "method (blue), as angle and as velocity. Enlarged: the filter lacks high frequencies that the method keeps "
        "(b.1), and stays at one constant speed where the limit is past, which the method does not (b.2).",
        f"{drawn} of {found.robot.body.name}: the dance as captured (grey), by the paper's method (orange), "
        "by Pollard's filter (purple) and by onbeat's programme (blue). (b.1) is where the original has most detail "
        "away from its limit, (b.2) where methods are longest at it.",
        "Our programme runs at full speed, too, entering and leaving it with bounded acceleration: a joint that is too "
        "slow gets farthest so. What is kept of the detail, and how long joints run at full speed, is in the table.",
    )


def _table(asked: Asked, captured: bool) -> TableResult:
    """All methods on one wish."""
    speed, wish = asked.speed, WISHES[captured]
    number = f"{EXPERIMENTS[speed][1]}, {wish}"
    price = "Angles found with no thought of the hinges' speeds, the paper's setting"
    planned = "Angles found as onbeat finds them, with a price on speeds that hinges do not have"
    remark = (
        f"{price if captured else planned}: {asked.past} of {asked.joints} joints of the upper body are past a limit "
        f"at some time, by up to {asked.fastest:.1f} times their speed."
    )
    return TableResult(
        number, f"The upper body at {speed:g}×, by all methods, its angles {wish}", _rows(asked), COLUMNS, remark
    )


def _rows(asked: Asked) -> tuple[Row, ...]:
    def row(label: str, paper: str | None, told: Callable[[str], str], note: str = "") -> Row:
        cells = [told(name) if name in asked.scaled else "fails" for name in _ORDER]
        return Row(label, paper, cells[0], note, tuple(cells[1:]))

    def of(name: str) -> Measures:
        return asked.scaled[name].measures

    def detail(name: str) -> str:
        kept = asked.scaled[name].detail
        return f"{max(kept, 0.0):.0%}" if np.isfinite(kept) else "–"

    slack = f"by Pollard's filter of {SLACK:.0f} 1/s² {asked.slack:.0%}" if np.isfinite(asked.slack) else ""
    return (
        row("joints past a limit of angle, of speed", "none", lambda name: "{}, {}".format(*of(name).violations)),
        row(
            "root mean square from the dance", None, lambda name: f"{_degrees(np.sqrt(np.square(of(name).rms).mean()))}"
        ),
        row(
            "worst keypose of those in reach",
            "clear",
            lambda name: _degrees(of(name).worst_keypose),
        ),
        row("keyposes, the mean", None, lambda name: _degrees(of(name).keypose_errors.mean()), "all, in reach or not"),
        row("detail kept away from limits", "more than Pollard's", detail, slack),
        row(
            "at full speed, seconds a minute",
            "less than Pollard's",
            lambda name: f"{60 * of(name).plateaus.mean():.1f}",
            "mean of the joints",
        ),
        row(
            "peak acceleration, rad/s²",
            "less than Pollard's",
            lambda name: f"{of(name).peak_acceleration.mean():.0f}",
            "mean of the joints",
        ),
        row(
            "danced when the music ends",
            "all",
            lambda name: f"{asked.scaled[name].done:.0%}",
            "uniform slows all of it, so that no beat is met",
        ),
    )


def _degrees(radians: float) -> str:
    return f"{np.degrees(radians):.1f}°"


def _stage(found: Tried, speed: float) -> FigureResult:
    number = EXPERIMENTS[speed][0]
    danced = found.danced[speed][:2]
    said = {
        "Fig. 7": "Photographs of HRP-2 dancing at the original speed beside the dancer: it imitates the dance stably.",
        "Fig. 9": "Pictures of HRP-2 in simulation at 1.2×, its zero-moment point marked: it stays inside the soles, "
        "and the robot dances to the end.",
    }
    told = "; ".join(f"{one.method}: {one.fell}" for one in danced)
    scaled = found.asked[True, speed].scaled
    worst = [f"{_degrees(scaled[one.method].measures.worst_keypose)} ({one.method})" for one in danced]
    return FigureResult(
        number,
        f"The robot at {speed:g}×, in simulation",
        figure_bytes(stage_figure(found.robot, found.solo, danced), "svg"),
        said[number],
        f"The dancer at the first keyposes, below it {found.robot.body.name} in MuJoCo at the same moments, its upper "
        f"body by the paper's method and by onbeat's on the same angles as captured; {told}.",
        "At the worst keypose that is in reach the upper body is " + ", ".join(worst) + " off what was captured.",
    )


def _stage_table(found: Tried, speed: float) -> TableResult:
    rows = tuple(_danced(one, place) for place, one in enumerate(found.danced[speed]))
    return TableResult(
        f"{EXPERIMENTS[speed][0]}, numbers",
        f"{found.robot.body.name} in simulation at {speed:g}×",
        rows,
        (
            "upper body, feet",
            "paper",
            "ours",
            "planned ZMP inside",
            "joints off",
            "beats met",
            "past limits",
            "",
        ),
        "The planned zero-moment point is the whole model's by inverse dynamics, inside by so much at least; “joints "
        "off” is between what the robot was told and did; “past limits” are hinges, legs too, that are past their "
        "angle or speed at any time.",
    )


def _others_table(found: Tried) -> TableResult:
    rows = list[Row]()
    for name, danced in found.others.items():
        own, ours = danced
        worst = tuple(_degrees(one.staged.retimed.measures.worst_keypose) for one in danced)
        rows.append(Row(name, "balanced", own.fell, "", (ours.fell, *worst)))
    heads = ("dancer", "paper", f"ours: {PUBLISHED}", OURS, f"worst keypose, {PUBLISHED}", f"worst keypose, {OURS}", "")
    return TableResult(
        "Fig. 9, dancers",
        f"More dancers of the troupe on {found.robot.body.name} in simulation at {SPEEDS[-1]:g}×",
        tuple(rows),
        heads,
        "Angles as captured, stepping. The worst keypose is of those that all hinges have the time for, legs too.",
    )


def _danced(one: Danced, place: int) -> Row:
    document = one.document
    assert document.trial is not None
    met = f"{document.trial.beats_met} of {document.trial.beats}"
    over = [
        name
        for name, excess in zip(document.joints, one.staged.limits.velocity_excess.tolist(), strict=True)
        if excess > 1e-6
    ]
    inside = f"{document.zmp.inside:.1%}, by {document.zmp.worst_mm:.0f} mm"
    past = f"{document.violations.position}, {document.violations.velocity}"
    wish = WISHES[place < len(WAYS)]
    return Row(
        f"{one.method}, {wish}, {one.feet}",
        "stable" if one.speed == 1.0 else "balanced",
        one.fell,
        f"too fast: {', '.join(over)}" if over else "",
        (inside, f"{document.trial.rms_deg:.1f}°", met, past),
    )
