from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.blend import BLENDS
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.realise import Realised, realise
from onbeat.dance.windows import LONGEST, ROOM, SHORTEST
from onbeat.errors import FormatError, PlanError
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames, facing
from onbeat.motion.contacts import foot_contacts, point_speeds
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.legs import place_foot
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

LEGS = ("left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle")


def skeleton(arm: float = 0.28) -> Skeleton:
    sides = (("l", -1), ("r", 1))
    names = [
        "hips",
        "chest",
        *(s + n for s, _ in sides for n in ("arm", "forearm", "wrist", "upleg", "leg", "foot", "toe")),
    ]
    offsets = [[0, 0, 0], [0, 0, 0.45]]
    for _, x in sides:
        offsets += [[0.18 * x, 0, 0.05], [0.05 * x, 0, -arm], [0, 0.05, -0.25]]
        offsets += [[0.1 * x, 0, -0.05], [0, 0.01, -0.42], [0, -0.01, -0.42], [0, 0.14, -0.05]]
    return Skeleton(names, [-1, 0, 1, 2, 3, 0, 5, 6, 7, 1, 9, 10, 0, 12, 13, 14], offsets)


def swaying(
    seed: int, seconds: float = 12.0, fps: float = 60.0, stance: float = 0.12, yaw: float = 0.0, slow: float = 1.0
) -> Motion:
    """A body that sways and swings its arms over feet that never move, turned and put anywhere on the ground."""
    rng, bones = np.random.default_rng(seed), skeleton()
    body, t = Body.of(bones), np.arange(round(seconds * fps)) / fps * slow
    waves = np.sin(2 * np.pi * (rng.uniform(0.3, 0.8, (16, 3)) * t[:, None, None] + rng.uniform(0, 1, (16, 3))))
    waves[:, :2] *= 0.3  # hips and chest turn little, so that the facing hardly sways over the feet
    rotations = rot.exp(waves * 0.25)
    rotations[:, 0] = rot.exp(waves[:, 0] * [0.2, 0.2, 0.1])
    rotations[:, [5, 6, 7, 8, 12, 13, 14, 15]] = rot.IDENTITY
    roots = np.array([0.0, 0.0, 0.85]) + waves[:, 1] * [0.13, 0.1, 0.07]
    for side, x in (("left", -stance), ("right", stance)):
        world = forward_kinematics(bones, rotations, roots)
        ankle = np.broadcast_to([x, 0.0, 0.08], (len(t), 3))
        rotations = place_foot(body, side, rotations, world, ankle, np.tile(rot.IDENTITY, (len(t), 1)))
    turn = rot.yaw(yaw)
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    roots = rot.rotate(turn, roots) + rng.uniform(-2, 2, 3) * [1.0, 1.0, 0.0]
    return Motion(bones, rotations, roots, fps, f"swaying {seed}")


def plan_of(lengths: list[float], clips: int, seed: int = 0) -> DancePlan:
    rng, at, moves = np.random.default_rng(seed), 0.0, []
    for k, length in enumerate(lengths):
        begin = float(rng.uniform(1.0, 4.0))
        moves.append(Move(k % clips, begin, begin + length, at))
        at += length
    return DancePlan(tuple(moves), at)


@pytest.fixture(scope="module")
def clips() -> list[Motion]:
    return [swaying(0), swaying(1, yaw=2.0), swaying(2, yaw=-1.1), swaying(3, yaw=3.0)]


@pytest.fixture(scope="module")
def plan() -> DancePlan:
    return plan_of([1.5, 2.2, 1.0, 3.1, 1.33, 2.0], clips=4)


def outside(dance: Realised) -> np.ndarray:
    t = dance.motion.times
    return ~np.any([(t >= a - 1e-9) & (t <= b + 1e-9) for a, b in dance.windows], axis=0)


