"""Robot CSV: 36 columns a line, read by place or by name, refused by line and column."""

import time
import warnings

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.conventions import Convention
from onbeat.formats.notes import noted
from onbeat.formats.rates import RateWarning
from onbeat.formats.robot_csv import is_robot_csv, read_robot_csv, write_robot_csv
from onbeat.motion import rotations as rot
from onbeat.motion.unitree_g1 import G1, G1_23, g1_angles

ROOT = ("x", "y", "z", "qx", "qy", "qz", "qw")
TURN = [0.36, 0.48, 0.0, 0.8]
FRAMES = np.column_stack(
    (np.tile([1.5, -2.0, 0.75, *TURN], (3, 1)), np.arange(3)[:, None] * 0.1 + np.linspace(-0.05, 0.05, 29))
).round(4)


def lines(table=FRAMES) -> list[str]:
    return [",".join(f"{value:.6f}" for value in row) for row in table]


def put(folder, text: str | bytes):
    path = folder / "dance.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def read(folder, text: str | bytes, **kwargs):
    return read_robot_csv(put(folder, text), **{"fps": 50.0, **kwargs})


def test_columns_are_the_root_its_quaternion_with_w_last_and_the_joints(tmp_path):
    motion = read(tmp_path, "\n".join(lines()) + "\n")
    assert motion.root_positions[2].tolist() == [1.5, -2.0, 0.75]
    assert motion.rotations[2, 0].tolist() == [0.8, 0.36, 0.48, 0.0]
    assert g1_angles(motion, "") == pytest.approx(FRAMES[:, 7:], abs=1e-12)
    assert (motion.name, motion.fps, len(motion)) == ("dance", 50, 3)


def test_thirty_frames_a_second_are_assumed_with_a_warning(tmp_path):
    path = put(tmp_path, "\n".join(lines()))
    with pytest.warns(RateWarning, match="30 frames a second are assumed"):
        assert read_robot_csv(path).fps == 30
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_robot_csv(path, 60).fps == 60


@pytest.mark.parametrize(
    "text",
    [
        "\n".join(lines()),
        "\r\n".join(lines()) + "\r\n",
        "\r".join(lines()),
        "\ufeff" + "\n\n".join(lines()) + "\n\n \n",
        "\n \n" + "\n".join(lines()),
        "\n".join(line.replace(",", " , ") for line in lines()),
        "\n".join(",".join(f"{v:.18e}" for v in row) for row in FRAMES),
    ],
)
def test_line_ends_blanks_and_digits_may_be_any(tmp_path, text):
    motion = read(tmp_path, text)
    assert len(motion) == 3
    assert g1_angles(motion, "") == pytest.approx(FRAMES[:, 7:], abs=1e-12)


def test_thirty_columns_are_the_robot_with_23_joints(tmp_path):
    with noted() as notes:
        motion = read(tmp_path, "\n".join(lines(FRAMES[:, :30])))
    angles = dict(zip(G1.names, g1_angles(motion, "")[1], strict=True))
    assert [angles[name] for name in G1_23] == pytest.approx(FRAMES[1, 7:30].tolist())
    assert angles["waist_roll_joint"] == 0
    assert [(note.about, note.taken) for note in notes] == [("joints", "23")]


def named(names: list[str], table: np.ndarray) -> str:
    return "\n".join([",".join(names), *lines(table)])


def test_with_a_header_columns_are_taken_by_name_in_any_order(tmp_path):
    names = ["time", *ROOT, *G1.names, "contact"]
    table = np.column_stack((np.arange(3) / 50, FRAMES, np.ones(3)))
    order = np.random.default_rng(1).permutation(len(names))
    with noted() as notes:
        motion = read(tmp_path, named([names[k] for k in order], table[:, order]))
    assert g1_angles(motion, "") == pytest.approx(FRAMES[:, 7:], abs=1e-12)
    assert motion.rotations[1, 0].tolist() == [0.8, 0.36, 0.48, 0.0]
    assert sorted(notes[0].why.split(", ")) == ["contact", "time"]


