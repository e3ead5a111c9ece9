import struct
import warnings

import numpy as np
import pytest

from c3d_files import c3d_file, expected, parameter, record, wandering
from onbeat.errors import FormatError
from onbeat.formats.c3d.read import read_c3d
from onbeat.formats.lost_frames import LostFramesWarning
from onbeat.formats.notes import noted
from onbeat.motion import Markers

POINTS = wandering()


def read(folder, data: bytes, **said) -> Markers:
    path = folder / "t.c3d"
    path.write_bytes(data)
    return read_c3d(path, **said)


def told(folder, data: bytes) -> tuple[Markers, dict[str, str]]:
    with noted() as notes:
        found = read(folder, data)
    return found, {note.about: f"{note.taken}: {note.why}" for note in notes}


@pytest.mark.parametrize("processor", [84, 85, 86])
@pytest.mark.parametrize("floating", [True, False])
def test_all_byte_orders_as_floats_and_integers(tmp_path, processor, floating):
    found = read(tmp_path, c3d_file(POINTS, processor, floating))
    assert found.names == ("M1", "M2", "M3", "M4")
    assert (found.fps, found.name) == (100.0, "t")
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_golden_numbers_of_each_processor(tmp_path):
    # 1.0, −6.5 and 0.1 as the processors' manuals have them.
    stored = {
        84: "0000803f 0000d0c0 cdcccc3d 00000000",
        85: "80400000 d0c10000 cc3ecdcc 00000000",
        86: "3f800000 c0d00000 3dcccccd 00000000",
    }
    for processor, golden in stored.items():
        data = c3d_file(np.zeros((1, 1, 4)), processor)
        found = read(tmp_path, data[:-512] + bytes.fromhex(golden).ljust(512, b"\0"), up="z")
        np.testing.assert_array_equal(found.positions[0, 0], np.array([1, -6.5, np.float32(0.1)]) * 0.001)


def test_smallest_and_largest_vax_floats(tmp_path):
    data = c3d_file(np.zeros((1, 1, 4)), 85)
    # The smallest (2⁻¹²⁸), the largest (just below 2¹²⁷), and minus zero, which VAX reserves for what is no number.
    for words_, value in (("80000000", 2.0**-128), ("ff7fffff", 2.0**127 * (1 - 2.0**-24))):
        found = read(tmp_path, data[:-512] + (bytes.fromhex(words_) * 3).ljust(512, b"\0"), up="z")
        np.testing.assert_allclose(found.positions, value * 0.001, rtol=1e-6)
    assert not read(tmp_path, data[:-512] + bytes.fromhex("00800000").ljust(512, b"\0")).seen.any()


def test_what_is_no_number_was_not_seen(tmp_path):
    data = c3d_file(np.ones((1, 2, 4)))
    # A signalling NaN and a quiet one.
    stored = struct.pack("<8I", 1, 0x7F800001, 0, 0, 0x7FC00000, 0, 0, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not read(tmp_path, data[:-512] + stored.ljust(512, b"\0")).seen.any()


def test_analog_samples_between_the_frames_are_passed_over(tmp_path):
    for floating in (True, False):
        found = read(tmp_path, c3d_file(POINTS, floating=floating, analog=6))
        np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_analog_size_by_its_parameters_where_the_header_is_wrong(tmp_path):
    analog = [record("ANALOG", -2, b"\0"), parameter("USED", 2, 3), parameter("RATE", 2, 200.0)]
    data = c3d_file(wandering(90), analog=6, others=analog, header={3: 0, 10: 0})
    np.testing.assert_allclose(read(tmp_path, data).positions, expected(wandering(90)), atol=1e-7)


def test_units_up_and_rate_can_be_said(tmp_path):
    data = c3d_file(POINTS, changed={"UNITS": "cm", "Y_SCREEN": "+Y"})
    found = read(tmp_path, data, fps=50, up="z", unit="mm")
    assert found.fps == 50
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("Meters", 1000.0)])
def test_stored_units(tmp_path, unit, metres):
    found = read(tmp_path, c3d_file(POINTS, changed={"UNITS": unit}))
    np.testing.assert_allclose(found.positions, expected(POINTS) * metres, rtol=1e-6)


def test_a_unit_that_is_missing_is_millimetres_and_told(tmp_path):
    found, notes = told(tmp_path, c3d_file(POINTS, changed={"UNITS": None}))
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)
    assert notes["unit"] == "mm: the file names no unit; mm is usual"


