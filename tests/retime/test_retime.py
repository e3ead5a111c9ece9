from pathlib import Path

import numpy as np
import pytest

from demands import curves
from onbeat.errors import OnbeatError
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.motion.joint_angles import JointAngles
from onbeat.retime.lock import TimeMap, lock
from onbeat.retime.methods import METHODS
from onbeat.retime.retime import LONGEST, demand_of, retime
from onbeat.retime.sources import Table, source_of

BEATS = np.arange(0, 8.01, 0.5)
KEYPOSES = np.arange(0.25, 8, 0.5)


def table(seed: int = 0, seconds: float = 8.0, fps: float = 60.0, channels: int = 3) -> Table:
    angles = curves(seed, int(seconds * fps) + 1, channels, fps)
    return Table(JointAngles(tuple(f"j{k}" for k in range(channels)), angles, fps, "swing"))


def arm(speed: float = np.inf, channels: int = 3, acceleration: float = np.inf, reach: float = 50.0) -> Limits:
    names = tuple(f"j{k}" for k in range(channels))
    each = (np.full(channels, v) for v in (-reach, reach, speed, acceleration))
    return Limits("arm", names, *each)


@pytest.mark.parametrize("speed", [0.5, 1.0, 1.2, 2.0])
def test_at_another_speed_without_need_it_is_the_same_dance_at_another_time(speed: float):
    source = table()
    made = retime(source, TimeMap.steady(speed), arm(), BEATS, KEYPOSES)
    assert isinstance(made.dance, JointAngles)
    np.testing.assert_allclose(made.dance.angles, source.curve(made.dance.times * speed), atol=1e-9)
    assert len(made.dance) == int(np.floor(8 / speed * 60 + 1e-6)) + 1
    np.testing.assert_allclose(made.beats, BEATS / speed, atol=1e-9)
    np.testing.assert_allclose(made.demand.keyposes, KEYPOSES / speed, atol=1e-9)
    assert made.start == 0
    assert made.dance.fps == 60


@pytest.mark.parametrize("method", METHODS)
def test_every_method_answers_to_its_name(method: str):
    made = retime(table(), TimeMap.steady(1.2), arm(3.0), BEATS, KEYPOSES, method)
    assert made.method == method
    assert len(made.dance) == len(made.demand.wish.samples)
    if method in ("qp", "layers-qp", "layers2007"):
        assert made.measures.violations == (0, 0)


def test_the_first_is_the_best_and_the_one_without_a_name():
    assert next(iter(METHODS)) == "qp"
    assert retime(table(), TimeMap.steady(1.0), arm(), BEATS, KEYPOSES).method == "qp"


def test_beats_of_the_dance_are_on_those_of_a_song_that_changes_its_tempo():
    song = 1.0 + np.concatenate(([0], np.cumsum(np.linspace(0.55, 0.4, 16))))
    source = table()
    made = retime(source, lock(song, BEATS), arm(), BEATS, KEYPOSES)
    assert np.abs(made.beats - song).max() < 1 / 60 / 2
    times = made.start + made.dance.times
    own = np.interp(song[1:-1], times, made.warp(times))
    assert np.abs(own - BEATS[1:-1]).max() < 1 / 60
    assert made.start == pytest.approx(1.0, abs=1 / 60)


def test_a_song_at_another_rate_gets_frames_at_that_rate():
    made = retime(table(fps=30.0), TimeMap.steady(1.1), arm(), BEATS, KEYPOSES, fps=59.94)
    assert made.dance.fps == 59.94
    assert made.start == 0


@pytest.mark.parametrize("fps", [49.0, 59.94, 98.0, 24000 / 1001])
def test_the_dances_own_rate_is_kept_to_the_last_digit(fps: float):
    assert retime(table(fps=fps), TimeMap.steady(1.0), arm(), BEATS, KEYPOSES).dance.fps == pytest.approx(fps, abs=1e-9)


def test_a_dance_that_begins_later_in_the_song_begins_on_a_frame_then():
    made = retime(table(), TimeMap.steady(1.0, -2.505), arm(), BEATS, KEYPOSES)
    assert made.start == pytest.approx(151 / 60)
    np.testing.assert_allclose(made.dance.angles[0], made.source.curve(np.array([151 / 60 - 2.505]))[0], atol=1e-9)


