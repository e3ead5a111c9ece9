from __future__ import annotations

import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError, MissingExtraError, OnbeatError
from onbeat.formats import Convention, read_motion
from onbeat.formats.body_mesh import body_mesh
from onbeat.formats.conventions import z_up_vectors
from onbeat.formats.usd.write import SUFFIXES, joint_paths, usd_bytes, write_usd
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import person, swinging

pxr = pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Gf, Usd, UsdGeom, UsdShade, UsdSkel, Vt  # noqa: E402


def written(motion: Motion, folder: Path, suffix: str = ".usda", convention: Convention | None = None) -> Usd.Stage:
    write_usd(motion, folder / f"motion{suffix}", convention)
    return Usd.Stage.Open(str(folder / f"motion{suffix}"))


def query(stage: Usd.Stage) -> UsdSkel.SkeletonQuery:
    cache = UsdSkel.Cache()
    cache.Populate(UsdSkel.Root(stage.GetDefaultPrim()), Usd.PrimDefaultPredicate)
    return cache.GetSkelQuery(UsdSkel.Skeleton(stage.GetPrimAtPath("/dancer/skeleton")))


def metres(points: object, stage: Usd.Stage) -> np.ndarray:
    """Points of a stage in metres with Z up, by what the stage says of itself."""
    up = {"Y": "y", "Z": "z"}[UsdGeom.GetStageUpAxis(stage)]
    return z_up_vectors(np.asarray(points, float) * UsdGeom.GetStageMetersPerUnit(stage), up)


def joints(stage: Usd.Stage, code: float) -> np.ndarray:
    """(J, 3) where UsdSkel puts the joints at a time code, in metres with Z up."""
    matrices = query(stage).ComputeJointWorldTransforms(UsdGeom.XformCache(code))
    return metres([matrix.ExtractTranslation() for matrix in matrices], stage)


def skinned(stage: Usd.Stage, code: float) -> np.ndarray:
    """(V, 3) where UsdSkel moves the body's vertices, in metres with Z up."""
    cache, root = UsdSkel.Cache(), UsdSkel.Root(stage.GetDefaultPrim())
    cache.Populate(root, Usd.PrimDefaultPredicate)
    body = stage.GetPrimAtPath("/dancer/body")
    points = Vt.Vec3fArray(UsdGeom.Mesh(body).GetPointsAttr().Get())
    moves = query(stage).ComputeSkinningTransforms(code)
    assert cache.GetSkinningQuery(body).ComputeSkinnedPoints(moves, points, code)
    return metres(points, stage)


def moved(motion: Motion, frame: int) -> np.ndarray:
    """(V, 3) the body's vertices by onbeat's own positions and rotations."""
    mesh = body_mesh(motion.skeleton)
    own = mesh.vertices - motion.skeleton.rest_positions[mesh.joints]
    return motion.positions[frame, mesh.joints] + rot.rotate(motion.world_rotations[frame, mesh.joints], own)


def travelling() -> Motion:
    """A motion whose offsets are animated."""
    body = swinging(person(), frames=30)
    offsets = np.tile(body.skeleton.offsets, (30, 1, 1))
    offsets[:, 1:, 2] += np.linspace(0, 0.2, 30)[:, None]
    return Motion(body.skeleton, body.rotations, body.root_positions, 30, "", offsets)


CONVENTIONS = [None, Convention("y", "cm"), Convention("z", "in"), Convention("y", "m")]


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_usd_sees_the_joints_where_they_are(suffix: str, convention: Convention | None, tmp_path: Path):
    body = swinging(person(), frames=40)
    stage = written(body, tmp_path, suffix, convention)
    for frame in (0, 17, 39):
        np.testing.assert_allclose(joints(stage, frame), body.positions[frame], atol=2e-6)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_animated_offsets_travel(convention: Convention | None, tmp_path: Path):
    body = travelling()
    stage = written(body, tmp_path, ".usdc", convention)
    for frame in (0, 11, 29):
        np.testing.assert_allclose(joints(stage, frame), body.positions[frame], atol=2e-6)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_body_moves_with_its_joints(convention: Convention | None, tmp_path: Path):
    body = swinging(person(), frames=20)
    stage = written(body, tmp_path, ".usda", convention)
    for frame in (0, 9, 19):
        np.testing.assert_allclose(skinned(stage, frame), moved(body, frame), atol=5e-6)


