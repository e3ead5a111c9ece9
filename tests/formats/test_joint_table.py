from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.angles_csv import write_angles_csv
from onbeat.formats.joint_table import AngleWarning, is_joint_table, read_joint_table, write_joint_table
from onbeat.formats.robot_csv import write_robot_csv
from onbeat.motion import rotations as rot
from onbeat.motion.joint_angles import JointAngles
from onbeat.motion.unitree_g1 import G1, g1_motion
from persons import person, swinging

PLAIN = "time,knee,hip\n0,0.1,-0.2\n0.02,0.11,-0.21\n0.04,0.12,-0.22\n"


@pytest.fixture
def write(tmp_path: Path):
    def written(text: str, name: str = "a.csv") -> Path:
        path = tmp_path / name
        path.write_bytes(text.encode())
        return path

    return written


def test_names_angles_and_rate(write):
    table = read_joint_table(write(PLAIN))
    assert table.names == ("knee", "hip")
    assert table.fps == 50
    assert table.name == "a"
    np.testing.assert_array_equal(table.angles, [[0.1, -0.2], [0.11, -0.21], [0.12, -0.22]])


def test_without_times_the_rate_is_asked_for(write):
    path = write("knee,hip\n0.1,0.2\n0.1,0.2\n")
    assert read_joint_table(path, fps=25).fps == 25
    with pytest.raises(
        FormatError, match="no column 'time' found, so the rate of its frames is not known; say it with"
    ):
        read_joint_table(path)


def test_a_rate_that_is_given_counts_more(write):
    assert read_joint_table(write(PLAIN), fps=10).fps == 10


def test_degrees(write):
    path = write("time,knee\n0,90\n0.1,180\n")
    np.testing.assert_allclose(read_joint_table(path, degrees=True).angles, [[np.pi / 2], [np.pi]])
    with pytest.warns(AngleWarning, match="angles up to 180 rad; are they degrees"):
        read_joint_table(path)


@pytest.mark.parametrize("text", [PLAIN.replace("\n", "\r\n"), PLAIN.replace("\n", "\r"), f"\n \n{PLAIN}\n\n"])
def test_line_ends_and_blank_lines(write, text: str):
    assert len(read_joint_table(write(text))) == 3


def test_names_in_quotes_and_with_blanks(write):
    table = read_joint_table(write('"Time", "left, knee" ,hip\n0,"1.5", 2\n0.5,1,2'))
    assert table.names == ("left, knee", "hip")
    assert table.angles[0].tolist() == [1.5, 2]


@pytest.mark.parametrize("fps", [24, 29.97002997002997, 30, 59.94005994005994, 60, 100, 240, 1000, 12.5, 0.5])
@pytest.mark.parametrize("frames", [2, 3, 90, 2000])
def test_what_is_written_is_read_again(tmp_path: Path, fps: float, frames: int):
    rng = np.random.default_rng(int(frames))
    wave = JointAngles(("knee", "a,b", 'the "hip"'), rng.uniform(-4, 4, (frames, 3)), fps)
    for degrees in (False, True):
        write_joint_table(wave, tmp_path / "a.csv", degrees)
        again = read_joint_table(tmp_path / "a.csv", degrees=degrees)
        assert again.names == wave.names
        assert again.fps == pytest.approx(fps, rel=1e-7)
        np.testing.assert_allclose(again.angles, wave.angles, atol=1e-9)


@pytest.mark.parametrize(("fps", "places"), [(60, 3), (30, 2), (120, 4), (29.97002997, 3), (90, 6)])
def test_rates_of_times_that_were_rounded(write, fps: float, places: int):
    lines = [f"{n / fps:.{places}f},0.5" for n in range(300)]
    assert read_joint_table(write("time,knee\n" + "\n".join(lines))).fps == pytest.approx(fps, rel=1e-8)


