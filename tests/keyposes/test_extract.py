"""Keyposes of dances of which they are known, and what is said where there are none."""

from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import BodyError, PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform
from onbeat.keyposes.extract import METHODS, Options, Reading, find_keyposes
from onbeat.keyposes.matching import score
from onbeat.motion import Markers, Motion
from onbeat.motion.body import Body


@pytest.fixture(scope="module")
def clip() -> Performance:
    return perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))


def inside(times: np.ndarray, clip: Performance) -> np.ndarray:
    """Those within the cycles: the poses before and after the dance are no keyposes of it."""
    return times[(times > clip.keyposes[0] - 0.3) & (times < clip.keyposes[-1] + 0.3)]


def test_all_keyposes_of_the_folk_dance_are_found_and_no_others(clip: Performance) -> None:
    found = find_keyposes(clip.motion, clip.beats)
    assert score(inside(found.times, clip), clip.keyposes, 0.12) == (1.0, 1.0, 1.0)


def test_the_method_of_2004_finds_about_half(clip: Performance) -> None:
    recall = score(inside(find_keyposes(clip.motion, clip.beats, "shiratori2004").times, clip), clip.keyposes, 0.12)[1]
    assert 0.1 < recall < 0.7


@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_increasing_times_near_their_beats(clip: Performance, method: str) -> None:
    found = find_keyposes(clip.motion, clip.beats, method)
    assert len(found)
    assert (np.diff(found.times) > 0).all()
    assert (np.abs(found.times - found.song_beats[found.beats]) < 0.6 * np.diff(clip.beats).max()).all()
    assert len(found.sources) == len(found.times)


def test_global_goes_before_local(clip: Performance) -> None:
    first, second = (
        find_keyposes(clip.motion, clip.beats, options=Options(order=o)) for o in ("global-local", "local-global")
    )
    both = ~np.isnan(first.candidates["global"]) & ~np.isnan(first.candidates["local"])
    assert both.sum() > 5
    for found, name in ((first, "global"), (second, "local")):
        assert {s for s, beat in zip(found.sources, found.beats, strict=True) if both[beat]} == {name}


def test_markers_give_what_the_joints_give(clip: Performance) -> None:
    body = Body.of(clip.motion.skeleton)
    roles = list(body.joints)
    labels = [f"point {number}" for number in range(len(roles))]
    markers = Markers(labels, clip.motion.positions[:, body.indices(*roles)], clip.motion.fps)
    alone = find_keyposes(markers, clip.beats, options=Options(order="global"))
    joints = find_keyposes(clip.motion, clip.beats, options=Options(order="global"))
    assert alone.times == pytest.approx(joints.times, abs=1e-6)


