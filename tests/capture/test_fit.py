from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from capture.marked import dancing, hidden, joint_errors, marked
from onbeat.capture import Fit, fit_body
from onbeat.errors import BodyError
from onbeat.motion import Markers, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import ROLES, Body
from persons import person

LIMBS = ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot")
SECONDS, FPS = 2.0, 60.0


@pytest.fixture(scope="module")
def truth() -> Motion:
    return dancing(SECONDS, FPS)


@pytest.fixture(scope="module")
def markers(truth: Motion) -> Markers:
    return marked(truth, noise_m=0.001)


@pytest.fixture(scope="module")
def fit(markers: Markers) -> Fit:
    return fit_body(markers)


def limb_errors(fitted: Motion, truth: Motion) -> dict[str, float]:
    errors = joint_errors(fitted, truth)
    return {side + limb: float(errors[side + limb].max()) for side in ("Left", "Right") for limb in LIMBS}


def test_limbs_are_found_to_a_centimetre(fit: Fit, truth: Motion):
    errors = limb_errors(fit.motion, truth)
    assert max(errors.values()) < 0.010, errors
    assert joint_errors(fit.motion, truth)["Hips"].max() < 0.015


def test_markers_are_nearly_where_they_were_seen(fit: Fit):
    assert fit.residual_mm < 2.0  # noise of 1 mm along each axis is 1.7 mm of distance
    assert max(fit.worst.values()) < 3.0
    assert list(fit.worst.values()) == sorted(fit.worst.values(), reverse=True)


def test_all_roles_of_a_body_are_there(fit: Fit):
    assert set(Body.of(fit.motion.skeleton).joints) == set(ROLES)


def test_frames_rate_and_name_are_the_markers(fit: Fit, markers: Markers):
    assert (len(fit.motion), fit.motion.fps, fit.motion.name) == (len(markers), markers.fps, "marked")


def test_bones_are_of_constant_length_and_alike_on_both_sides(fit: Fit):
    p, skeleton = fit.motion.positions, fit.motion.skeleton
    lengths = np.linalg.norm(p[:, 1:] - p[:, skeleton.parents[1:]], axis=-1)
    assert np.ptp(lengths, axis=0).max() < 1e-9
    for limb in LIMBS:
        left, right = (skeleton.bone_lengths[skeleton.index(side + limb)] for side in ("Left", "Right"))
        assert left == pytest.approx(right, abs=1e-12)


def test_bones_of_both_sides_may_differ():
    uneven = fit_body(marked(dancing(1.0)), symmetric=False).motion.skeleton
    left, right = (uneven.bone_lengths[uneven.index(f"{side}Hand")] for side in ("Left", "Right"))
    assert left != right
    assert abs(left - right) < 0.01


def test_the_rest_pose_is_a_t_pose_that_looks_along_y(fit: Fit):
    skeleton = fit.motion.skeleton
    rest = {name: skeleton.rest_positions[skeleton.index(name)] for name in skeleton.names}
    assert rest["LeftHand"][0] < rest["LeftForeArm"][0] < rest["LeftArm"][0] < 0 < rest["RightHand"][0]
    assert abs(rest["LeftHand"][2] - rest["LeftArm"][2]) < 1e-9
    assert rest["LeftToeBase"][1] > rest["LeftFoot"][1]
    assert rest["Head"][2] > rest["Neck"][2] > rest["Chest"][2] > 0 > rest["LeftLeg"][2] > rest["LeftFoot"][2]


def test_knees_and_elbows_bend_forwards(fit: Fit, truth: Motion):
    skeleton, local = fit.motion.skeleton, fit.motion.rotations
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        shin = rot.rotate(local[:, skeleton.index(f"{side}Leg")], np.array([0, 0, -1.0]))
        forearm = rot.rotate(local[:, skeleton.index(f"{side}ForeArm")], np.array([sign, 0, 0]))
        assert shin[:, 1].max() < 0.05
        assert forearm[:, 1].min() > -0.05
        bent = rot.angle_between(rot.IDENTITY, truth.rotations[:, truth.skeleton.index(f"{side}Knee")])
        assert np.abs(np.arctan2(-shin[:, 1], -shin[:, 2]) - bent).max() < np.radians(4)