def sources(dance: Realised, clips: list[Motion]) -> tuple[np.ndarray, np.ndarray]:
    """Local rotations and root positions of the clip frames shown."""
    poses = [clips[c].at(np.array([s])) for c, s in zip(dance.clips, dance.seconds, strict=True)]
    return np.concatenate([p.rotations for p in poses]), np.concatenate([p.root_positions for p in poses])


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return rot.angle_between(a, b)


@pytest.mark.parametrize("fps", [24, 60, 120])
@pytest.mark.parametrize("last", [2.0, 2.013])
def test_the_dance_is_as_long_as_the_plan(clips, fps, last):
    plan = plan_of([1.1, 0.9, last], 3)
    dance = realise(clips, plan, fps)
    assert len(dance.motion) == round(plan.duration * fps)
    assert dance.motion.fps == fps
    assert len(dance.contacts) == len(dance.clips) == len(dance.seconds) == len(dance.motion)


def test_sources_follow_the_plan(clips, plan):
    dance = realise(clips, plan)
    which, seconds = plan.clip_times(dance.motion.times)
    assert np.array_equal(dance.clips, np.array([m.clip for m in plan.moves])[which])
    assert np.allclose(dance.seconds, seconds, atol=1e-9)
    assert np.allclose([(a + b) / 2 for a, b in dance.windows], plan.join_times)


@pytest.mark.parametrize("blend", sorted(BLENDS))
def test_outside_windows_frames_are_the_clips_own_moved_on_the_ground(clips, plan, blend):
    dance = realise(clips, plan, blend=blend, plant=False)
    rotations, roots = sources(dance, clips)
    free = outside(dance)
    assert free.mean() > 0.4
    assert angles(dance.motion.rotations[free, 1:], rotations[free, 1:]).max() < 2e-3
    moves, _ = plan.clip_times(dance.motion.times)
    for move in range(len(plan.moves)):
        rows = np.flatnonzero(free & (moves == move))
        turn = rot.multiply(dance.motion.rotations[rows[0], 0], rot.inverse(rotations[rows[0], 0]))
        assert abs(turn[1]) + abs(turn[2]) < 2e-3, "turned about the vertical only"
        assert angles(rot.multiply(turn, rotations[rows, 0]), dance.motion.rotations[rows, 0]).max() < 2e-3
        path = rot.rotate(turn, roots[rows])
        shift = dance.motion.root_positions[rows] - path
        assert np.ptp(shift, axis=0).max() < 1e-3
        assert abs(shift[:, 2]).max() < 1e-3, "never lifted"


def test_planting_changes_legs_and_height_only(clips, plan):
    plain, planted = realise(clips, plan, plant=False), realise(clips, plan)
    upper = np.setdiff1d(np.arange(16), Body.of(skeleton()).indices(*LEGS))
    assert np.array_equal(plain.motion.rotations[:, upper], planted.motion.rotations[:, upper])
    assert np.allclose(plain.motion.root_positions[:, :2], planted.motion.root_positions[:, :2])


@pytest.mark.parametrize("blend", sorted(BLENDS))
def test_nothing_jumps(clips, plan, blend):
    dance = realise(clips, plan, blend=blend).motion
    step = np.linalg.norm(np.diff(dance.positions, axis=0), axis=-1).max(axis=1)
    own = max(np.linalg.norm(np.diff(c.positions, axis=0), axis=-1).max() for c in clips)
    assert step.max() < 2.5 * own + 0.01
    turns = angles(dance.rotations[1:], dance.rotations[:-1])
    assert turns.max() < 0.15
    assert np.allclose(np.linalg.norm(dance.rotations, axis=-1), 1.0)


@pytest.mark.parametrize("blend", sorted(BLENDS))
def test_the_roots_velocity_goes_on_through_joins(clips, plan, blend):
    dance = realise(clips, plan, 120.0, blend=blend, plant=False).motion
    acceleration = np.linalg.norm(np.diff(dance.root_positions, 2, axis=0), axis=1) * 120**2
    assert acceleration.max() < 12.0, "a jump of velocity would be hundreds of m/s²"


