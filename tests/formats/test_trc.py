import time
import warnings

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.conventions import Convention
from onbeat.formats.lost_frames import LostFramesWarning
from onbeat.formats.notes import noted
from onbeat.formats.rates import RateWarning
from onbeat.formats.trc.read import read_trc
from onbeat.formats.trc.write import trc_text, write_trc
from onbeat.motion import Markers
from onbeat.motion.joint_markers import joint_markers
from persons import person, swinging

TRC = """PathFileType\t4\t(X/Y/Z)\tt.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
100.00\t100.00\t3\t2\tmm\t100.00\t1\t3
Frame#\tTime\tLFHD\t\t\tLTOE\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t1\t1700\t3\t4\t50\t6
2\t0.01\t1.5\t1.7e3\t3\t\t\t
3\t0.02\t2\t1700\t3\t-4\t50\t-6
"""
NAN = np.nan
WANTED = np.array([[[1, -3, 1700], [4, -6, 50]], [[1.5, -3, 1700], [NAN, NAN, NAN]], [[2, -3, 1700], [-4, 6, 50]]])


def read(folder, text: str | bytes, **said) -> Markers:
    path = folder / "t.trc"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_trc(path, **said)


def told(folder, text: str) -> tuple[Markers, dict[str, str]]:
    with noted() as notes:
        found = read(folder, text)
    return found, {note.about: f"{note.taken}: {note.why}" for note in notes}


def same(found: Markers, names=("LFHD", "LTOE"), wanted=WANTED / 1000) -> None:
    assert found.names == names
    np.testing.assert_allclose(found.positions, wanted, atol=1e-12)


def test_a_table_of_tabs_with_empty_cells(tmp_path):
    found = read(tmp_path, TRC)
    same(found)
    assert (found.fps, found.name, found.gaps()) == (100, "t", [("LTOE", 1, 2)])


@pytest.mark.parametrize(
    "text",
    [
        TRC.replace("\n", "\r\n"),
        TRC.replace("Z2\n\n", "Z2\n"),
        TRC.replace("Z2\n\n", "Z2\n\n\n\t\t\n"),
        "\ufeff" + TRC,
        TRC[:-1],
        TRC + "\n\n",
        TRC.replace("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n", ""),
        TRC.replace("1.7e3\t3\t\t\t\n", "1.7e3\t3\n"),
        TRC.replace("1.7e3\t3\t\t\t\n", "1.7e3\t3\t \tNaN\t7\t\t\t\n"),
        TRC.replace("-6\n", "-6\t\n"),
        TRC.replace("LFHD\t\t\tLTOE\t\t", "LFHD\tLTOE"),
    ],
    ids=[
        "CRLF",
        "no empty line",
        "more empty lines",
        "BOM",
        "no final newline",
        "empty lines at the end",
        "no row of axes",
        "cells missing at the end",
        "half a marker",
        "a tab too many",
        "labels side by side",
    ],
)
def test_what_real_tables_look_like(tmp_path, text):
    same(read(tmp_path, text))


def test_a_table_of_spaces(tmp_path):
    rows = TRC.replace("\t\t\t\n", "\t4\t50\t6\n").split("\n")
    text = "\n".join([*rows[:5], *("   ".join(row.split()) for row in rows[5:])])
    wanted = WANTED.copy()
    wanted[1, 1] = [4, -6, 50]
    same(read(tmp_path, text), wanted=wanted / 1000)
    same(read(tmp_path, text.replace("\t", " ")), wanted=wanted / 1000)
    with pytest.raises(FormatError, match=r":7: 7 numbers found, 8 are expected for 2 markers"):
        read(tmp_path, text.replace("1   0.00   1   ", "1   0.00   "))


@pytest.mark.parametrize(("unit", "metres"), [("m", 1.0), ("cm", 0.01), ("Meters", 1.0), ("in", 0.0254)])
def test_units(tmp_path, unit, metres):
    same(read(tmp_path, TRC.replace("\tmm\t", f"\t{unit}\t"), up="y"), wanted=WANTED * metres)


