"""Figures of retiming: which joint is drawn and when, what of it, and the same bytes for the same results."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.limits.limits import Limits
from onbeat.motion import Motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.retime.lock import TimeMap, lock
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import Character, Source, Table
from onbeat.viewer.plots.limits import limits_figure, write_limits_figure
from onbeat.viewer.plots.retime import COLOURS, retime_figure, write_retime_figure
from onbeat.viewer.plots.retime_curves import (
    Look,
    changed,
    joint_told,
    look_at,
    one_dance,
    over_limits,
    speed_told,
    speed_use,
)

FPS = 60.0
TIMES = np.arange(0, 14, 1 / FPS)
BEATS = np.arange(0, 14, 0.5)
KEYPOSES = np.arange(0.25, 14, 1.0)


def arm() -> Table:
    """A shoulder that swings slowly, and an elbow that shakes about second 10."""
    shake = 0.25 * np.exp(-np.square(TIMES - 10.0) * 4) * np.sin(2 * np.pi * 4 * TIMES)
    angles = np.column_stack((0.5 * np.sin(2 * np.pi * 0.5 * TIMES), np.sin(2 * np.pi * 0.5 * TIMES) + shake))
    return Table(JointAngles(("shoulder_joint", "elbow_joint"), angles, FPS, "wave"))


def limits(speed: float = 4.5) -> Limits:
    return Limits("arm", ("shoulder_joint", "elbow_joint"), [-2, -1.1], [2, 1.1], [speed, speed])


def made(method: str = "qp", speed: float = 4.5, rate: float = 1.2, source: Source | None = None) -> Retimed:
    return retime(source or arm(), TimeMap.steady(rate), limits(speed), BEATS, KEYPOSES, method)


@pytest.fixture(scope="module")
def results() -> list[Retimed]:
    return [made(method) for method in ("qp", "layers-qp", "layers2007", "clamp")]


@pytest.fixture(scope="module")
def free(swinger: Motion) -> Retimed:
    joints = tuple(swinger.skeleton.index(name) for name in ("LeftArm", "RightArm"))
    slow = Limits("person", ("LeftArm", "RightArm"), -np.inf, np.inf, [2.5, 9.0])
    return retime(Character(swinger, joints), TimeMap.steady(1.2), slow, BEATS[:8], KEYPOSES[:4])


def lines(axes: Any) -> dict[str, Any]:
    return {line.get_label(): line for line in axes.get_lines()}


def test_the_joint_that_was_changed_most_is_drawn_about_its_largest_change(results: list[Retimed]):
    look = look_at(results[0])
    assert look.joint == "elbow_joint"
    assert look.end - look.start == pytest.approx(8.0)
    at = changed(results[0])[:, 1].argmax() / FPS
    assert at == pytest.approx(10.0 / 1.2, abs=0.5)
    assert look.start < at < look.end


def test_where_nothing_is_changed_the_fastest_joint_is_drawn():
    quiet = made(speed=100.0, rate=1.0)
    assert np.array_equal(quiet.answer.trajectory.controls, quiet.demand.wish.controls)
    assert look_at(quiet).joint == "elbow_joint"


def test_a_joint_and_a_stretch_may_be_told(results: list[Retimed]):
    look = look_at(results[0], "shoulder_joint", (2.0, 99.0))
    assert (look.joint, look.channels, look.start) == ("shoulder_joint", slice(0, 1), 2.0)
    assert look.end == results[0].demand.wish.knots.end
    with pytest.raises(OnbeatError, match=r"no joint 'shoulder_jont' \(is it shoulder_joint\?\); there are shoulder"):
        look_at(results[0], "shoulder_jont")
    with pytest.raises(
        OnbeatError, match=r"from 50 to 60 s there is nothing of the dance; it lasts from 0\.00 to 11\.65"
    ):
        look_at(results[0], None, (50.0, 60.0))
    with pytest.raises(OnbeatError, match="nothing of the dance"):
        look_at(results[0], None, (float("nan"), 3.0))


def test_a_hinge_is_drawn_in_degrees(results: list[Retimed]):
    look, wish = look_at(results[0], "elbow_joint"), results[0].demand.wish
    times = np.array([1.0, 2.0])
    assert look.angle(wish, times) == pytest.approx(np.degrees(wish(times)[:, 1]))
    assert look.velocity(wish, times) == pytest.approx(np.degrees(wish(times, 1)[:, 1]))


def test_a_free_joint_is_drawn_about_the_axis_it_turns(free: Retimed):
    look = look_at(free, "LeftArm")
    assert np.abs(look.axis) == pytest.approx([0, 1, 0], abs=1e-6)
    times = np.linspace(look.start, look.end, 200)
    assert np.ptp(look.angle(free.demand.wish, times)) == pytest.approx(np.degrees(1.0), rel=0.01)
    top = look.velocity(free.demand.wish, times).max()
    assert top == pytest.approx(np.degrees(0.5 * 2 * np.pi * 1.2), rel=0.01)
    assert look.angles_allowed(free) == (-np.inf, np.inf)


def test_shares_of_the_limit_are_those_of_the_speed(free: Retimed):
    use = speed_use(free, free.demand.wish)
    assert use.highest == pytest.approx(np.pi * 1.2 / np.array([2.5, 9.0]), rel=0.01)
    wish = free.demand.wish
    fine = np.linalg.norm(wish(np.arange(wish.knots.start, wish.knots.end, 1e-3), 1)[:, :3], axis=1)
    assert use.seconds_over == pytest.approx([1e-3 * (fine > 2.5).sum(), 0.0], abs=0.02)
    assert speed_use(free, free.answer.trajectory).highest.max() <= 1 + 1e-9
    assert over_limits(free, wish).tolist() == [True, False]


def test_long_dances_are_looked_at_in_parts(results: list[Retimed], monkeypatch: pytest.MonkeyPatch):
    whole = speed_use(results[0], results[0].demand.wish)
    monkeypatch.setattr("onbeat.viewer.plots.retime_curves.AT_ONCE", 501)
    parts = speed_use(results[0], results[0].demand.wish)
    assert np.array_equal(whole.highest, parts.highest)
    assert np.array_equal(whole.seconds_over, parts.seconds_over)


def test_an_angle_past_its_limit_is_over_it(results: list[Retimed]):
    assert over_limits(results[0], results[0].demand.wish).tolist() == [False, True]
    narrow = Limits("arm", ("shoulder_joint", "elbow_joint"), [-2, -0.8], [2, 0.8], 1e3)
    slow = retime(arm(), TimeMap.steady(1.2), narrow, BEATS, KEYPOSES)
    assert not (speed_use(slow, slow.demand.wish).highest > 1).any()
    assert over_limits(slow, slow.demand.wish).tolist() == [False, True]
    assert not over_limits(slow, slow.answer.trajectory).any()


def test_weights_are_of_the_joint_that_is_drawn(results: list[Retimed]):
    assert look_at(results[0]).weights(results[0]) is None
    every = results[1].answer.weights
    assert every is not None
    seen = look_at(results[1], "elbow_joint").weights(results[1])
    assert np.array_equal(seen, every[:, :, 1])
    assert every.min() < 0.99 < every.max()


def test_results_of_different_dances_are_not_drawn_together(results: list[Retimed]):
    assert one_dance(results) is results[0]
    with pytest.raises(OnbeatError, match="one result or more"):
        one_dance([])
    with pytest.raises(OnbeatError, match=r"different dances or speeds: 2 channels over 11\.65 s, 2 over 9\.32"):
        one_dance([results[0], made(rate=1.5)])


def test_a_speed_that_changes_is_told_from_and_to(results: list[Retimed]):
    assert speed_told(results[0], 0.0, 5.0) == "1.2×"
    slower = np.concatenate((np.arange(0, 4, 0.4), 4 + np.arange(0, 5, 0.5)))
    bent = retime(arm(), lock(slower, np.arange(20) * 0.5), limits(), BEATS, KEYPOSES)
    low, high = speed_told(bent, 0.0, 9.0).removesuffix("×").split("–")
    assert float(low) == pytest.approx(1.0, abs=0.05)
    assert float(high) == pytest.approx(1.25, abs=0.05)
    assert joint_told("left_wrist_yaw_joint") == "left wrist yaw"


def test_the_figure_shows_wish_methods_limits_keyposes_and_beats(results: list[Retimed]):
    figure = retime_figure(results, "elbow_joint", (6.0, 11.0))
    panels = [axes for axes in figure.get_axes() if axes.get_title(loc="left")]
    wish = results[0].demand.wish(np.linspace(6.0, 11.0, 1200), 1)[:, 1]
    assert [axes.get_title(loc="left") for axes in panels] == [
        "angle, limits −63° and 63°",
        f"angular velocity, limit ±258 °/s, wished up to {np.degrees(np.abs(wish).max()):.0f} °/s",
        "layers-qp: weights of the layers",
        "layers2007: weights of the layers",
    ]
    above, below = lines(panels[0]), lines(panels[1])
    assert {"wish", "qp", "layers-qp", "layers2007", "clamp", "keypose", "limit"} <= set(above)
    assert above["qp"].get_color() == COLOURS["qp"]
    assert above["qp"].get_ydata() == pytest.approx(
        np.degrees(results[0].answer.trajectory(above["qp"].get_xdata())[:, 1])
    )
    top = np.degrees(4.5)
    assert np.abs(below["qp"].get_ydata()).max() <= top + 1e-6 < np.abs(below["wish"].get_ydata()).max()
    bottom, head = panels[1].get_ylim()
    assert bottom < -top
    assert top < head < 3.3 * top
    kept = above["keypose"].get_xdata()
    assert kept == pytest.approx([time for time in KEYPOSES / 1.2 if 6.0 <= time <= 11.0])
    beats = [line for line in panels[0].get_lines() if np.ptp(line.get_xdata()) == 0 and len(line.get_xdata()) == 2]
    assert len(beats) == sum(6.0 <= time <= 11.0 for time in BEATS / 1.2)
    assert figure.get_suptitle() == "elbow · 1.2× · qp, layers-qp, layers2007, clamp · arm · wave"
    assert panels[0].get_xlim() == (6.0, 11.0)


def test_no_legend_covers_a_curve(results: list[Retimed]):
    for figure in (retime_figure(results), limits_figure(results)):
        figure.draw_without_rendering()
        box = figure.legends[0].get_window_extent()
        for axes in figure.get_axes():
            assert not box.overlaps(axes.get_window_extent())
            assert axes.get_legend() is None


def test_a_keypose_out_of_reach_is_hollow():
    figure = retime_figure([made(speed=0.5)], "elbow_joint")
    marks = lines(figure.get_axes()[0])
    assert marks["keypose out of reach"].get_markerfacecolor() == "white"


def test_what_turns_freely_has_a_speed_and_no_angle_to_keep(free: Retimed):
    figure = retime_figure([free], "LeftArm")
    above, below = figure.get_axes()
    assert above.get_title(loc="left") == "turn about its main axis, no limits"
    assert below.get_title(loc="left").startswith("angular speed, limit 143 °/s, wished up to 2")
    assert below.get_ylim()[0] == 0.0


def test_a_joint_without_limits_is_drawn_without():
    unlimited = Limits("arm", ("shoulder_joint", "elbow_joint"), -np.inf, np.inf, np.inf)
    result = retime(arm(), TimeMap.steady(1.2), unlimited, BEATS, np.zeros(0))
    above, below = retime_figure([result]).get_axes()
    assert above.get_title(loc="left") == "angle, no limits"
    assert below.get_title(loc="left") == "angular velocity, no limit"
    assert "limit" not in lines(below)
    assert not speed_use(result, result.demand.wish).highest.any()
    assert limits_figure([result]).get_suptitle().startswith("0 of 2 joints would be over")


def test_a_still_dance_of_two_frames_is_drawn(tmp_path: Path):
    still = Table(JointAngles(("shoulder_joint", "elbow_joint"), np.zeros((2, 2)), FPS))
    result = retime(still, TimeMap.steady(1.0), limits(), BEATS[:2], np.zeros(0))
    write_retime_figure(tmp_path / "still.png", [result])
    write_limits_figure(tmp_path / "limits.png", [result])


def test_names_are_drawn_as_they_are(tmp_path: Path):
    odd = Table(JointAngles((r"$\frac{$", "a_$_b$"), arm().angles.angles, FPS, "$x$"))
    named = Limits("$", (r"$\frac{$", "a_$_b$"), -9, 9, 4.5)
    result = retime(odd, TimeMap.steady(1.2), named, BEATS, KEYPOSES)
    for joint in odd.joints:
        write_retime_figure(tmp_path / "odd.png", [result], joint)
    write_limits_figure(tmp_path / "limits.png", [result])


def test_the_strip_of_joints_tells_which_are_over(results: list[Retimed]):
    figure = limits_figure(results)
    (axes,) = figure.get_axes()
    assert [label.get_text() for label in axes.get_yticklabels()] == ["shoulder", "elbow"]
    assert figure.get_suptitle() == "1 of 2 joints would be over their speed limit · 1.2× · arm · wave"
    (told,) = [text.get_text() for text in axes.texts]
    assert told == f"{speed_use(results[0], results[0].demand.wish).seconds_over[1]:.2f} s"
    qp = lines(axes)["qp"].get_xdata()
    assert qp == pytest.approx(speed_use(results[0], results[0].answer.trajectory).highest)
    assert qp.max() <= 1 + 1e-9


def test_bars_that_are_far_over_end_and_tell_their_number():
    (axes,) = limits_figure([made(speed=0.5)]).get_axes()
    assert axes.get_xlim()[1] == 3.0
    assert [text.get_text().split(", up to ")[1] for text in axes.texts] == [
        f"{share:.1f}" for share in np.sort(speed_use(made(speed=0.5), made(speed=0.5).demand.wish).highest)
    ]


@pytest.mark.parametrize("write", [write_retime_figure, write_limits_figure])
@pytest.mark.parametrize("ending", [".png", ".svg"])
def test_the_same_results_give_the_same_bytes(
    write: Callable[[Path, list[Retimed]], None], ending: str, results: list[Retimed], tmp_path: Path
):
    for name in ("a", "b"):
        write(tmp_path / (name + ending), results[:2])
    assert (tmp_path / f"a{ending}").read_bytes() == (tmp_path / f"b{ending}").read_bytes()
    with pytest.raises(OnbeatError, match="cannot draw"):
        write(tmp_path / "a.gif", results[:2])


def test_a_look_is_a_value():
    look = Look("elbow", slice(0, 1), np.ones(1), 0.0, 1.0)
    with pytest.raises(AttributeError):
        look.joint = "knee"  # type: ignore[misc]
