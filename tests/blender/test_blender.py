"""Blender opens what onbeat writes: the right length, size and place; skipped where Blender is absent."""

from __future__ import annotations

import importlib.util
import warnings
from pathlib import Path

import numpy as np
import pytest

from blender.opened import Seen, Wanted, blender, bone_names, open_in_blender, seen_joints, worst_difference
from onbeat.examples import embedded_motions
from onbeat.formats import read_motion, write_motion
from onbeat.formats.rates import RateWarning
from onbeat.formats.usd.write import write_usd
from onbeat.motion import Body, Motion, Skeleton
from onbeat.motion.body import ancestors
from persons import swinging

LOOKS = 9
"""Frames looked at in each file, the first and the last among them."""
TROUPE, CAPTURED = ("troupe", "travelling"), ("05_01", "60_01")
SUFFIXES = (".bvh", ".glb", ".usdc")


def travelling() -> Motion:
    """Animated offsets, odd names, a rate that is no whole number."""
    skeleton = Skeleton(["rig:hips", "a joint", "größe", "x.001"], [-1, 0, 1, 1], np.diag([0, 0.5, 0.3, 0.4])[:, 1:])
    body = swinging(skeleton, frames=50, fps=29.97)
    offsets = np.tile(skeleton.offsets, (50, 1, 1))
    offsets[:, 1] += np.linspace(0, 0.3, 50)[:, None]
    return Motion(skeleton, body.rotations, body.root_positions, body.fps, "", offsets)


def clips(request: pytest.FixtureRequest) -> dict[str, Motion]:
    """All motions to look at; the captured ones where the data is there."""
    made = {"troupe": embedded_motions()[0], "travelling": travelling()}
    try:
        folder: Path = request.getfixturevalue("data")
    except pytest.skip.Exception:
        return made
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RateWarning)
        return made | {name: read_motion(next(folder.rglob(f"{name}.amc"))) for name in CAPTURED}


@pytest.fixture(scope="module")
def opened(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, tuple[Wanted, Seen | None]]:
    """Each file with what was written to it and what Blender sees in it: None where it has no importer."""
    if blender() is None:
        pytest.skip("Blender is not installed (or named by ONBEAT_BLENDER)")
    folder, wanted = tmp_path_factory.mktemp("blender"), list[Wanted]()
    for name, motion in clips(request).items():
        frames = np.linspace(0, len(motion) - 1, LOOKS).astype(int).tolist()
        for suffix in SUFFIXES:
            path = folder / f"{name}{suffix}"
            if suffix != ".usdc":
                write_motion(motion, path)
            elif importlib.util.find_spec("pxr"):
                write_usd(motion, path)
            wanted += [Wanted(path, motion, frames)] if path.exists() else []
    metres = wanted[0]._replace(path=folder / "metres.bvh", scale=1.0)
    write_motion(metres.motion, metres.path, unit="m")
    wanted.append(metres)
    seen = open_in_blender(wanted, folder)
    return {each.path.name: (each, seen.get(each.path.name)) for each in wanted}


@pytest.fixture
def pair(request: pytest.FixtureRequest, opened: dict[str, tuple[Wanted, Seen | None]]) -> tuple[Wanted, Seen]:
    """A file that is asked for by its name, and what Blender sees in it."""
    wanted, seen = opened.get(request.param, (None, None))
    if wanted is None:
        pytest.skip(f"{request.param} could not be made: no real data, or no usd-core")
    if seen is None:
        pytest.skip("this Blender is built without USD")
    return wanted, seen


def files(*names: str, suffixes: tuple[str, ...] = SUFFIXES) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("pair", [n + s for n in names for s in suffixes], indirect=True)


@files(*TROUPE, *CAPTURED)
def test_joints_are_where_the_motion_has_them(pair: tuple[Wanted, Seen]):
    wanted, seen = pair
    assert worst_difference(seen, wanted) < 1e-3


@files(*TROUPE, *CAPTURED)
def test_it_lasts_as_long(pair: tuple[Wanted, Seen]):
    wanted, seen = pair
    assert seen.seconds == pytest.approx((len(wanted.motion) - 1) / wanted.motion.fps, abs=0.01 / wanted.motion.fps)


@files(*TROUPE, *CAPTURED)
def test_every_joint_is_a_bone_of_its_name(pair: tuple[Wanted, Seen]):
    wanted, seen = pair
    ends = wanted.motion.skeleton.end_sites & (wanted.path.suffix == ".bvh")
    assert set(seen.heads) == {name for name, end in zip(bone_names(wanted), ends, strict=True) if not end}


@files("metres", suffixes=(".bvh",))
def test_a_file_in_metres_needs_no_scale(pair: tuple[Wanted, Seen]):
    wanted, seen = pair
    assert worst_difference(seen, wanted) < 1e-3


@files("troupe", *CAPTURED)
def test_a_person_is_as_tall_as_a_person_and_stands_up(pair: tuple[Wanted, Seen]):
    wanted, seen = pair
    skeleton, found = wanted.motion.skeleton, seen_joints(seen, wanted)
    shoulders = set(Body.of(skeleton).indices("left_shoulder", "right_shoulder").tolist())
    armless = [at for joint, at in found.items() if not shoulders & set(ancestors(skeleton, joint))]
    extent = np.ptp(np.array(armless), axis=0)  # (T, 3)
    assert 1.5 < extent[:, 2].max() < 2.0
    assert (np.median(extent[:, 2]) > 1.5 * np.median(extent[:, :2], axis=0)).all()


@files("troupe", *CAPTURED)
def test_no_foot_is_under_the_floor(pair: tuple[Wanted, Seen]):
    """In the frames looked at; captured toes dip in others (in 60_01 28 of 2242 frames, to 6 cm), in any program."""
    _, seen = pair
    assert min(float(at[:, 2].min()) for at in seen.heads.values()) > -0.03
    assert seen.lowest is None or seen.lowest > -0.03


@files("troupe", suffixes=(".glb", ".usdc"))
def test_a_body_is_seen(pair: tuple[Wanted, Seen]):
    assert pair[1].lowest is not None
