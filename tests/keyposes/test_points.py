"""Which points of a body count, and how much."""

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.examples.dancers import DANCERS
from onbeat.keyposes.points import body_points, bridged, marker_masses, role_masses
from onbeat.motion import Markers, Motion
from onbeat.motion.role_names import ROLES


def still(seconds: float = 1.0) -> Motion:
    body = DANCERS[0].build.skeleton
    frames = round(60 * seconds)
    return Motion(body, np.tile([1.0, 0, 0, 0], (frames, len(body), 1)), np.tile([0, 0, 1.0], (frames, 1)), 60)


def test_joints_that_play_a_role_count_and_no_others() -> None:
    found = body_points(still())
    assert set(found.names) <= set(ROLES)
    assert found.positions.shape == (60, len(found.names), 3)
    assert [found.names[k] for k in found.hands] == ["left_wrist", "right_wrist"]
    assert [found.names[k] for k in found.feet] == ["left_ankle", "right_ankle"]


def test_weights_add_up_to_one() -> None:
    for weights in ("uniform", "mass"):
        assert body_points(still(), weights).weights.sum() == pytest.approx(1.0)


def test_the_trunk_is_heavy_and_the_hands_are_light() -> None:
    shares = dict(zip(ROLES, role_masses(tuple(ROLES)), strict=True))
    assert shares["left_hand"] < 0.01 < shares["left_knee"] < shares["chest"]
    trunk = sum(shares[role] for role in ("hips", "spine", "chest", "neck"))
    assert trunk == pytest.approx(0.497, abs=1e-9)


def test_markers_of_one_segment_share_its_mass() -> None:
    segment = {"a": "LeftArm", "b": "LeftArm", "c": "Head", "d": "nowhere"}
    shares = marker_masses(("a", "b", "c", "d"), segment)
    assert shares[0] == shares[1]
    assert shares[2] / shares[0] == pytest.approx(0.081 / 0.014)
    assert shares[3] == 0.0


def test_unknown_markers_have_no_mass_to_share() -> None:
    with pytest.raises(BodyError, match="no marker of x, y is known to sit on a bone"):
        marker_masses(("x", "y"), {})


def test_short_holes_are_crossed_and_long_ones_do_not_count() -> None:
    path = np.arange(300.0)[:, None, None] * np.ones((1, 2, 3))
    holed = path.copy()
    holed[50:60, 0] = holed[100:200, 1] = holed[:10, 1] = holed[290:, 0] = np.nan
    whole, counted = bridged(holed, 100.0)
    assert whole[:290, 0] == pytest.approx(path[:290, 0])
    assert (whole[290:, 0] == 289.0).all()
    assert (whole[:10, 1] == 10.0).all()
    assert counted[50:60, 0].all()
    assert not counted[100:200, 1].any()
    assert not counted[:10, 1].any()
    assert not counted[290:, 0].any()
    assert np.isnan(holed[55, 0]).all()


def test_markers_never_seen_are_left_out() -> None:
    positions = np.ones((20, 3, 3))
    positions[:, 1] = np.nan
    assert body_points(Markers(("a", "b", "c"), positions, 60), local=False).names == ("a", "c")


def test_without_known_labels_only_the_world_is_had() -> None:
    markers = Markers(("a", "b"), np.ones((20, 2, 3)), 60)
    assert len(body_points(markers, local=False).names) == 2
    with pytest.raises(BodyError, match="pelvis"):
        body_points(markers)