def test_a_marker_that_is_lost_for_long_is_told_by_the_others(markers: Markers, truth: Motion):
    holed = hidden(hidden(markers, "LKNE", 0.5, 1.1), "LFHD", 0.5, 1.0)
    fit = fit_body(holed)
    assert joint_errors(fit.motion, truth)["LeftLeg"].max() < 0.015
    assert any(line.startswith("LKNE: 0.60 s") and "by the fitted body" in line for line in fit.report)
    assert any(line.startswith("LFHD: 0.50 s") and "by the markers of its bone" in line for line in fit.report)


def test_a_forearm_that_nobody_sees_goes_on_as_it_went(markers: Markers, truth: Motion):
    holed = markers
    for label in ("RWRA", "RWRB", "RFIN", "RFRM"):
        holed = hidden(holed, label, 0.8, 1.1)
    fit = fit_body(holed)
    errors = joint_errors(fit.motion, truth)["RightHand"]
    assert errors.max() < 0.03
    steps = np.linalg.norm(np.diff(fit.motion.positions[:, fit.motion.skeleton.index("RightHand")], axis=0), axis=1)
    assert steps.max() < 0.08


def test_ghosts_and_swaps_are_taken_as_unseen_and_told(markers: Markers, truth: Motion):
    positions = markers.positions.copy()
    left, right = markers.index("LKNE"), markers.index("RKNE")
    positions[30:50, [left, right]] = positions[30:50, [right, left]] + [0, 0, 0.3]
    positions[70:80, markers.index("RWRA")] += 1.0
    fit = fit_body(Markers(markers.names, positions, markers.fps))
    assert max(limb_errors(fit.motion, truth).values()) < 0.015
    assert any(line.startswith("RWRA") and "seen where it cannot be" in line for line in fit.report)


def test_frames_in_which_nothing_is_seen_are_told_and_outside_the_trusted(markers: Markers):
    positions = markers.positions.copy()
    positions[:30] = np.nan
    fit = fit_body(Markers(markers.names, positions, markers.fps))
    assert len(fit.motion) == len(markers)
    assert fit.trusted == (30, len(markers))
    assert any(line.startswith("0.00 s to 0.50 s") for line in fit.report)
    assert np.ptp(fit.motion.root_positions[:30], axis=0).max() < 1e-6


def test_what_is_not_used_is_told(markers: Markers):
    more = np.concatenate((markers.positions, markers.positions[:, :1]), axis=1)
    fit = fit_body(Markers((*markers.names, "Tail"), more, markers.fps))
    assert any("not used" in line and "Tail" in line for line in fit.report)


def test_left_and_right_under_each_other_s_labels_are_doubted(markers: Markers):
    sides = {"L": "R", "R": "L"}
    swapped = Markers([sides.get(name[0], name[0]) + name[1:] for name in markers.names], markers.positions, FPS)
    assert any("left and right?" in line for line in fit_body(swapped).report)


def test_joints_are_no_more_restless_than_their_markers(fit: Fit, markers: Markers):
    for label, joint in (("LANK", "LeftFoot"), ("RKNE", "RightLeg"), ("LWRA", "LeftHand")):
        there = np.diff(markers.positions[:, markers.index(label)], 2, axis=0)
        here = np.diff(fit.motion.positions[:, fit.motion.skeleton.index(joint)], 2, axis=0)
        assert np.linalg.norm(here, axis=1).mean() < 1.05 * np.linalg.norm(there, axis=1).mean()


def test_half_the_frames_give_the_same_motion(truth: Motion):
    many = marked(dancing(SECONDS, 120.0))
    few = Markers(many.names, many.positions[::4], 30.0)
    difference = fit_body(many).motion.positions[::4] - fit_body(few).motion.positions
    assert np.abs(difference).max() < 0.005


