import time

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats import Convention, read_motion, write_motion
from onbeat.formats.bvh.read import parse_bvh
from onbeat.formats.bvh.write import bvh_text
from onbeat.formats.notes import noted
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import BVH, person, swinging


def parsed(text: str, **more) -> Motion:
    return parse_bvh(text, "a.bvh", **more)


def same(a: Motion, b: Motion) -> bool:
    return a.skeleton == b.skeleton and a.fps == b.fps and np.allclose(a.positions, b.positions, atol=1e-9)


AWKWARD = {
    "lines inside a frame": BVH.replace(" 20.0 30.0 40.0", "\n20.0 30.0\n\n40.0"),
    "all frames in one line": BVH.replace("70.0\n", "70.0 "),
    "several spaces": BVH.replace(" 40.0 50.0", "   40.0    50.0   "),
    "tabs": BVH.replace(" ", "\t").replace("End\tSite", "End Site"),
    "CRLF": BVH.replace("\n", "\r\n"),
    "CR": BVH.replace("\n", "\r"),
    "lower case": BVH.lower().replace("hips", "Hips").replace("spine", "Spine").replace("leg", "Leg"),
    "upper case": BVH.upper().replace("HIPS", "Hips").replace("SPINE", "Spine").replace("LEG", "Leg"),
    "no final newline": BVH.rstrip("\n"),
    "blank lines at the end": BVH + "\n \n\t\n",
    "scientific notation": BVH.replace(" 90.0 ", " 9.0e1 ").replace("60.0\n", "6.0E+01\n"),
    "a brace beside the name": BVH.replace("ROOT Hips\n{", "ROOT Hips {"),
    "everything in one line": BVH.replace("  OFFSET 0.0 0.0 0.0\n", "OFFSET 0.0 0.0 0.0 "),
    "byte order mark": "\ufeff" + BVH,
    "no space after the colon": BVH.replace("Frames: 2", "Frames:2").replace("Time: ", "Time:\t"),
    "a comment-like end site name": BVH.replace("End Site", "End Site_x"),
}


@pytest.mark.parametrize("kind", AWKWARD)
def test_awkward_files_read_as_the_plain_one(kind, tmp_path):
    path = tmp_path / "a.bvh"
    path.write_bytes(AWKWARD[kind].encode())
    assert same(read_motion(path), parsed(BVH))


def test_values_reach_the_right_joints():
    motion = parsed(BVH)
    assert motion.skeleton.names == ("Hips", "Spine", "Spine_end", "Leg", "Leg_end")
    assert motion.skeleton.end_sites.tolist() == [False, False, True, False, True]
    assert motion.fps == 30.0
    np.testing.assert_allclose(motion.root_positions[1], [0.02, -0.04, 0.91])
    np.testing.assert_allclose(motion.skeleton.offsets[1], [0, 0, 0.6])
    # Y up, order Y X Z: the same turns about Z, X and -Y in the world with Z up.
    y, x, z = (
        rot.about(np.array(a), np.radians(v)) for a, v in (([0, 0, 1.0], 40), ([1.0, 0, 0], 50), ([0, -1.0, 0], 60))
    )
    expected = rot.multiply(rot.multiply(y, x), z)
    assert rot.angle_between(motion.rotations[0, 1], expected) < 1e-9
    assert rot.angle_between(motion.rotations[1, 3], rot.about(np.array([1.0, 0, 0]), np.radians(71))) < 1e-9


@pytest.mark.parametrize("name", ["Left Hip", "mixamorig:LeftUpLeg", "Bip01 L Thigh", "hüfte", "a{b"])
def test_names_are_kept(name):
    if "{" in name:
        with pytest.raises(FormatError):
            parsed(BVH.replace("JOINT Leg", f"JOINT {name}"))
    else:
        assert parsed(BVH.replace("JOINT Leg", f"JOINT {name}")).skeleton.names[3:] == (name, f"{name}_end")