def test_a_unit_that_is_none_is_seen_from_the_body(tmp_path):
    found, notes = told(tmp_path, TRC.replace("\tmm\t", "\t\t"))
    same(found)
    assert notes["unit"] == "mm: the file names no unit, and the head is 1650 over the feet"


def test_what_the_user_says_goes_before_all(tmp_path):
    found = read(tmp_path, TRC, fps=25, up="z", unit="m")
    assert found.fps == 25
    same(found, wanted=WANTED[..., [0, 2, 1]] * [1, 1, -1])


def test_up_is_seen_from_the_body(tmp_path):
    found, notes = told(tmp_path, TRC)
    assert notes["up"] == "y: the head is over the feet along it"
    found, notes = told(tmp_path, TRC.replace("LFHD", "A").replace("LTOE", "B"))
    assert notes["up"] == "y: it is usual; neither the file nor what it shows tells"
    same(found, ("A", "B"))


def test_labels_are_numbered_and_told_apart(tmp_path):
    assert read(tmp_path, TRC.replace("LFHD", "")).names == ("point_1", "LTOE")
    assert read(tmp_path, TRC.replace("LFHD", "LTOE")).names == ("LTOE", "LTOE_2")
    same(read(tmp_path, TRC.replace("LFHD", "Anna:LFHD").replace("LTOE", "Anna:LTOE")))


def test_columns_without_a_label_are_left_out_and_told(tmp_path):
    found, notes = told(tmp_path, TRC.replace("-6\n", "-6\t\t\t\t7\t8\t9\n"))
    same(found)
    assert notes["points"] == "2 markers: in columns without a label up to 1 more were seen"


def test_fewer_frames_than_promised_are_a_warning_and_more_a_note(tmp_path):
    with pytest.warns(LostFramesWarning, match="promises 5 frames and holds 3 whole ones"):
        same(read(tmp_path, TRC.replace("\t3\t2\tmm", "\t5\t2\tmm")))
    found, notes = told(tmp_path, TRC.replace("\t3\t2\tmm", "\t2\t7\tmm"))
    same(found)
    assert notes["frames"] == "3: all that are there; NumFrames says 2"
    assert notes["markers"] == "2: as many as there are labels; NumMarkers says 7"


def test_a_row_that_is_cut_off_is_lost(tmp_path):
    with pytest.warns(LostFramesWarning, match="promises 3 frames and holds 2"):
        same(read(tmp_path, TRC[:-6]), wanted=WANTED[:2] / 1000)


