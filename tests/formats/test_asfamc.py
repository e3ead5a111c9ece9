import warnings

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats import read_motion
from onbeat.formats.acclaim.read import read_amc, skeleton_file
from onbeat.formats.rates import RateWarning
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from persons import AMC, ASF

SCALE = 0.0254 / 0.45


def read(folder, asf: str = ASF, amc: str = AMC, fps: float | None = 120.0) -> Motion:
    (folder / "t.asf").write_text(asf)
    (folder / "t_01.amc").write_text(amc)
    return read_amc(folder / "t_01.amc", fps)


def about(x: float, y: float, z: float) -> np.ndarray:
    """Turns about the fixed axes x, then y, then z of a Y-up world, in degrees, as a matrix."""
    one = [rot.to_matrix(rot.about(axis, np.radians(v))) for axis, v in zip(np.eye(3), (x, y, z), strict=True)]
    return one[2] @ one[1] @ one[0]


def test_bones_start_where_their_parents_end(tmp_path):
    motion = read(tmp_path)
    assert motion.skeleton.names == ("root", "thigh", "shin", "shin_end", "back", "back_end")
    np.testing.assert_allclose(motion.skeleton.offsets[2], [0, 0, -8 * SCALE])
    np.testing.assert_allclose(motion.positions[0, 3], np.array([1, -2, 16 - 15]) * SCALE, atol=1e-12)
    assert motion.skeleton.end_sites.tolist() == [False, False, False, True, False, True]


def test_rotations_are_conjugated_by_the_axis(tmp_path):
    motion = read(tmp_path)
    c = about(0, 0, 20)
    root, thigh, shin = about(10, 20, 30), c @ about(40, 50, 60) @ c.T, about(90, 0, 0)
    knee = np.array([1, 16, 2]) + root @ thigh @ [0, -8, 0]
    foot = knee + root @ thigh @ shin @ [0, -7, 0]
    x, y, z = foot * SCALE
    np.testing.assert_allclose(motion.positions[1, 3], [x, -z, y], atol=1e-12)


def test_radians_and_units(tmp_path):
    asf = (
        ASF.replace("length 0.45", "length 1.0").replace("angle deg", "angle rad").replace("20 XYZ", "0.3490658504 XYZ")
    )
    amc = AMC.replace(":DEGREES", ":RADIANS").replace("40 50 60", "0.6981317 0.8726646 1.0471976")
    amc = amc.replace("9e1", "1.5707963").replace("10 20 30", "0.17453293 0.34906585 0.52359878")
    plain, radians = read(tmp_path), read(tmp_path, asf, amc)
    np.testing.assert_allclose(radians.positions / 0.0254, plain.positions / SCALE, atol=1e-5)


def test_values_come_in_the_order_of_the_dofs(tmp_path):
    swapped = read(tmp_path, ASF.replace("dof rx ry rz", "dof rz rx ry"), AMC.replace("40 50 60", "60 40 50"))
    np.testing.assert_allclose(swapped.positions, read(tmp_path).positions, atol=1e-12)


def test_the_root_may_list_its_channels_otherwise(tmp_path):
    asf = ASF.replace("order TX TY TZ RX RY RZ", "order RX RY RZ TX TY TZ")
    amc = AMC.replace("root 1.0 16.0 2.0 10 20 30", "root 10 20 30 1.0 16.0 2.0")
    amc = amc.replace("root 1.0 16.0 2.0 0 0 0", "root 0 0 0 1.0 16.0 2.0")
    np.testing.assert_allclose(read(tmp_path, asf, amc).positions, read(tmp_path).positions, atol=1e-12)


def test_the_rate_is_assumed_with_a_warning(tmp_path):
    with pytest.warns(RateWarning, match="120 frames a second are assumed"):
        assert read(tmp_path, fps=None).fps == 120
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_motion(tmp_path / "t_01.amc", fps=60).fps == 60


def test_two_subjects_of_cmu_are_slower(tmp_path):
    (tmp_path / "60.asf").write_text(ASF)
    (tmp_path / "60_01.amc").write_text(AMC)
    with pytest.warns(RateWarning, match="60 frames a second are assumed"):
        assert read_motion(tmp_path / "60_01.amc").fps == 60
    assert read_motion(tmp_path / "60_01.amc", fps=120).fps == 120


