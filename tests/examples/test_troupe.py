"""The troupe keeps its promises: on the beat, on its feet, in its body, and the same every time."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest

from onbeat.examples.dancers import DANCERS, Dancer
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform
from onbeat.examples.repertoire import REPERTOIRE
from onbeat.examples.troupe import FIGURES, SPEEDS, dance_library, troupe
from onbeat.motion import Body
from onbeat.motion import rotations as rot
from onbeat.motion.body import ROLES
from onbeat.motion.features import hand_features


@pytest.fixture(scope="module")
def everyone() -> tuple[Performance, ...]:
    return troupe()


@pytest.fixture(scope="module")
def some(everyone: tuple[Performance, ...]) -> list[Performance]:
    """Each figure by a few dancers at a few speeds: 7 has no factor in common with 8 dancers × 3 speeds."""
    return list(everyone[::7])


def only(performances: tuple[Performance, ...], task: str) -> dict[tuple[str, float], Performance]:
    return {(p.person, p.speed): p for p in performances if p.task == task}


def test_everyone_dances_every_figure_at_every_speed(everyone: tuple[Performance, ...]) -> None:
    seen = {(p.task, p.person, p.speed) for p in everyone}
    assert len(everyone) == len(seen) == len(FIGURES) * len(DANCERS) * len(SPEEDS)
    assert len(DANCERS) == 8
    assert len(REPERTOIRE) >= 12
    assert len(FOLK_DANCE.keyposes) == 8


def test_same_seed_same_bytes_and_another_seed_another_take() -> None:
    def take(seed: int) -> bytes:
        return b"".join(
            p.motion.rotations.tobytes() + p.motion.root_positions.tobytes() for p in dance_library(seed=seed)
        )

    first = take(3)
    assert take(3) == first
    assert take(4) != first


def test_all_roles_are_found_and_all_joints_are_named_alike(some: list[Performance]) -> None:
    for p in some:
        body = Body.of(p.motion.skeleton)
        assert [role for role in ROLES if role not in body] == []
        assert p.motion.skeleton.names == some[0].motion.skeleton.names
        assert body.skeleton.names[body["left_shoulder"]] == "LeftArm"
        assert body.skeleton.names[body["right_ankle"]] == "RightFoot"


def test_heights_differ_and_are_those_of_people() -> None:
    for dancer in DANCERS:
        rest = dancer.build.skeleton.rest_positions[:, 2]
        sole = rest[dancer.build.skeleton.index("LeftFoot")] - dancer.build.ankle_height
        assert rest.max() - sole == pytest.approx(dancer.build.height, abs=1e-9)
    heights = [dancer.build.height for dancer in DANCERS]
    assert min(heights) == 1.50
    assert max(heights) == 1.90
    assert len(set(heights)) == 8


def test_bones_keep_their_length(some: list[Performance]) -> None:
    for p in some:
        skeleton, positions = p.motion.skeleton, p.motion.positions
        bones = np.linalg.norm(positions[:, 1:] - positions[:, skeleton.parents[1:]], axis=-1)
        assert np.abs(bones - skeleton.bone_lengths[1:]).max() < 1e-9


def test_a_foot_in_contact_does_not_move_and_lies_on_the_floor(some: list[Performance]) -> None:
    for p in some:
        for side, stands in zip(("Left", "Right"), p.contacts.T, strict=True):
            foot = p.motion.positions[:, [p.motion.skeleton.index(side + n) for n in ("Foot", "ToeBase", "ToeEnd")]]
            together = stands[1:] & stands[:-1]
            assert np.abs(np.diff(foot, axis=0)[together]).max() < 1e-9, p.motion.name
            assert foot[stands, 0, 2].max() < 0.11  # the ankle of a tall dancer who stands on a heel
            assert foot[..., 2].min() > 0.0


def test_a_foot_that_moves_is_not_in_contact(some: list[Performance]) -> None:
    for p in some:
        ankles = p.motion.positions[:, [p.motion.skeleton.index(s + "Foot") for s in ("Left", "Right")]]
        speed = np.linalg.norm(np.diff(ankles, axis=0), axis=-1) * p.motion.fps
        assert not (p.contacts[1:] & p.contacts[:-1])[speed > 0.01].any()
        assert p.contacts.any(1).all(), "somebody must stand"


def test_knees_bend_forward_and_never_snap_straight(some: list[Performance]) -> None:
    for p in some:
        shins = [p.motion.skeleton.index(s + "Leg") for s in ("Left", "Right")]
        bent = -2 * np.arctan2(p.motion.rotations[:, shins, 1], p.motion.rotations[:, shins, 0])
        assert np.degrees(bent.min()) > 10
        assert np.degrees(bent.max()) < 130


def test_nothing_jerks(some: list[Performance]) -> None:
    for p in some:
        turning = rot.angle_between(p.motion.rotations[1:], p.motion.rotations[:-1]) * p.motion.fps
        assert turning.max() < 20, p.motion.name  # rad/s; a fast throw reaches 30 and more
        wrists = p.motion.positions[:, Body.of(p.motion.skeleton).indices("left_wrist", "right_wrist")]
        assert np.linalg.norm(np.diff(wrists, 2, axis=0), axis=-1).max() * p.motion.fps**2 < 150


def test_hands_stay_out_of_trunk_and_head(some: list[Performance]) -> None:
    for p in some:
        body, positions = Body.of(p.motion.skeleton), p.motion.positions
        crown = positions[:, p.motion.skeleton.index("HeadEnd")]
        size = positions[0, :, 2].max() / 1.7
        for side in ("left", "right"):
            for role in ("elbow", "wrist", "hand"):
                point = positions[:, body[f"{side}_{role}"]]
                assert distance(point, positions[:, body["hips"]], positions[:, body["neck"]]) > 0.14 * size
                assert distance(point, positions[:, body["head"]], crown) > 0.11 * size


def test_the_weight_is_over_the_standing_foot(some: list[Performance]) -> None:
    """While the other foot swings; before it lands the body is on its way to it, so not always nearly so."""
    away: list[np.ndarray] = []
    for p in some:
        skeleton, positions = p.motion.skeleton, p.motion.positions
        centre = centre_of_mass(p)[:, :2]
        for side, (stands, other) in zip(("Left", "Right"), (p.contacts.T, p.contacts.T[::-1]), strict=True):
            foot = positions[:, [skeleton.index(side + n) for n in ("Foot", "ToeBase")], :2].mean(1)
            away.append(np.linalg.norm(centre - foot, axis=-1)[stands & ~other] / positions[0, :, 2].max() * 1.7)
    assert np.median(np.concatenate(away)) < 0.09
    assert np.percentile(np.concatenate(away), 90) < 0.18


def centre_of_mass(p: Performance) -> np.ndarray:
    """(F, 3) from the masses of the body's segments (de Leva 1996), rounded."""
    masses = {"Spine": 0.14, "Chest": 0.16, "Neck": 0.14, "HeadEnd": 0.07}
    for side in ("Left", "Right"):
        masses |= {side + name: mass for name, mass in (("ForeArm", 0.028), ("Hand", 0.016), ("HandEnd", 0.006))}
        masses |= {side + name: mass for name, mass in (("Leg", 0.142), ("Foot", 0.043), ("ToeBase", 0.014))}
    joints = [p.motion.skeleton.index(name) for name in masses]
    middles = (p.motion.positions[:, joints] + p.motion.positions[:, p.motion.skeleton.parents[joints]]) / 2
    weights = np.array(list(masses.values()))
    return np.einsum("fjc,j->fc", middles, weights / weights.sum())