def test_two_joints_of_one_name_are_told_apart():
    with noted() as notes:
        motion = parsed(BVH.replace("JOINT Leg", "JOINT Spine"))
    assert motion.skeleton.names == ("Hips", "Spine", "Spine_end", "Spine_2", "Spine_2_end")
    assert ("names", "Spine_2", "line 15 names another joint 'Spine'") in notes


BROKEN = {
    "fewer frames": (
        BVH.replace("Frames: 2", "Frames: 3"),
        "3 frames of 10 channels are promised (30 numbers), 2 frames",
    ),
    "more frames": (
        BVH.replace("Frames: 2", "Frames: 1"),
        "1 frames of 10 channels are promised (10 numbers), 2 frames",
    ),
    "cut inside a frame": (BVH[:-12], "1.8 frames found (18 numbers)"),
    "cut inside the hierarchy": (BVH[:300], "no MOTION"),
    "NaN": (BVH.replace("51.0", "nan"), "a.bvh:29: frame 1 has a value that is not a number"),
    "infinite": (BVH.replace("50.0", "inf"), "a.bvh:28: frame 0 has a value that is too large"),
    "a word": (BVH.replace("51.0", "5l.0"), "a.bvh:29: a number is expected, '5l.0' found"),
    "a decimal comma": (BVH.replace("51.0", "51,0"), "a.bvh:29: a number is expected, '51,0' found"),
    "a huge count": (BVH.replace("Frames: 2", "Frames: 99999999999999"), "99999999999999 frames"),
    "a count beyond belief": (BVH.replace("Frames: 2", "Frames: " + "9" * 400), "a whole number of frames"),
    "huge channels": (BVH.replace("CHANNELS 1", "CHANNELS 999999999"), "a.bvh:18: 999999999 channels"),
    "no frames": (BVH.replace("Frames: 2", "Frames: 0"), "0 frames"),
    "negative frames": (BVH.replace("Frames: 2", "Frames: -2"), "a whole number of frames"),
    "frame time of zero": (BVH.replace("0.0333333", "0"), "a frame time in seconds"),
    "frame time in milliseconds": (BVH.replace("0.0333333", "33.3333"), "33.3333 s is found, too long for a movement"),
    "a rate as frame time": (BVH.replace("0.0333333", "30.0"), "and say it with --source-fps"),
    "no frame time": (BVH.replace("Frame Time: 0.0333333\n", ""), "'Frame Time: <seconds>'"),
    "an unknown channel": (BVH.replace("1 Xrotation", "1 Wrotation"), "a.bvh:18: 1 channels such as Xrotation"),
    "an offset too short": (BVH.replace("OFFSET 10.0 0.0 0.0", "OFFSET 10.0 0.0"), "a.bvh:18: a number is expected"),
    "no offset": (BVH.replace("OFFSET 10.0 0.0 0.0", ""), "joint 'Leg' has no OFFSET"),
    "a brace too few": (BVH.replace("}\nMOTION", "MOTION"), "the braces of joint 'Hips' (line 2) are not closed"),
    "a brace too many": (BVH.replace("}\nMOTION", "}\n}\nMOTION"), "a.bvh:25: '}' found"),
    "two roots": (BVH.replace("JOINT Leg", "ROOT Leg"), "a.bvh:15: ROOT is out of place"),
    "another file": ("RIFF....WAVE", "no MOTION line"),
    "empty": ("", "no MOTION line"),
    "only MOTION": ("MOTION\nFrames: 1\nFrame Time: 1\n", "HIERARCHY is expected"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_broken_files_are_refused_with_their_place(kind):
    text, message = BROKEN[kind]
    with pytest.raises(FormatError, match=r"^a\.bvh") as caught:
        parsed(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_rate_that_is_told_replaces_a_frame_time_that_cannot_be():
    assert parse_bvh(BVH.replace("0.0333333", "33.3333"), "b.bvh", fps=30).fps == 30


def test_frame_times_rounded_when_printed_are_whole_rates():
    for text, fps in (("0.0083333", 120), (".0333333", 30), ("0.016667", 60), ("0.04", 25), ("0.033333", 30)):
        assert parsed(BVH.replace("0.0333333", text)).fps == fps
    for text, film in (("0.0417083", 24), ("0.033367", 30), ("3.33667e-02", 30), ("0.00834167", 120)):
        assert parsed(BVH.replace("0.0333333", text)).fps == pytest.approx(film * 1000 / 1001, rel=1e-12)
    assert parsed(BVH.replace("0.0333333", "8.33333e-03")).fps == 120
    assert parsed(BVH.replace("0.0333333", "0.016")).fps == 62.5
    assert parsed(BVH, fps=48.0).fps == 48.0


@pytest.mark.parametrize("fps", [24.0, 29.97, 30.0, 59.94005994, 60.0, 100.0, 120.0, 1000 / 3])
def test_the_rate_survives_writing(fps):
    assert parsed(bvh_text(parsed(BVH, fps=fps), Convention())).fps == pytest.approx(fps, rel=1e-12)


SIX = "CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation"


def test_positions_that_stay_replace_the_offset():
    text = BVH.replace("CHANNELS 3 Yrotation Xrotation Zrotation", SIX)
    text = text.replace(" 40.0 50.0", " 1.0 55.0 2.0 40.0 50.0").replace(" 41.0 51.0", " 1.0 55.0 2.0 41.0 51.0")
    motion = parsed(text)
    assert motion.translations is None
    np.testing.assert_allclose(motion.skeleton.offsets[1], [0.01, -0.02, 0.55])


def test_positions_that_move_are_kept_as_translations():
    text = BVH.replace("CHANNELS 3 Yrotation Xrotation Zrotation", SIX)
    text = text.replace(" 40.0 50.0", " 0 55.0 0 40.0 50.0").replace(" 41.0 51.0", " 0 65.0 0 41.0 51.0")
    motion = parsed(text)
    assert motion.translations is not None
    np.testing.assert_allclose(motion.translations[:, 1, 2], [0.55, 0.65])
    again = parsed(bvh_text(motion, Convention()))
    assert again.translations is not None
    np.testing.assert_allclose(again.positions, motion.positions, atol=1e-6)


def test_positions_that_are_all_zero_leave_the_offsets():
    body = swinging(person(), frames=8)
    text = bvh_text(body, Convention())
    head, _, frames = text.partition("MOTION")
    root, _, below = head.partition("JOINT")
    bones = below.count("CHANNELS 3")
    below = below.replace("CHANNELS 3 ", "CHANNELS 6 Xposition Yposition Zposition ")
    titles, lines = frames.splitlines()[1:3], [line.split() for line in frames.splitlines()[3:]]
    zeros = ["0", "0", "0"]
    wide = [
        " ".join([*line[:6], *(word for n in range(bones) for word in [*zeros, *line[6 + 3 * n : 9 + 3 * n]])])
        for line in lines
    ]
    again = parsed("\n".join([root + "JOINT" + below + "MOTION", *titles, *wide]) + "\n")
    assert again.translations is None
    np.testing.assert_allclose(again.positions, parsed(text).positions, atol=1e-9)


def test_a_helper_root_is_folded_into_the_travelling_hips():
    body = swinging(person(), frames=8)
    lines = bvh_text(body, Convention()).splitlines()
    at = next(n for n, line in enumerate(lines) if line.startswith("MOTION"))
    hierarchy = [line.replace("ROOT Hips", "JOINT Hips") for line in lines[1:at]]
    top = ["HIERARCHY", "ROOT ground", "{", "OFFSET 0 0 0", "CHANNELS 6 " + SIX.split(" ", 2)[2]]
    frames = [f"100 0 0 90 0 0 {line}" for line in lines[at + 3 :]]  # 1 m along x and turned about the vertical
    folded = parsed("\n".join([*top, *hierarchy, "}", *lines[at : at + 3], *frames]))
    assert folded.skeleton == body.skeleton
    turned = rot.rotate(rot.yaw(np.pi / 2), body.positions) + np.array([1.0, 0, 0])
    np.testing.assert_allclose(folded.positions, turned, atol=1e-5)


def test_units_and_axes_are_guessed_from_the_body():
    body = swinging(person(), frames=5, angle=0.1)
    for convention in (
        Convention(),
        Convention("y", "m"),
        Convention("z", "cm"),
        Convention("z", "cmu"),
        Convention("y", "mm"),
    ):
        again = parsed(bvh_text(body, convention))
        np.testing.assert_allclose(again.positions, body.positions, atol=1e-4)


def test_a_convention_overrides_the_guesses():
    small = swinging(Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0, 0.02]]), frames=3)
    again = parsed(bvh_text(small, Convention("z", "cm")), up="z", unit="cm")
    np.testing.assert_allclose(again.positions, small.positions, atol=1e-7)


