import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from onbeat.errors import FormatError
from onbeat.formats import read_motion
from onbeat.formats.conventions import up_vectors, z_up_vectors
from onbeat.formats.keyed import read_pkl
from onbeat.formats.notes import noted
from onbeat.formats.npz import read_npz
from onbeat.formats.rates import RateWarning
from onbeat.formats.smpl.body import FINGER_JOINTS, ORDERS, STATURE, smpl_skeleton
from onbeat.formats.smpl.read import is_smpl, smpl_motion
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames, facing
from onbeat.motion.retarget import floor_height, retarget

_Y_TO_Z = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
# SMPL adds the pelvis of its rest pose to the path, unturned, in whatever axes the world has.
_PELVIS = np.array([0.0, -0.23, 0.0])


def arrays_of(motion: Motion, up: str = "z", joints: int = 24) -> dict[str, np.ndarray]:
    """Poses and path that a fit of SMPL would have for a motion of the mean body; the way back, by its own formula."""
    back = rot.inverse(_Y_TO_Z)
    world = rot.IDENTITY if up == "z" else back
    poses = np.zeros((len(motion), joints, 3))
    for place, name in enumerate(ORDERS[joints]):
        if name in motion.skeleton.names:
            local = motion.rotations[:, motion.skeleton.index(name)]
            poses[:, place] = rot.log(rot.multiply(rot.multiply(back, local), _Y_TO_Z))
    poses[:, 0] = rot.log(rot.multiply(rot.multiply(world, motion.rotations[:, 0]), _Y_TO_Z))
    path = up_vectors(motion.root_positions, "y" if up == "y" else "z") - _PELVIS
    return {"poses": poses.reshape(len(motion), -1), "trans": path}


def amass(motion: Motion, joints: int = 52) -> dict[str, object]:
    more = {"mocap_framerate": motion.fps, "betas": np.zeros(16), "dmpls": np.zeros((len(motion), 8)), "gender": "male"}
    return arrays_of(motion, "z", joints) | more


def aist(motion: Motion) -> dict[str, np.ndarray]:
    arrays = arrays_of(motion, "y", 24)
    poses, trans, scale = arrays["poses"], arrays["trans"], 93.5
    return {"smpl_loss": 0.1, "smpl_poses": poses, "smpl_trans": trans * scale, "smpl_scaling": np.array([scale])}


def walker(size: float = 1.0, fingers: bool = False, fps: float = 120.0, frames: int = 240) -> Motion:
    """Somebody who walks towards +X, bends the knees in turn and raises the left hand."""
    body, t = smpl_skeleton(fingers, size), np.arange(frames) / fps
    rotations = np.tile(rot.IDENTITY, (frames, len(body), 1))

    def turn(name: str, axis: tuple[int, int, int], angle: np.ndarray | float) -> None:
        rotations[:, body.index(name)] = rot.about(np.array(axis, float), np.broadcast_to(angle, t.shape))

    turn("pelvis", (0, 0, 1), np.pi / 2)  # at rest the body looks along -Y
    turn("left_shoulder", (0, 1, 0), -0.3 - 0.9 * t / t[-1])  # from beside the shoulder to above the head
    turn("right_shoulder", (0, 1, 0), -1.3)
    for name, phase in (("left", 0.0), ("right", np.pi)):
        swing = 0.5 * np.sin(2 * np.pi * t + phase)
        turn(f"{name}_hip", (1, 0, 0), -np.abs(swing))
        turn(f"{name}_knee", (1, 0, 0), np.abs(swing) * 1.3)
    path = np.stack((1.2 * t, np.zeros_like(t), np.zeros_like(t)), axis=1)
    motion = Motion(body, rotations, path, fps, "walker")
    lowest = motion.positions[..., 2].min(1) - 0.01 * STATURE * size
    return motion.replace(root_positions=path - lowest[:, None] * np.array([0, 0, 1.0]))


def saved(path, arrays, pickled: bool = False):
    if pickled:
        path.write_bytes(pickle.dumps(arrays))
    else:
        np.savez(path, **arrays)
    return path


