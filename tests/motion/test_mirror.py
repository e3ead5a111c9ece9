import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats import read_motion
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.mirror import mirrored, partners, sagittal_normal
from persons import along_local_axes, person, swinging

ACROSS = np.diag([-1.0, 1, 1])


def test_left_and_right_are_partners():
    body = Body.of(person())
    names = body.skeleton.names
    for joint, other in enumerate(partners(body)):
        expected = names[joint].replace("Left", "#").replace("Right", "Left").replace("#", "Right")
        assert names[other] == expected


@pytest.mark.parametrize("pair", [("l", "r"), ("left_", "right_"), ("J:Left", "J:Right")])
def test_partners_by_other_names(pair):
    plain = person()
    names = [name.replace("Left", pair[0]).replace("Right", pair[1]) for name in plain.names]
    named = Skeleton(names, plain.parents, plain.offsets, plain.end_sites)
    np.testing.assert_array_equal(partners(Body.of(named)), partners(Body.of(plain)))


def test_joints_land_where_the_reflected_ones_are():
    motion = swinging(person())
    image = mirrored(motion)
    reflected = (motion.positions @ ACROSS)[:, partners(Body.of(motion.skeleton))]
    np.testing.assert_allclose(image.positions, reflected, atol=1e-9)
    assert image.skeleton is motion.skeleton


def test_mirroring_twice_gives_the_motion_back():
    motion = swinging(person())
    again = mirrored(mirrored(motion))
    assert rot.angle_between(again.rotations, motion.rotations).max() < 1e-7
    np.testing.assert_allclose(again.root_positions, motion.root_positions, atol=1e-12)


def test_animated_offsets_are_mirrored_too():
    plain = swinging(person(), frames=10)
    offsets = plain.skeleton.offsets * np.linspace(1, 1.2, 10)[:, None, None]
    motion = Motion(plain.skeleton, plain.rotations, plain.root_positions, 30, "", offsets)
    reflected = (motion.positions @ ACROSS)[:, partners(Body.of(motion.skeleton))]
    np.testing.assert_allclose(mirrored(motion).positions, reflected, atol=1e-9)


def test_a_slightly_lopsided_body_keeps_its_bones():
    plain = person()
    offsets = plain.offsets * np.where(np.char.startswith(np.array(plain.names), "Left"), 1.03, 1.0)[:, None]
    motion = swinging(Skeleton(plain.names, plain.parents, offsets, plain.end_sites))
    image = mirrored(motion)
    lengths = np.linalg.norm(
        np.diff(image.positions[:, [image.skeleton.index(n) for n in ("LeftHip", "LeftKnee")]], axis=1), axis=-1
    )
    np.testing.assert_allclose(lengths, 0.42 * 1.03)
    reflected = (motion.positions @ ACROSS)[:, partners(Body.of(motion.skeleton))]
    assert np.linalg.norm(image.positions - reflected, axis=-1).max() < 0.06


def test_bones_along_local_axes_are_mirrored():
    motion = along_local_axes(swinging(person()))
    np.testing.assert_allclose(motion.positions, swinging(person()).positions, atol=1e-9)
    reflected = (motion.positions @ ACROSS)[:, partners(Body.of(motion.skeleton))]
    image = mirrored(motion)
    np.testing.assert_allclose(image.positions, reflected, atol=1e-6)
    assert rot.angle_between(mirrored(image).rotations, motion.rotations).max() < 1e-7


def test_the_normal_is_the_axis_the_body_is_built_on():
    plain = person()
    assert abs(sagittal_normal(Body.of(plain))[0]) == 1
    turned = rot.rotate(rot.yaw(np.radians(40)), plain.offsets)
    normal = sagittal_normal(Body.of(Skeleton(plain.names, plain.parents, turned, plain.end_sites)))
    assert abs(normal @ [np.cos(np.radians(40)), np.sin(np.radians(40)), 0]) == pytest.approx(1)


def test_a_body_without_sides_is_refused():
    with pytest.raises(BodyError):
        mirrored(swinging(Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0, 1.0]])))


@pytest.mark.data
@pytest.mark.parametrize(("name", "limit"), [("cmu/05_01.amc", 0.025), ("bandai/dance-short_normal_001.bvh", 0.01)])
def test_real_bodies(data, name, limit):
    motion = read_motion(data / name, fps=120)
    reflected = (motion.positions @ ACROSS)[:, partners(Body.of(motion.skeleton))]
    assert np.linalg.norm(mirrored(motion).positions - reflected, axis=-1).max() < limit
