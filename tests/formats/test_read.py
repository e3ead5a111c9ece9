import warnings

import numpy as np
import pytest

from onbeat.errors import BodyError, FormatError
from onbeat.formats import motion_files, read_file, read_markers, read_motion, write_markers, write_motion
from onbeat.formats.notes import noted
from onbeat.formats.read import FitWarning
from onbeat.motion import Body, Markers, Motion
from onbeat.motion.joint_markers import joint_markers
from persons import person, swinging


def strange(frames: int = 5) -> Motion:
    """A body two of whose joints have names that say nothing."""
    body = swinging(person(), frames)
    names = [name.replace("LeftHip", "Ast 1").replace("LeftKnee", "Ast 2") for name in body.skeleton.names]
    return body.replace(skeleton=body.skeleton.replace(names=names))


def test_a_roles_file_beside_the_file_or_in_its_folder_is_used(tmp_path):
    write_motion(strange(), tmp_path / "a.bvh")
    (tmp_path / "roles.toml").write_text('[joints]\nleft_hip = "Ast 1"\nleft_knee = "Ast 2"\n')
    assert dict(read_motion(tmp_path / "a.bvh").skeleton.roles) == {"left_hip": "Ast 1", "left_knee": "Ast 2"}
    (tmp_path / "a.roles.toml").write_text('[joints]\nleft_hip = "Ast 2"\n')
    assert dict(read_motion(tmp_path / "a.bvh").skeleton.roles) == {"left_hip": "Ast 2"}
    (tmp_path / "a.roles.toml").write_text('[joints]\nleft_hip = "Ast 9"\n')
    with pytest.raises(FormatError, match=r"a\.roles\.toml.*'Ast 9'"):
        read_motion(tmp_path / "a.bvh")


def test_a_folders_roles_are_not_forced_on_other_bodies(tmp_path):
    (tmp_path / "roles.toml").write_text('[joints]\nleft_hip = "Ast 1"\n')
    write_motion(swinging(person(), 3), tmp_path / "other.bvh")
    with noted() as notes:
        assert not read_motion(tmp_path / "other.bvh").skeleton.roles
    assert ("roles", "not those of roles.toml", "it is of another body: there is no 'Ast 1'") in notes


def test_markers_are_read_as_markers_and_as_a_body(tmp_path):
    motion = swinging(person(), 20, 30, angle=0.3)
    write_motion(motion, tmp_path / "a.c3d")
    assert isinstance(read_file(tmp_path / "a.c3d"), Markers)
    assert "LeftWrist" in read_markers(tmp_path / "a.c3d").names
    with noted() as notes, warnings.catch_warnings():
        warnings.simplefilter("error")  # nothing was guessed that one has to know
        body = read_motion(tmp_path / "a.c3d")
    assert any(note.about == "body" for note in notes)
    ours, theirs = Body.of(body.skeleton), Body.of(motion.skeleton)
    for role in ("left_wrist", "right_ankle", "left_knee"):
        off = np.linalg.norm(body.positions[:, ours[role]] - motion.positions[:, theirs[role]], axis=-1)
        assert off.max() < 0.02


def test_gaps_that_were_filled_are_told_without_being_asked(tmp_path):
    markers = joint_markers(swinging(person(), 60, 30, angle=0.3))
    seen = np.array(markers.positions)
    seen[20:40, markers.index("LeftWrist")] = np.nan
    write_markers(Markers(markers.names, seen, 30), tmp_path / "a.trc")
    with pytest.warns(FitWarning, match=r"a\.trc: a body was fitted"):
        read_motion(tmp_path / "a.trc")


def test_labels_can_be_told_by_a_roles_file(tmp_path):
    markers = joint_markers(swinging(person(), 20, 30, angle=0.3))
    names = [name.replace("LeftWrist", "M 17") for name in markers.names if name != "LeftWrist_end"]
    kept = [n for n, name in enumerate(markers.names) if name != "LeftWrist_end"]
    write_markers(Markers(names, markers.positions[:, kept], 30), tmp_path / "a.c3d")
    with pytest.raises(BodyError, match=r"a\.c3d: .*left_wrist"):
        read_motion(tmp_path / "a.c3d")
    (tmp_path / "roles.toml").write_text('[markers]\nleft_wrist = "M 17"\n')
    body = read_motion(tmp_path / "a.c3d")
    wrist = body.positions[:, Body.of(body.skeleton)["left_wrist"]]
    assert np.linalg.norm(wrist - markers.positions[:, markers.index("LeftWrist")], axis=-1).max() < 0.02


def test_a_bodys_motion_is_no_markers_and_markers_go_into_no_body(tmp_path):
    motion = swinging(person(), 3)
    write_motion(motion, tmp_path / "a.npz")
    with pytest.raises(FormatError, match="holds a body's motion, no markers"):
        read_markers(tmp_path / "a.npz")
    with pytest.raises(FormatError, match=r"cannot write markers to .*a\.bvh"):
        write_markers(joint_markers(motion), tmp_path / "a.bvh")


def test_other_files_of_a_folder_are_passed_over(tmp_path):
    np.savez(tmp_path / "other.npz", weights=np.zeros(3))
    (tmp_path / "prices.csv").write_text("a,b\n1,2\n")
    (tmp_path / "model.pkl").write_bytes(b"cos\nsystem\n(S'true'\ntR.")
    write_motion(swinging(person(), 3), tmp_path / "dance.npz")
    assert [path.name for path in motion_files(tmp_path)] == ["dance.npz"]


def test_rates_that_cannot_be_are_refused(tmp_path):
    write_motion(swinging(person(), 3), tmp_path / "a.npz")
    for fps in (0.0, -1.0, float("nan"), 1e9):
        with pytest.raises(FormatError, match="give a rate"):
            read_motion(tmp_path / "a.npz", fps)
