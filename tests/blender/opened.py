"""Opens motion files in Blender, all in one process, and tells what is seen there.

``blender`` is the program, or the one that ONBEAT_BLENDER names.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat.formats.usd.write import joint_paths
from onbeat.motion import Motion

INSIDE = Path(__file__).with_name("inside_blender.py")
CENTIMETRES = 0.01
"""The scale of Blender's BVH importer for a file in centimetres; 1, where it stands, is for metres."""


class Wanted(NamedTuple):
    """A file to open, the motion that was written to it, and the frames to look at."""

    path: Path
    motion: Motion
    frames: Sequence[int]
    scale: float = CENTIMETRES
    """What is typed as the scale of the BVH importer."""


class Seen(NamedTuple):
    """What Blender sees in a file, in metres."""

    rate: float
    seconds: float
    heads: dict[str, np.ndarray]
    """Each bone's start at each frame looked at, (T, 3)."""
    tails: dict[str, np.ndarray]
    lowest: float | None
    """The lowest vertex in all frames looked at; None for files without a body."""


def blender() -> str | None:
    """The Blender to use, if there is one."""
    return os.environ.get("ONBEAT_BLENDER") or shutil.which("blender")


def open_in_blender(wanted: Sequence[Wanted], folder: Path) -> dict[str, Seen]:
    """What Blender sees in each file, by the file's name; a file it has no importer for is left out."""
    jobs = folder / "jobs.json"
    jobs.write_text(json.dumps([_job(each) for each in wanted]))
    words = [blender() or "blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", str(INSIDE)]
    run = subprocess.run([*words, "--", str(jobs)], capture_output=True, text=True, timeout=900, check=False)
    if run.returncode:
        raise RuntimeError(f"Blender could not read what was written:\n{(run.stdout + run.stderr)[-3000:]}")
    found = [json.loads(line[5:]) for line in run.stdout.splitlines() if line.startswith("SEEN ")]
    return {Path(each["path"]).name: _seen(each) for each in found}


def _job(wanted: Wanted) -> dict:
    times = [frame / wanted.motion.fps for frame in wanted.frames]
    return {"path": str(wanted.path), "times": times, "rate": wanted.motion.fps, "scale": wanted.scale}


def _seen(found: dict) -> Seen:
    def places(key: str) -> dict[str, np.ndarray]:
        return dict(zip(found["names"], np.array(found[key]).swapaxes(0, 1), strict=True))

    lowest = [z for z in found["lowest"] if z is not None]
    return Seen(found["rate"], found["seconds"], places("heads"), places("tails"), min(lowest, default=None))


def bone_names(wanted: Wanted) -> list[str]:
    """The name that each joint has in a file: BVH has no spaces in names, USD only letters, digits and underscores."""
    names = wanted.motion.skeleton.names
    if wanted.path.suffix == ".bvh":
        return [name.replace(" ", "_") for name in names]
    return (
        list(names) if wanted.path.suffix == ".glb" else [p.split("/")[-1] for p in joint_paths(wanted.motion.skeleton)]
    )


def seen_joints(seen: Seen, wanted: Wanted) -> dict[int, np.ndarray]:
    """(T, 3) Blender's place of each joint; an End Site of a BVH file is the tail of the bone that it ends."""
    skeleton, names = wanted.motion.skeleton, bone_names(wanted)
    found = {joint: seen.heads[name] for joint, name in enumerate(names) if name in seen.heads}
    for joint in set(range(len(skeleton))) - set(found):
        parent = int(skeleton.parents[joint])
        # An importer gives a bone that would have no length a length.
        if len(skeleton.children[parent]) == 1 and skeleton.bone_lengths[joint] > 0.01:
            found[joint] = seen.tails[names[parent]]
    return found


def worst_difference(seen: Seen, wanted: Wanted) -> float:
    """Metres, the largest distance of a joint in Blender from where the motion has it."""
    ours = wanted.motion.positions[list(wanted.frames)]
    found = seen_joints(seen, wanted)
    return max(float(np.linalg.norm(at - ours[:, joint], axis=1).max()) for joint, at in found.items())
