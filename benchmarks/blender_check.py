"""Do BVH and GLB files open right elsewhere?  Blender imports them headless; Khronos' validator reads the GLB.

    python benchmarks/blender_check.py [MOTION]

prints height, seconds and up axis as Blender sees them beside what onbeat wrote, and the validator's counts. Needs
``blender`` (3 or later); the validator is used where ``npm i gltf-validator`` was run in the current folder.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from onbeat.formats import read_motion, write_motion
from onbeat.motion import Motion

INSIDE = r"""
import builtins, json, sys
import bpy, numpy
numpy.bool = bool  # importers of Blender 3.4 on today's Python and NumPy
plain_open = builtins.open
builtins.open = lambda file, mode="r", *a, **k: plain_open(file, mode.replace("U", ""), *a, **k)
path = sys.argv[-1]
bpy.ops.wm.read_factory_settings(use_empty=True)
if path.endswith(".bvh"):
    bpy.ops.import_anim.bvh(filepath=path, global_scale=0.01, update_scene_fps=True, update_scene_duration=True)
else:
    bpy.ops.import_scene.gltf(filepath=path)
scene = bpy.context.scene
body = next(o for o in bpy.data.objects if o.type == "ARMATURE")
first, last = body.animation_data.action.frame_range
rate = scene.render.fps / scene.render.fps_base
heads = []
for frame in (first, last):
    scene.frame_set(int(frame), subframe=frame % 1)
    heads.append([list(body.matrix_world @ bone.head) for bone in body.pose.bones])
print("SEEN", json.dumps({"seconds": (last - first) / rate, "rate": rate, "bones": len(heads[0]), "heads": heads}))
"""
VALIDATE = """
const v = require("gltf-validator"), fs = require("fs");
v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(r => console.log(JSON.stringify(r.issues)));
"""


def seen(path: Path) -> dict:
    """What Blender says of a file."""
    script = path.with_suffix(".inside.py")
    script.write_text(INSIDE)
    words = ["blender", "-b", "--python-exit-code", "1", "-P", str(script), "--", str(path)]
    output = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False).stdout
    lines = [line for line in output.splitlines() if line.startswith("SEEN ")]
    if not lines:
        sys.exit(f"Blender could not read {path}:\n{output[-2000:]}")
    return json.loads(lines[0][5:])


def report(path: Path, motion: Motion) -> None:
    """One line: heights, seconds and the up axis, Blender's beside ours."""
    found = seen(path)
    theirs = np.array(found["heads"])
    ours = motion.positions  # a BVH importer makes no bones of End Sites
    if theirs.shape[1] < ours.shape[1]:
        ours = ours[:, ~motion.skeleton.end_sites]
    high, height = np.ptp(theirs[0], axis=0), np.ptp(ours[0], axis=0)
    off = max(np.abs(np.sort(theirs[k], 0)[[0, -1]] - np.sort(ours[k], 0)[[0, -1]]).max() for k in (0, -1))
    print(
        f"{path.suffix[1:].upper()}: height {high[2]:.3f} m (written {height[2]:.3f}), "
        f"{found['seconds']:.3f} s from first to last frame (written {(len(motion) - 1) / motion.fps:.3f}), "
        f"up axis {'xyz'[int(np.argmax(high))]}, {found['bones']} bones, largest difference {1000 * off:.1f} mm"
    )


def main() -> None:
    motion = read_motion(sys.argv[1]) if len(sys.argv) > 1 else _embedded()
    if shutil.which("blender") is None:
        sys.exit("blender is not installed (Debian: apt-get install blender python3-numpy)")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("a.bvh", "a.glb"):
            write_motion(motion, Path(folder, name))
            report(Path(folder, name), motion)
        if Path("node_modules/gltf-validator").is_dir():
            words = ["node", "-e", VALIDATE, str(Path(folder, "a.glb"))]
            issues = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
            kinds = ("Errors", "Warnings", "Infos", "Hints")
            print("validator:", ", ".join(f"{issues['num' + kind]} {kind.lower()}" for kind in kinds))


def _embedded() -> Motion:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
    from persons import person, swinging

    return swinging(person(), frames=90, fps=30, angle=0.3)


if __name__ == "__main__":
    main()