@pytest.mark.parametrize(
    ("screen", "turned"),
    [
        ("+Z", lambda x, y, z: (x, y, z)),
        ("+Y", lambda x, y, z: (x, -z, y)),
        ("+X", lambda x, y, z: (y, z, x)),
        ("-Z", lambda x, y, z: (x, -y, -z)),
        ("-Y", lambda x, y, z: (x, z, -y)),
        ("-X", lambda x, y, z: (-y, z, -x)),
    ],
)
def test_up_the_screen_is_up_and_left_stays_left(tmp_path, screen, turned):
    found = read(tmp_path, c3d_file(POINTS, changed={"Y_SCREEN": screen}))
    want = np.stack(turned(*np.moveaxis(expected(POINTS), -1, 0)), axis=-1)
    np.testing.assert_allclose(found.positions, want, atol=1e-7)


def standing(count: int = 12) -> np.ndarray:
    """Points of a body that walks along X on a floor, Z up."""
    rng = np.random.default_rng(3)
    points = np.zeros((40, count, 4))
    points[..., 0] = np.linspace(0, 3000, 40)[:, None] + rng.uniform(-200, 200, count)
    points[..., 1] = np.linspace(300, 900, 40)[:, None] + rng.uniform(-200, 200, count)
    points[..., 2] = np.linspace(20, 1700, count)
    return points


def test_a_body_that_stands_along_another_axis_is_believed_more_than_the_file(tmp_path):
    found, notes = told(tmp_path, c3d_file(standing()[..., [2, 0, 1, 3]]))
    assert notes["up"] == "x: bodies stand along it, on a floor at its zero, though the file says +z"
    np.testing.assert_allclose(found.positions, expected(standing()), atol=1e-6)


def test_somebody_who_lies_on_the_floor_does_not_turn_the_file(tmp_path):
    lying = standing()[..., [2, 0, 1, 3]]
    lying[..., 1] = np.linspace(0, 400, 12)
    lying[..., 2] = np.linspace(10, 150, 12)[::-1]
    found, notes = told(tmp_path, c3d_file(lying, changed={"LABELS": ["LTOE", "RTOE", *"abcdefgh", "LFHD", "RFHD"]}))
    assert notes["up"].startswith("z: the file says so, though it may be +x")
    np.testing.assert_allclose(found.positions, expected(lying), atol=1e-6)


def test_the_head_is_over_the_feet_where_the_file_says_nothing(tmp_path):
    labels = ["LTOE", "RTOE", *"abcdefgh", "LFHD", "RFHD"]
    turned = standing()[..., [1, 2, 0, 3]]
    found, notes = told(tmp_path, c3d_file(turned, changed={"LABELS": labels, "Y_SCREEN": None}))
    assert notes["up"] == "y: the head is over the feet along it"
    want = expected(standing())[..., [1, 0, 2]] * [1, -1, 1]
    np.testing.assert_allclose(found.positions, want, atol=1e-6)


def test_labels_are_numbered_told_apart_and_freed_of_the_subject(tmp_path):
    labels = ["Anna:LASI", "", "Anna:LASI", "Anna:RASI"]
    found, notes = told(tmp_path, c3d_file(POINTS, changed={"LABELS": labels}))
    assert found.names == ("LASI", "point_2", "LASI_2", "RASI")
    assert notes["labels"].startswith("LASI_2: 1 labels occur more than once")


def test_subjects_that_differ_keep_their_names(tmp_path):
    labels = ["Anna:LASI", "Ben:LASI", "*3", "Ben:RASI"]
    assert read(tmp_path, c3d_file(POINTS, changed={"LABELS": labels})).names == tuple(labels)


def test_labels_continue_in_a_second_parameter(tmp_path):
    points = wandering(2, 300)
    labels = [f"m{n:03}" for n in range(300)]
    data = c3d_file(points, changed={"LABELS": labels[:255], "LABELS2": labels[255:]})
    assert read(tmp_path, data).names == tuple(labels)


def test_angles_and_forces_of_models_are_no_markers(tmp_path):
    changed = {"LABELS": ["LASI", "LHipAngles", "LHipForce", "RASI"], "ANGLES": ["LHipAngles"], "FORCES": ["LHipForce"]}
    found, notes = told(tmp_path, c3d_file(POINTS, changed=changed))
    assert found.names == ("LASI", "RASI")
    np.testing.assert_allclose(found.positions, expected(POINTS)[:, [0, 3]], atol=1e-7)
    assert notes["points"] == "2 markers: 2 points are angles, forces or the like of a model"
    changed["MOMENTS"] = ["LASI", "RASI"]
    with pytest.raises(FormatError, match="4 points are angles, forces or the like, no markers"):
        read(tmp_path, c3d_file(POINTS, changed=changed))


