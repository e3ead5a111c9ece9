"""Figures of a robot's balance: what is told of margins, feet and falls, and the same bytes for the same arrays."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.viewer.plots.robot import FALL, Measured, robot_figure, stretches, write_robot_figure

FRAMES = 120
TIMES = 3.0 + np.arange(FRAMES) / 30
SOLE = np.array([[-0.05, -0.03], [0.12, -0.03], [0.12, 0.03], [-0.05, 0.03]])
LEFT = np.array([0, 0.1])
BEATS = np.arange(0.0, 9.0, 0.5)


def plan() -> tuple[np.ndarray, ...]:
    """Times, margins, points, soles and standing feet of a robot that shifts its weight and lifts its left foot."""
    sway = 0.08 * np.sin(2 * np.pi * 0.5 * (TIMES - 3.0))
    corners = np.tile(np.stack([SOLE + LEFT, SOLE - LEFT]), (FRAMES, 1, 1, 1))
    standing = np.ones((FRAMES, 2), np.bool_)
    standing[60:90, 0] = False
    return TIMES, 0.05 - np.abs(sway), np.column_stack((0 * sway, sway)), corners, standing


def titles(figure: Any) -> list[str]:
    return [axes.get_title(loc="left") for axes in figure.axes]


def marks(axes: Any, colour: str) -> list[float]:
    return [float(line.get_xdata()[0]) for line in axes.get_lines() if line.get_color() == colour and vertical(line)]


def vertical(line: Any) -> bool:
    return len(set(line.get_xdata())) == 1


def test_a_margin_below_zero_is_told_and_drawn():
    figure = robot_figure(*plan(), title="a dance")
    assert titles(figure)[0].startswith("zero-moment point inside the soles' hull: planned ")
    inside = 100 * (plan()[1] >= 0).mean()
    assert 20 < inside < 80
    assert f"planned {inside:.1f} % inside, least −30 mm" in titles(figure)[0]
    bottom, top = figure.axes[0].get_ylim()
    assert bottom < -30 < 50 < top
    assert figure.get_suptitle() == "a dance"


def test_hardly_ever_outside_is_not_never_outside():
    times, _, zmp, corners, standing = plan()
    long = np.linspace(3.0, 4.0, 10_000)
    margin = np.full(10_000, 0.02)
    margin[7] = -1e-3
    many = [np.resize(each, (10_000, *each.shape[1:])) for each in (zmp, corners, standing)]
    assert "planned 99.9 % inside" in titles(robot_figure(long, margin, *many))[0]
    sure = robot_figure(times, np.full(FRAMES, 0.02), zmp, corners, standing)
    assert "planned 100 % inside, least 20 mm" in titles(sure)[0]
    for least, words in ((-3e-8, "100 % inside, least 0 mm"), (-3e-4, "% inside, least −0.3 mm")):
        margin = np.where(np.arange(FRAMES) == 5, least, 0.02)
        assert words in titles(robot_figure(times, margin, zmp, corners, standing))[0]


def test_a_margin_far_outside_does_not_hide_the_rest():
    times, margin, zmp, corners, standing = plan()
    margin = np.where(np.arange(FRAMES) == 50, -3.0, margin)
    figure = robot_figure(times, margin, zmp, corners, standing)
    assert "least −3000 mm" in titles(figure)[0]
    assert figure.axes[0].get_ylim()[0] > -70


def test_feet_are_bars_over_time():
    figure = robot_figure(*plan())
    support = figure.axes[1]
    assert titles(figure)[1] == "feet that stand: on one 25 % of the time"
    spans = sorted(
        (round(box.x0, 3), round(box.x1, 3), round(box.y0, 1))
        for bars in support.collections
        for box in (path.get_extents() for path in bars.get_paths())
    )
    assert spans == [(3.0, 5.0, -0.4), (3.0, 5.0, 0.6), (5.0, 6.0, -0.4), (6.0, 7.0, -0.4), (6.0, 7.0, 0.6)]
    assert [label.get_text() for label in support.get_yticklabels()] == ["left", "right"]


def test_what_was_measured_is_drawn_beside_what_was_planned():
    times = np.linspace(3.0, 5.5, 500)
    pressed = np.where(times[:, None] < 5.4, np.column_stack((0 * times, 0.01 * times)), np.nan)
    margin = np.where(times < 5.4, 0.012, np.nan)
    measured = Measured(times, margin, np.linspace(0, 12.5, 500), np.linspace(0, 0.8, 500), pressed)
    figure = robot_figure(*plan(), measured=measured, fell_at=5.5, beats=BEATS)
    assert len(figure.axes) == 5
    assert titles(figure)[0].endswith("; measured 100 % inside, least 12 mm")
    assert titles(figure)[2:4] == [
        "joints off their target: 12.5° at most",
        "of the motors' greatest torque: 80.0 % at most",
    ]
    only = robot_figure(*plan(), measured=Measured(times, None, np.ones(500)))
    assert len(only.axes) == 4
    assert "measured" not in titles(only)[0]


def test_a_fall_is_a_red_line_through_all_panels():
    figure = robot_figure(*plan(), fell_at=5.5, beats=BEATS)
    for axes in figure.axes[:2]:
        assert 5.5 in marks(axes, FALL)
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["planned", "both feet", "one foot", "beat", "fall at 5.5 s"]
    assert marks(robot_figure(*plan()).axes[0], FALL) == []


def test_beats_are_on_the_time_of_the_music():
    figure = robot_figure(*plan(), beats=BEATS)
    drawn = [line.get_xdata()[0] for line in figure.axes[1].get_lines() if vertical(line)]
    assert drawn == pytest.approx(BEATS[(BEATS >= 3.0) & (TIMES[-1] >= BEATS)])
    assert figure.axes[0].get_xlim() == pytest.approx((3.0, TIMES[-1]))


def test_from_above_all_soles_are_seen_in_true_proportion():
    axes = robot_figure(*plan()).axes[-1]
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim()[0] < -0.05 < 0.12 < axes.get_xlim()[1]
    assert axes.get_ylim()[0] < -0.13 < 0.13 < axes.get_ylim()[1]
    hulls = [patch for patch in axes.patches if patch.get_fill()]
    assert len(hulls) == len(stretches(plan()[-1])) == 3
    (path,) = (line.get_xydata() for line in axes.get_lines())
    assert path == pytest.approx(plan()[2])


def test_little_or_nothing_still_makes_a_figure():
    times, margin, zmp, corners, standing = plan()
    robot_figure(times[:1], margin[:1], zmp[:1], corners[:1], standing[:1], fell_at=3.0)
    robot_figure(times, np.full(FRAMES, np.nan), np.full((FRAMES, 2), np.nan), corners, standing & False)
    flat = robot_figure(times, margin, zmp, 0 * corners, standing, measured=Measured(np.zeros(0), np.zeros(0)))
    assert "measured nowhere known" in titles(flat)[0]


def test_the_same_arrays_give_the_same_bytes(tmp_path: Path):
    for name in ("a", "b"):
        write_robot_figure(tmp_path / f"{name}.svg", *plan(), fell_at=5.0, beats=BEATS, title="one $ of _ names")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_shapes_that_disagree_are_said():
    times, margin, zmp, corners, standing = plan()
    with pytest.raises(OnbeatError, match=r"margin has the shape \(119,\); \(120,\) is needed"):
        robot_figure(times, margin[1:], zmp, corners, standing)
    with pytest.raises(OnbeatError, match=r"corners has the shape \(120, 4, 2\); \(120, 2, 4, 2\) is needed"):
        robot_figure(times, margin, zmp, corners[:, 0], standing)
    with pytest.raises(OnbeatError, match="needs one frame at least"):
        robot_figure(times[:0], margin[:0], zmp[:0], corners[:0], standing[:0])
    with pytest.raises(OnbeatError, match=r"measured zmp has the shape \(3, 3\); \(3, 2\) is needed"):
        Measured(np.arange(3.0), zmp=np.zeros((3, 3)))