def test_sixty_percent_occlusion_is_borne(clip: Performance) -> None:
    rng = np.random.default_rng(5)
    body = Body.of(clip.motion.skeleton)
    positions = np.array(clip.motion.positions[:, body.indices(*body.joints)])
    for marker in range(positions.shape[1]):
        for start in rng.integers(0, len(positions), 60 * len(positions) // 100 // 12):
            positions[start : start + 12, marker] = np.nan
    assert 0.35 < np.isnan(positions[..., 0]).mean() < 0.7
    found = find_keyposes(
        Markers(list(body.joints), positions, clip.motion.fps), clip.beats, options=Options(order="global")
    )
    assert score(inside(found.times, clip), clip.keyposes, 0.12).f > 0.85


def test_energy_is_in_units_of_its_mean_where_the_beats_are(clip: Performance) -> None:
    still = np.repeat(clip.motion.rotations[-1:], 600, axis=0)
    longer = Motion(
        clip.motion.skeleton,
        np.concatenate([clip.motion.rotations, still]),
        np.concatenate([clip.motion.root_positions, np.repeat(clip.motion.root_positions[-1:], 600, axis=0)]),
        clip.motion.fps,
    )
    beats = clip.beats[:-2]
    assert find_keyposes(longer, beats).times == pytest.approx(find_keyposes(clip.motion, beats).times, abs=2e-3)


def test_beats_beside_the_motion_are_told_with_both_spans(clip: Performance) -> None:
    with pytest.raises(PlanError, match=r"0 of 25 beats fall into it \(the beats go from 100.00 to 12"):
        find_keyposes(clip.motion, 100.0 + np.arange(25.0))


@pytest.mark.parametrize("beats", [[1.0, 1.0], [2.0, 1.0], [np.nan, 1.0], [[1.0, 2.0]]])
def test_what_is_no_list_of_beats_is_refused(clip: Performance, beats: list) -> None:
    with pytest.raises(PlanError, match="not a list of increasing seconds"):
        find_keyposes(clip.motion, np.array(beats))


def test_a_motion_shorter_than_a_beat_is_told(clip: Performance) -> None:
    with pytest.raises(PlanError, match="two are needed"):
        find_keyposes(clip.motion[:10], clip.beats)


def test_a_constant_pose_has_no_keypose(clip: Performance) -> None:
    still = clip.motion.at(np.full(300, 1.0))
    for method in METHODS:
        assert len(find_keyposes(still, np.arange(0.2, 4.0, 0.5), method)) == 0


def test_unknown_names_are_refused_with_those_there_are(clip: Performance) -> None:
    with pytest.raises(PlanError, match="there are energy, paper2009, shiratori2004, hands"):
        find_keyposes(clip.motion, clip.beats, "magic")
    for options in (Options(order="up"), Options(weights="fat"), Options(kind="none")):
        with pytest.raises(BodyError, match="there are"):
            Reading(clip.motion, clip.beats, options)


def test_markers_without_hands_still_have_keyposes_but_not_by_hand(clip: Performance) -> None:
    body = Body.of(clip.motion.skeleton)
    roles = [role for role in body.joints if "hand" not in role and "wrist" not in role]
    markers = Markers(roles, clip.motion.positions[:, body.indices(*roles)], clip.motion.fps)
    assert len(find_keyposes(markers, clip.beats, options=Options(order="global")))
    with pytest.raises(BodyError, match="no hands or feet among"):
        find_keyposes(markers, clip.beats, "hands", Options(order="global"))


def test_the_same_motion_gives_the_same_keyposes_whatever_its_mean_speed(clip: Performance) -> None:
    slower = replace(clip, motion=clip.motion.replace(fps=clip.motion.fps / 1.3), beats=clip.beats * 1.3)
    found = find_keyposes(slower.motion, slower.beats)
    straight = find_keyposes(clip.motion, clip.beats)
    before_and_after = {0, len(straight.song_beats) - 1}  # the poses in which the dancer stands
    assert set(found.beats.tolist()) - before_and_after == set(straight.beats.tolist()) - before_and_after


def test_someone_who_stands_and_sways_has_no_keypose_there(clip: Performance) -> None:
    motion = clip.motion
    count = round(6 * motion.fps)
    sway = 0.004 * np.sin(2 * np.pi * 0.9 * np.arange(count) / motion.fps)
    standing = np.repeat(motion.root_positions[:1], count, axis=0) + np.outer(sway, [1.0, 0.3, 0.0])
    longer = Motion(
        motion.skeleton,
        np.concatenate([np.repeat(motion.rotations[:1], count, axis=0), motion.rotations]),
        np.concatenate([standing, motion.root_positions]),
        motion.fps,
    )
    beats = np.concatenate([np.arange(0.2, 5.6, 0.5), 6.0 + clip.beats])
    found = find_keyposes(longer, beats)
    assert (found.times > 5.5).all()
    assert score(inside(found.times - 6.0, clip), clip.keyposes, 0.12).recall == 1.0


@pytest.mark.parametrize("method", METHODS)
def test_times_increase_on_uneven_beats_too(clip: Performance, method: str) -> None:
    rng = np.random.default_rng(2)
    beats = np.sort(rng.uniform(0.2, clip.motion.duration - 0.2, 40))
    assert (np.diff(find_keyposes(clip.motion, beats, method).times) > 0).all()


def test_two_far_beats_cost_no_more_than_others(clip: Performance) -> None:
    found = find_keyposes(clip.motion, np.array([0.1, clip.motion.duration - 0.5]))
    assert len(found) <= 2


def test_without_a_known_frame_there_is_no_local_energy(clip: Performance) -> None:
    markers = Markers([f"x{k}" for k in range(5)], clip.motion.positions[:, :5], clip.motion.fps)
    found = find_keyposes(markers, clip.beats, options=Options(order="global"))
    assert len(found.energy.local) == 0
    assert set(found.candidates) == {"global"}
