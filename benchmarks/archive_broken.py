"""Motion files that are broken in as many ways as files of an archive are."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np

from onbeat.formats import read_motion, write_motion
from onbeat.motion import Motion


def _changed(motion: Motion, **arrays: np.ndarray) -> bytes:
    """The bytes of an ``.npz`` that says what a motion may not hold."""
    buffer, s = io.BytesIO(), motion.skeleton
    kept = {
        "onbeat_motion": np.array(1),
        "names": np.array(s.names),
        "parents": s.parents,
        "offsets": s.offsets,
        "end_sites": s.end_sites,
        "rotations": motion.rotations,
        "root_positions": motion.root_positions,
        "fps": np.array(motion.fps),
        "name": np.array(motion.name),
    }
    np.savez(buffer, **(kept | arrays))
    return buffer.getvalue()


def _with_nan(motion: Motion) -> bytes:
    rotations = np.array(motion.rotations)
    rotations[len(rotations) // 2, 3] = np.nan
    return _changed(motion, rotations=rotations)


def _bomb(motion: Motion) -> bytes:
    """A small file that says it holds 10¹² numbers."""
    buffer = io.BytesIO(_changed(motion))
    with zipfile.ZipFile(buffer, "a") as archive:
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(
            header, {"descr": "<f8", "fortran_order": False, "shape": (1_000_000, 250_000, 4)}
        )
        archive.writestr("translations.npy", header.getvalue())
    return buffer.getvalue()


def _without_legs(motion: Motion) -> bytes:
    s, kept = motion.skeleton, 5  # hips to head: no arms, either
    parts = {"names": np.array(s.names[:kept]), "parents": s.parents[:kept], "offsets": s.offsets[:kept]}
    return _changed(motion, **parts, end_sites=s.end_sites[:kept], rotations=motion.rotations[:, :kept])


def _bvh(motion: Motion, folder: Path) -> bytes:
    path = folder / ".made.bvh"
    write_motion(motion, path)
    data = path.read_bytes()
    path.unlink()
    return data


def _words(data: bytes) -> bytes:
    head, _, rows = data.partition(b"Frame Time")
    lines = rows.split(b"\n")
    lines[len(lines) // 2] = b"no numbers at all"
    return head + b"Frame Time" + b"\n".join(lines)


Way = Callable[[Motion, bytes, Path], tuple[str, bytes]]
WAYS: dict[str, Way] = {
    "empty": lambda motion, data, folder: ("npz", b""),
    "cut": lambda motion, data, folder: ("npz", data[: len(data) // 2]),
    "noise": lambda motion, data, folder: ("npz", np.random.default_rng(len(data)).bytes(len(data))),
    "nan": lambda motion, data, folder: ("npz", _with_nan(motion)),
    "long-quaternions": lambda motion, data, folder: ("npz", _changed(motion, rotations=3 * motion.rotations)),
    "bomb": lambda motion, data, folder: ("npz", _bomb(motion)),
    "objects": lambda motion, data, folder: ("npz", _changed(motion, fps=np.array([{"a": 1}], object))),
    "short": lambda motion, data, folder: ("npz", _changed(motion[:20])),
    "words": lambda motion, data, folder: ("bvh", _words(_bvh(motion, folder))),
    "half-tree": lambda motion, data, folder: ("bvh", _bvh(motion, folder)[:700]),
    "no-marks": lambda motion, data, folder: ("amc", b"#!OML:ASF\n:FULLY-SPECIFIED\n1\nroot 0 0 0\n"),
    "no-legs": lambda motion, data, folder: ("npz", _without_legs(motion)),
    "copy": lambda motion, data, folder: ("npz", data),
}
"""How a file is broken, by the word in its name: each gives a suffix and bytes."""


def write_broken(folder: Path, good: Sequence[Path], count: int) -> list[Path]:
    """Write broken files, as many of each way; they are made of good ones."""
    folder.mkdir(parents=True, exist_ok=True)
    made: list[Path] = []
    for n, (way, source) in enumerate(zip(cycle(WAYS), cycle(good), strict=False)):
        if n == count:
            return made
        suffix, data = WAYS[way](read_motion(source), source.read_bytes(), folder)
        path = folder / f"{way}-{n:05}.{suffix}"
        path.write_bytes(data)
        made.append(path)
    return made
