"""Rehearsed takes: early and late as was asked, true to their keyposes, noisy, and the same every time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.examples.performer import Performance
from onbeat.examples.rehearsal import FARTHEST, NOISE, rehearse
from onbeat.motion import rotations as rot

STILL = (0.0, 0.0)


@pytest.fixture(scope="module")
def clip() -> Performance:
    return perform_dance(DANCERS[0], "festival dance", 1.5, 3, np.random.default_rng(0))


def seeded(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def test_a_keypose_comes_at_its_new_time(clip: Performance) -> None:
    take = rehearse(clip, seeded(), noise=STILL)
    here, there = take.motion.at(take.keyposes), clip.motion.at(clip.keyposes)
    assert np.abs(take.keyposes - clip.keyposes).max() > 0.05
    assert np.abs(here.positions - there.positions).max() < 0.02
    assert np.abs(take.motion.at(clip.keyposes).positions - there.positions).max() > 0.05


def test_between_two_keyposes_time_never_runs_back(clip: Performance) -> None:
    """The path of the root is a clock here, so that it shows which moment each frame shows."""
    clock = np.column_stack((clip.motion.times, np.zeros((len(clip.motion), 2))))
    take = rehearse(replace(clip, motion=clip.motion.replace(root_positions=clock)), seeded(1), 0.2, STILL, "normal")
    shown = take.motion.root_positions[:, 0]
    assert (np.diff(shown) >= 0).all()
    assert shown[0] == 0.0
    assert shown[-1] == pytest.approx(clip.motion.times[-1])


def test_uniform_timing_stays_within_its_bound_and_fills_it(clip: Performance) -> None:
    shifts = np.concatenate([rehearse(clip, seeded(s), 0.06, STILL).keyposes - clip.keyposes for s in range(5)])
    assert np.abs(shifts).max() <= 0.06
    assert shifts.std() == pytest.approx(0.06 / np.sqrt(3), rel=0.1)
    assert abs(shifts.mean()) < 0.006


def test_normal_timing_has_its_deviation(clip: Performance) -> None:
    takes = [rehearse(clip, seeded(s), 0.06, STILL, "normal") for s in range(5)]
    shifts = np.concatenate([take.keyposes - clip.keyposes for take in takes])
    assert shifts.std() == pytest.approx(0.06, rel=0.1)
    assert np.abs(shifts).max() > 0.1


@pytest.mark.parametrize("spread", ["uniform", "normal"])
def test_keyposes_keep_their_order_and_their_beat(clip: Performance, spread: str) -> None:
    take = rehearse(clip, seeded(), 1.0, STILL, spread)
    assert (np.diff(take.keyposes) > 0).all()
    assert np.abs(take.keyposes - clip.keyposes).max() <= 2 * FARTHEST * clip.beats[1] + 1e-9
    nearest = np.abs(take.keyposes[:, None] - clip.keyposes[None]).argmin(1)
    assert nearest.tolist() == list(range(len(clip.keyposes)))
    assert take.beats is clip.beats


def test_noise_is_as_large_as_it_says(clip: Performance) -> None:
    take = rehearse(clip, seeded(), 0.0)
    turned = rot.log(rot.multiply(rot.inverse(clip.motion.rotations), take.motion.rotations))
    assert turned.std() == pytest.approx(NOISE[0], rel=0.02)
    assert (take.motion.root_positions - clip.motion.root_positions).std() == pytest.approx(NOISE[1], rel=0.02)


def test_without_jitter_and_noise_nothing_changes(clip: Performance) -> None:
    take = rehearse(clip, seeded(), 0.0, STILL)
    assert np.abs(take.motion.positions - clip.motion.positions).max() < 1e-6
    assert take.keyposes.tolist() == clip.keyposes.tolist()
    assert (take.contacts == clip.contacts).all()


def test_feet_in_contact_stand_still_in_the_take(clip: Performance) -> None:
    take = rehearse(clip, seeded(), 0.06, STILL)
    skeleton, positions = take.motion.skeleton, take.motion.positions
    moves = []
    for side, stands in zip(("Left", "Right"), take.contacts.T, strict=True):
        foot = positions[:, skeleton.index(side + "Foot")]
        moves.append(np.linalg.norm(np.diff(foot, axis=0), axis=1)[stands[1:] & stands[:-1]])
    assert np.percentile(np.concatenate(moves), 99) * take.motion.fps < 0.05  # half a frame at an edge is rounded
    assert (take.contacts != clip.contacts).any()


def test_same_generator_same_take_and_another_another(clip: Performance) -> None:
    def bytes_of(seed: int) -> bytes:
        take = rehearse(clip, seeded(seed))
        return take.motion.rotations.tobytes() + take.motion.root_positions.tobytes() + take.keyposes.tobytes()

    assert bytes_of(1) == bytes_of(1)
    assert bytes_of(1) != bytes_of(2)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda clip: rehearse(clip, seeded(), spread="gamma"), "no spread 'gamma'; there are uniform and normal"),
        (lambda clip: rehearse(clip, seeded(), jitter=-0.1), "none below 0"),
        (lambda clip: rehearse(clip, seeded(), noise=(float("nan"), 0.0)), "have to be numbers"),
    ],
)
def test_nonsense_is_refused(clip: Performance, ask: Callable[[Performance], Performance], words: str) -> None:
    with pytest.raises(PlanError, match=words):
        ask(clip)
