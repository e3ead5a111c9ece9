"""A dancer performs a score: keys become paths, paths become joint rotations."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Bools, Positions, Rotations, Times
from onbeat.examples.body import NAMES
from onbeat.examples.choreography import LEAD, Score, write_score
from onbeat.examples.dancers import Dancer
from onbeat.examples.figures import Figure, Pose
from onbeat.examples.footwork import FootPath, foot_path, highest_pelvis, settle, softest_minimum
from onbeat.examples.limbs import arm_rotations, leg_rotations, mirrored
from onbeat.examples.paths import Keys, bump, exaggeration, follow, follow_through, place_in, soften
from onbeat.motion import Motion
from onbeat.motion import rotations as rot

TEMPO = 104.0
"""Beats per minute at speed 1."""
FADING = 4.5
"""Ornaments shrink as ``exp(−FADING (speed − 1))``: there is no time for them in fast music."""
SHRINKING = 0.3
"""Moves shrink as ``1 − SHRINKING (speed − 1)``."""
OVERSHOOT = 0.3
"""Beats over which moves wind up and overshoot."""
ARMS_AHEAD = 0.026
"""Share of the height by which the pelvis is held back, since arms are mostly carried in front."""
_POSE = {name: index for index, name in enumerate(Pose._fields)}


@dataclass(frozen=True)
class Performance:
    """A clip of one dancer with its ground truth.

    Parameters
    ----------
    motion : what the dancer does.
    task : the figure's name, or those of several, with commas.
    person : the dancer's name.
    speed : how fast, 1 for ``TEMPO``.
    cycles : how often each figure is repeated.
    beats : (B,) seconds of all beats of the clip.
    keyposes : (K,) seconds, some of the beats.
    contacts : (F, 2) true where the left and right foot stand.
    """

    motion: Motion
    task: str
    person: str
    speed: float
    cycles: int
    beats: Times
    keyposes: Times
    contacts: Bools


def perform(
    dancer: Dancer, figures: Sequence[Figure], speed: float, cycles: int, rng: np.random.Generator, fps: float = 60.0
) -> Performance:
    """One clip: each of ``figures`` danced ``cycles`` times at ``speed`` times ``TEMPO``.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    >>> clip.task, clip.person, len(clip.keyposes), round(clip.motion.duration, 1)
    ('folk dance', 'Aiko', 16, 16.2)
    """
    period = 60.0 / TEMPO / speed
    calmer = 1.0 - SHRINKING * (speed - 1.0)
    dancer = replace(dancer, amplitude=dancer.amplitude * calmer, stride=dancer.stride * calmer)
    order = [figure for figure in figures for _ in range(cycles)]
    score = write_score(order, dancer, period, rng)
    times = np.arange(int(np.floor(score.duration * fps + 1e-6)) + 1) / fps
    task = ", ".join(dict.fromkeys(figure.name for figure in figures))
    seeds = {figure.name: zlib.crc32(figure.name.encode()) for figure in figures}
    ornaments = _ornaments(times, score, sum(seeds.values())) * dancer.ornaments * np.exp(-FADING * (speed - 1.0))
    breath = np.sin(2 * np.pi * (0.27 * times + rng.random()))
    name = f"{dancer.name} {task} {speed:g}x"
    motion, contacts = _move(dancer, score, times, ornaments, breath, fps, name)
    count = int(np.floor(times[-1] / period + 1e-6)) + 1
    beats = np.arange(count, dtype=np.float64) * period
    return Performance(motion, task, dancer.name, speed, cycles, beats, score.keyposes, contacts)


def _ornaments(times: Times, score: Score, seed: int) -> Array:
    """Small fast details (F, 6) between the keyposes, at rest in them: wrists roll and flex (left, right), nod, tip.

    They belong to the figure: every cycle and every dancer has the same ones, of one's own size.
    """
    rng = np.random.default_rng(seed)
    index, share = place_in(times, np.concatenate(([0.0], score.keyposes, [score.duration])))
    beats = np.diff(np.concatenate(([0.0], score.keyposes, [score.duration]))) / score.period
    turns = np.round(2.0 * beats + 0.5)[index]
    sizes = rng.uniform(0.4, 1.0, 6) * rng.choice([-1.0, 1.0], 6) * np.array([0.5, 0.35, 0.5, 0.35, 0.07, 0.06])
    return (bump(share) * np.sin(2 * np.pi * turns * share))[:, None] * sizes


def _move(
    dancer: Dancer, score: Score, times: Times, ornaments: Array, breath: Array, fps: float, name: str
) -> tuple[Motion, Bools]:
    build = dancer.build
    skeleton = build.skeleton
    q = np.zeros((len(times), len(NAMES), 4))
    q[..., 0] = 1.0
    pelvis = soften(follow(times, score.pelvis, 0.1), fps, 0.08)
    floor = follow(times, score.floor)
    arms = [_arm_path(dancer, keys, score.period, times, fps) for keys in score.hands]
    trunk = _trunk_path(dancer, score, times, fps)
    _groove(
        trunk, arms, follow(times, score.weight)[:, 0], _dip(times - 0.03, score.period) * floor[:, 0] * dancer.bounce
    )
    _set_trunk(q, trunk, pelvis[:, 2], ornaments[:, 4:], breath)
    for side, path, details in zip(("Left", "Right"), arms, (ornaments[:, :2], ornaments[:, 2:4]), strict=True):
        _set_arm(q, side, path, details, dancer, breath, fps)
    left, right = (foot_path(plan, times, build) for plan in score.feet)
    root = _root(dancer, score, times, trunk, pelvis, floor, q[:, 0], (left, right), fps)
    _set_leg(q, "Left", root, left, pelvis[:, 2], dancer)
    _set_leg(q, "Right", root, right, pelvis[:, 2], dancer)
    return Motion(skeleton, q, root, fps, name), np.stack((left.contact, right.contact), axis=-1)


def _trunk_path(dancer: Dancer, score: Score, times: Times, fps: float) -> Array:
    times = times - dancer.lag / 2
    path = soften(follow(times, score.trunk, dancer.hold * 0.6), fps, dancer.softness + 0.02)
    path += 0.6 * dancer.overshoot * exaggeration(follow(times, score.trunk), fps, OVERSHOOT * score.period)
    path[:, : _POSE["sink"]] *= dancer.amplitude
    path[:, _POSE["bow"]] += dancer.bow
    path[:, _POSE["sink"]] += dancer.crouch
    return path


def _arm_path(dancer: Dancer, keys: Keys, period: float, times: Times, fps: float) -> Array:
    path = soften(follow(times, keys, dancer.hold), fps, dancer.softness)
    free = 1.0 - np.clip(path[:, 7:], 0.0, 1.0)  # hands that meet do not go through each other
    return path + dancer.overshoot * free * exaggeration(follow(times, keys), fps, OVERSHOOT * period)


def _vector(x: Array, y: Array, z: Array) -> Rotations:
    return rot.exp(np.stack((x, y, z), axis=-1))


def _dip(times: Times, period: float) -> Array:
    """How deep the bounce is: 1 on each beat, 0 between."""
    return (0.5 + 0.5 * np.cos(2 * np.pi * times / period)) ** 1.5


def _groove(trunk: Array, arms: list[Array], weight: Array, dip: Array) -> None:
    """What the trunk does by itself, added in place: it gives way to the arms, the weight and the bounce."""
    left, right = arms
    trunk[:, _POSE["twist"]] += 0.07 * (left[:, 0] - right[:, 0])
    trunk[:, _POSE["lean"]] += 0.05 * (left[:, 1] - right[:, 1]) + 0.03 * (2 * weight - 1)
    trunk[:, _POSE["hip"]] += 0.07 * (2 * weight - 1)
    trunk[:, _POSE["bow"]] += 1.0 * dip - 0.035 * (left[:, 1] + right[:, 1])
    trunk[:, _POSE["nod"]] += 2.5 * dip


def _set_trunk(q: Rotations, trunk: Array, yaw: Array, ornaments: Array, breath: Array) -> None:
    """Hips, spine, chest, neck and head; the head stays nearly level and looks ahead."""
    bow, lean, twist, hip, turn = trunk[:, :5].T
    nod, tip, look = trunk[:, 8:].T
    q[:, NAMES.index("Hips")] = rot.multiply(rot.yaw(yaw + turn), _vector(-0.4 * bow, 0.2 * lean - hip, 0 * bow))
    q[:, NAMES.index("Spine")] = _vector(-0.35 * bow, 0.45 * lean + 0.6 * hip, 0.45 * twist - 0.3 * turn)
    q[:, NAMES.index("Chest")] = _vector(
        -0.25 * bow + 0.018 * breath, 0.35 * lean + 0.4 * hip, 0.55 * twist - 0.3 * turn
    )
    down, aside = 0.6 * bow - 0.015 * breath - nod - ornaments[:, 0], tip - 0.7 * lean + ornaments[:, 1]
    around = look - 0.75 * twist - 0.4 * turn
    q[:, NAMES.index("Neck")] = _vector(0.4 * down, 0.4 * aside, 0.4 * around)
    q[:, NAMES.index("Head")] = _vector(0.6 * down, 0.6 * aside, 0.6 * around)


def _set_arm(q: Rotations, side: str, path: Array, ornaments: Array, dancer: Dancer, breath: Array, fps: float) -> None:
    """Collar, upper arm, forearm and hand; the hand trails behind the arm and swings past it."""
    build = dancer.build
    upper, forearm = arm_rotations(path[:, :2], path[:, 2], path[:, 3], (build.upper_arm, build.forearm))
    raised = 0.14 * (1.0 + np.tanh(1.8 * (path[:, 1] - 0.55))) + 0.012 * breath
    collar = _vector(0 * raised, -raised, -0.10 * path[:, 0])
    drag = 0.5 * np.tanh(0.16 * dancer.wrist * follow_through(path[:, :2], fps))
    hand = _vector(0 * raised, path[:, 5] + drag[:, 0] + ornaments[:, 1], path[:, 6] - drag[:, 1])
    twist = path[:, 4] + ornaments[:, 0]
    forearm = rot.multiply(forearm, _vector(0.5 * twist, 0 * twist, 0 * twist))
    hand = rot.multiply(_vector(0.5 * twist, 0 * twist, 0 * twist), hand)
    for name, value in zip(
        ("Shoulder", "Arm", "ForeArm", "Hand"),
        (collar, rot.multiply(rot.inverse(collar), upper), forearm, hand),
        strict=True,
    ):
        q[:, NAMES.index(side + name)] = mirrored(value) if side == "Left" else value


def _root(
    dancer: Dancer, score: Score, times: Times, trunk: Array, pelvis: Array, floor: Array, hips: Rotations,
    feet: tuple[FootPath, FootPath], fps: float,
) -> Positions:  # fmt: skip
    """The pelvis: over the foot that bears the weight, the trunk's lean balanced, as high as the legs allow."""
    build = dancer.build
    turn = np.pi * (times / score.period - LEAD)
    circle = floor[:, 1] * build.leg * dancer.amplitude
    aside = trunk[:, 5] * build.leg - 0.08 * build.height * np.sin(trunk[:, 1]) + circle * np.sin(turn)
    ahead = trunk[:, 6] * build.leg - 0.11 * build.height * np.sin(trunk[:, 0]) + circle * np.cos(turn)
    ahead -= ARMS_AHEAD * build.height
    sine, cosine = np.sin(pelvis[:, 2]), np.cos(pelvis[:, 2])
    root = np.empty((len(times), 3))
    root[:, 0] = pelvis[:, 0] + cosine * aside - sine * ahead
    root[:, 1] = pelvis[:, 1] + sine * aside + cosine * ahead
    dip = _dip(times, score.period)
    standing = build.ankle_height + build.leg * (0.99 - trunk[:, 7] - floor[:, 0] * dancer.bounce * dip)
    heights = [standing + build.hip_drop]
    root[:, 2] = 0.0
    for sign, foot in zip((-1.0, 1.0), feet, strict=True):
        hip = root + rot.rotate(hips, np.array([sign * build.hip_half_width, 0.0, -build.hip_drop]))
        heights.append(highest_pelvis(hip, foot.ankle, build.leg))
    root[:, 2] = settle(softest_minimum(np.stack(heights, axis=-1)), fps)
    return root


def _set_leg(q: Rotations, side: str, root: Positions, foot: FootPath, yaw: Array, dancer: Dancer) -> None:
    build = dancer.build
    sign = -1.0 if side == "Left" else 1.0
    hips = q[:, 0]
    hip = root + rot.rotate(hips, np.array([sign * build.hip_half_width, 0.0, -build.hip_drop]))
    heading = 0.35 * yaw + 0.65 * foot.yaw
    thigh, shin = leg_rotations(foot.ankle - hip, heading, (build.thigh, build.shin))
    q[:, NAMES.index(side + "UpLeg")] = rot.multiply(rot.inverse(hips), thigh)
    q[:, NAMES.index(side + "Leg")] = shin
    q[:, NAMES.index(side + "Foot")] = rot.multiply(rot.inverse(rot.multiply(thigh, shin)), foot.rotation)
    q[:, NAMES.index(side + "ToeBase")] = _vector(foot.toes, 0 * foot.toes, 0 * foot.toes)