def test_facing_goes_on_through_joins(clips, plan):
    dance = realise(clips, plan).motion
    yaw = np.unwrap(facing(body_frames(dance)[0]))
    assert np.abs(np.diff(yaw)).max() < 0.05
    assert abs(yaw[0]) < 1e-6, "the first pose faces +Y"
    assert np.abs(dance.root_positions[:, :2].min(0) + dance.root_positions[:, :2].max(0)).max() < 1e-9


@pytest.mark.parametrize("blend", sorted(BLENDS))
def test_planted_feet_do_not_move(clips, plan, blend):
    dance = realise(clips, plan, blend=blend)
    assert dance.contacts.all()
    body = Body.of(skeleton())
    soles = dance.motion.positions[:, body.indices("left_toe", "right_toe")]
    assert np.ptp(soles, axis=0).max() < 0.004
    plain = realise(clips, plan, blend=blend, plant=False).motion.positions[:, body.indices("left_toe", "right_toe")]
    assert np.ptp(plain, axis=0).max() > 0.01, "they do where nothing plants them"


def test_feet_of_different_stances_meet_without_sliding(plan):
    clips = [swaying(0), swaying(1, stance=0.16, yaw=1.0), swaying(2, stance=0.1)]
    dance = realise(clips, plan_of([2.0, 2.0, 2.0], 3))
    body = Body.of(skeleton())
    toes = dance.motion.positions[:, body.indices("left_toe", "right_toe")]
    assert dance.contacts.all()
    assert point_speeds(toes * [1, 1, 0], 60).max() < 0.01
    assert np.ptp(toes[..., 2]) < 0.002


def test_feet_too_far_apart_step_across():
    clips = [swaying(0), swaying(1, stance=0.36)]
    dance = realise(clips, plan_of([2.0, 2.0], 2))
    body = Body.of(skeleton())
    toes = dance.motion.positions[:, body.indices("left_toe", "right_toe")]
    assert not dance.contacts.all(axis=0).any()
    assert np.ptp(toes[..., 2], axis=0).min() > 0.02, "lifted"
    moving = np.linalg.norm(np.diff(toes[..., :2], axis=0), axis=-1) * 60 > 0.15
    assert not (moving & dance.contacts[1:] & dance.contacts[:-1]).any()


def test_legs_are_never_longer_than_they_are(clips):
    wide = [swaying(0), swaying(1, stance=0.2), swaying(2, stance=0.28)]
    motion = realise(wide, plan_of([1.5] * 6, 3)).motion
    body = Body.of(skeleton())
    for side in ("left", "right"):
        hip, ankle = (motion.positions[:, body[f"{side}_{role}"]] for role in ("hip", "ankle"))
        assert np.linalg.norm(hip - ankle, axis=1).max() < 0.8405


def test_a_warp_moves_frames_in_time_and_windows_with_them(clips, plan):
    def warp(t):
        return t + 0.2 * np.sin(2 * np.pi * t / plan.duration)

    dance = realise(clips, plan, warp=warp, plant=False)
    which, seconds = plan.clip_times(warp(dance.motion.times))
    free = outside(dance)
    assert len(dance.motion) == round(plan.duration * 60)
    assert np.allclose(dance.seconds[free], seconds[free], atol=1e-6)
    centres = np.array([(a + b) / 2 for a, b in dance.windows])
    assert np.allclose(warp(centres), plan.join_times, atol=1e-3)
    rotations, _ = sources(dance, clips)
    assert angles(dance.motion.rotations[free, 1:], rotations[free, 1:]).max() < 2e-3
    assert np.array_equal(dance.clips[free], np.array([m.clip for m in plan.moves])[which][free])


@pytest.mark.parametrize("warp", [lambda t: 0.9 * t, lambda t: t - 1.5 * np.sin(t), lambda t: t + 0.5])
def test_a_warp_that_goes_back_or_misses_the_ends_is_refused(clips, plan, warp):
    with pytest.raises(PlanError, match="rise from 0"):
        realise(clips, plan, warp=warp)