@pytest.mark.parametrize("body", [swinging(person(), frames=15), travelling()], ids=["fixed", "travelling"])
def test_the_extent_holds_the_body_and_little_more(body: Motion, tmp_path: Path):
    stage = written(body, tmp_path, ".usda", Convention("y", "cm"))
    for frame in range(0, len(body), 7):
        box = np.sort(metres(UsdGeom.Boundable(stage.GetDefaultPrim()).GetExtentAttr().Get(frame), stage), axis=0)
        points = skinned(stage, frame)
        assert (box[0] <= points.min(0) + 1e-5).all()
        assert (box[1] >= points.max(0) - 1e-5).all()
        assert np.abs(box - np.stack((points.min(0), points.max(0)))).max() < 0.12


def test_a_time_between_frames_is_between_them(tmp_path: Path):
    body = swinging(person(), frames=40)
    between = body.at(np.array([10.5 / body.fps])).positions[0]
    np.testing.assert_allclose(joints(written(body, tmp_path), 10.5), between, atol=2e-6)


def test_the_stage_says_what_it_is(tmp_path: Path):
    stage = written(swinging(person(), frames=31, fps=29.97), tmp_path)
    assert (UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)) == ("Z", 1.0)
    assert (stage.GetTimeCodesPerSecond(), stage.GetFramesPerSecond()) == (29.97, 29.97)
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, 30)
    assert stage.GetDefaultPrim().GetTypeName() == "SkelRoot"
    assert UsdGeom.GetStageUpAxis(written(swinging(person()), tmp_path, ".usdc", Convention("y", "cm"))) == "Y"


def test_frames_are_sampled_at_whole_time_codes(tmp_path: Path):
    stage = written(swinging(person(), frames=12), tmp_path)
    animation = UsdSkel.Animation(stage.GetPrimAtPath("/dancer/skeleton/motion"))
    for attribute in (animation.GetRotationsAttr(), animation.GetTranslationsAttr()):
        assert attribute.GetTimeSamples() == list(range(12))


def test_rotations_are_unit_and_continuous(tmp_path: Path):
    stage = written(swinging(person(), frames=90, angle=3.0), tmp_path)
    turns = UsdSkel.Animation(stage.GetPrimAtPath("/dancer/skeleton/motion")).GetRotationsAttr()
    turned = np.array([[[q.real, *q.imaginary] for q in turns.Get(frame)] for frame in range(90)])
    np.testing.assert_allclose(np.linalg.norm(turned, axis=-1), 1, atol=1e-6)
    assert (np.sum(turned[1:] * turned[:-1], axis=-1) > 0).all()


def test_rest_and_bind_pose_are_one_and_stand_on_the_ground(tmp_path: Path):
    skeleton = person()
    stage = written(swinging(skeleton), tmp_path)
    bind = np.array(query(stage).GetJointWorldBindTransforms())[:, 3, :3]
    rest = np.array(query(stage).ComputeJointSkelTransforms(Usd.TimeCode.Default(), True))[:, 3, :3]
    np.testing.assert_allclose(bind, rest, atol=1e-12)
    np.testing.assert_allclose(bind - bind[0], skeleton.rest_positions, atol=1e-12)
    assert bind[:, 2].min() == pytest.approx(0)
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/dancer/body"))
    points = np.array(mesh.GetPointsAttr().Get())
    np.testing.assert_allclose(np.array(mesh.GetExtentAttr().Get()), [points.min(0), points.max(0)])
    assert np.ptp(points[:, 2]) == pytest.approx(1.78, abs=0.05)


def test_the_body_has_one_colour_for_viewers_and_renderers(tmp_path: Path):
    stage = written(swinging(person(), frames=2), tmp_path)
    body = stage.GetPrimAtPath("/dancer/body")
    material, _ = UsdShade.MaterialBindingAPI(body).ComputeBoundMaterial()
    surface, _, _ = material.ComputeSurfaceSource()
    shown = UsdGeom.Mesh(body).GetDisplayColorAttr().Get()[0]
    assert surface.GetInput("diffuseColor").Get() == shown != Gf.Vec3f(0)