def test_times_may_begin_anywhere(write):
    assert read_joint_table(write("t,knee\n12.5,0\n12.6,1\n12.7,2")).fps == pytest.approx(10)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "is empty; a line with the names of joints"),
        ("  \n\n", "is empty"),
        ("time,knee\n", "has names of joints and no frame; lines of 2 numbers are expected"),
        ("0,0.1\n0.1,0.2\n", "a.csv:1: numbers found; the first line has to name the joints"),
        ("time\n0\n", "a.csv:1: no column but 'time' found"),
        ("time,knee,\n0,1,2\n", "a.csv:1: column 3 has no name"),
        ("time,knee,knee\n0,1,2\n", "a.csv:1: more than one column is named knee"),
        ("time;knee;hip\n0;1;2\n", "a.csv:1: columns with semicolons or tabs found; commas are expected"),
        ("time,x,y,z,knee\n0,1,2,3,4\n", "a.csv:1: columns x, y and z found: a motion with a root"),
        ("time,knee\n0,1\n0.1\n0.2,3\n", "a.csv:3: 1 columns found, 2 are expected"),
        ("time,knee\n0,1\n0.1,2,3\n", "a.csv:3: 3 columns found, 2 are expected"),
        ("time,knee\n0,1\n\n0.1,nan\n", "a.csv:4: knee: a number is expected, 'nan' found"),
        ("time,knee\n0,1\n0.1,\n", "a.csv:3: knee: a number is expected, nothing found"),
        ("time,knee\n0,1\n0.1,bent\n", "a.csv:3: knee: a number is expected, 'bent' found"),
        ("time,knee\n0,1\n0.1,inf\n", "a.csv:3: knee: a number is expected, 'inf' found"),
        ("time,knee\n0,1\n0.1,1e300\n", "a.csv:3: knee: a number is expected"),
        ("time,knee\n0,1\n0.1,1\n\n0.1,1\n", "a.csv:5: the time 0.1 s is not after 0.1 s; times have to increase"),
        (
            "time,knee\n0,1\n0.1,1\n0.2,1\n0.4,1\n0.5,1\n",
            "a.csv:5: a step of 0.2 s found where .* even steps are expected",
        ),
        ("time,knee\n0,1\n", "a single frame found, so the rate of its frames is not known"),
    ],
)
def test_what_is_wrong_is_told(write, text: str, told: str):
    with pytest.raises(FormatError, match=told):
        read_joint_table(write(text))


def test_files_that_cannot_be_read(tmp_path: Path):
    with pytest.raises(FormatError, match=r"cannot read .*No such file"):
        read_joint_table(tmp_path / "none.csv")
    assert not is_joint_table(tmp_path / "none.csv")


@pytest.mark.parametrize("name", ["time", "x"])
def test_names_that_cannot_be_columns_are_not_written(tmp_path: Path, name: str):
    names = ("x", "y", "z") if name == "x" else ("time",)
    wave = JointAngles(names, np.zeros((3, len(names))), 30)
    with pytest.raises(FormatError, match="a joint table: "):
        write_joint_table(wave, tmp_path / "a.csv")
    assert not list(tmp_path.iterdir())


def test_tables_are_told_from_other_files(write, tmp_path: Path):
    assert is_joint_table(write(PLAIN))
    assert is_joint_table(write("knee\n0.5"))
    g1 = g1_motion(np.zeros((3, 3)), np.tile(rot.IDENTITY, (3, 1)), np.zeros((3, len(G1.names))), 30)
    write_robot_csv(g1, tmp_path / "g1.csv")
    assert not is_joint_table(tmp_path / "g1.csv")
    header = ",".join(["x", "y", "z", "qx", "qy", "qz", "qw", *G1.names])
    assert not is_joint_table(write(header + "\n" + (tmp_path / "g1.csv").read_text()))
    write_angles_csv(swinging(person(), frames=3, fps=30, angle=0.2), tmp_path / "p.angles.csv")
    assert not is_joint_table(tmp_path / "p.angles.csv")
    for text in ("", "0,1\n0,1\n", "file,from,to\nb.bvh,0,1\n", "# Nothing\n", "\x00\x01\x02", "knee\n"):
        assert not is_joint_table(write(text)), text
