"""Takes on musical time: means, variances, what is left of the layers, common valleys."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from onbeat.errors import MetricError, OnbeatError
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.retime.attenuation import attenuation
from onbeat.retime.observe import observe, variance
from onbeat.retime.speeds import speeds_from
from onbeat.retime.takes import Repetitions, Take, branch, repetitions
from onbeat.retime.valleys import common_valleys, contrast, valleys

BODY = Skeleton(("hips", "arm", "hand"), [-1, 0, 1], [[0, 0, 0], [0, 0, 0.5], [0.3, 0, 0]])
PERIOD, BEATS = 0.5, 12
FINE = 3.0  # cycles a beat of the small details: too many for layer 3, not for layer 4


def take(
    speed: float = 1.0, rng: np.random.Generator | None = None, details: float = 0.05, fps: float = 120.0,
    late: float = 0.0, turn: float = 0.0, start: float = 0.0,
) -> Take:  # fmt: skip
    """A body that swings its arm once in four beats, with fast small details; the beats begin at ``start`` seconds."""
    period = PERIOD / speed
    times = np.arange(int((start + BEATS * period) * fps) + 2) / fps
    beats = (times - start) / period - late
    noise = np.zeros((len(times), 3)) if rng is None else rng.normal(0, 0.004, (len(times), 3))
    swing = 0.8 * np.sin(2 * np.pi * beats / 4) + details * np.sin(2 * np.pi * FINE * beats)
    arm = np.column_stack((swing, 0.3 * np.cos(2 * np.pi * beats / 4), np.zeros(len(times)))) + noise
    vectors = np.stack((np.zeros_like(arm), arm + np.array([turn, 0, 0]), 0.5 * arm[:, ::-1]), axis=1)
    motion = Motion(BODY, rot.exp(vectors), np.zeros((len(times), 3)), fps, f"take {speed:g}")
    return Take(motion, start + period * np.arange(BEATS + 1), speed)


def several(details: dict[float, float], count: int = 4, seed: int = 0) -> Repetitions:
    """Takes at some speeds, with details of given sizes, early and late by a hundredth of a second."""
    rng = np.random.default_rng(seed)
    takes = [
        take(speed, rng, size, late=0.01 * speed / PERIOD * rng.uniform(-1, 1))
        for speed, size in details.items()
        for _ in range(count)
    ]
    return repetitions(takes, ["arm", "hand"])


def test_variance_is_that_of_the_paper() -> None:
    rng = np.random.default_rng(0)
    logs = rng.normal(0, 0.5, (5, 7, 2, 3))
    mean = logs.mean(axis=0)
    expected = np.zeros((7, 2))
    for point in range(7):
        for joint in range(2):
            vectors = [np.append(v, 1.0) for v in logs[:, point, joint]]
            middle = np.append(mean[point, joint], 1.0)
            dots = [v @ middle / np.linalg.norm(v) / np.linalg.norm(middle) for v in vectors]
            expected[point, joint] = sum(1 - dot for dot in dots) / 4
    assert variance(logs) == pytest.approx(expected)
    assert (variance(np.repeat(logs[:1], 3, axis=0)) < 1e-15).all()


def test_a_single_repetition_has_no_variance() -> None:
    with pytest.raises(MetricError, match="1 repetition; a variance needs two"):
        variance(np.zeros((1, 4, 3)))


def test_speed_and_rate_do_not_matter_where_the_movement_is_the_same() -> None:
    every = repetitions([take(1.0), take(1.5, fps=100.0), take(0.8, fps=60.0), take(1.0, start=0.31)], ["arm"])
    logs = every.logs(5)
    assert logs.shape == (4, 12 * 32 + 1, 1, 3)
    assert np.abs(logs - logs[0]).max() < 0.003
    assert np.abs(logs[0, ::8, 0, 0] * 2 - logs[0, ::8, 0, 0].mean() * 2).max() > 0.7


def test_layers_add_up_to_half_the_rotation() -> None:
    one = take()
    every = repetitions([one, one], ["arm"])
    moments = one.beats[0] + PERIOD * every.beats
    turns = rot.log(one.motion.at(moments).rotations[:, 1])
    logs = every.logs(5)[0, :, 0]
    apart = turns - 2 * logs
    assert np.abs(apart - apart.mean(axis=0)).max() < 0.05  # about the mean rotation, which is not nought
    relative = rot.multiply(rot.inverse(rot.exp(2 * logs[:1])), rot.exp(2 * logs))
    given = one.motion.at(moments).rotations[:, 1]
    assert rot.angle_between(relative, rot.multiply(rot.inverse(given[:1]), given)).max() < 0.01


def test_all_takes_are_on_one_branch() -> None:
    """About half a turn, and wide: the logarithm alone jumps, and differently in every take."""
    wide = [
        take(1.0, turn=2.9, details=0.0),
        take(1.2, turn=2.9, details=0.0),
        take(1.0, turn=2.9, details=0.0, start=0.3),
    ]
    spins: list[Take] = []
    for each in wide:
        turned = rot.multiply(
            each.motion.rotations, rot.about(np.array([1.0, 0, 0]), 1.0 * np.sin(each.motion.times[:, None]))
        )
        spins.append(Take(each.motion.replace(rotations=turned), each.beats, each.speed))
    for takes, most in ((wide, 1e-5), (spins[:1] * 2, 1e-12)):
        every = repetitions(takes, ["arm"])
        assert np.abs(np.diff(every.logs(5), axis=1)).max() < 0.2
        assert observe(every).all.variance[-1].max() < most


def test_a_branch_goes_on_both_ways_from_its_anchor() -> None:
    turns, round_ = np.linspace(-5, 9, 300)[:, None] * np.array([0, 0, 1.0]), np.array([0, 0, 2 * np.pi])
    wrapped = rot.log(rot.exp(turns))
    for frame in (0, 120, 299):
        assert branch(wrapped, frame, turns[frame]) == pytest.approx(turns)
        assert branch(wrapped, frame, turns[frame] + round_) == pytest.approx(turns + round_)


def test_cycles_of_one_take_are_repetitions() -> None:
    every = repetitions([take()], ["arm"], cycle=4)
    assert len(every) == 3
    assert every.takes.tolist() == [0, 0, 0]
    assert every.period == 4
    logs = every.logs(5)
    assert np.abs(logs - logs[0]).max() < 0.003
    assert attenuation(every, np.random.default_rng(0), 20).drawn == "cycles"


def test_beats_count_from_the_first_that_all_takes_have() -> None:
    late = take(1.0, start=1.0)
    cut = Take(late.motion[150:], late.beats - 150 / 120, 1.0)  # its first beat is lost
    every = repetitions([take(), cut], ["arm"])
    assert every.first == 1
    assert every.beats[-1] == BEATS - 1
    assert np.abs(every.logs(5)[0] - every.logs(5)[1]).max() < 0.005


def test_details_that_are_left_out_in_fast_music_are_found_in_their_layer() -> None:
    energies = attenuation(several({1.0: 0.05, 1.2: 0.035, 1.5: 0.0125}), np.random.default_rng(0))
    ratios = energies.ratios[0]
    assert ratios[0].tolist() == [1] * 5
    assert ratios[1, 3] == pytest.approx(0.7, abs=0.06)
    assert ratios[2, 3] == pytest.approx(0.25, abs=0.06)
    assert ratios[:, 0] == pytest.approx(1.0, abs=0.02)
    slope, low, high = energies.slopes[0, 3]
    assert low <= slope <= high < -1.2
    assert energies.slopes[0, 0, 1] < 0.05
    assert energies.slopes[0, 0, 2] > -0.05


def test_merely_playing_faster_leaves_every_layer() -> None:
    energies = attenuation(several({1.0: 0.05, 1.2: 0.05, 1.5: 0.05}, count=6), np.random.default_rng(0))
    assert energies.ratios[0][:, [0, 3]] == pytest.approx(1.0, abs=0.05)
    assert np.abs(energies.slopes[0, [0, 3], 0]).max() < 0.2


def test_what_takes_share_is_told_from_noise() -> None:
    rng = np.random.default_rng(1)
    of = repetitions([take(1.0, rng, details=0.0) for _ in range(8)], ["arm", "hand"])
    energies = attenuation(of, rng)
    assert energies.shared[0, 4] < 0.3 * energies.rms[0, 4]
    assert energies.noise[0, 0] < 0.02 * energies.shared[0, 0]
    assert energies.rms**2 == pytest.approx(energies.shared**2 + energies.noise**2, rel=1e-6)
    assert np.isnan(energies.slopes).all()


def test_intervals_come_from_the_generator_alone() -> None:
    every = several({1.0: 0.05, 1.5: 0.02})
    first, again, other = (attenuation(every, np.random.default_rng(seed), 200).slopes for seed in (0, 0, 1))
    assert (first == again).all()
    assert (first != other).any()


def test_one_take_a_speed_has_means_but_no_variance_of_its_own() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        every = repetitions([take(1.0), take(1.2, details=0.03), take(1.5, details=0.01)], ["arm"])
        found, energies = observe(every), attenuation(every, np.random.default_rng(0), 50)
    assert [curves.count for curves in found.speeds] == [1, 1, 1]
    assert found.repeated == (found.all,)
    assert np.isnan(energies.shared).all()
    assert energies.slopes[0, 3, 0] < -1
    assert np.isnan(energies.slopes[..., 1:]).all()


def test_a_joint_that_never_moves_does_not_count() -> None:
    still = Motion(BODY, np.tile(rot.IDENTITY, (722, 3, 1)), np.zeros((722, 3)), 120.0)
    every = repetitions([Take(still, take().beats, 1.0)] * 2, ["arm", "hand"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = observe(every)
        attenuation(every, np.random.default_rng(0), 20)
        assert (found.all.pooled < 1e-15).all()
        assert len(valleys(every.beats, np.zeros(len(every.beats)))) == 0
    moving = repetitions([take(rng=np.random.default_rng(k)) for k in range(3)], ["hips", "arm"])
    found = observe(moving)
    assert found.all.pooled == pytest.approx(found.all.variance[-1, :, 1])


def test_poses_that_are_kept_are_valleys_of_every_speed() -> None:
    """Whoever is early or late is so between the stops; there nobody moves."""
    every = repetitions(
        [
            take(speed, late=0.04 * (k - 1.5) * speed, details=0.0)
            for speed in (1.0, 1.2, 1.5)
            for k in range(4)
        ],
        ["arm"],
        cycle=4,
    )  # fmt: skip
    found = observe(every)
    each = [valleys(every.beats, curves.pooled, cyclic=True) for curves in found.repeated]
    assert common_valleys(each, every.period) == pytest.approx([1.0, 3.0], abs=0.07)
    assert contrast(every.beats, found.all.pooled, np.array([1.0, 3.0]), 4.0) < 0.5


def test_valleys_have_to_be_deep_and_within_an_eighth_of_a_beat() -> None:
    beats = np.arange(8 * 32 + 1) / 32
    curve = 1.5 + np.cos(2 * np.pi * beats / 4)
    assert valleys(beats, curve).tolist() == [2.0, 6.0]
    assert valleys(beats, curve + 0.02 * np.sin(20 * beats)).round(0).tolist() == [2.0, 6.0]
    assert len(valleys(beats, np.full(len(beats), np.nan))) == 0
    a, b = np.array([1.0, 5.0]), np.array([1.24, 5.3])
    assert common_valleys([a, b]).tolist() == [1.12]
    assert common_valleys([a, b, np.array([1.6])]).tolist() == []
    assert common_valleys([np.array([1.0, 1.1]), np.array([1.05])]).tolist() == [1.025]  # each only once
    assert common_valleys([]).tolist() == []


def test_tempi_become_speeds() -> None:
    assert speeds_from(np.array([100.0, 150.0, 100.2, 121.0, 120.0])).tolist() == [1.0, 1.5, 1.0, 1.2, 1.2]
    assert speeds_from(np.array([88.0])).tolist() == [1.0]


@pytest.mark.parametrize(
    ("takes", "joints", "cycle", "message"),
    [
        ([], ["arm"], None, "0 takes"),
        ([take()], ["arm"], None, "1 repetition of the dance; give two or more takes"),
        ([take(), take()], [], None, "0 joints"),
        ([take(), take()], ["leg"], None, "no joint leg; it has hips, arm, hand"),
        ([take(), take()], ["arm"], 0, "a cycle of 0 beats"),
        ([take(), take()], ["arm"], 13, "a cycle of 13 beats is needed"),
        ([take(), Take(take().motion, take().beats + 100, 1.0)], ["arm"], None, "two beats or more that all"),
        ([take(), Take(take().motion, np.array([1.0]), 1.0)], ["arm"], None, "has 1 beats"),
        ([take(), Take(take().motion, np.array([1.0, np.nan, 2.0]), 1.0)], ["arm"], None, "seconds that rise"),
        ([take(), Take(take().motion, np.array([2.0, 1.0]), 1.0)], ["arm"], None, "seconds that rise"),
        ([take(), Take(take().motion, take().beats, 0.0)], ["arm"], None, "has the speed 0"),
        ([take(), Take(take().motion[:1], take().beats, 1.0)], ["arm"], None, "two beats or more"),
        ([take()] * 2, ["arm"] * 3000, None, "fewer joints or takes"),
    ],
)  # fmt: skip
def test_what_cannot_be_observed_is_told(takes: list[Take], joints: list[str], cycle: int | None, message: str) -> None:
    many = [take()] * 2 + [take()] * 300 if len(joints) > 100 else takes
    with pytest.raises(OnbeatError, match=message):
        repetitions(many, joints, cycle)