def test_what_would_be_before_the_song_is_left_out():
    made = retime(table(), TimeMap.steady(1.0, 3.0), arm(), BEATS, KEYPOSES)
    assert made.start == 0
    assert len(made.dance) == 5 * 60 + 1


def test_it_ends_where_it_is_told_to():
    made = retime(table(), TimeMap.steady(1.0), arm(), BEATS, KEYPOSES, until=3.0)
    assert made.dance.duration == pytest.approx(3.0, abs=2 / 60)


def test_limits_are_found_by_the_joints_names_in_any_order():
    source = table()
    turned = Limits("arm", ("j2", "x", "j0", "j1"), [-9] * 4, [9] * 4, [3.0, 1, 1.0, 2.0])
    asked = demand_of(source, TimeMap.steady(1.0), turned, BEATS, KEYPOSES)
    assert asked.speed[0].tolist() == [1, 2, 3]
    assert asked.acceleration.tolist() == [20, 40, 60]


def test_the_order_of_keyposes_is_nothing():
    a, b = (retime(table(), TimeMap.steady(1.2), arm(3.0), BEATS, k).dance for k in (KEYPOSES, KEYPOSES[::-1]))
    np.testing.assert_array_equal(a.angles, b.angles)  # pyright: ignore[reportAttributeAccessIssue]


def test_at_another_rate_it_is_nearly_the_same():
    made = [retime(table(), TimeMap.steady(1.2), arm(3.0), BEATS, KEYPOSES, fps=fps) for fps in (60.0, 120.0)]
    a, b = (one.answer.trajectory(np.linspace(0, 6.6, 300)) for one in made)
    assert np.abs(a - b).max() < 0.06
    assert np.sqrt(np.square(a - b).mean()) < 0.01


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"method": "topp"}, "no method 'topp'; there are qp, layers-qp"),
        ({"warp": TimeMap.steady(1.0, 99.0)}, "swing has no time in the music"),
        ({"until": -1.0}, "no time in the music"),
        ({"until": 0.0}, "no time in the music"),
        ({"warp": TimeMap.steady(8 / LONGEST / 1.1)}, "3600 is the most"),
        ({"fps": -60.0}, "frames a second"),
        ({"fps": 0.0}, "frames a second"),
        ({"fps": np.nan}, "frames a second"),
        ({"fps": np.inf}, "frames a second"),
        ({"fps": 1e9}, "frames a second"),
        ({"beats": BEATS[:1]}, "beats"),
        ({"beats": np.zeros(0)}, "beats"),
        ({"beats": BEATS[::-1]}, "is not after the one before it"),
        ({"beats": np.append(BEATS, np.nan)}, "not a number"),
        ({"keyposes": np.array([1.0, np.nan])}, "not a number"),
        ({"limits": arm(channels=2)}, "j2"),
    ],
    ids=str,
)
def test_what_cannot_be_is_said_so(change: dict, said: str):
    given = {"source": table(), "warp": TimeMap.steady(1.0), "limits": arm(), "beats": BEATS, "keyposes": KEYPOSES}
    with pytest.raises(OnbeatError, match=said):
        retime(**{**given, **change})


def test_a_g1_dances_a_fifth_faster_inside_its_limits_and_in_its_keyposes(data: Path):
    path = data / "g1_moves" / "J_Dance2_Salsa.csv"
    if not path.is_file():
        pytest.skip(f"no {path}")
    motion = read_motion(path, fps=60)[:2100]
    beats = motion_beats(motion)
    keyposes = np.asarray(find_keyposes(motion, beats).times)
    made = retime(source_of(motion), TimeMap.steady(1.2), robot_limits("g1"), beats, keyposes)
    assert made.measures.violations == (0, 0)
    assert len(made.measures.keyposes) > 10
    assert made.measures.feasible.mean() > 0.9
    assert np.degrees(made.measures.worst_keypose) < 0.5
    assert (made.answer.trajectory.controls != made.demand.wish.controls).any(), "else it was no test"
