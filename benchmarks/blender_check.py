"""Do BVH, GLB and USD files open right elsewhere?  Blender imports them headless; Khronos' validator reads the GLB.

    python benchmarks/blender_check.py [MOTION …]

writes each motion (without one: a dancer of the embedded troupe) in each format and prints what Blender sees beside
what was written. Needs ``blender`` (3 or later; another is named by ONBEAT_BLENDER), usd-core for USD; the validator is
used where ``npm ci`` was run in viewer-js, or ``npm i gltf-validator`` in the folder that ONBEAT_GLTF_VALIDATOR names.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from onbeat.examples import embedded_motions
from onbeat.formats import read_motion, write_motion
from onbeat.formats.usd.write import write_usd
from onbeat.motion import Motion

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from blender.opened import Seen, Wanted, blender, open_in_blender, seen_joints, worst_difference

LOOKS = 13
"""Frames looked at in each file, the first and the last among them."""
VALIDATE = """
const validator = require("gltf-validator"), fs = require("fs");
validator.validateBytes(new Uint8Array(fs.readFileSync(0))).then(r => console.log(JSON.stringify(r.issues)));
"""
HEADER = (
    f"{'file':28} {'bones':>5} {'seconds':>8} {'written':>8} {'height':>7} {'up':>3} {'lowest joint':>12} "
    f"{'lowest vertex':>13} {'worst difference':>16}"
)


def written(name: str, motion: Motion, folder: Path) -> list[Wanted]:
    """A motion as a file of each format."""
    frames = np.linspace(0, len(motion) - 1, LOOKS).astype(int).tolist()
    made = [Wanted(folder / f"{name}{suffix}", motion, frames) for suffix in (".bvh", ".glb", ".usdc")]
    for each in made[:2]:
        write_motion(motion, each.path)
    if importlib.util.find_spec("pxr") is None:
        return made[:2]
    write_usd(motion, made[2].path)
    return made


def row(wanted: Wanted, seen: Seen | None) -> str:
    """What Blender sees in one file."""
    if seen is None:
        return f"{wanted.path.name:28} this Blender is built without an importer for it"
    points = np.array(list(seen_joints(seen, wanted).values()))  # (bones, frames, 3)
    extent = np.ptp(points, axis=0)
    up = "xyz"[int(np.argmax(np.median(extent, axis=0)))]
    vertex = "" if seen.lowest is None else f"{100 * seen.lowest:.1f} cm"
    return (
        f"{wanted.path.name:28} {len(seen.heads):5d} {seen.seconds:8.3f} "
        f"{(len(wanted.motion) - 1) / wanted.motion.fps:8.3f} {extent[:, 2].max():5.2f} m {up:>3} "
        f"{100 * points[..., 2].min():9.1f} cm {vertex:>13} {1000 * worst_difference(seen, wanted):13.3f} mm"
    )


def validated(path: Path) -> str:
    """The validator's counts for a GLB file."""
    beside = Path(__file__).resolve().parents[1] / "viewer-js"
    modules = Path(os.environ.get("ONBEAT_GLTF_VALIDATOR", beside)) / "node_modules"
    if not (modules / "gltf-validator").is_dir():
        return "no gltf-validator found"
    words, environment = ["node", "-e", VALIDATE], os.environ | {"NODE_PATH": str(modules.resolve())}
    run = subprocess.run(words, input=path.read_bytes(), capture_output=True, check=True, env=environment)
    issues = json.loads(run.stdout)
    return ", ".join(f"{issues['num' + kind]} {kind.lower()}" for kind in ("Errors", "Warnings", "Infos", "Hints"))


def main() -> None:
    if blender() is None:
        sys.exit("blender is not installed (Debian: apt-get install blender python3-numpy)")
    motions = {Path(name).stem: read_motion(name) for name in sys.argv[1:]} or {"troupe": embedded_motions()[0]}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        wanted = [each for stem, motion in motions.items() for each in written(stem, motion, folder)]
        seen = open_in_blender(wanted, folder)
        print(HEADER)
        for each in wanted:
            print(row(each, seen.get(each.path.name)))
        for each in wanted:
            if each.path.suffix == ".glb":
                print(f"validator, {each.path.name}: {validated(each.path)}")


if __name__ == "__main__":
    main()
