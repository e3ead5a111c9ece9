"""The drawn body: alike on both sides, as large as its skeleton, whole where a file lacks head, hands or toes."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from onbeat.motion import Body, Skeleton
from onbeat.motion.unitree_g1 import G1
from onbeat.viewer.figure import Figure
from onbeat.viewer.shape import GROUPS, capsules

LIMBS = {
    "Arm": (0.18, 0.0, 1.42),
    "ForeArm": (0.45, 0.0, 1.42),
    "Hand": (0.7, 0.0, 1.42),
    "UpLeg": (0.1, 0.0, 0.9),
    "Leg": (0.1, 0.0, 0.5),
    "Foot": (0.1, 0.0, 0.08),
}
ABOVE = {"Arm": "Chest", "ForeArm": "Arm", "Hand": "ForeArm", "UpLeg": "Hips", "Leg": "UpLeg", "Foot": "Leg"}
SPINE = {"Hips": 0.95, "Chest": 1.3, "Neck": 1.48, "Head": 1.6}


def person(size: float = 1.0, without: tuple[str, ...] = ()) -> Skeleton:
    places = {name: (0.0, 0.0, z) for name, z in SPINE.items() if name not in without}
    parents = dict(zip(list(places)[1:], list(places), strict=False))
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        for name, (x, y, z) in LIMBS.items():
            places[side + name] = (sign * x, y, z)
            parents[side + name] = ABOVE[name] if ABOVE[name] in places else side + ABOVE[name]
    names = list(places)
    at = size * np.array([places[name] for name in names])
    index = [-1] + [names.index(parents[name]) for name in names[1:]]
    return Skeleton(names, index, np.vstack((np.zeros(3), at[1:] - at[index[1:]])))


def test_both_sides_are_alike() -> None:
    skeleton = person()
    shape = capsules(skeleton, Body.of(skeleton))
    assert {capsule.group for capsule in shape} <= set(GROUPS)

    def side(name: str) -> Counter[tuple[object, ...]]:
        return Counter((c.group[len(name) :], *c[2:4], *c[5:]) for c in shape if c.group.startswith(name))

    assert side("left") == side("right")
    assert len(side("left")) >= 6


def test_a_smaller_body_has_the_same_shape() -> None:
    heights = []
    for size in (1.0, 0.6):
        skeleton = person(size)
        low, high = Figure.of(skeleton).bounds(skeleton.rest_positions)
        heights.append((high - low) / size)
    assert heights[0] == pytest.approx(heights[1], rel=1e-6)


@pytest.mark.parametrize("without", [(), ("Head",), ("Neck", "Head")])
def test_there_is_a_skull_above_the_shoulders(without: tuple[str, ...]) -> None:
    skeleton = person(without=without)
    shape = capsules(skeleton, Body.of(skeleton))
    figure = Figure.from_capsules(shape)
    ends = figure.ends(skeleton.rest_positions)
    skull = ends[[i for i, capsule in enumerate(shape) if capsule.group == "head"]]
    top = skull[..., 2].max() + SPINE["Hips"]  # the rest pose has the hips at the origin
    assert 1.55 < top < 1.95


@pytest.mark.parametrize(
    "neck_head_end",
    [
        (1.48, 1.57, 1.76),  # the crown at the end of the head
        (1.33, 1.51, 1.60),  # a neck from the chest up, and a head that ends in its middle
        (1.40, 1.47, None),  # a head joint at the chin, and no end of it
    ],
)
def test_the_head_sits_on_a_neck_wherever_files_have_its_joints(neck_head_end: tuple[float, float, float | None]):
    neck, head, end = neck_head_end
    whole = person()
    heights = {"Neck": neck, "Head": head}
    rest = whole.rest_positions + np.array([0, 0, SPINE["Hips"]])
    for name, height in heights.items():
        rest[whole.index(name), 2] = height
    names, parents = list(whole.names), whole.parents.tolist()
    if end is not None:
        names, parents, rest = [*names, "HeadEnd"], [*parents, names.index("Head")], np.vstack((rest, [0, 0, end]))
    skeleton = Skeleton(names, parents, np.vstack((np.zeros(3), rest[1:] - rest[parents[1:]])))
    skull = max((c for c in capsules(skeleton, Body.of(skeleton)) if c.group == "head"), key=lambda one: one.radius_b)
    heights_of = [rest[skull.joint_a, 2] + part * (rest[skull.joint_b] - rest[skull.joint_a])[2] for part in skull[5:]]
    shoulders = LIMBS["Arm"][2]
    assert 0.05 < heights_of[0] - skull.radius_a - shoulders < 0.15  # there is a neck to be seen
    assert 0.28 < heights_of[1] + skull.radius_b - shoulders < 0.37


def test_hands_reach_past_the_wrists_and_heels_below_the_ankles() -> None:
    skeleton = person()
    figure = Figure.of(skeleton)
    low, high = figure.bounds(skeleton.rest_positions)
    assert high[0] - low[0] > 2 * (0.7 + 0.1)
    assert low[2] + 0.95 < 0.05


def test_a_robots_head_is_above_its_shoulders_and_its_chest_is_closed() -> None:
    skeleton = G1.skeleton
    ends = zip(skeleton.names, skeleton.end_sites, strict=True)
    for robot in (skeleton, skeleton.replace(names=[f"{n}_x" if end else n for n, end in ends])):
        body, rest = Body.of(robot), robot.rest_positions
        made = capsules(robot, body)
        heads = [c for c in made if c.group == "head"]
        assert heads
        for c in heads:
            top = rest[c.joint_a] + c.end * (rest[c.joint_b] - rest[c.joint_a])
            assert top[2] > rest[body["left_shoulder"], 2]
        assert any(c.group == "torso" and c.joint_b == body["head"] for c in made)
