"""Feet, jerk and hands of dances put together from the embedded troupe, against the clips they are made of."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.realise import Realised, realise
from onbeat.examples.troupe import dance_library
from onbeat.metrics import feet, smoothness
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.features import hand_paths
from onbeat.motion.links import link_directions
from onbeat.motion.motion import Motion

RATE = 15.0  # Hz at which poses are compared


@pytest.fixture(scope="module")
def clips() -> list[Motion]:
    return [performance.motion for performance in dance_library(fps=60.0)][:6]


def similar_plan(clips: list[Motion], moves: int, rng: np.random.Generator) -> DancePlan:
    """Moves of 1 to 3 s that are left and entered at poses much alike."""
    rows, own, times = [], [], []
    for index, clip in enumerate(clips):
        slow = clip.resampled(RATE)
        links = link_directions(slow).reshape(len(slow), -1)
        rows.append(np.hstack((links, 0.2 * np.gradient(links, axis=0) * RATE)))
        own.append(np.full(len(slow), index))
        times.append(slow.times)
    table, own, times = np.concatenate(rows), np.concatenate(own), np.concatenate(times)
    ends = np.array([clip.times[-1] for clip in clips])
    good = np.flatnonzero((times > 0.5) & (times < ends[own] - 4.0))
    here, at, plan = int(rng.choice(good)), 0.0, []
    for _ in range(moves):
        leave = here + np.arange(int(RATE), int(3 * RATE))
        enter = rng.choice(good, min(200, len(good)), replace=False)
        enter = enter[(own[enter] != own[here]) | (np.abs(times[enter] - times[here]) > 4.0)]
        apart = np.linalg.norm(table[leave][:, None] - table[enter], axis=-1)
        i, j = np.unravel_index(np.argsort(apart, axis=None)[20], apart.shape)
        plan.append(Move(int(own[here]), float(times[here]), float(times[leave[i]]), at))
        at += float(times[leave[i]] - times[here])
        here = int(enter[j])
    return DancePlan(tuple(plan), at)


@pytest.fixture(scope="module")
def dances(clips) -> list[tuple[DancePlan, Realised]]:
    plans = [similar_plan(clips, 9, np.random.default_rng(seed)) for seed in range(4)]
    return [(plan, realise(clips, plan)) for plan in plans]


def shown(clips: list[Motion], plan: DancePlan) -> list[tuple[Motion, np.ndarray]]:
    parts = []
    for move in plan.moves:
        clip, contacts = clips[move.clip], foot_contacts(clips[move.clip]).feet
        part = slice(int(move.from_s * clip.fps), int(move.to_s * clip.fps))
        parts.append((clip[part], contacts[part]))
    return parts


def joins(dance: Realised) -> np.ndarray:
    return np.array([(a + b) / 2 for a, b in dance.windows])


def test_feet_in_joins_are_as_good_as_the_clips(clips, dances):
    found = [feet.evaluate(d.motion, d.contacts, joins(d), shown(clips, plan)) for plan, d in dances]
    for figures in found:
        assert figures["over_reach_m"] == 0.0
        assert figures["skate_joins"] <= 1.2 * figures["skate_source"] + 0.005
    for key, most in (("skate_joins_p95", 0.02), ("acceleration_joins", 0.5)):
        mine = np.mean([figures[key] for figures in found])
        theirs = np.mean([figures[key.replace("joins", "source")] for figures in found])
        assert mine <= 1.2 * theirs + most, key


def test_feet_would_skate_if_they_were_not_planted(clips, dances):
    def skate(dance: Realised, contacts: np.ndarray) -> float:
        speeds = feet.contact_speeds(dance.motion, contacts)
        near = np.any([np.abs(dance.motion.times - join) < 0.25 for join in joins(dance)], axis=0)
        return float(np.nanmean(speeds[near]))

    planted = np.mean([skate(dance, dance.contacts) for _, dance in dances])
    plain = np.mean([skate(realise(clips, plan, plant=False), dance.contacts) for plan, dance in dances])
    assert planted < 0.8 * plain


def test_joins_are_smooth(clips, dances):
    found = [
        smoothness.evaluate(dance.motion, joins(dance), [clip for clip, _ in shown(clips, plan)])["jerk_all_ratio"]
        for plan, dance in dances
    ]
    assert np.mean(found) < 1.8


def test_hands_are_never_faster_than_in_the_clips(clips, dances):
    def peak(motion: Motion) -> float:
        return float(np.linalg.norm(np.diff(hand_paths(motion), axis=0), axis=-1).max() * motion.fps)

    fastest = max(peak(clip) for clip in clips)
    assert max(peak(dance.motion) for _, dance in dances) <= 1.02 * fastest