def test_zeros_of_a_marker_that_is_nowhere_near_are_gaps(tmp_path):
    points = np.abs(wandering(8)) + 500
    points[..., 3] = 0
    points[2:4, 1] = 0
    found, notes = told(tmp_path, c3d_file(points))
    assert found.gaps() == [("M2", 2, 4)]
    assert notes["gaps"].startswith("2 zeros")


def test_more_frames_than_a_word_can_count(tmp_path):
    points = np.zeros((65600, 1, 4), np.float32)
    points[:, 0, 0] = np.arange(65600)
    trial = [record("TRIAL", -4, b"\0"), parameter("ACTUAL_START_FIELD", 4, [1, 0])]
    trial += [parameter("ACTUAL_END_FIELD", 4, [65600 - 65536, 1])]
    plain = c3d_file(points[:1], others=trial, changed={"FRAMES": 65535}, header={5: 65535})
    data = plain[:-512] + points.astype("<f4").tobytes().ljust(2051 * 512, b"\0")
    assert len(read(tmp_path, data)) == 65600
    lost = c3d_file(points[:1], changed={"FRAMES": 65535}, header={5: 65535})
    lost = lost[:-512] + points.astype("<f4").tobytes()
    assert len(read(tmp_path, lost)) == 65600


def test_a_trial_that_was_cut_out_begins_later(tmp_path):
    data = c3d_file(POINTS, header={4: 101, 5: 106})
    assert len(read(tmp_path, data)) == 6


def test_header_and_parameters_that_disagree_are_settled_by_the_size(tmp_path):
    points = wandering(40)
    # As in files of PhoeniX: one frame too many promised, and no start of the data.
    found = read(tmp_path, c3d_file(points, changed={"FRAMES": 60, "DATA_START": 0}))
    np.testing.assert_allclose(found.positions, expected(points), atol=1e-7)
    found = read(tmp_path, c3d_file(points, header={2: 9, 5: 70}))
    np.testing.assert_allclose(found.positions, expected(points), atol=1e-7)


def test_a_start_beyond_the_file_is_not_taken(tmp_path):
    found = read(tmp_path, c3d_file(POINTS, changed={"DATA_START": 900}))
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_everything_from_the_header_where_there_are_no_parameters(tmp_path):
    data = bytearray(c3d_file(POINTS))
    data[516] = 0
    found = read(tmp_path, bytes(data))
    assert found.names == ("point_1", "point_2", "point_3", "point_4")
    assert found.fps == 100
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_a_missing_description_and_strings_without_width_are_harmless(tmp_path):
    others = [parameter("NOTE", 1, "hello", described=False)]
    others += [record("DESCRIPTIONS", 1, bytes([255, 2, 0, 4, 0])), parameter("LAST", 1, 5)]
    found = read(tmp_path, c3d_file(POINTS, others=others))
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_a_parameter_that_is_not_whole_is_left_out_and_told(tmp_path):
    others = [record("UNITS", 9, bytes([255, 2, 40, 200]) + b"mm", step=8), parameter("LAST", 1, 5)]
    found, notes = told(tmp_path, c3d_file(POINTS, others=others))
    assert notes["parameters"] == "left out: damaged: 9:UNITS"
    np.testing.assert_allclose(found.positions, expected(POINTS), atol=1e-7)


def test_a_file_that_is_cut_off_gives_its_whole_frames_with_a_warning(tmp_path):
    points = wandering(40)
    data = c3d_file(points)
    start = len(data) - 40 * 64
    with pytest.warns(LostFramesWarning, match="promises 40 frames and holds 29 whole ones"):
        found = read(tmp_path, data[: start + 29 * 64 + 63])
    np.testing.assert_allclose(found.positions, expected(points)[:29], atol=1e-7)
    with pytest.raises(FormatError, match="is cut off: 40 frames of 64 bytes are promised"):
        read(tmp_path, data[: start + 63])


def test_a_stale_header_does_not_hide_that_a_file_is_cut_off(tmp_path):
    data = c3d_file(wandering(40), header={5: 12})
    with pytest.warns(LostFramesWarning, match="promises 40 frames and holds 20"):
        assert len(read(tmp_path, data[: len(data) - 20 * 64])) == 20