def test_leaves_that_are_joints_come_back_as_leaves():
    arm = Skeleton(["a", "b", "c"], [-1, 0, 0], [[0, 0, 0], [0, 0, 1.0], [0.6, 0, 0]])
    assert parsed(bvh_text(swinging(arm), Convention("y", "m"))).skeleton == arm


def test_deep_trees_are_written_too():
    deep = Skeleton([f"j{n}" for n in range(1500)], range(-1, 1499), np.tile([0, 0, 0.001], (1500, 1)))
    offsets = np.array(deep.offsets)
    offsets[0] = 0
    deep = Skeleton(deep.names, deep.parents, offsets)
    motion = Motion(deep, np.tile(rot.IDENTITY, (1, 1500, 1)), np.zeros((1, 3)), 30)
    assert parsed(bvh_text(motion, Convention("y", "m"))).skeleton == deep


def test_names_that_bvh_cannot_hold_are_refused():
    with pytest.raises(FormatError, match="BVH cannot hold the joint name"):
        bvh_text(swinging(Skeleton(["a\nb"], [-1], [[0, 0, 0]])), Convention())


def test_files_have_exactly_the_frames_and_end_sites(tmp_path):
    body = swinging(person(), frames=7)
    write_motion(body, tmp_path / "a.bvh")
    text = (tmp_path / "a.bvh").read_text()
    assert "Frames: 7\n" in text
    assert len(text.partition("Frame Time")[2].strip().splitlines()) == 8
    assert text.count("End Site") == int(body.skeleton.end_sites.sum())


