import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats import read_motion
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.retarget import floor_height, grounded, retarget, same_build, stands_in_rest
from persons import along_local_axes, person, swinging

LINKS = [(f"{s}_{a}", f"{s}_{b}") for s in ("left", "right") for a, b in
         (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))]  # fmt: skip


def directions(motion: Motion) -> np.ndarray:
    body = Body.of(motion.skeleton)
    bones = np.stack([motion.positions[:, body[b]] - motion.positions[:, body[a]] for a, b in LINKS], axis=1)
    return bones / np.linalg.norm(bones, axis=-1, keepdims=True)


def errors(a: Motion, b: Motion) -> np.ndarray:
    """Degrees (F, links) between the limbs of two motions."""
    return np.degrees(np.arccos(np.clip(np.sum(directions(a) * directions(b), axis=-1), -1, 1)))


def renamed(skeleton: Skeleton) -> Skeleton:
    names = {
        "Hips": "pelvis",
        "Shoulder": "UpperArm",
        "Elbow": "ForeArm",
        "Wrist": "Hand",
        "Hip": "Thigh",
        "Knee": "Shin",
    }
    made = []
    for name in skeleton.names:
        side = next((s for s in ("Left", "Right") if name.startswith(s)), "")
        made.append(side + names.get(name.removeprefix(side), name.removeprefix(side)))
    return Skeleton(made, skeleton.parents, skeleton.offsets, skeleton.end_sites)


def test_the_same_skeleton_gives_the_same_motion():
    motion = grounded(swinging(person()), near=0.0)
    again = retarget(motion, person())
    np.testing.assert_allclose(again.positions, motion.positions, atol=1e-9)
    assert (again.fps, again.name) == (motion.fps, motion.name)


def test_a_twice_larger_body_makes_twice_the_path():
    motion = grounded(swinging(person()), near=0.0)
    large = retarget(motion, person(2.0))
    np.testing.assert_allclose(large.positions, 2 * motion.positions, atol=1e-9)


def test_other_names_are_the_same_body():
    motion = swinging(person())
    assert not same_build(person(), renamed(person()))
    moved = retarget(motion, renamed(person()))
    np.testing.assert_allclose(moved.positions, retarget(motion, person()).positions, atol=1e-6)


def test_another_rest_pose_and_facing_keep_the_limbs():
    motion = swinging(person())
    down = renamed(person(1.1, arms_down=True))
    turned = Skeleton(down.names, down.parents, rot.rotate(rot.yaw(2.0), down.offsets), down.end_sites)
    for target in (down, turned):
        moved = retarget(motion, target)
        assert errors(motion, moved).max() < 1e-4
        assert floor_height(moved) == pytest.approx(0, abs=1e-9)
        hips = moved.positions[:, 0, :2] - moved.positions[0, 0, :2]
        np.testing.assert_allclose(hips, 1.1 * (motion.positions[:, 0, :2] - motion.positions[0, 0, :2]), atol=0.04)


def test_a_rest_pose_that_is_no_body_is_calibrated_from_the_motion():
    plain = swinging(person(), angle=0.4)
    laid = along_local_axes(plain)
    assert stands_in_rest(Body.of(plain.skeleton))
    assert not stands_in_rest(Body.of(laid.skeleton))
    assert errors(plain, retarget(laid, person())).max() < 1e-4
    assert errors(plain, retarget(plain, laid.skeleton, laid)).max() < 1e-4
    with pytest.raises(BodyError, match="give a motion of it as reference"):
        retarget(plain, laid.skeleton)


def test_extra_joints_of_the_spine_share_the_turn():
    motion = swinging(person(), angle=0.0)
    turned = np.array(motion.rotations)
    turned[:, motion.skeleton.index("Chest")] = rot.yaw(0.8)
    motion = motion.replace(rotations=turned)
    s = person()
    names, parents, offsets, ends = list(s.names), s.parents.tolist(), s.offsets.tolist(), s.end_sites.tolist()
    at = names.index("Chest")
    parents = [p + (p >= at) for p in parents]
    names, ends = [*names[:at], "Middle", *names[at:]], [*ends[:at], False, *ends[at:]]
    parents, offsets = [*parents[:at], parents[at], *parents[at:]], [*offsets[:at], [0, 0, 0.1], *offsets[at:]]
    parents[at + 1], offsets[at + 1] = at, [0, 0, 0.1]
    moved = retarget(motion, Skeleton(names, parents, offsets, ends))
    middle, chest = (moved.world_rotations[0, moved.skeleton.index(n)] for n in ("Middle", "Chest"))
    assert rot.angle_between(chest, rot.yaw(0.8)) < 1e-9
    assert rot.angle_between(middle, rot.yaw(0.4)) < 1e-9


def test_end_sites_never_turn_and_bones_keep_their_length():
    moved = retarget(swinging(person()), renamed(person(0.8, arms_down=True)))
    assert (moved.rotations[:, moved.skeleton.end_sites] == rot.IDENTITY).all()
    p = moved.positions
    lengths = np.linalg.norm(p[:, 1:] - p[:, moved.skeleton.parents[1:]], axis=-1)
    np.testing.assert_allclose(lengths, np.tile(moved.skeleton.bone_lengths[1:], (60, 1)), atol=1e-9)


def test_grounded_moves_only_floors_that_are_off():
    motion = grounded(swinging(person()), near=0.0)
    assert floor_height(motion) == pytest.approx(0, abs=1e-12)
    near = motion.replace(root_positions=motion.root_positions + np.array([0, 0, 0.02]))
    far = motion.replace(root_positions=motion.root_positions + np.array([0, 0, 0.4]))
    assert grounded(near) is near
    np.testing.assert_allclose(grounded(far).positions, motion.positions, atol=1e-12)


def test_a_skeleton_without_roles_is_refused_in_one_line():
    with pytest.raises(BodyError, match="no joint found for") as caught:
        retarget(swinging(person()), Skeleton(["a"], [-1], [[0, 0, 0]]))
    assert "\n" not in str(caught.value)


@pytest.mark.data
@pytest.mark.parametrize("name", ["cmu/131_01.bvh", "bandai/dance-short_normal_001.bvh"])
def test_real_motions_onto_a_cmu_body(data, name):
    source = read_motion(data / name)
    target = read_motion(data / "cmu" / "05_01.amc", fps=120)
    moved = retarget(source, target.skeleton)
    assert errors(source, moved).mean() < 0.5
    assert floor_height(moved) == pytest.approx(0, abs=1e-6)