def test_joint_names_are_made_valid_and_kept(tmp_path: Path):
    names = ("rig:hips", "größe", "1", "", "rig hips", "rig_hips_2", "日本")
    skeleton = Skeleton(names, [-1, 0, 0, 0, 0, 0, 5], np.eye(7, 3, k=-1))
    stage = written(swinging(skeleton), tmp_path)
    made = UsdSkel.Skeleton(stage.GetPrimAtPath("/dancer/skeleton"))
    assert tuple(made.GetJointNamesAttr().Get()) == names
    assert list(made.GetJointsAttr().Get()) == joint_paths(skeleton)
    assert UsdSkel.Topology(made.GetJointsAttr().Get()).Validate()[0]
    assert list(UsdSkel.Topology(made.GetJointsAttr().Get()).GetParentIndices()) == skeleton.parents.tolist()
    leaves = [path.rpartition("/")[2] for path in joint_paths(skeleton)]
    assert leaves == ["rig_hips", "gr__e", "_1", "_", "rig_hips_2", "rig_hips_2_2", "__"]


def complaints(stage: Usd.Stage) -> list[str]:
    """What the validators that come with USD say of a stage."""
    validation = pytest.importorskip("pxr.UsdValidation", reason="this usd-core has no validators")
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    return [str(found.GetMessage()) for found in validation.ValidationContext(validators).Validate(stage)]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_validators_of_usd_find_nothing(suffix: str, tmp_path: Path):
    assert complaints(written(travelling(), tmp_path, suffix)) == []


def test_the_validators_of_usd_would_find_something(tmp_path: Path):
    stage = written(travelling(), tmp_path)
    stage.ClearMetadata("metersPerUnit")
    stage.GetPrimAtPath("/dancer/body").RemoveAPI(UsdSkel.BindingAPI)
    assert len(complaints(stage)) >= 2


def test_any_skeleton_is_written(tmp_path: Path):
    for skeleton in (Skeleton(["a"], [-1], [[0, 0, 0]]), Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0.1, 0, 0]])):
        body = swinging(skeleton, frames=1)
        np.testing.assert_allclose(joints(written(body, tmp_path, ".usdc"), 0), body.positions[0], atol=1e-6)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_motion_gives_the_same_bytes(suffix: str):
    assert usd_bytes(swinging(person()), suffix) == usd_bytes(swinging(person()), suffix)


def test_a_package_holds_the_binary_at_a_multiple_of_64_bytes(tmp_path: Path):
    body = swinging(person())
    write_usd(body, tmp_path / "a.usdz")
    binary = usd_bytes(body, ".usdc")
    with zipfile.ZipFile(tmp_path / "a.usdz") as package:
        assert package.namelist() == ["motion.usdc"]
        assert package.read("motion.usdc") == binary
    assert (tmp_path / "a.usdz").read_bytes().index(binary) % 64 == 0


def test_x_up_is_refused(tmp_path: Path):
    with pytest.raises(FormatError, match="Y up and Z up, not X up"):
        write_usd(swinging(person()), tmp_path / "a.usda", Convention("x", "m"))
    assert not list(tmp_path.iterdir())


def test_another_suffix_is_refused(tmp_path: Path):
    with pytest.raises(FormatError, match=r"ends in one of \.usda, \.usdc"):
        write_usd(swinging(person()), tmp_path / "a.txt")


def test_a_missing_folder_is_said(tmp_path: Path):
    with pytest.raises(OnbeatError, match="cannot write"):
        write_usd(swinging(person()), tmp_path / "no" / "a.usda")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "motion",
    [
        swinging(person()).replace(root_positions=np.full((60, 3), 1e39)),
        swinging(Skeleton(["a", "b", "c"], [-1, 0, 1], [[0, 0, 0], [0, 0, 3e38], [0, 0, 3e38]])),
    ],
    ids=["far away", "long"],
)
def test_what_no_32_bit_number_holds_is_refused(motion: Motion):
    with pytest.raises(FormatError, match="no USD file can hold"):
        usd_bytes(motion)


def test_a_chain_too_deep_for_paths_is_refused():
    count = 20_000
    offsets = np.zeros((count, 3))
    with pytest.raises(FormatError, match="too deep for USD"):
        joint_paths(Skeleton([f"joint{n}" for n in range(count)], range(-1, count - 1), offsets))


def test_a_missing_extra_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "pxr"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'onbeat\[usd\]'"):
        write_usd(swinging(person()), tmp_path / "a.usda")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("file", ["05_01.amc", "dance-short_normal_001.bvh"])
@pytest.mark.filterwarnings("ignore:AMC files store no frame rate")
def test_usd_sees_captured_motion_where_it_is(file: str, data: Path, tmp_path: Path):
    body = read_motion(next(data.rglob(file)))
    stage = written(body, tmp_path, ".usdc")
    for frame in (0, len(body) // 2, len(body) - 1):
        np.testing.assert_allclose(joints(stage, frame), body.positions[frame], atol=2e-6)
    assert query(stage).HasBindPose()
