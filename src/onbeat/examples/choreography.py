"""Figures one after the other, written out for one dancer as keys in seconds and metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.examples.dancers import Dancer
from onbeat.examples.figures import PLACES, STANCE, Figure, Pose, Step
from onbeat.examples.footwork import LANDED, LIFT_OFF, FootPlan
from onbeat.examples.limbs import arm_direction
from onbeat.examples.paths import Keys

LEAD = 2.0
"""Beats from the start of a clip, at rest, to its first keypose, and from its last to its end, at rest."""
LEAVING = 0.65
"""Beats before a step's beat until which the pelvis stays over the other foot: half-way when the foot lands."""
ARRIVING = 0.06
"""Beats after its beat at which the pelvis has come to the new foot."""
TOE_OUT = np.radians(8.0)
_HOME = arm_direction(np.array([0.2, 0.6, -0.5]))  # arms grow and shrink about this


@dataclass(frozen=True)
class Score:
    """What one dancer is to do in one clip; keys are in seconds.

    Parameters
    ----------
    period, duration : seconds of a beat and of the clip.
    hands : left and right, 8 values a key: arc outward and upward, reach, swivel, roll, flex, deviate; 1 in a clap.
    trunk : the 11 values of a ``Pose``.
    pelvis : x, y in metres and yaw in radians.
    weight : the share of the weight on the right foot, on the beats.
    feet : left and right.
    floor : bounce and hip circle, shares of the leg's length.
    keyposes : seconds.
    """

    period: float
    duration: float
    hands: tuple[Keys, Keys]
    trunk: Keys
    pelvis: Keys
    weight: Keys
    feet: tuple[FootPlan, FootPlan]
    floor: Keys
    keyposes: Times


@dataclass
class _Foot:
    """A foot while the steps are read: its events so far, the last one being where it is."""

    swings: list[tuple[float, float]]
    rows: list[tuple[float, ...]]


@dataclass
class _Stage:
    """Where the dancer is while the figures are read."""

    leg: float
    unit: float
    origin: Array = field(default_factory=lambda: np.zeros(2))
    yaw: float = 0.0
    weight: float = 0.5
    feet: dict[str, _Foot] = field(default_factory=dict[str, _Foot])
    pelvis: list[tuple[float, ...]] = field(default_factory=list[tuple[float, ...]])

    def world(self, x: float, y: float) -> Array:
        """A point of the figure (shares of the leg's length) on the floor, in metres."""
        sine, cosine = np.sin(self.yaw), np.cos(self.yaw)
        return self.origin + self.unit * np.array([cosine * x - sine * y, sine * x + cosine * y])

    def foothold(self, side: float, x: float, y: float, turn: float) -> Array:
        """Where a foot stands: steps are as long as the dancer's stride, but the feet never closer than at rest."""
        apart = side * STANCE * (self.leg / self.unit - 1.0)
        return self.world(x + apart * np.cos(turn), y + apart * np.sin(turn))

    def stand(self, beat: float, weight: float) -> None:
        """The pelvis between the feet, over the right foot by ``weight``, on a beat."""
        left, right = (np.array(self.feet[foot].rows[-1]) for foot in "LR")
        spot = (1 - weight) * left + weight * right
        self.pelvis.append((beat, spot[0], spot[1], (left[3] + right[3]) / 2, weight))


def write_score(figures: Sequence[Figure], dancer: Dancer, period: float, rng: np.random.Generator) -> Score:
    """The score of ``figures`` (one cycle each, in order) for a dancer with beats of ``period`` seconds."""
    starts = np.cumsum([0.0, *(figure.beats for figure in figures)])
    stage = _begin(dancer)
    for figure, start in zip(figures, starts[:-1], strict=True):
        _walk(stage, figure, float(start), dancer)
    stage.stand(float(starts[-1]) + LEAD, 0.5)
    keyposes = _keypose_beats(figures, starts)
    beats = starts[-1] + 2 * LEAD
    pelvis = _in_order(np.array(stage.pelvis), period)
    on_beat = np.abs(pelvis.times / period - np.round(pelvis.times / period)) < 1e-6
    late = Keys(pelvis.times + ARRIVING * period * on_beat, pelvis.values[:, :3])
    return Score(
        period=period,
        duration=float(beats * period),
        hands=_hands(figures, starts, dancer, period, rng),
        trunk=_trunk(figures, starts, period, rng),
        pelvis=late,
        weight=Keys(pelvis.times[on_beat], pelvis.values[on_beat, 3:]),
        feet=(_plan(stage.feet["L"], period), _plan(stage.feet["R"], period)),
        floor=_floor(figures, starts, period),
        keyposes=(keyposes + LEAD) * period,
    )


