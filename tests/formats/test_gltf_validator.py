"""Khronos' validator finds nothing wrong in any GLB file; skipped where Node.js or the validator are absent.

``npm i gltf-validator`` in any folder, and that folder in ONBEAT_GLTF_VALIDATOR, or in ``viewer-js``.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from onbeat.examples import embedded_motions
from onbeat.formats import read_motion
from onbeat.formats.glb import glb_bytes
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import person, swinging

_VALIDATE = """
const validator = require("gltf-validator"), fs = require("fs");
validator.validateBytes(new Uint8Array(fs.readFileSync(0))).then(r => console.log(JSON.stringify(r)));
"""


@pytest.fixture(scope="module")
def modules() -> Path:
    """The folder ``node_modules`` that holds the validator."""
    if shutil.which("node") is None:
        pytest.skip("Node.js is not installed")
    beside = Path(__file__).resolve().parents[2] / "viewer-js"
    folder = Path(os.environ.get("ONBEAT_GLTF_VALIDATOR", beside)) / "node_modules"
    if not (folder / "gltf-validator").is_dir():
        pytest.skip(f"no gltf-validator in {folder}: npm i gltf-validator, and its folder in ONBEAT_GLTF_VALIDATOR")
    return folder


def report(glb: bytes, modules: Path) -> dict:
    """What the validator says of the bytes of a file."""
    words, environment = ["node", "-e", _VALIDATE], os.environ | {"NODE_PATH": str(modules)}
    run = subprocess.run(words, input=glb, capture_output=True, check=True, timeout=600, env=environment)
    return json.loads(run.stdout)


def assert_clean(motion: Motion, modules: Path) -> dict:
    """No error, warning, information or hint."""
    found = report(glb_bytes(motion), modules)
    assert found["issues"]["messages"] == []
    assert found["info"]["animationCount"] == 1
    return found


def moved_offsets(motion: Motion) -> Motion:
    offsets = np.tile(motion.skeleton.offsets, (len(motion), 1, 1))
    offsets[:, 1, 2] += np.linspace(0, 0.2, len(motion))
    return Motion(motion.skeleton, motion.rotations, motion.root_positions, motion.fps, motion.name, offsets)


def chains(joints: int) -> Skeleton:
    """Ten chains of joints that hang on one root."""
    parents = [-1, *(0 if joint <= 10 else joint - 10 for joint in range(1, joints))]
    offsets = np.random.default_rng(0).normal(size=(joints, 3)) * 0.01
    offsets[0] = 0
    return Skeleton([f"joint {n}" for n in range(joints)], parents, offsets)


_ODD = Skeleton(("", 'größe/"x"\\\n', "日本 🕺", "a:b|c"), [-1, 0, 1, 1], np.eye(4, 3, k=-1))
_CASES = {
    "a person": swinging(person()),
    "travelling joints": moved_offsets(swinging(person())),
    "one joint": swinging(Skeleton(["a"], [-1], [[0, 0, 0]])),
    "odd names": swinging(_ODD),
    "one frame": swinging(person(), frames=1),
    "two hundred thousand frames a second": swinging(person(), frames=200, fps=2e5),
    "a frame in three hours": swinging(person(), frames=3, fps=1e-4),
    "bones of no length": swinging(Skeleton(["a", "b", "c"], [-1, 0, 1], np.zeros((3, 3)))),
    "large turns": swinging(person(), angle=9.0),
    "a quaternion that is nearly of unit length": swinging(person()).replace(
        rotations=swinging(person()).rotations * (1 + 1e-3)
    ),
    "a giant": swinging(person(1e6)),
    "a body of a tenth of a millimetre": swinging(person(5e-5)),
    "three thousand joints": swinging(chains(3000), frames=3),
    "a name of its own": swinging(person()).replace(name="\x00 \udcff".encode("utf-8", "replace").decode()),
}


@pytest.mark.parametrize("case", _CASES)
def test_the_validator_finds_nothing(case: str, modules: Path):
    assert_clean(_CASES[case], modules)


def test_the_validator_finds_nothing_in_the_troupe(modules: Path):
    assert_clean(embedded_motions()[0], modules)


@pytest.mark.parametrize("file", ["cmu/05_01.amc", "cmu/60_01.amc", "bandai/dance-short_normal_001.bvh"])
@pytest.mark.filterwarnings("ignore:AMC files store no frame rate")
def test_the_validator_finds_nothing_in_captured_motion(file: str, data: Path, modules: Path):
    found = next(data.rglob(Path(file).name))
    assert_clean(read_motion(found), modules)


def test_the_validator_would_find_something(modules: Path):
    glb = glb_bytes(swinging(person()))
    assert report(glb.replace(b'"version":"2.0"', b'"version":"9.0"'), modules)["issues"]["numErrors"] > 0
    damaged = bytearray(glb)
    damaged[-5000:] = rot.IDENTITY.tobytes()[:1] * 5000
    assert report(bytes(damaged), modules)["issues"]["messages"]