def test_the_skeleton_is_found_beside_the_motion(tmp_path):
    for name in ("05.asf", "05_01.asf", "06.ASF"):
        (tmp_path / name).write_text(ASF)
    assert skeleton_file(tmp_path / "05_01.amc").name == "05_01.asf"
    assert skeleton_file(tmp_path / "05_02.amc").name == "05.asf"
    assert skeleton_file(tmp_path / "06_02.amc").name == "06.ASF"
    with pytest.raises(FormatError, match=r"07_01\.asf is expected beside it \(3 \.asf"):
        skeleton_file(tmp_path / "07_01.amc")
    (tmp_path / "only").mkdir()
    (tmp_path / "only" / "x.asf").write_text(ASF)
    assert skeleton_file(tmp_path / "only" / "y_9.amc").name == "x.asf"


BROKEN_AMC = {
    "cut inside a frame": (AMC[:-10], "ends inside frame 2"),
    "an unknown bone": (AMC.replace("shin", "calf"), "'calf'"),
    "a word": (AMC.replace("9e1", "nine"), "frame 2 has 'nine'"),
    "NaN": (AMC.replace("9e1", "nan"), "frame 2 has 'nan'"),
    "other bones later": (AMC.replace("thigh 40", "shin 40"), "frame 2 has 'shin' where 'thigh' is expected"),
    "a frame missing": (AMC.replace("\n2\n", "\n3\n"), "'3' found where frame 2 should start"),
    "a value too many": (AMC.replace("shin 0\n", "shin 0 0\n"), "'0' found where frame 2 should start"),
    "no frames": (AMC[:40], "ends inside frame 1"),
    "text": ("hello\n", "a frame number is expected"),
    "empty": ("", "ends inside frame 1"),
    "only a number": ("1\n", "no frames"),
}


@pytest.mark.parametrize("kind", BROKEN_AMC)
def test_broken_motions_are_refused(kind, tmp_path):
    text, message = BROKEN_AMC[kind]
    with pytest.raises(FormatError, match=r"t_01") as caught:
        read(tmp_path, amc=text)
    assert message in str(caught.value)


BROKEN_ASF = {
    "empty": ("", "an ASF skeleton is expected"),
    "an unknown bone in the hierarchy": (ASF.replace("thigh shin\n", "thigh calf\n"), "'calf' is not in :bonedata"),
    "two parents": (ASF.replace("thigh shin\n", "thigh back\n"), "'back' has two parents"),
    "a bad direction": (ASF.replace("direction 0 1 0", "direction 0 one 0"), "t.asf:36: 3 numbers are expected"),
    "a bad dof": (ASF.replace("dof rx\n", "dof rx rq\n"), "degrees of freedom"),
    "a bad order": (ASF.replace("axis 0 0 20 XYZ", "axis 0 0 20 XXZ"), "an axis order"),
    "a length of nothing": (ASF.replace("length 0.45", "length 0"), "a positive unit of length"),
    "bones that travel": (ASF.replace("dof rx\n", "dof tx\n"), "only the root may have translations"),
    "a bone twice": (ASF.replace("name shin", "name thigh"), "occurs twice"),
}


@pytest.mark.parametrize("kind", BROKEN_ASF)
def test_broken_skeletons_are_refused(kind, tmp_path):
    text, message = BROKEN_ASF[kind]
    with pytest.raises(FormatError) as caught:
        read(tmp_path, asf=text)
    assert message in str(caught.value)


@pytest.mark.data
def test_a_real_trial_is_an_adult_on_the_floor(data):
    motion = read_motion(data / "cmu" / "05_01.amc", fps=120)
    body = Body.of(motion.skeleton)
    assert len(motion) == 598
    assert body.leg_length == pytest.approx(0.82, abs=0.01)
    assert np.percentile(np.ptp(motion.positions[..., 2], axis=1), 99) == pytest.approx(1.58, abs=0.03)
    assert abs(np.percentile(motion.positions[..., 2].min(1), 5)) < 0.03
