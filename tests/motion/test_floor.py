import numpy as np
import pytest

from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.floor import SOLE, is_on_floor, on_floor
from onbeat.motion.retarget import feet_in_air, floor_height
from persons import person


def standing(height: float) -> Motion:
    """Somebody whose feet's lowest joints are at a height."""
    skeleton = person()
    up = height - skeleton.rest_positions[:, 2].min()
    return Motion(skeleton, np.tile(rot.IDENTITY, (30, len(skeleton), 1)), np.tile([0, 0, up], (30, 1)), 30)


@pytest.mark.parametrize("height", [-0.02, 0.0, 0.05])
def test_who_stands_on_the_floor_is_left_alone(height):
    assert is_on_floor(standing(height))
    assert on_floor(standing(height)).root_positions[0, 2] == standing(height).root_positions[0, 2]


@pytest.mark.parametrize("height", [-1.0, -0.05, 0.1, 3.0])
def test_others_are_put_on_it_with_their_soles(height):
    assert not is_on_floor(standing(height))
    assert floor_height(on_floor(standing(height))) == pytest.approx(SOLE)


def test_the_floor_of_who_stands_on_the_hands_is_under_the_hands():
    upright = standing(0.0)
    turns = np.array(upright.rotations)
    turns[:, 0] = rot.about(np.array([1.0, 0, 0]), np.pi)
    over = upright.replace(rotations=turns)
    assert feet_in_air(over)
    assert floor_height(over) == pytest.approx(over.positions[..., 2].min(), abs=0.3)
    assert is_on_floor(over.replace(root_positions=over.root_positions - [0, 0, floor_height(over) - 0.12]))
    assert not feet_in_air(upright)
