"""Feet of live dances do not sink into the floor, and what is above it stays what it is."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat._shapes import Positions, Rotations
from onbeat.examples.body import Build
from onbeat.examples.troupe import dance_library
from onbeat.live.beat.pulse import Pulse
from onbeat.live.bodies.dancers import Character
from onbeat.live.bodies.soles import Soles
from onbeat.live.cast import Cast, Known, following
from onbeat.live.session import Session
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.motion import Motion
from onbeat.motion.soles import DEEPEST, FREE, on_soles

SKELETON = Build(1.7).skeleton
BODY = Body.of(SKELETON)
SOLES = Soles.of(BODY)
FLOOR = -float(SKELETON.rest_positions[:, 2].min())


def poses(heights: list[float], **angles: float) -> tuple[Rotations, Positions, Positions]:
    """One pose at some heights (metres) of its feet, joints turned about the axis to the right (radians)."""
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (len(heights), len(SKELETON), 1))
    for name, angle in angles.items():
        rotations[:, SKELETON.names.index(name)] = rot.about(np.array([1.0, 0.0, 0.0]), angle)
    roots = np.array([[0.3, -0.2, FLOOR + height] for height in heights])
    return rotations, roots, forward_kinematics(SKELETON, rotations, roots)[1]


def test_the_legs_are_all_that_hangs_on_the_hips_and_what_carries_them():
    names = {SKELETON.names[joint] for joint in SOLES.legs}
    assert {"Hips", "LeftUpLeg", "RightLeg", "LeftToeEnd", "RightToeEnd"} <= names
    assert not {"Chest", "Head", "LeftArm"} & names
    assert {SKELETON.names[joint] for joint in SOLES.feet} == {
        f"{side}{part}" for side in ("Left", "Right") for part in ("Foot", "ToeBase", "ToeEnd")
    }


def test_legs_alone_are_pressed_as_those_of_the_whole_body_to_the_bit():
    rotations, roots, places = poses([0.1, -0.01, -0.03, -0.09], LeftUpLeg=0.2, LeftLeg=-0.3, RightToeBase=-0.9)
    pressed, moved = SOLES.pressed(rotations, roots, places)
    assert np.array_equal(pressed, on_soles(BODY, rotations, roots))
    assert np.array_equal(moved, forward_kinematics(SKELETON, pressed, roots)[1])
    assert moved[..., 2].min() >= -DEEPEST - 1e-9


def test_poses_above_the_floor_keep_their_bytes_beside_deep_ones():
    rotations, roots, places = poses([0.0, -0.05, -0.9 * FREE])
    pressed, moved = SOLES.pressed(rotations, roots, places)
    for pose, (before, after) in enumerate(zip(rotations, pressed, strict=True)):
        assert np.array_equal(before, after) == (pose != 1)
        assert np.array_equal(places[pose], moved[pose]) == (pose != 1)
    rotations, roots, places = poses([0.0, 0.2])
    pressed, moved = SOLES.pressed(rotations, roots, places)
    assert pressed is rotations
    assert moved is places


def cast_of(motion: Motion) -> tuple[Cast, Character]:
    cast = following([Known(motion, np.arange(0.5, motion.duration, 0.5), np.zeros(0))])
    assert isinstance(cast.dancer, Character)
    return cast, cast.dancer


def toes_down(motion: Motion, angle: float) -> Motion:
    """The same with toes that point down for a moment, again and again, where a shoe could not."""
    rotations = np.array(motion.rotations)
    bends = -angle * (0.5 - 0.5 * np.cos(2 * np.pi * motion.times / 1.7)) ** 4
    for side in ("Left", "Right"):
        toe = motion.skeleton.names.index(f"{side}ToeBase")
        turns = rot.about(np.tile([1.0, 0.0, 0.0], (len(motion), 1)), bends)
        rotations[:, toe] = rot.multiply(rotations[:, toe], turns)
    return motion.replace(rotations=rotations)


def lowest(dancer: Character, own: np.ndarray) -> np.ndarray:
    """(N,) metres: the lowest joint of the timeline's own poses."""
    return forward_kinematics(dancer.skeleton, *dancer.turned.line.pose(own))[1][..., 2].min(axis=1)


@pytest.fixture(scope="module")
def clicks() -> np.ndarray:
    """Twelve seconds of clicks at 120 BPM."""
    sound = np.zeros(12 * 44100, np.float32)
    for at in range(4410, len(sound) - 200, 22050):
        sound[at : at + 200] = 0.8 * np.exp(-np.arange(200) / 40.0) * np.sin(np.arange(200) * 0.3)
    return sound


def test_a_live_dance_whose_toes_go_deep_stays_out_of_the_floor(clicks: np.ndarray):
    cast, dancer = cast_of(toes_down(dance_library()[0].motion, 1.5))
    session = Session(Pulse(), cast.conductor, cast.dancer)
    steps = [session.step(clicks[at : at + 441]) for at in range(0, len(clicks), 441)]
    danced = [pose for step in steps for pose in step.poses]
    rotations, roots = np.stack([pose.rotations for pose in danced]), np.stack([pose.root for pose in danced])
    places = forward_kinematics(dancer.skeleton, rotations, roots)[1]
    assert cast.conductor.dancing != "resting"
    settled = cast.conductor.line.settled
    assert lowest(dancer, np.arange(settled - 3.0, settled, 0.01)).min() < -2 * DEEPEST
    assert -DEEPEST - 1e-9 <= places[..., 2].min() < -FREE
    told = np.stack([pose.points for pose in danced])
    columns = [cast.who.joints.index(name) for name in cast.who.points]
    assert told == pytest.approx(places[:, columns], abs=1e-5)


def test_a_dance_above_the_floor_is_the_timelines_own_to_the_bit():
    _, dancer = cast_of(dance_library()[0].motion)
    own = np.arange(0.0, 4.0, 0.01)
    values = dancer.followed.values(own, dancer.start(0.0))
    shown, _ = dancer.turned.made(values, own)
    above = lowest(dancer, own) > -FREE
    assert above.mean() > 0.5
    danced = np.stack([pose.rotations for pose in dancer.poses(0, values, own)])
    assert np.array_equal(danced[above], rot.normalise(shown)[above])