def check_walker(motion: Motion) -> None:
    """The left hand goes up, on the body's left; it walks to where it looks; it stands upright on the floor."""
    body, p = Body.of(motion.skeleton), motion.positions
    rise = np.ptp(p[:, body.indices("left_wrist", "right_wrist"), 2] - p[:, [0], 2], axis=0)
    assert rise[0] > 0.3
    assert rise[1] < 0.05
    assert np.all(p[:, body["head"], 2] - p[:, body.indices("left_ankle", "right_ankle"), 2].min(1) > 1.2)
    yaw = facing(body_frames(motion, body)[0])
    ahead = np.stack((-np.sin(yaw), np.cos(yaw)), axis=1)
    gone = (p[-1, 0] - p[0, 0])[:2]
    np.testing.assert_allclose(ahead.mean(0), gone / np.linalg.norm(gone), atol=0.02)
    across = (p[:, body["left_hip"]] - p[:, body["right_hip"]])[:, :2].mean(0)
    assert ahead.mean(0)[0] * across[1] - ahead.mean(0)[1] * across[0] > 0.1  # left is to the left of ahead
    toes = (p[:, body["left_toe"]] - p[:, body["left_ankle"]])[:, :2].mean(0)
    assert toes @ ahead.mean(0) > 0.05
    assert abs(floor_height(motion)) < 0.03
    assert p[..., 2].min() > -0.02


def test_amass_with_z_up(tmp_path):
    given_ = walker(1.05)
    with noted() as notes:
        motion = read_motion(saved(tmp_path / "walk.npz", amass(given_)))
    check_walker(motion)
    assert (motion.fps, motion.name) == (120, "walk")
    assert motion.skeleton == given_.skeleton  # the heights of the path tell its size
    gone = motion.positions - motion.positions[:1, :1] - (given_.positions - given_.positions[:1, :1])
    assert np.abs(gone).max() < 0.01
    assert {("up", "z"), ("unit", "m"), ("size", "1.05")} <= {(note.about, note.taken) for note in notes}
    assert (motion.positions[0, 0] - motion.root_positions[0]).tolist() == [0, 0, 0]
    assert abs(motion.root_positions[0, 0]) < 0.1  # and not where the path would be if Y were up


def test_aist_with_y_up(tmp_path):
    given_ = walker(fps=60)
    for name, read in (("a.npz", read_npz), ("a.pkl", read_pkl)):
        path = saved(tmp_path / name, aist(given_), name.endswith("pkl"))
        with pytest.warns(RateWarning, match="60 frames a second are assumed"), noted() as notes:
            motion = read(path)
        check_walker(motion)
        assert np.abs(motion.positions - given_.positions)[..., :2].max() < 1e-6
        assert np.abs(motion.positions - given_.positions)[..., 2].max() < 0.01
        assert {("up", "y"), ("unit", "m")} <= {(note.about, note.taken) for note in notes}
        assert "floor" in {note.about for note in notes}


@pytest.mark.parametrize("up", ["y", "z"])
def test_joints_are_where_the_formula_of_the_model_puts_them(up):
    """In its own frame (Y up, left along +X), with its own tree by number and matrices: ``p_j = p_i + R_i o_j``."""
    parents = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21]
    rng, body = np.random.default_rng(3), smpl_skeleton()
    at = [body.index(name) for name in ORDERS[24]]
    rest = up_vectors(body.rest_positions, "y")[at]
    assert rest[13, 0] > 0.02 > -0.02 > rest[14, 0]  # SMPL's 13th joint is in the left collar bone
    poses, trans = rng.normal(0, 0.5, (4, 24, 3)), rng.normal(0, 1, (4, 3))
    world, places = np.empty((4, 24, 3, 3)), np.empty((4, 24, 3))
    for joint, parent in enumerate(parents):
        local = Rotation.from_rotvec(poses[:, joint]).as_matrix()
        world[:, joint] = local if parent < 0 else world[:, parent] @ local
        step = rest[joint] - rest[max(parent, 0)]
        places[:, joint] = trans if parent < 0 else places[:, parent] + world[:, parent] @ step
    motion = smpl_motion({"poses": poses.reshape(4, 72), "trans": trans}, "a.npz", fps=30, up=up, unit="m")
    scale = motion.skeleton.bone_lengths.sum() / body.bone_lengths.sum()
    expected = z_up_vectors(places - places[:, :1], up) * scale
    np.testing.assert_allclose(motion.positions[:, at] - motion.positions[:, :1], expected, atol=1e-9)


def test_parts_of_poses_and_other_names():
    given_, whole = walker(), arrays_of(walker(), "z", 52)
    poses, trans = whole["poses"], whole["trans"]
    parts = {"root_orient": poses[:, :3], "pose_body": poses[:, 3:66], "pose_hand": poses[:, 66:], "trans": trans}
    video = {"global_orient": poses[None, :, :3], "body_pose": poses[:, 3:66].reshape(-1, 21, 3), "transl": trans[None]}
    smpl = arrays_of(given_, "z", 24)
    physics = {"pose_aa": smpl["poses"].reshape(-1, 24, 3), "root_trans_offset": trans}
    edge = {"smpl_poses": smpl["poses"], "smpl_trans": trans, "full_pose": np.zeros((240, 24, 3))}
    for arrays in (parts, video, physics, edge):
        assert is_smpl(arrays)
        motion = smpl_motion(arrays, "a.npz", fps=120)
        check_walker(motion)
        np.testing.assert_allclose(motion.rotations, smpl_motion(whole, "a.npz", fps=120).rotations, atol=1e-12)
    with pytest.warns(RateWarning, match="30 frames"):
        assert smpl_motion(edge, "a.pkl").fps == 30


