"""``onbeat convert``: a motion file in another format."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Annotated, Literal

import cyclopts
import numpy as np

from onbeat.errors import FormatError
from onbeat.formats import Convention, read_motion, write_motion
from onbeat.formats.asfamc import RateWarning
from onbeat.motion import Motion
from onbeat.motion.mirror import mirrored
from onbeat.motion.retarget import retarget


def convert_command(
    source: Annotated[Path, cyclopts.Parameter(name=["SOURCE"], help="A .bvh, .amc (.asf beside it) or .npz file.")],
    target: Annotated[Path, cyclopts.Parameter(name=["TARGET"], help="The .bvh, .glb or .npz file to write.")],
    /,
    *,
    fps: Annotated[float | None, cyclopts.Parameter(help="Frames a second of the new file.")] = None,
    source_fps: Annotated[
        float | None, cyclopts.Parameter(help="The rate of SOURCE, where it stores none (AMC) or a wrong one.")
    ] = None,
    up: Annotated[Literal["y", "z"] | None, cyclopts.Parameter(help="Up axis of a BVH file; y by default.")] = None,
    unit: Annotated[Literal["m", "cm"] | None, cyclopts.Parameter(help="Unit of a BVH file; cm by default.")] = None,
    like: Annotated[Path | None, cyclopts.Parameter(help="Move it over to the skeleton of this motion file.")] = None,
    mirror: Annotated[bool, cyclopts.Parameter(negative="", help="Left becomes right.")] = False,
) -> None:
    """Convert a motion file: BVH, ASF/AMC or npz in, BVH, GLB or npz out."""
    for rate in (fps, source_fps):
        if rate is not None and not 0.1 <= rate <= 10000:
            raise FormatError(f"{rate} frames a second cannot be; give a rate from 0.1 to 10000")
    convention = None if up is None and unit is None else Convention(up or "y", unit or "cm")
    motion = _read(source, source_fps)
    if like is not None:
        other = _read(like, None)
        motion = retarget(motion, other.skeleton, other)
    motion = mirrored(motion) if mirror else motion
    motion = motion if fps is None else motion.resampled(fps)
    write_motion(motion, target, convention)
    print(f"{target}: {_described(motion)}", file=sys.stderr)  # noqa: T201


def _read(path: Path, fps: float | None) -> Motion:
    """Read; an assumed rate is told in one line on stderr."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", RateWarning)
        motion = read_motion(path, fps)
    for warning in noted:
        print(f"onbeat: {path.name}: {warning.message}", file=sys.stderr)  # noqa: T201
    return motion


def _described(motion: Motion) -> str:
    height = float(np.percentile(np.ptp(motion.positions[..., 2], axis=1), 90))
    return (
        f"{len(motion)} frames, {motion.duration:.2f} s at {motion.fps:g} frames a second, "
        f"{len(motion.skeleton)} joints, {height:.2f} m tall"
    )