def test_who_turns_and_moves_the_markers_turns_and_moves_the_body(fit: Fit, markers: Markers):
    turn, shift = rot.yaw(1.1), np.array([3.0, -2.0, 0.1])
    moved = fit_body(Markers(markers.names, rot.rotate(turn, markers.positions) + shift, markers.fps)).motion
    assert np.abs(moved.positions - (rot.rotate(turn, fit.motion.positions) + shift)).max() < 1e-3


def test_mirrored_markers_give_the_mirrored_body(fit: Fit, markers: Markers):
    sides = {"L": "R", "R": "L"}
    names = [sides.get(name[0], name[0]) + name[1:] for name in markers.names]
    mirrored = fit_body(Markers(names, markers.positions * [-1, 1, 1], markers.fps)).motion
    names = [n.replace("Left", "#").replace("Right", "Left").replace("#", "Right") for n in mirrored.skeleton.names]
    order = [mirrored.skeleton.index(name) for name in names]
    assert np.abs(mirrored.positions[:, order] * [-1, 1, 1] - fit.motion.positions).max() < 1e-6


def test_the_same_markers_give_the_same_bytes(fit: Fit, markers: Markers):
    again = fit_body(markers).motion
    assert again.rotations.tobytes() == fit.motion.rotations.tobytes()


@pytest.mark.parametrize("size", [0.6, 1.15])
def test_children_and_giants_are_fitted_as_well(size: float):
    truth = dancing(1.0, skeleton=person(size))
    fit = fit_body(marked(truth, 0.001, size=size))
    assert max(limb_errors(fit.motion, truth).values()) < 0.012


def test_joint_centres_as_markers_are_met(truth: Motion):
    sided = ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle", "Toe")
    joints = ["Hips", "Neck", "Head", *(side + name for side in ("Left", "Right") for name in sided)]
    seen = Markers(joints, truth.positions[:, [truth.skeleton.index(name) for name in joints]], truth.fps)
    fit = fit_body(seen)
    assert max(limb_errors(fit.motion, truth).values()) < 0.003
    assert fit.residual_mm < 1.0


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_few_frames_are_enough(markers: Markers, frames: int):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert fit_body(markers[:frames]).residual_mm < 3.0


def test_most_markers_missing_at_random_is_borne(markers: Markers, truth: Motion):
    positions = markers.positions.copy()
    positions[np.random.default_rng(0).random(positions.shape[:2]) < 0.5] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fit = fit_body(Markers(markers.names, positions, markers.fps))
    assert max(limb_errors(fit.motion, truth).values()) < 0.04


@pytest.mark.parametrize(
    ("scale", "message"),
    [(1000.0, "unit"), (10.0, "m tall"), (0.0, "m tall"), (1e200, "unit")],
)
def test_a_size_that_no_human_has_is_refused(markers: Markers, scale: float, message: str):
    with pytest.raises(BodyError, match=message):
        fit_body(Markers(markers.names, markers.positions * scale, markers.fps))


def test_markers_that_are_on_no_body_are_refused(markers: Markers):
    noise = np.random.default_rng(0).normal(scale=0.3, size=markers.positions.shape)
    with pytest.raises(BodyError, match=r"no body has its markers so: .* mm off"):
        fit_body(Markers(markers.names, noise, markers.fps))


def test_progress_comes_to_an_end(markers: Markers):
    told: list[float] = []
    fit_body(markers[:20], progress=told.append)
    assert told[-1] == 1.0


def test_a_real_ballet_is_met(data: Path):
    from onbeat.formats.trc.read import read_trc

    fit = fit_body(read_trc(data / "c3d" / "MOTEK__ballet_reduced.trc"))
    assert fit.residual_mm < 5.0
    assert len(fit.sites) == 41
    up = rot.rotate(fit.motion.world_rotations[:, fit.motion.skeleton.index("Chest")], np.array([0, 0, 1.0]))
    assert up[:, 2].min() > np.cos(np.radians(25))  # she keeps her back upright throughout


def test_a_real_optitrack_clip_is_met(data: Path):
    from onbeat.formats.c3d.read import read_c3d

    fit = fit_body(read_c3d(data / "c3d" / "others__mocap36.c3d"))
    assert fit.residual_mm < 8.0
    assert len(fit.sites) == 36
