from __future__ import annotations

import pytest

from onbeat.capture.labels import NEEDED, check_enough, find_sites, plain_labels
from onbeat.capture.marker_sets import SETS
from onbeat.capture.sites import SITES
from onbeat.errors import BodyError


def test_every_site_of_every_set_exists():
    for name, table in SETS.items():
        for site in table:
            sides = [site.replace("*", side) for side in ("left_", "right_")] if "*" in site else [site]
            assert set(sides) <= set(SITES), f"{name}: {site}"


def test_every_needed_place_exists():
    places = {f"{side}_{place}" for side in ("left", "right") for words in NEEDED.values() for place in words.split()}
    assert places <= set(SITES)


@pytest.mark.parametrize(
    ("label", "site"),
    [
        ("LFWT", "left_asis"),
        ("RASI", "right_asis"),
        ("Anna:LKNE", "left_knee_lateral"),
        ("R.Knee.Medial", "right_knee_medial"),
        ("V.Sacral", "sacrum"),
        ("IJ", "clavicle"),
        ("WaistLFront", "left_asis"),
        ("BackRight", "right_scapula"),
        ("LUArmHigh", "left_upper_arm"),
        ("ARIEL", "head_top"),
        ("LSHN", "left_shin"),
        ("RMT5", "right_mt5"),
    ],
)
def test_the_usual_labels_are_known(label: str, site: str):
    assert find_sites([label]) == {site: (label,)}


def test_joints_are_told_from_markers_of_the_same_name():
    joints = ["Hips", *(side + n for side in ("Left", "Right") for n in ("Hip", "Knee", "Ankle", "Elbow", "Wrist"))]
    assert "left_knee" in find_sites(joints)
    markers = ["R.ASIS", "L.ASIS", "V.Sacral", "R.Knee", "L.Knee", "R.Ankle", "L.Ankle", "R.Elbow", "L.Elbow"]
    assert "left_knee_lateral" in find_sites(markers)


def test_an_arm_beside_a_shoulder_is_the_upper_arm_s_joint():
    arm = ["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]
    found = find_sites(["Hips", *arm, "LeftUpLeg", "LeftLeg", "LeftFoot"])
    assert (found["left_shoulder"], found["left_elbow"], found["left_wrist"]) == (
        ("LeftArm",),
        ("LeftForeArm",),
        ("LeftHand",),
    )


def test_a_subject_s_name_in_front_is_not_read():
    labels = [f"Skeleton_{name}" for name in ("Hip1", "Hip2", "LShin1", "RShin1")]
    assert plain_labels(labels) == ["hip1", "hip2", "lshin1", "rshin1"]


def test_what_the_user_says_comes_first():
    found = find_sites(["LKNE", "LWRA", "LWRB", "odd"], {"left_wrist": ["LWRA", "LWRB"], "left_knee": ["odd"]})
    assert found["left_wrist"] == ("LWRA", "LWRB")
    assert found["left_knee"] == ("odd",)
    assert "left_wrist_thumb" not in found
    assert found["left_knee_lateral"] == ("LKNE",)


@pytest.mark.parametrize(
    ("sites", "message"),
    [
        ({"nose": ["LKNE"]}, "no place on the body is called 'nose'"),
        ({"left_knee": ["XX"]}, "markers XX for left_knee are not there"),
        ({"left_knee": []}, "for left_knee"),
    ],
)
def test_what_the_user_says_must_exist(sites: dict[str, list[str]], message: str):
    with pytest.raises(BodyError, match=message):
        find_sites(["LKNE"], sites)


def test_too_little_is_refused_with_what_is_found_needed_and_there():
    with pytest.raises(BodyError) as caught:
        check_enough({"left_asis": ("LASI",)}, ["LASI", "Tail"], "clip", unseen=["LSHO"])
    message = str(caught.value)
    for part in ("clip", "left_shoulder", "right_ankle", "three of the pelvis", "Tail", "never seen are LSHO"):
        assert part in message