def test_legs_pass_each_other(everyone: tuple[Performance, ...]) -> None:
    for p in everyone[::11]:
        skeleton, positions = p.motion.skeleton, p.motion.positions
        shares = np.linspace(0, 1, 7)[:, None]
        left, right = (
            np.concatenate([
                positions[:, None, skeleton.index(side + a)] * (1 - shares)
                + positions[:, None, skeleton.index(side + b)] * shares
                for a, b in (("Leg", "Foot"), ("Foot", "ToeEnd"))
            ], axis=1)
            for side in ("Left", "Right")
        )  # fmt: skip
        apart = np.linalg.norm(left[:, :, None] - right[:, None], axis=-1).min()
        assert apart > 0.045, p.motion.name


def distance(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """The least distance of points (F, 3) from bones a–b (F, 3)."""
    along = np.clip(np.sum((points - a) * (b - a), axis=1) / np.sum((b - a) ** 2, axis=1), 0, 1)
    return float(np.linalg.norm(points - a - along[:, None] * (b - a), axis=1).min())


def test_keyposes_are_beats(some: list[Performance]) -> None:
    for p in some:
        period = p.beats[1] - p.beats[0]
        assert 60 / period / p.speed == pytest.approx(104)
        assert np.allclose(np.diff(p.beats), period)
        assert np.abs(p.beats[None] - p.keyposes[:, None]).min(1).max() < 1e-9
        assert p.keyposes[-1] < p.motion.duration


def test_hands_stop_on_the_keyposes_and_only_on_beats(everyone: tuple[Performance, ...]) -> None:
    found, stray, stops, count = 0, 0, 0, 0
    for p in everyone[::5]:
        features = hand_features(p.motion)
        at = np.concatenate(features.stops)
        found += int((np.abs(at[:, None] - p.keyposes[None]).min(0) < 0.1).sum())
        count += len(p.keyposes)
        stray += int((np.abs(at[:, None] - p.beats[None]).min(1) > 0.1).sum())
        stops += len(at)
    assert found / count > 0.97
    assert stray / stops < 0.03


def test_figures_differ_in_intensity(everyone: tuple[Performance, ...]) -> None:
    fast = {}
    for figure in FIGURES:
        at_one = [p for p in everyone if p.task == figure.name and p.speed == 1.0]
        fast[figure.name] = np.median([np.percentile(hand_features(p.motion).speeds, 95) for p in at_one[::3]])
    assert min(fast.values()) < 0.8
    assert max(fast.values()) > 2.5


def test_ornaments_fade_with_speed() -> None:
    size = []
    for speed in SPEEDS:
        plain, rich = (
            perform(who, [FOLK_DANCE], speed, 2, np.random.default_rng(0)).motion.rotations
            for who in (with_ornaments(0.0), with_ornaments(1.0))
        )
        size.append(float(rot.angle_between(plain, rich).max()))
    assert size[0] > 0.2
    assert size[0] > 2 * size[1] > 4 * size[2]


def with_ornaments(size: float) -> Dancer:
    return replace(DANCERS[0], ornaments=size)


def test_ornaments_rest_in_the_keyposes() -> None:
    plain, rich = (perform(with_ornaments(s), [FOLK_DANCE], 1.0, 2, np.random.default_rng(0)) for s in (0.0, 1.0))
    frames = np.round(rich.keyposes * rich.motion.fps).astype(int)
    apart = rot.angle_between(plain.motion.rotations, rich.motion.rotations)
    assert apart[frames].max() < 0.05 * apart.max()


def test_every_dancer_is_told_from_the_others_by_the_way_of_moving(everyone: tuple[Performance, ...]) -> None:
    """The same figure by two people differs more than two cycles of it by one."""
    poses = defaultdict(list)
    for (person, _), p in only(everyone, "star").items():
        arms = [p.motion.skeleton.index(s + n) for s in ("Left", "Right") for n in ("Arm", "ForeArm")]
        first, cycle = 2 * p.beats[1], 4 * p.beats[1]
        for turn in (1, 2):
            shares = first + cycle * (turn + np.arange(32) / 32)
            poses[person].append(p.motion.at(shares).rotations[:, arms])
    people = sorted(poses)
    own = [rot.angle_between(*poses[a][:2]).mean() for a in people]
    other = [rot.angle_between(poses[a][0], poses[b][0]).mean() for a in people for b in people if a < b]
    assert np.median(other) > 2 * np.median(own)


def test_faster_is_shorter_and_the_path_returns(everyone: tuple[Performance, ...]) -> None:
    takes = only(everyone, "folk dance")
    for dancer in DANCERS:
        durations = [takes[dancer.name, speed].motion.duration for speed in SPEEDS]
        assert durations == pytest.approx([durations[0] / s for s in SPEEDS], abs=0.05)
        root = takes[dancer.name, 1.0].motion.root_positions
        assert np.linalg.norm(root[-1, :2] - root[0, :2]) < 0.05


def test_the_library_is_minutes_of_clips_on_one_body_with_all_figures() -> None:
    library = dance_library()
    total = sum(p.motion.duration for p in library)
    assert 240 < total < 360
    assert all(8 < p.motion.duration < 27 for p in library)
    danced = [task for p in library for task in p.task.split(", ")]
    assert all(danced.count(figure.name) == 4 for figure in FIGURES)
    assert len({p.person for p in library}) == 8
    assert all(p.motion.skeleton == library[0].motion.skeleton for p in library)
    own = dance_library(body=None)
    assert own[0].motion.skeleton != own[1].motion.skeleton


@pytest.mark.parametrize("fps", [30.0, 120.0])
def test_any_frame_rate_is_the_same_dance(fps: float) -> None:
    reference, other = (perform(DANCERS[2], [REPERTOIRE[10]], 1.0, 2, np.random.default_rng(0), f) for f in (60.0, fps))
    times = np.arange(0, reference.motion.duration - 0.1, 1 / 30)
    apart = reference.motion.at(times).positions - other.motion.at(times).positions
    assert np.linalg.norm(apart, axis=-1).max() < 0.03
    assert np.allclose(reference.keyposes, other.keyposes)
