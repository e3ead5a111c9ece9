"""Which axis of a file is up: by the rest pose, by the frames, by the floor."""

import numpy as np
import pytest

from onbeat.formats.bvh.read import parse_bvh
from onbeat.formats.bvh.write import bvh_text
from onbeat.formats.conventions import UP_AXES, Convention, Up, up_vectors
from onbeat.formats.notes import noted
from onbeat.formats.read import read_motion
from onbeat.formats.upright import guessed_up, has_floor
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import local_rotations
from persons import along_local_axes, person, swinging


def standing() -> Motion:
    """A person who moves a little, on a floor at 0."""
    return on_floor(swinging(person(), frames=90, angle=0.1))


def on_floor(motion: Motion) -> Motion:
    """Each frame's lowest joint a little over 0, as of somebody who stands, lies or crawls."""
    low = motion.positions[..., 2].min(1)
    return motion.replace(root_positions=motion.root_positions - np.array([0, 0, 1.0]) * (low - 0.03)[:, None])


def turned(motion: Motion, turn: np.ndarray) -> Motion:
    """The body turned in the world by its root, its path as it was."""
    world = np.array(motion.rotations)
    world[:, 0] = rot.multiply(turn, world[:, 0])
    return motion.replace(rotations=world)


def pitched(degrees: float) -> Motion:
    """On the floor, bent forward about X."""
    return on_floor(turned(standing(), rot.about(np.array([1.0, 0, 0]), np.radians(-degrees))))


def told(motion: Motion, up: Up) -> tuple[Motion, str]:
    """The motion as a file of another axis brings it back, and what was said of that axis."""
    with noted() as notes:
        found = parse_bvh(bvh_text(motion, Convention(up)), "a.bvh")
    return found, next(f"{note.taken}: {note.why}" for note in notes if note.about == "up")


@pytest.mark.parametrize("up", UP_AXES)
def test_every_axis_is_found_where_the_body_stands(up: Up):
    motion = standing()
    found, said = told(motion, up)
    assert said == f"{up}: the head is over the feet along it"
    np.testing.assert_allclose(found.positions, motion.positions, atol=1e-4)


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize(("degrees", "along"), [(75, "lies"), (90, "lies"), (-90, "lies"), (180, "head down")])
def test_who_crawls_lies_or_stands_on_the_hands_does_so_on_the_floor(degrees: float, along: str, up: Up):
    motion = pitched(degrees)
    found, said = told(motion, up)
    assert said.startswith(f"{up}: the body stands along it in its rest pose, though")
    assert along in said
    np.testing.assert_allclose(found.positions, motion.positions, atol=1e-4)


def test_a_root_that_turns_the_body_upright_is_believed_where_there_is_a_floor():
    # Z up in the frames, but the skeleton as it was with Y up: the root carries the turn.
    motion = standing()
    s = motion.skeleton
    quarter = rot.about(np.array([1.0, 0, 0]), np.pi / 2)
    laid = s.replace(offsets=up_vectors(s.offsets, "y"))
    world = rot.multiply(motion.world_rotations, quarter)
    path = motion.root_positions + np.array([0.0, 3.0, 0.0])
    raw = Motion(laid, local_rotations(laid, world), path, motion.fps)
    np.testing.assert_allclose(raw.positions, motion.positions + np.array([0.0, 3.0, 0.0]), atol=1e-9)
    assert guessed_up(raw) == ("z", "the head is over the feet along it, though at rest the body stands along y")


@pytest.mark.parametrize("up", ["y", "z", "-y", "-z"])
def test_bodies_without_a_standing_rest_pose_are_seen_in_the_frames(up: Up):
    motion = along_local_axes(standing())
    found, said = told(motion, up)
    assert said.startswith(f"{up}: the head is over the feet along it")
    np.testing.assert_allclose(found.positions, motion.positions, atol=1e-4)


def test_such_bodies_lie_where_the_floor_tells():
    motion = along_local_axes(pitched(-90))
    path = motion.root_positions + np.linspace(1, 3, len(motion))[:, None] * [0.0, 1.0, 0.0]
    found, said = told(motion.replace(root_positions=path), "y")
    assert said.startswith("y: ")
    assert has_floor(found.positions, "+z")


def test_the_real_motion_stands_as_it_did(data):
    files = sorted((data / "cmu").glob("*.bvh")) + sorted((data / "bandai").rglob("*.bvh"))[::8]
    assert len(files) > 10
    for path in files:
        with noted() as notes:
            read_motion(path)
        assert [(note.taken, note.why) for note in notes if note.about == "up"] == [
            ("y", "the head is over the feet along it")
        ]
