"""Roles files: read, refused, found beside a motion, and written for a skeleton."""

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat.errors import FormatError
from onbeat.motion import Body, Skeleton
from onbeat.motion.role_file import Roles, read_roles, role_template, roles_beside
from onbeat.motion.roles import find_roles
from persons import person


def written(tmp_path, text):
    path = tmp_path / "dance.roles.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_joints_and_markers_are_read(tmp_path):
    text = '[joints]  # mine\nleft_wrist = "Hand.L"\n[markers]\nleft_wrist = ["LWRA", "LWRB"]\nhead = "TOP"\n'
    path = written(tmp_path, "\ufeff" + text.replace("\n", "\r\n"))
    roles = read_roles(path)
    assert roles.joints == {"left_wrist": "Hand.L"}
    assert roles.markers == {"left_wrist": ("LWRA", "LWRB"), "head": ("TOP",)}
    assert roles.source == str(path)
    assert read_roles(written(tmp_path, "")) == Roles(source=str(path))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[joints]\nleft_rist = "A"', r"joints\.left_rist: no such role; is left_wrist .*meant\?"),
        ('[joints]\nxyz = "A"', r"joints\.xyz: no such role; there are hips, spine"),
        ('[joint]\nhead = "A"', r"no table \[joint\] is known; is joints meant\?"),
        ("[joints]\nhead = 3", r"joints\.head: the name of a joint in quotes is expected, 3 found"),
        ('[joints]\nhead = ""', r"joints\.head: the name of a joint in quotes is expected, '' found"),
        ("joints = 1", r"joints: a table \[joints\] is expected, 1 found"),
        ("[markers]\nhead = []", r"markers\.head: a label or a list of labels in quotes is expected, \[\] found"),
        ("[markers]\nhead = [1]", r"markers\.head: a label or a list"),
        ("[markers]\nhead = 1", r"markers\.head: a label or a list of labels in quotes is expected, 1 found"),
        ("[joints]\nleft wrist = 3", r"is no TOML: .*line 2"),
        ('[joints]\nhead = "A"\nhead = "B"', r"is no TOML"),
        (b"\xff\xfe\x00", r"is not UTF-8"),
        ("a = " + "[" * 100000, r"is no TOML"),
        ("[joints]\nhead = " + "9" * 10000, r"is no TOML|in quotes is expected"),
        ("#" * 300000, r"300000 bytes are too many"),
    ],
)
def test_what_is_wrong_is_said_with_file_and_key(tmp_path, text, message):
    with pytest.raises(FormatError, match=message) as caught:
        read_roles(written(tmp_path, text))
    assert "dance.roles.toml" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 1000


def test_files_that_are_not_there_or_are_folders_are_refused(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(FormatError, match="cannot read"):
            read_roles(path)


@given(st.binary(max_size=200) | st.text(max_size=200).map(str.encode))
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("any") / "roles.toml"
    path.write_bytes(content)
    with contextlib.suppress(FormatError):
        assert isinstance(read_roles(path), Roles)


def test_the_file_beside_a_motion_is_its_own_or_its_folders(tmp_path):
    motion = tmp_path / "dance.take1.bvh"
    assert roles_beside(motion) is None
    (tmp_path / "roles.toml").write_text("")
    assert roles_beside(motion) == tmp_path / "roles.toml"
    (tmp_path / "dance.take1.roles.toml").write_text("")
    assert roles_beside(str(motion)) == tmp_path / "dance.take1.roles.toml"
    assert roles_beside(tmp_path / "other.bvh") == tmp_path / "roles.toml"


def test_a_file_tells_a_skeleton(tmp_path):
    roles = read_roles(written(tmp_path, '[joints]\nhead = "Head_end"\n'))
    told = Body.of(roles.told(person()))
    assert told.skeleton.names[told["head"]] == "Head_end"
    assert Roles().told(told.skeleton) is told.skeleton
    wrong = read_roles(written(tmp_path, '[joints]\nhead = "Haed"\n'))
    with pytest.raises(FormatError, match=r"dance\.roles\.toml: head is to be 'Haed'.*'Head'"):
        wrong.told(person())


def test_the_template_read_again_tells_the_same_roles(tmp_path):
    skeleton = person()
    text = role_template(skeleton)
    roles = read_roles(written(tmp_path, text))
    assert roles.joints == {role: skeleton.names[joint] for role, joint in find_roles(skeleton).joints.items()}
    assert next(line for line in text.splitlines() if "LeftKnee" in line) == '#       "LeftKnee"'


def test_the_template_marks_what_is_missing_and_what_is_guessed(tmp_path):
    body = person()
    strange = body.replace(
        names=[name.replace("LeftWrist", "LeftWrst").replace("LeftElbow", "Q") for name in body.names]
    )
    text = role_template(Skeleton(strange.names, body.parents, body.offsets * 0))
    assert '# left_wrist = ""  # needed; perhaps "LeftWrst"' in text
    assert "left_wrist" not in read_roles(written(tmp_path, text)).joints
    nameless = body.replace(names=[f"j{n}" for n in range(len(body))])
    assert '\nhips = "j0"  # a guess\n' in role_template(nameless)


@given(st.lists(st.text(min_size=1), min_size=1, max_size=6, unique=True))
def test_the_template_holds_any_names(tmp_path_factory, names):
    skeleton = Skeleton(names, range(-1, len(names) - 1), [[0, 0, 0.1]] * len(names), roles={"head": names[-1]})
    path = tmp_path_factory.mktemp("any") / "roles.toml"
    path.write_bytes(role_template(skeleton).encode())
    assert read_roles(path).joints["head"] == names[-1]