@pytest.mark.parametrize(
    "root",
    [
        ["root_pos_x", "root_pos_y", "root_pos_z", "root_quat_x", "root_quat_y", "root_quat_z", "root_quat_w"],
        ["base_x", "base_y", "base_z", "base_qx", "base_qy", "base_qz", "base_qw"],
        ['"X"', '"Y"', '"Z"', '"QX"', '"QY"', '"QZ"', '"QW"'],
        ["root_x", "root_y", "root_z", "root_rot_x", "root_rot_y", "root_rot_z", "root_rot_w"],
    ],
)
def test_names_of_the_root_and_joints_may_vary(tmp_path, root):
    joints = [name.removesuffix("_joint") + "_dof" for name in G1_23]
    motion = read(tmp_path, named([*root, *joints], FRAMES[:, :30]))
    assert motion.rotations[0, 0].tolist() == [0.8, 0.36, 0.48, 0.0]
    assert g1_angles(motion, "")[0, 0] == pytest.approx(-0.05)


def damaged(row: int, column: int, word: str) -> str:
    words = [line.split(",") for line in lines()]
    words[row][column] = word
    return "\n".join(",".join(line) for line in words)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "an empty file found; lines of 36 numbers"),
        (" \n\n\t", "white space found; lines of 36 numbers"),
        (" " * 50000, "white space found; lines of 36 numbers"),
        ("1," * 20000, "without an end of line found"),
        ("\n".join(lines(FRAMES[:, :20])), "20 columns found; a robot's motion has x y z qx qy qz qw and the angles"),
        ("\n".join(lines()).replace(",", ";"), "the columns are separated by semicolons; numbers with commas"),
        ("\n".join(lines()).replace(",", "\t"), "the columns are separated by tabs; numbers with commas"),
        ("time,beat\n0,1\n", "'time,beat' found; numbers with commas are expected, or a header that names x, y, z and"),
        (named([*ROOT[:6], "w", *G1.names], FRAMES), "or a header that names qw"),
        (named([*ROOT, *G1.names[:-1], "x"], FRAMES), "more than one column is named x"),
        (named([*ROOT, *G1.names], FRAMES[:0]), "no frame found"),
        (damaged(1, 9, "abc"), "dance.csv:2: column 10 holds 'abc'; a number of metres or radians"),
        (damaged(0, 9, "abc"), "dance.csv:1: column 10 holds 'abc'"),
        (damaged(2, 0, "nan"), "dance.csv:3: column 1 holds 'nan'"),
        (damaged(2, 35, "1e300"), "dance.csv:3: column 36 holds '1e300'"),
        (damaged(1, 7, ""), "dance.csv:2: column 8 holds ''"),
        (damaged(1, 7, "1_0"), "dance.csv:2: column 8 holds '1_0'"),
        (damaged(1, 7, "0.1,0.2"), "dance.csv:2: 37 columns found, 36 are expected"),
        ("\n".join([*lines(), "1,2,3"]), "dance.csv:4: 3 columns found, 36 are expected"),
        ("\n\n" + damaged(1, 6, "9"), "dance.csv:4: frame 0 has a root quaternion of length 9"),
        ("\n".join(lines()).encode("utf-16"), "found; numbers with commas are expected"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(tmp_path, text, message):
    with pytest.raises(FormatError) as refused:
        read(tmp_path, text)
    assert message in str(refused.value)
    assert "dance.csv" in str(refused.value)


def test_a_missing_file_or_a_folder_is_refused(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(FormatError, match="cannot read"):
            read_robot_csv(path, 30)
        assert not is_robot_csv(path)


@pytest.mark.parametrize("ending", [b"\n" * 9_000_000, b" " * 9_000_000])
def test_white_space_without_end_is_not_read_to_its_end(tmp_path, ending):
    started = time.process_time()
    with pytest.raises(FormatError, match=r"white space found|a line of over"):
        read(tmp_path, "\n".join(lines()).encode() + b"\n" + ending)
    assert time.process_time() - started < 2


def test_a_file_larger_than_one_block_is_read_whole(tmp_path):
    table = np.tile(FRAMES, (6000, 1))
    table[:, 0] = np.arange(len(table))
    text = "\n".join(lines(table)) + "\n"
    assert len(text) > 1 << 22
    motion = read(tmp_path, text)
    assert motion.root_positions[:, 0].tolist() == table[:, 0].tolist()
    with pytest.raises(FormatError, match=r"dance\.csv:18001: 2 columns"):
        read(tmp_path, text + "1,2\n")


def test_up_and_unit_turn_the_world_and_not_the_robot(tmp_path):
    plain = read(tmp_path, "\n".join(lines()))
    turned = np.array(FRAMES)
    to_y = rot.about(np.array([1.0, 0, 0]), -np.pi / 2)
    turned[:, :3] = rot.rotate(to_y, FRAMES[:, :3]) * 100
    turned[:, 3:7] = np.roll(rot.multiply(to_y, np.roll(FRAMES[:, 3:7], 1, axis=1)), -1, axis=1)
    motion = read(tmp_path, "\n".join(",".join(f"{v:.9f}" for v in row) for row in turned), up="y", unit="cm")
    np.testing.assert_allclose(motion.positions, plain.positions, atol=1e-6)


@pytest.mark.parametrize(
    ("text", "is_one"),
    [
        ("\n".join(lines()), True),
        ("\n".join(lines(FRAMES[:, :30])), True),
        (named([*ROOT, *G1.names], FRAMES), True),
        ("beat,time\n1,0.5\n", False),
        ("1,2,3\n", False),
        (",".join("0" * 36), False),
        ("\n".join(lines()).replace(",", ";"), False),
        (damaged(0, 3, "x"), False),
        ("", False),
        (b"\x00\xff\xfe" * 300, False),
    ],
)
def test_motion_is_told_from_other_tables(tmp_path, text, is_one):
    assert is_robot_csv(put(tmp_path, text)) is is_one


def test_six_digits_are_written_as_they_were_read(tmp_path):
    text = "\n".join(lines()) + "\n"
    write_robot_csv(read(tmp_path, text), tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_text() == text
    assert "-0.000000" not in text


def test_other_motion_is_written_with_nine_digits(tmp_path):
    motion = read(tmp_path, "\n".join(lines()))
    write_robot_csv(motion.resampled(77), tmp_path / "again.csv")
    words = (tmp_path / "again.csv").read_text().split("\n")[1].split(",")
    assert len(words) == 36
    assert {len(word.partition(".")[2]) for word in words} == {9}


def test_a_human_motion_is_not_written(tmp_path, swinger):
    with pytest.raises(FormatError, match="Retarget it to that robot"):
        write_robot_csv(swinger, tmp_path / "a.csv")
    assert not (tmp_path / "a.csv").exists()


def test_it_is_always_in_metres_with_z_up(tmp_path):
    motion = read(tmp_path, "\n".join(lines()))
    write_robot_csv(motion, tmp_path / "a.csv", Convention("z", "m"))
    with pytest.raises(FormatError, match="metres with Z up"):
        write_robot_csv(motion, tmp_path / "a.csv", Convention("y", "m"))


def test_real_dances_come_back_to_the_last_digit_and_stand_on_the_floor(data, tmp_path):
    files = sorted((data / "g1_moves").glob("*.csv"))
    assert files
    for path in files:
        assert is_robot_csv(path)
        motion = read_robot_csv(path, 60)
        write_robot_csv(motion, tmp_path / "a.csv")
        assert (tmp_path / "a.csv").read_bytes() == path.read_bytes().replace(b"-0.000000", b"0.000000")
        soles = [k for k, name in enumerate(motion.skeleton.names) if name.endswith(("_toe", "_heel"))]
        lowest = motion.positions[:, soles, 2].min(axis=1)
        assert lowest.min() > -0.01
        assert abs(np.median(lowest)) < 0.01