def _begin(dancer: Dancer) -> _Stage:
    stage = _Stage(leg=dancer.build.leg, unit=dancer.build.leg * dancer.stride)
    for foot, side in (("L", -1.0), ("R", 1.0)):
        x, y = stage.foothold(side, side * STANCE, 0.0, 0.0)
        stage.feet[foot] = _Foot([(-9.0, -8.0)], [(float(x), float(y), 0.0, -side * TOE_OUT, 0.0, 0.0, 0.0, 0.0, True)])
    stage.stand(-LEAD - 1.0, 0.5)
    return stage


def _walk(stage: _Stage, figure: Figure, start: float, dancer: Dancer) -> None:
    """Read one cycle's steps: foot events, and the weight on every beat and before each lift-off."""
    over = min(0.5 * 0.74 * dancer.sway, 0.45)
    beats = sorted({float(b) for b in range(figure.beats)} | {step.beat for step in figure.steps})
    for beat in beats:
        landing = [step for step in figure.steps if step.beat == beat]
        for step in landing:
            support = 0.5 - over if step.foot == "R" else 0.5 + over
            if step.kind == "shift":
                stage.weight = 1.0 - support
                continue
            stage.stand(start + beat - LEAVING, support)
            _step(stage, step, start, dancer)
            stage.weight = {"step": 1.0 - support, "close": 0.5}.get(step.kind, support)
        stage.stand(start + beat, stage.weight)
    x, y, turn = figure.travel
    stage.origin = stage.world(x, y)
    stage.yaw += np.radians(turn)


def _step(stage: _Stage, step: Step, start: float, dancer: Dancer) -> None:
    side = -1.0 if step.foot == "L" else 1.0
    x, y = stage.foothold(side, step.x, step.y, np.radians(step.turn))
    foot = stage.feet[step.foot]
    pitch = {"heel": 0.42, "air": -0.35}.get(step.kind, 0.0)
    height = stage.unit * step.z if step.kind == "air" else 0.0
    if step.kind == "heel":  # the ball of the foot hangs where the heel touches the floor
        build = dancer.build
        height = (build.ball_forward + build.heel_back) * np.sin(pitch) - build.ball_height * (1 - np.cos(pitch))
    far = float(np.hypot(x - foot.rows[-1][0], y - foot.rows[-1][1]))
    clearance = (0.030 + 0.06 * min(far, 0.6)) * dancer.build.height / 1.7 * (0.6 + 0.4 * dancer.bounce)
    clearance += 0.0 if step.kind == "air" else stage.unit * step.z
    detour = stage.world(0.0, step.around) - stage.origin
    foot.swings.append((start + step.beat - LIFT_OFF, start + step.beat - LANDED))
    yaw = stage.yaw + np.radians(step.turn) - side * TOE_OUT
    foot.rows.append((float(x), float(y), height, yaw, pitch, clearance, *detour, step.kind != "air"))


def _plan(foot: _Foot, period: float) -> FootPlan:
    swings = (np.array(foot.swings) + LEAD) * period
    rows = np.array(foot.rows)
    return FootPlan(
        swings[:, 0], swings[:, 1], rows[:, :3], rows[:, 3], rows[:, 4], rows[:, 5], rows[:, 6:8], rows[:, 8] > 0
    )


def _keypose_beats(figures: Sequence[Figure], starts: Array) -> Array:
    beats = [start + beat for figure, start in zip(figures, starts, strict=False) for beat in figure.keyposes]
    return np.array(beats)