def test_a_long_file_is_read_fast():
    """11,008 frames of 96 channels; 0.25 s when it was written, 0.58 s by the fastest peer known."""
    rng = np.random.default_rng(1)
    joints = "".join(f"JOINT j{n}\n{{\nOFFSET 0 6 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n" for n in range(30))
    head = BVH.partition("  JOINT")[0] + joints + "}" * 31 + "\nMOTION\nFrames: 11008\nFrame Time: 0.0083333\n"
    rows = [" ".join(f"{v:.4f}" for v in row) for row in rng.uniform(-90, 90, (688, 96))]
    text = head + "\n".join(rows * 16)
    start = time.process_time()
    motion = parsed(text)
    assert time.process_time() - start < 2.0
    assert len(motion) == 11008


@pytest.mark.data
def test_real_bvh_files_stand_on_the_floor(data):
    for name, joints, height in (("cmu/131_01.bvh", 38, 1.4), ("bandai/dance-short_normal_001.bvh", 21, 1.5)):
        motion = read_motion(data / name)
        assert len(motion.skeleton) == joints
        assert motion.translations is None
        tall = np.percentile(np.ptp(motion.positions[..., 2], axis=1), 80)
        assert tall == pytest.approx(height, abs=0.25)
        assert abs(np.percentile(motion.positions[..., 2].min(1), 5)) < 0.08


@pytest.mark.parametrize("turn", [0.0, np.pi])
def test_who_lies_on_the_floor_lies(turn):
    body = swinging(person(), frames=20, angle=0.05)
    flat = rot.multiply(rot.yaw(turn), rot.about(np.array([1.0, 0, 0]), np.pi / 2))
    rotations = np.array(body.rotations)
    rotations[:, 0] = rot.multiply(flat, rotations[:, 0])
    body = body.replace(rotations=rotations, root_positions=np.tile([0.0, 0, 0.1], (20, 1)))
    again = parsed(bvh_text(body, Convention()))
    np.testing.assert_allclose(again.positions, body.positions, atol=1e-5)