def test_a_header_that_promises_too_much_costs_nothing(tmp_path):
    data = c3d_file(POINTS, changed={"USED": 65535, "FRAMES": 65535}, header={2: 65535, 5: 65535})
    with pytest.raises(FormatError, match="is cut off: 65535 frames"):
        read(tmp_path, data)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is no C3D file"),
        (b" " * 4096, "is no C3D file: the bytes 20 20 found, 02 50 expected"),
        (c3d_file(POINTS)[:100], "ends inside its header of 512 bytes, at 100"),
        (c3d_file(POINTS)[:512], "the file ends at 512"),
        (c3d_file(POINTS).replace(b"\1\x50\2\x54", b"\1\x50\2\x07"), "7 found"),
        (c3d_file(POINTS, changed={"USED": 0}, header={2: 0, 3: 12}), "holds 12 analog values a frame and no points"),
        (c3d_file(POINTS, changed={"FRAMES": 0}, header={4: 5, 5: 4}), "has no frames: its header says 5 to 4"),
        (c3d_file(POINTS, changed={"DATA_START": 0}, header={9: 0}), "says where the points are"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, data, message):
    with pytest.raises(FormatError, match=message):
        read(tmp_path, data)


def test_a_rate_that_is_none_is_refused_or_replaced(tmp_path):
    data = c3d_file(POINTS, changed={"RATE": 0.0})
    assert read(tmp_path, data).fps == 100  # the header's
    data = data[:20] + bytes(4) + data[24:]
    with pytest.raises(FormatError, match="--source-fps"):
        read(tmp_path, data)
    assert read(tmp_path, data, fps=24).fps == 24


def test_rates_are_the_decimals_that_were_meant(tmp_path):
    assert read(tmp_path, c3d_file(POINTS, changed={"RATE": 59.94})).fps == 59.94


def test_an_infinite_coordinate_is_refused(tmp_path):
    points = wandering()
    points[1, 2] = [np.inf, 0, 0, 0]
    with pytest.raises(FormatError, match="frame 1 of 'M3' is infinite"):
        read(tmp_path, c3d_file(points))


# Beside another reader, and on real files


def of_ezc3d(path) -> tuple[list[str], np.ndarray]:
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d(str(path))
    labels = file["parameters"]["POINT"]["LABELS"]["value"]
    return labels, np.transpose(file["data"]["points"][:3], (2, 1, 0)) / 1000


@pytest.mark.parametrize("name", ["sample01__Eb015pi", "sample01__Eb015vr", "PiG__PiG_Motion-FlatFoot-Full"])
def test_real_files_as_another_reader_sees_them(data, name):
    path = data / "c3d" / f"{name}.c3d"
    labels, positions = of_ezc3d(path)
    found = read_c3d(path)
    np.testing.assert_allclose(found.positions, positions[:, [labels.index(n) for n in found.names]], atol=1e-9)


def test_the_same_trial_in_three_byte_orders(data):
    intel, mips, dec = (read_c3d(data / "c3d" / f"sample01__Eb015{kind}.c3d") for kind in ("pi", "sr", "vr"))
    assert intel.names == mips.names == dec.names
    assert (intel.fps, len(intel), len(intel.names)) == (50, 450, 26)
    np.testing.assert_array_equal(mips.positions, dec.positions)
    # As integers they are rounded to 1/12 mm.
    np.testing.assert_allclose(intel.positions, mips.positions, atol=0.5e-3 / 12 + 1e-7)


@pytest.mark.parametrize(
    ("name", "frames", "markers", "height"),
    [
        ("others__mocap36", 1380, 36, 1.70),
        ("others__badParameterOffset", 111, 41, 1.70),
        ("sample13__Dance", 499, 40, 1.72),
        ("sample13__golfswing", 514, 29, 1.42),
    ],
)
def test_real_files_that_others_refuse(data, name, frames, markers, height):
    found = read_c3d(data / "c3d" / f"{name}.c3d")
    assert (len(found), len(found.names)) == (frames, markers)
    heights = found.positions[found.seen.any(1), :, 2]
    top, bottom = np.nanmax(heights, 1), np.nanmin(heights, 1)
    assert abs(np.median(top) - height) < 0.06
    assert np.abs(bottom).max() < 0.2


def test_real_damage_is_read_as_far_as_it_goes(data, tmp_path):
    whole = (data / "c3d" / "sample13__Dance.c3d").read_bytes()
    with pytest.warns(LostFramesWarning):
        cut = read(tmp_path, whole[:200_000], up="x")
    np.testing.assert_array_equal(cut.positions, read(tmp_path, whole, up="x").positions[: len(cut)])