def test_times_are_held_against_the_rate(tmp_path):
    with pytest.warns(RateWarning, match="DataRate says 50 frames a second, the column of times 100; 50 is taken"):
        assert read(tmp_path, TRC.replace("100.00\t100.00\t3", "50.00\t100.00\t3")).fps == 50
    found, notes = told(tmp_path, TRC.replace("100.00\t100.00\t3", "0\t100.00\t3"))
    assert found.fps == 100
    assert notes["fps"] == "100: by the column of times; the file has no DataRate"
    with pytest.raises(FormatError, match=":3: a DataRate in frames a second is expected, 'x' found"):
        read(tmp_path, TRC.replace("100.00\t100.00\t3", "x\t100.00\t3").replace("0.02", "0.00"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read(tmp_path, TRC.replace("100.00\t100.00\t3", "50.00\t100.00\t3"), fps=30).fps == 30


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "t.trc:1: 'PathFileType' is expected at the start of a TRC file, '' found"),
        ("HIERARCHY\n", "'HIERARCHY"),
        (TRC.replace("DataRate", "Rate"), "t.trc:2: 'DataRate', 'Units' and so on are expected"),
        (TRC.replace("Frame#", "Bild"), "t.trc:4: 'Frame#', 'Time' and labels are expected"),
        (TRC.replace("LFHD\t\t\tLTOE", ""), "t.trc:4: no labels found"),
        (TRC.split("\n\n")[0], "t.trc: no frame found after the header of 5 lines"),
        (TRC.replace("1.5", "1,5"), "t.trc:8: '1,5' has a decimal comma"),
        (TRC.replace("100.00", "100,00"), "t.trc:3: '100,00' has a decimal comma"),
        (TRC.replace("-4", "four"), "t.trc:9: a number is expected in column 6, 'four' found"),
        (TRC.replace("\n2\t", "\nend\t"), "t.trc:8: a frame number is expected, 'end' found"),
        (TRC.replace("-4", "inf"), "frame 2 of 'LTOE' is infinite"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_line(tmp_path, text, message):
    with pytest.raises(FormatError, match=message):
        read(tmp_path, text)


@pytest.mark.parametrize("head", ["", TRC, TRC.replace("\t3\t2\tmm", "\t1000000000\t2\tmm")])
@pytest.mark.parametrize("filling", [b" ", b"\n", b" \n"])
def test_megabytes_of_nothing_are_refused_at_once(tmp_path, head, filling):
    path = tmp_path / "t.trc"
    path.write_bytes(head.encode() + filling * (40_000_000 // len(filling)))
    before = time.process_time()
    with pytest.raises(FormatError, match=r"longer than|empty lines found|'PathFileType' is expected"):
        read_trc(path)
    assert time.process_time() - before < 0.5


def test_short_rows_under_many_labels_are_refused_before_they_fill_the_memory(tmp_path):
    text = TRC.split("\n\n")[0].replace("\tX1\tY1\tZ1\tX2\tY2\tZ2", "\tX" * 20000) + "\n" + "1\t0.1\n" * 1000
    with pytest.raises(FormatError, match="rows of 60002 cells are expected, almost all are empty"):
        read(tmp_path, text)


# Writing


def test_the_text_that_is_written():
    markers = Markers(("A b", "C\tD"), WANTED / 1000, 59.94)
    lines = trc_text(markers, Convention("y", "mm"), "t.trc").split("\n")
    assert lines[0] == "PathFileType\t4\t(X/Y/Z)\tt.trc"
    assert lines[2] == "59.94\t59.94\t3\t2\tmm\t59.94\t1\t3"
    assert lines[3:6] == ["Frame#\tTime\tA b\t\t\tC D\t\t", "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", ""]
    assert lines[7] == "2\t0.016683\t1.50000\t1700.00000\t3.00000\t\t\t"
    assert len(lines) == 10
    assert not lines[-1]


def test_units_that_others_do_not_know_are_not_written(tmp_path):
    with pytest.raises(FormatError, match="mm, cm or m is expected"):
        write_trc(Markers(("A",), np.ones((1, 1, 3)), 30), tmp_path / "t.trc", Convention("y", "cmu"))


def test_a_body_as_markers_needs_no_hints(tmp_path):
    motion = swinging(person(), 20, 60, seed=1, angle=0.3)
    for up in ("y", "z"):
        write_trc(joint_markers(motion), tmp_path / "t.trc", Convention(up, "m"))
        found = read_trc(tmp_path / "t.trc")
        np.testing.assert_allclose(found.positions, motion.positions, atol=1e-7)


# Real files


def test_a_real_ballet(data):
    found = read_trc(data / "c3d" / "MOTEK__ballet_reduced.trc")
    assert (len(found), len(found.names), found.fps) == (100, 41, 30)
    assert found.seen.all()
    np.testing.assert_allclose(found.positions[0, 0], [0.09308053, 0.12198482, 1.54235254], atol=1e-9)


def test_a_real_walk_with_scraps_in_columns_without_a_label(data):
    with noted() as notes:
        found = read_trc(data / "c3d" / "TRCSamples__Gait.trc")
    assert (len(found), len(found.names), found.fps) == (487, 33, 100)
    assert {note.about: note.taken for note in notes} == {"points": "33 markers", "markers": "33", "up": "z"}
    head = found.positions[:, found.index("R.Shoulder"), 2]
    assert abs(np.nanmedian(head) - 1.4) < 0.1