def _in_order(rows: Array, period: float) -> Keys:
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    keep = np.append(np.diff(rows[:, 0]) > 0.05, True)
    return Keys((rows[keep, 0] + LEAD) * period, rows[keep, 1:])


@cache
def _hand(name: str, dancer: Dancer) -> Array:
    """A named place as this dancer takes it."""
    place = PLACES[name]
    build = dancer.build
    if name.startswith("clap") or name == "waist":  # hands that meet, or lie on the body, do so on every body
        aside = 0.024 if name != "waist" else 0.125
        out = (aside * build.height - build.shoulder_half_width) / (build.upper_arm + build.forearm)
        point, scale, lift, clap = np.array([out, place.front, place.up]), 1.0, 0.0, 1.0
    else:
        point, scale, lift = np.array(place[:3]), dancer.amplitude, dancer.lift
        clap = 0.0
    arcs = _HOME + scale * (arm_direction(point) - _HOME) + np.array([0.0, lift])
    reach = min(float(np.linalg.norm(point)), 0.97)
    return np.array([*arcs, reach, place.swivel, place.roll, place.flex, place.deviate, clap])


def _pair(names: str, dancer: Dancer) -> Array:
    return np.array([_hand(name.strip(), dancer) for name in names.split("|")])


def _hands(
    figures: Sequence[Figure], starts: Array, dancer: Dancer, period: float, rng: np.random.Generator
) -> tuple[Keys, Keys]:
    """Keys of both hands, no two cycles quite alike."""
    rest = _pair("down | down", dancer)
    beats, values, through = [-LEAD - 1.0, -LEAD], [rest, rest], dict[float, Array]()
    for figure, start in zip(figures, starts, strict=False):
        for beat in figure.keyposes:
            beats.append(float(start + beat))
            values.append(_pair(figure.hands[beat], dancer))
        through |= {float(start + beat): _pair(names, dancer) for beat, names in figure.through.items()}
    beats += [float(starts[-1]), float(starts[-1]) + LEAD]
    values += [_pair(figures[-1].hands[figures[-1].keyposes[0]], dancer), rest]
    path = np.array(values)
    varied = rng.normal(0.0, 1.0, path[2:, :, :3].shape) * np.array([0.03, 0.03, 0.012])
    path[2:, :, :3] += varied * (1.0 - path[2:, :, 7:])  # hands that meet must meet
    jitter = rng.normal(0.0, 0.006, len(beats))
    bulges = np.zeros_like(path)
    for beat, via in through.items():
        key = int(np.searchsorted(beats, beat)) - 1
        bulges[key] = via - (path[key] + path[key + 1]) / 2
    times = (np.array(beats) + LEAD) * period + jitter + dancer.lag
    return Keys(times, path[:, 0], bulges[:, 0]), Keys(times, path[:, 1], bulges[:, 1])


def _trunk(figures: Sequence[Figure], starts: Array, period: float, rng: np.random.Generator) -> Keys:
    beats, poses = [-LEAD - 1.0, -LEAD], [Pose(), Pose()]
    for figure, start in zip(figures, starts, strict=False):
        for beat in sorted(figure.trunk):
            beats.append(float(start + beat))
            poses.append(figure.trunk[beat])
    last = figures[-1].trunk[min(figures[-1].trunk)]
    beats += [float(starts[-1]), float(starts[-1]) + LEAD]
    values = np.array([*poses, last, Pose()])
    values *= 1.0 + rng.normal(0.0, 0.06, (len(values), 1))
    return Keys((np.array(beats) + LEAD) * period, values)


def _floor(figures: Sequence[Figure], starts: Array, period: float) -> Keys:
    """Bounce and hip circle: each figure's own from its start to its end."""
    beats, values = [-LEAD - 1.0], [(0.0, 0.0)]
    for figure, start in zip(figures, starts, strict=False):
        beats += [float(start), float(start + figure.beats - 1)]
        values += [(figure.bounce, figure.circle)] * 2
    return Keys((np.array([*beats, float(starts[-1]) + LEAD]) + LEAD) * period, np.array([*values, (0.0, 0.0)]))
