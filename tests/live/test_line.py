"""The growing timeline: what is settled stays, nothing jumps, feet stand as they do in a dance made as a whole."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.realise import realise
from onbeat.dance.windows import link_speeds
from onbeat.errors import PlanError
from onbeat.examples.troupe import dance_library
from onbeat.live.growing.line import MARGIN, Line
from onbeat.metrics import feet
from onbeat.motion.motion import Motion

FPS = 60.0
CLIPS = [performance.motion for performance in dance_library(fps=FPS)][:3]
FASTER, QUICKEST = 3.5, 60.0  # times the clips' own fastest; m/s² of the root, for moves that do not fit each other


def seconds(first: float, last: float) -> np.ndarray:
    return np.arange(int(np.ceil(first * FPS)), int(last * FPS)) / FPS


def danced(line: Line, times: np.ndarray) -> Motion:
    pose = line.pose(times)
    return Motion(CLIPS[0].skeleton, pose.rotations, pose.roots, FPS)


def random_plan(moves: int, seed: int) -> list[Move]:
    rng, plan, at = np.random.default_rng(seed), list[Move](), 0.0
    for _ in range(moves):
        clip, length = int(rng.integers(len(CLIPS))), float(rng.uniform(0.8, 2.5))
        begin = float(rng.uniform(0.0, CLIPS[clip].duration - length))
        plan.append(Move(clip, begin, begin + length, at))
        at += length
    return plan


def grown_line(plan: list[Move], ahead: float = 2.6) -> Line:
    """A line that is danced while it grows."""
    line = Line(CLIPS)
    for move in plan:
        line.add(move.clip, move.from_s, move.to_s, move.rate)
        if line.end > ahead:
            line.settle(line.end - ahead)
    return line


deed = st.one_of(
    st.tuples(
        st.just("add"), st.integers(0, 2), st.floats(0.5, 12.0), st.floats(0.05, 2.5), st.sampled_from([1.0, 0.8, 1.25])
    ),
    st.tuples(st.just("cut"), st.floats(0.0, 1.0)),
    st.tuples(st.just("settle"), st.floats(0.0, 1.0)),
    st.tuples(st.just("look")),
)


def do(line: Line, what: tuple) -> None:
    free = line.settled + line.margin
    match what:
        case ("add", clip, begin, length, rate):
            line.add(clip, begin, begin + length, rate)
        case ("cut", share) if line.end > free:
            line.cut(free + share * (line.end - free))
        case ("settle", share) if line.end - MARGIN > line.settled:
            line.settle(line.settled + share * (line.end - MARGIN - line.settled))
        case ("look",) if line.end > 0:
            line.pose(np.array([line.end]))


@settings(max_examples=15, deadline=None)
@given(deeds=st.lists(deed, min_size=4, max_size=16))
def test_what_is_settled_never_changes_and_nothing_jumps(deeds):
    line = Line(CLIPS)
    line.add(0, 1.0, 3.0)
    settled = list[tuple[np.ndarray, Motion]]()
    for what in deeds:
        do(line, what)
        if what[0] == "settle":
            times = seconds(0.0, line.settled)
            if len(times):
                settled.append((times, danced(line, times)))
    for times, before in settled:
        after = line.pose(times)
        assert np.array_equal(after.rotations, before.rotations)
        assert np.array_equal(after.roots, before.root_positions)
    # What has not come near yet may still end in the middle of a move.
    whole = danced(line, seconds(0.0, max(line.end - MARGIN, 0.1)))
    speeds = link_speeds(whole.skeleton, whole.positions, whole.times)
    assert (speeds <= FASTER * np.maximum(line.dancers.peaks, 1.0)).all()
    assert np.linalg.norm(np.diff(whole.root_positions, 2, axis=0), axis=1).max(initial=0.0) * FPS**2 <= QUICKEST


def test_feet_stand_as_well_as_in_a_dance_that_is_made_as_a_whole():
    plan = random_plan(14, seed=3)
    line = grown_line(plan)
    whole = realise(CLIPS, DancePlan(tuple(plan), line.end), FPS, peaks=line.dancers.peaks)
    times = seconds(0.0, line.end)
    joins = np.array([move.at_s for move in plan[1:]])
    mine = feet.evaluate(danced(line, times), line.contacts(times), joins)
    theirs = feet.evaluate(whole.motion[: len(times)], whole.contacts[: len(times)], joins)
    assert mine["skate_joins_p95"] <= 1.15 * theirs["skate_joins_p95"] + 0.01
    assert mine["support_joins"] <= 1.3 * theirs["support_joins"] + 0.005
    assert mine["acceleration_joins"] <= 1.15 * theirs["acceleration_joins"]
    assert mine["over_reach_m"] == 0.0


def test_a_move_that_goes_on_is_shown_as_the_clip_has_it():
    line, times = Line(CLIPS), seconds(0.0, 4.0)
    line.add(1, 2.0, 3.5)
    line.pose(times)
    line.add(1, 3.5, 6.0)
    clip = CLIPS[1].rotations[120 : 120 + len(times), 1:]
    assert np.abs(np.abs(np.sum(line.pose(times).rotations[:, 1:] * clip, axis=-1)) - 1).max() < 1e-9
    assert line.showing(3.0) == (1, pytest.approx(5.0))


def test_a_brief_rest_of_a_move_that_was_cut_off_leaves_no_jolt():
    line = Line(CLIPS)
    for move in random_plan(3, seed=1):
        line.add(move.clip, move.from_s, move.to_s)
    join = line._moves[1].move.at_s
    line.cut(join + 0.02)
    line.add(2, 5.0, 7.0)
    assert line.end == pytest.approx(join + 2.02)
    whole = danced(line, seconds(0.0, line.end))
    speeds = link_speeds(whole.skeleton, whole.positions, whole.times)
    assert (speeds <= FASTER * np.maximum(line.dancers.peaks, 1.0)).all()


def test_a_pose_does_not_depend_on_what_else_is_asked_for():
    line = grown_line(random_plan(4, seed=2))
    times = seconds(0.0, line.end) + 0.004
    together = line.pose(times)
    alone = [line.pose(times[k : k + 1]).rotations[0] for k in range(0, len(times), 7)]
    assert np.array_equal(together.rotations[::7], np.stack(alone))


def test_memory_stays_flat_and_what_is_forgotten_is_not_asked_for():
    line, kept = Line(CLIPS), []
    for move in random_plan(30, seed=4):
        line.add(move.clip, move.from_s, move.to_s)
        if line.end > 2.6:
            line.settle(line.end - 2.6)
            line.forget(line.settled - 1.0)
            line.pose(np.array([line.settled - 1.0, line.end]))
            kept.append((len(line._frames), len(line._moves)))
    assert max(frames for frames, _ in kept) < 7.0 * FPS
    assert max(moves for _, moves in kept) < 12
    with pytest.raises(PlanError, match="remembered from"):
        line.pose(np.array([1.0]))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda line: line.add(7, 0.0, 1.0), "there are 3"),
        (lambda line: line.add(0, 1.0, 1e9), "it lasts"),
        (lambda line: line.add(0, np.nan, 1.0), "give a stretch"),
        (lambda line: line.add(0, 0.0, 1.0, 0.0), "a rate from"),
        (lambda line: line.cut(np.nan), "a cut at nan"),
        (lambda line: line.cut(1.1), "a cut at 1.100"),
        (lambda line: line.settle(np.nan), "are to settle|is to settle"),
        (lambda line: line.settle(4.0), "add a move first"),
        (lambda line: line.pose(np.array([np.nan])), "is asked for"),
        (lambda line: Line(CLIPS).pose(np.zeros(1)), "no moves yet"),
        (lambda line: Line([]), "no clips"),
    ],
)
def test_what_cannot_be_is_said(wrong, said):
    line = Line(CLIPS)
    line.add(0, 1.0, 5.0)
    line.settle(1.0)
    before = line.pose(np.array([2.0])).rotations
    with pytest.raises(PlanError, match=said):
        wrong(line)
    assert np.array_equal(line.pose(np.array([2.0])).rotations, before)
