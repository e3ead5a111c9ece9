"""Link directions: unit, blind to place and facing, and complete on bodies that lack joints."""

import numpy as np
import pytest

from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.links import LINKS, link_directions, link_error

NAMES = ("hips", "chest", *(s + n for s in "lr" for n in ("humerus", "radius", "wrist", "femur", "tibia", "foot")))
PARENTS = [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12]
OFFSETS = [
    *([0, 0, 0], [0, 0, 0.4]),
    *([-0.2, 0, 0.1], [0, 0, -0.3], [0, 0, -0.25], [-0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4]),
    *([0.2, 0, 0.1], [0, 0, -0.3], [0, 0, -0.25], [0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4]),
]


def motion(seed: int = 0, frames: int = 5, skeleton: Skeleton | None = None) -> Motion:
    skeleton = skeleton or Skeleton(NAMES, PARENTS, OFFSETS)
    turns = np.random.default_rng(seed).normal(0, 0.4, (frames, len(skeleton), 3))
    return Motion(skeleton, rot.exp(turns), np.zeros((frames, 3)), 30)


def test_seventeen_unit_vectors() -> None:
    links = link_directions(motion())
    assert len(LINKS) == 17
    assert links.shape == (5, 17, 3)
    assert np.linalg.norm(links, axis=-1) == pytest.approx(1.0)


def test_trunk_is_the_frames_own_axis() -> None:
    trunk = link_directions(motion())[:, LINKS.index("trunk")]
    assert trunk == pytest.approx(np.tile([0, 0, 1.0], (5, 1)), abs=1e-9)


def test_place_and_facing_do_not_matter() -> None:
    still = motion()
    turned = still.rotations.copy()
    turned[:, 0] = rot.multiply(rot.yaw(1.1), turned[:, 0])
    moved = still.replace(rotations=turned, root_positions=np.tile([3.0, -2.0, 0.5], (5, 1)))
    assert link_directions(moved) == pytest.approx(link_directions(still), abs=1e-9)


def test_missing_joints_take_their_neighbours_direction() -> None:
    links = link_directions(motion())
    for link, neighbour in (
        ("head", "trunk"),
        ("left_collar", "left_upper_arm"),
        ("right_hand", "right_forearm"),
        ("left_foot", "left_shin"),
    ):
        assert np.array_equal(links[:, LINKS.index(link)], links[:, LINKS.index(neighbour)])


def test_a_link_without_length_takes_its_neighbours_direction() -> None:
    skeleton = Skeleton((*NAMES, "lhand"), [*PARENTS, 4], [*OFFSETS, [0, 0, 0]])
    links = link_directions(motion(skeleton=skeleton))
    assert np.array_equal(links[:, LINKS.index("left_hand")], links[:, LINKS.index("left_forearm")])


def test_link_error_is_the_mean_angle() -> None:
    links = link_directions(motion())
    assert link_error(links, links) == pytest.approx(0.0, abs=1e-9)
    bent = links.copy()
    bent[:, 4] *= -1
    assert link_error(links, bent) == pytest.approx(180 / 17)
    assert link_error(links[:1], bent) == pytest.approx(link_error(bent, links[:1]))