@pytest.mark.parametrize(("joints", "moving"), [(52, True), (52, False), (55, True), (24, True)])
def test_fingers_are_kept_where_they_move(joints, moving):
    given_ = walker(fingers=True)
    rotations = given_.rotations.copy()
    bend = 0.8 * np.sin(np.arange(240) / 20.0)[:, None] if moving else np.full((240, 1), 0.4)
    fingers = [given_.skeleton.index(name) for name in FINGER_JOINTS]
    rotations[:, fingers] = rot.about(np.array([0, 1.0, 0]), bend)
    motion = smpl_motion(amass(given_.replace(rotations=rotations), joints), "a.npz")
    kept = joints > 24 and moving
    assert ("left_index3" in motion.skeleton.names) is kept
    assert ("left_hand" in motion.skeleton.names) is not kept
    assert len(motion.skeleton) == (65 if kept else 29)
    check_walker(motion)
    if kept:
        np.testing.assert_allclose(motion.rotations[:, fingers], rotations[:, fingers], atol=1e-9)


def test_worlds_with_y_down_are_turned_over():
    arrays, over = arrays_of(walker(), "y"), np.array([0.0, 1.0, 0.0, 0.0])
    poses = arrays["poses"].copy()
    poses[:, :3] = rot.log(rot.multiply(over, rot.exp(poses[:, :3])))
    with noted() as notes:
        motion = smpl_motion({"poses": poses, "trans": rot.rotate(over, arrays["trans"])}, "a.npz", fps=120)
    check_walker(motion)
    assert ("up", "-y") in {(note.about, note.taken) for note in notes}


def test_what_is_given_replaces_what_is_guessed():
    given_ = walker()
    arrays = arrays_of(given_, "y")
    assert smpl_motion(arrays, "a.npz", fps=25).fps == 25
    check_walker(smpl_motion(arrays, "a.npz", fps=120, up="y", unit="m"))
    lying = smpl_motion(arrays, "a.npz", fps=120, up="z")
    crown = lying.positions[0, lying.skeleton.index("head_end")] - lying.positions[0, 0]
    assert abs(crown[2]) < 0.01
    large = {"poses": arrays["poses"], "trans": arrays["trans"] * 100}
    check_walker(smpl_motion(large, "a.npz", fps=120))
    check_walker(smpl_motion(large, "a.npz", fps=120, unit="cm"))


@pytest.mark.parametrize("rest", ["z", "y"])
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), joints=st.sampled_from([22, 24, 52, 55]), size=st.floats(0.9, 1.1))
def test_any_pose_comes_back(rest, seed, joints, size):
    rng, body = np.random.default_rng(seed), smpl_skeleton(joints > 24, round(size, 2))
    rotations = rot.exp(rng.normal(0, 0.8, (5, len(body), 3)))
    rotations[:, body.end_sites] = rot.IDENTITY
    if joints < 52:
        rotations[:, [body.index(f"{side}_hand") for side in ("left", "right")]] = rot.IDENTITY
    given_ = Motion(body, rotations, rng.normal(0, 1, (5, 3)), 30)
    motion = smpl_motion(arrays_of(given_, rest, joints), "a.npz", fps=30, up=rest, unit="m")
    np.testing.assert_allclose(rot.angle_between(motion.rotations, rotations), 0, atol=1e-7)
    small = (motion.positions - motion.positions[:, :1]) / motion.skeleton.bone_lengths.sum()
    np.testing.assert_allclose(small, (given_.positions - given_.positions[:, :1]) / body.bone_lengths.sum(), atol=1e-9)
    path = np.diff(motion.root_positions, axis=0)
    np.testing.assert_allclose(path, np.diff(given_.root_positions, axis=0), atol=1e-9)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"poses": np.zeros((240, 71))}, "shape .240, 71.; .frames, 3 × joints. is expected"),
        ({"poses": np.zeros((240, 75))}, "poses of 75 numbers a frame found; 66, 72, 156, 165 are known"),
        ({"poses": np.zeros((240, 24, 3, 3))}, "axis times angle"),
        ({"poses": np.zeros((0, 72))}, "axis times angle"),
        ({"poses": np.zeros(72)}, "axis times angle"),
        ({"poses": np.full((240, 72), np.nan)}, "not a number at .0, 0"),
        ({"poses": np.full((240, 72), 1e200)}, "has 1e.200 at frame 0; that cannot be"),
        ({"poses": np.full((240, 72), "x")}, "numbers are expected"),
        ({"trans": np.zeros((239, 3))}, "poses of 240 frames, but a path of 239"),
        ({"trans": np.zeros((240, 6))}, "'trans' has the shape .240, 6.; .frames, 3. is expected"),
        ({"trans": np.full((240, 3), np.inf)}, "'trans' has a value that is not a number"),
        ({"mocap_framerate": 0.0}, "'mocap_framerate' is .0"),
        ({"mocap_framerate": np.ones(2)}, "one rate from 0.1 to 10000"),
        ({"smpl_scaling": np.zeros(1)}, "one positive number is expected"),
        ({"root_orient": np.zeros((240, 3))}, None),
    ],
)
def test_what_is_wrong_is_refused(tmp_path, changed, words):
    path = saved(tmp_path / "a.npz", amass(walker()) | changed)
    if words is None:
        check_walker(read_npz(path))
        return
    with pytest.raises(FormatError, match=words):
        read_npz(path)


