"""What Blender sees in motion files: a script for Blender, ``blender -b -P inside_blender.py -- JOBS``.

JOBS is a JSON file, a list of ``{"path": …, "times": [seconds, …], "rate": …, "scale": …}``. ``scale`` is what a user
sets in the importer of BVH files, 0.01 for one in centimetres; ``rate`` the frames a second that a user gives the scene
before a USD file, whose time codes become frames. One line ``SEEN {…}`` comes out for each.
"""

from __future__ import annotations

import json
import sys
from typing import Any

USD = (".usda", ".usdc", ".usd", ".usdz")


def mend_importers() -> None:
    """Blender 3.4's importers on the Python 3.11 and NumPy 1.24 that Debian gives it: they use what is gone there."""
    import builtins

    import numpy

    if "bool" not in vars(numpy):
        numpy.bool = bool
    plain_open = builtins.open
    builtins.open = lambda file, mode="r", *a, **k: plain_open(file, mode.replace("U", ""), *a, **k)


def load(bpy: Any, path: str, scale: float, rate: float) -> None:
    """Into an empty scene, as File > Import does, with all else as it comes."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=path, global_scale=scale, update_scene_fps=True, update_scene_duration=True)
    elif path.endswith(USD):
        render = bpy.context.scene.render
        render.fps = max(1, round(rate))
        render.fps_base = render.fps / rate
        bpy.ops.wm.usd_import(filepath=path)
    else:
        bpy.ops.import_scene.gltf(filepath=path)


def lowest_point(bpy: Any) -> float | None:
    """The lowest vertex of the moved body in the present frame; None where there is no mesh."""
    seen, scene = bpy.context.evaluated_depsgraph_get(), bpy.context.scene
    lowest = []
    for thing in bpy.data.objects:
        # The importer of glTF makes a ball to draw bones with; it hangs on no armature.
        if thing.type == "MESH" and scene.objects.get(thing.name) and thing.find_armature():
            moved = thing.evaluated_get(seen)
            lowest += [(moved.matrix_world @ vertex.co).z for vertex in moved.data.vertices]
    return min(lowest, default=None)


def seen(bpy: Any, job: dict[str, Any]) -> dict[str, Any]:
    """Rate, seconds from the first to the last frame, bones, and where they are at the times asked for."""
    load(bpy, job["path"], job["scale"], job["rate"])
    scene = bpy.context.scene
    body = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    first, last = body.animation_data.action.frame_range
    rate = scene.render.fps / scene.render.fps_base
    found: dict[str, Any] = {"heads": [], "tails": [], "lowest": []}
    for time in job["times"]:
        frame = first + time * rate
        whole = int(frame + 1e-4)
        scene.frame_set(whole, subframe=max(frame - whole, 0.0))
        found["heads"].append([list(body.matrix_world @ bone.head) for bone in body.pose.bones])
        found["tails"].append([list(body.matrix_world @ bone.tail) for bone in body.pose.bones])
        found["lowest"].append(lowest_point(bpy))
    names = [bone.name for bone in body.pose.bones]
    return {"path": job["path"], "rate": rate, "seconds": (last - first) / rate, "names": names, **found}


def main() -> None:
    import bpy

    if bpy.app.version < (4, 0):
        mend_importers()
    with open(sys.argv[-1], encoding="utf-8") as file:
        jobs = json.load(file)
    for job in jobs:
        # Debian's Blender is built without USD.
        if bpy.app.build_options.usd or not job["path"].endswith(USD):
            print("SEEN", json.dumps(seen(bpy, job)), flush=True)


if __name__ == "__main__":
    main()
