"""A robot that dances on the spot in MuJoCo, with and without feedback, undisturbed and disturbed."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.motion import Motion
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.simulate import Options, simulate
from onbeat.robots.simulation.disturb import Push
from onbeat.robots.state import configurations, motion_of
from onbeat.robots.zmp import centres_of_mass


def swaying(robot: Robot, seconds: float, sway: float, fps: float = 60, knees: float = 0.7) -> Motion:
    """The robot on both feet, its hips going forward and back by ``sway`` metres once in two seconds."""
    times = np.arange(round(seconds * fps)) / fps
    qpos = np.zeros((len(times), 7 + len(robot.body.names)))
    qpos[:, 2], qpos[:, 3] = knees, 1
    legs = Legs.of(robot)
    places, turns = legs.feet(qpos)
    places = places.copy()
    places[..., 2] = -robot.feet["left"].corners[:, 2].min()
    middle = robot.feet["left"].corners[:, 0].mean() + places[0, :, 0].mean()
    for _ in range(3):
        qpos[:, 0] += middle - centres_of_mass(robot, legs.standing(qpos[:1], places[:1], turns[:1])[0])[0, 0]
    qpos[:, 0] += sway * np.sin(np.pi * times) * np.minimum(times, 1)
    return motion_of(robot, legs.standing(qpos, places, turns)[0], fps)


@pytest.fixture(scope="module")
def g1() -> Robot:
    return robot_named("g1")


def test_a_gentle_dance_is_danced_to_its_end_and_followed(g1: Robot):
    motion = swaying(g1, 3, 0.02)
    trial = simulate(g1, motion, Options(feedback="truth"))
    assert trial.upright
    assert trial.why is None
    assert np.degrees(trial.worst_error).max() < 3
    assert abs(len(trial.motion) - len(motion)) <= 1
    assert trial.motion.fps == motion.fps
    assert trial.contacts.all()
    assert trial.load.sum(axis=1).mean() == pytest.approx(g1.mass * 9.81, rel=0.02)
    assert np.isfinite(trial.pressure).all()


def test_sensors_balance_it_too(g1: Robot):
    assert simulate(g1, swaying(g1, 3, 0.02), Options(feedback="estimate"), rng=np.random.default_rng(1)).upright


def test_leaning_past_the_toes_is_a_fall_with_its_time(g1: Robot):
    motion = swaying(g1, 3, 0.2)
    trial = simulate(g1, motion, Options(feedback="none"))
    assert trial.fell_at is not None
    assert 0 < trial.fell_at < 3
    assert trial.why
    assert trial.motion.duration == pytest.approx(trial.fell_at, abs=0.05)


def test_feedback_stands_a_push_that_servos_alone_do_not(g1: Robot):
    motion, push = swaying(g1, 4, 0.0), (Push(1.0, (60.0, 0, 0), 0.15),)
    assert not simulate(g1, motion, Options(feedback="none", pushes=push)).upright
    assert simulate(g1, motion, Options(feedback="truth", pushes=push)).upright


def test_the_same_seed_gives_the_same_trial_and_another_another(g1: Robot):
    motion = swaying(g1, 1, 0.02)
    one, same, other = (simulate(g1, motion, rng=np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert np.array_equal(one.error, same.error)
    assert not np.array_equal(one.error, other.error)


def test_it_does_not_depend_on_the_rate_the_dance_is_stored_at(g1: Robot):
    coarse, fine = (simulate(g1, swaying(g1, 2, 0.02, fps), Options(feedback="truth")) for fps in (60, 120))
    ticks = min(len(coarse.times), len(fine.times))
    assert np.abs(coarse.error[:ticks] - fine.error[:ticks]).max() < np.radians(0.5)


def test_a_heavier_robot_presses_more(g1: Robot):
    trial = simulate(g1, swaying(g1, 1, 0.0), Options(feedback="truth", mass_scale=1.1))
    assert trial.load.sum(axis=1).mean() == pytest.approx(1.1 * g1.mass * 9.81, rel=0.02)


def test_one_frame_is_a_pose_that_is_held(g1: Robot):
    trial = simulate(g1, swaying(g1, 1, 0.0)[:1], Options(feedback="truth"))
    assert trial.upright
    assert len(trial.motion) == 1


def test_progress_rises(g1: Robot):
    seen: list[float] = []
    simulate(g1, swaying(g1, 1, 0.0), Options(feedback="truth"), progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] <= 1


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (Options(friction=-1), "friction of -1"),
        (Options(mass_scale=0), "masses times 0"),
        (Options(mass_scale=float("nan")), "masses times nan"),
        (Options(delay=-0.1), "late by -0.1"),
    ],
)
def test_what_cannot_be_is_said(g1: Robot, options: Options, told: str):
    with pytest.raises(BodyError, match=told):
        simulate(g1, swaying(g1, 0.2, 0.0), options)


def test_another_body_is_not_simulated(g1: Robot, swinger: Motion):
    with pytest.raises(BodyError):
        simulate(g1, swinger)


def test_it_begins_in_the_first_pose(g1: Robot):
    motion = swaying(g1, 1, 0.0)
    trial = simulate(g1, motion, Options(feedback="truth"))
    started, meant = configurations(g1, trial.motion)[0], configurations(g1, motion)[0]
    assert np.degrees(np.abs(started[7:] - meant[7:])).max() < 2