def test_objects_beside_the_motion_do_no_harm(tmp_path):
    odd = {"labels": np.array([None, print], dtype=object), "marker_data": np.array([{}], dtype=object)}
    check_walker(read_npz(saved(tmp_path / "a.npz", amass(walker()) | odd)))


def test_the_mean_body_is_a_person():
    for fingers in (False, True):
        body = smpl_skeleton(fingers)
        rest = body.rest_positions
        roles = Body.of(body)
        left, right = (
            rest[roles.indices(*(f"{s}_{r}" for r in ("wrist", "elbow", "ankle", "toe")))] for s in ("left", "right")
        )
        np.testing.assert_allclose(left, right * [-1, 1, 1], atol=1e-12)
        assert (left[:, 0] > 0).all()
        assert left[3, 1] < left[2, 1]  # toes before the heel: it looks along -Y
        assert 1.66 < np.ptp(rest[:, 2]) < 1.71
        assert 1.65 < np.ptp(rest[:, 0]) < 1.85
        assert not body.bone_lengths[1:].min() < 0.01
        order = [body.names[j] for j in range(len(body))]
        stack = [0]
        while stack:  # depth first, as files with a hierarchy list joints
            joint = stack.pop()
            assert order.pop(0) == body.names[joint]
            stack += reversed(body.children[joint])


def test_a_real_dance_goes_there_and_back(data, tmp_path):
    with pytest.warns(RateWarning):
        clip = retarget(read_motion(next(data.rglob("05_02.amc"))), smpl_skeleton())
    motion = read_npz(saved(tmp_path / "a.npz", amass(clip)), unit="m")
    body = Body.of(motion.skeleton)
    scale = motion.skeleton.bone_lengths.sum() / clip.skeleton.bone_lengths.sum()
    away = (motion.positions - motion.positions[:, :1]) - scale * (clip.positions - clip.positions[:, :1])
    assert np.abs(away).max() < 1e-6
    assert abs(floor_height(motion, body)) < 0.03
    assert 0.95 < scale < 1.05


@pytest.mark.parametrize(
    ("root", "height", "head_over_ankle"),
    [
        ([0.0, 0, 0], 0.12, [0, 1.5, 0]),  # on the back, the head towards +Y
        ([-np.pi / 2, 0, 0], 1.2, [0, 0, -1.5]),  # on the hands
        ([np.pi / 2, 0, 0], 0.95, [0, 0, 1.5]),
    ],
)
def test_who_lies_or_stands_on_the_hands_does_so(root, height, head_over_ankle, tmp_path):
    poses = np.zeros((90, 156))
    poses[:, :3] = root
    path = np.tile([0, 0, height], (90, 1))
    np.savez(tmp_path / "a.npz", poses=poses, trans=path, mocap_framerate=120.0, betas=np.zeros(16))
    motion = read_motion(tmp_path / "a.npz")
    head, ankle = (motion.positions[:, motion.skeleton.index(name)] for name in ("head", "left_ankle"))
    np.testing.assert_allclose((head - ankle)[0], head_over_ankle, atol=0.15)
    assert motion.positions[..., 2].min() > -0.05


def test_who_stands_and_then_lies_is_on_one_floor(tmp_path):
    poses, path = np.zeros((100, 156)), np.tile([0, 0, 0.12], (100, 1))
    poses[:40, 0], path[:40, 2] = np.pi / 2, 0.95
    np.savez(tmp_path / "a.npz", poses=poses, trans=path, mocap_framerate=30.0)
    motion = read_motion(tmp_path / "a.npz")
    lowest = motion.positions[..., 2].min(axis=1)
    assert -0.03 < lowest[:40].min() < 0.08
    assert abs(lowest[50:].min() - lowest[:40].min()) < 0.15