def test_one_move_is_the_clip(clips):
    dance = realise(clips, DancePlan((Move(1, 2.0, 5.0, 0.0),), 3.0))
    assert dance.windows == ()
    assert angles(dance.motion.rotations[:, 1:], clips[1].rotations[120:300, 1:]).max() < 1e-6


def test_one_frame():
    dance = realise([swaying(0)], DancePlan((Move(0, 1.0, 1.01, 0.0),), 0.01))
    assert len(dance.motion) == 1


@pytest.mark.parametrize("blend", sorted(BLENDS))
def test_very_short_moves(clips, blend):
    dance = realise(clips, plan_of([0.5, 0.1, 0.07, 0.12, 0.2, 0.05, 0.6], 4), blend=blend)
    edges = np.array(dance.windows).ravel()
    assert np.all(np.diff(edges) > 0), "windows do not overlap"
    assert np.isfinite(dance.motion.positions).all()
    assert len(dance.motion) == round(1.64 * 60)


def test_windows_are_bounded_and_fit_between_the_joins(clips, plan):
    spans = np.diff(np.array(realise(clips, plan).windows), axis=1)[:, 0]
    assert np.all((spans >= SHORTEST - 1e-9) & (spans <= LONGEST + 1e-9))
    lengths = np.array([1.5, 2.2, 1.0, 3.1, 1.33, 2.0])
    assert np.all(spans <= ROOM * np.minimum(lengths[1:], lengths[:-1]))


def test_slower_bodies_take_longer_to_join(clips, plan):
    def mean_span(peak: float) -> float:
        return float(np.diff(np.array(realise(clips, plan, peaks=np.full(16, peak)).windows), axis=1).mean())

    assert mean_span(100.0) == pytest.approx(SHORTEST)
    assert mean_span(0.01) == pytest.approx(LONGEST)


def test_clips_at_different_rates_dance_together(plan):
    one_rate = [swaying(k, yaw=k) for k in range(4)]
    rates = [swaying(k, yaw=k, fps=fps) for k, fps in enumerate((30.0, 60.0, 120.0, 25.0))]
    same, mixed = realise(one_rate, plan).motion, realise(rates, plan).motion
    assert np.linalg.norm(same.positions - mixed.positions, axis=-1).max() < 0.01


def test_contacts_found_beforehand_are_taken(clips, plan):
    standing = [foot_contacts(clip).feet for clip in clips]
    again = realise(clips, plan, standing=standing)
    assert np.array_equal(again.motion.rotations, realise(clips, plan).motion.rotations)


def test_the_same_dance_twice_is_the_same_to_the_bit(clips, plan):
    one, two = realise(clips, plan), realise(clips, plan)
    assert one.motion.rotations.tobytes() == two.motion.rotations.tobytes()
    assert one.motion.root_positions.tobytes() == two.motion.root_positions.tobytes()


def test_mistakes_are_named(clips, plan):
    with pytest.raises(PlanError, match=r"no blend 'magic'; choose one of .*inertial"):
        realise(clips, plan, blend="magic")
    with pytest.raises(PlanError, match="move 3 shows clip 3; there are 3 clips"):
        realise(clips[:3], plan)
    with pytest.raises(PlanError, match=r"move 0 shows 11.00…13.00 s of clip 'swaying 0', which lasts 12.00 s"):
        realise(clips, DancePlan((Move(0, 11.0, 13.0, 0.0),), 2.0))
    other = clips[0].replace(name="other")
    longer = Motion(skeleton(arm=0.4), other.rotations, other.root_positions, 60.0, "other")
    with pytest.raises(FormatError, match="'other' has another skeleton"):
        realise([*clips[:3], longer], plan)
    loose = Motion(skeleton(), other.rotations, other.root_positions, 60.0, "loose", np.zeros((len(other), 16, 3)))
    with pytest.raises(FormatError, match="'loose' has animated bone offsets"):
        realise([*clips[:3], loose], plan)
