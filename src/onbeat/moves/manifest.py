"""``library.json``: what is in the folder of a library; the arrays lie beside it.

Version 2. ``data`` names the sub-folder of arrays, NumPy ``.npy`` files without pickles. Clips follow each other in
them: clip k has ``frames`` rows of ``rotations`` (float64, J × 4, wxyz) and ``root_positions`` (float64, 3, metres),
``poses`` rows of ``poses`` (float32, D) and ``intensity`` (float64), ``stops`` rows of ``stops`` and ``keyposes`` rows
of ``keyposes`` (float64, seconds). ``first``, ``second`` (int64) and ``distance`` (float32) are the close pairs of
graph frames, counted over all clips; ``indptr``, ``targets`` (int64) and ``costs`` (float32) the joins made of them, as
of ``graph.MotionGraph``.
"""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Literal

import msgspec

from onbeat.errors import LibraryError
from onbeat.motion.skeleton import Skeleton

FORMAT = "onbeat library"
VERSION = 2


class Clips(msgspec.Struct, forbid_unknown_fields=True):
    """One clip.

    Parameters
    ----------
    name, source, mirrored : as of ``library.Clip``.
    file : its motion file, relative to the folder that was given.
    sha256 : of the file's content.
    body, seconds, notes : of the recording, as of ``clips.Read``.
    fps : of the stored motion.
    frames, poses, stops, keyposes : how many rows it has in the arrays.
    """

    name: str
    source: int
    mirrored: bool
    file: str
    sha256: str
    body: str
    seconds: float
    notes: list[str]
    fps: float
    frames: int
    poses: int
    stops: int
    keyposes: int


class Body(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """A skeleton.

    Parameters
    ----------
    names, parents, offsets, end_sites : as of ``Skeleton``.
    roles : what is told of its joints, role to joint name; left out where nothing is.
    """

    names: list[str]
    parents: list[int]
    offsets: list[tuple[float, float, float]]
    end_sites: list[bool]
    roles: dict[str, str] = {}  # msgspec copies it

    @classmethod
    def of(cls, skeleton: Skeleton) -> Body:
        """Lists of a skeleton's arrays."""
        s, offsets = skeleton, [tuple(row) for row in skeleton.offsets.tolist()]
        return cls(list(s.names), s.parents.tolist(), offsets, s.end_sites.tolist(), dict(s.roles))

    def skeleton(self) -> Skeleton:
        """The skeleton, exact to the last bit."""
        return Skeleton(self.names, self.parents, self.offsets, self.end_sites, roles=self.roles)


class Problem(msgspec.Struct, forbid_unknown_fields=True):
    """A file that is not in the library, and why."""

    file: str
    sha256: str
    reason: str


class Manifest(msgspec.Struct, forbid_unknown_fields=True):
    """All that a library is besides its arrays.

    Parameters
    ----------
    method : of the code by which clips and joins were made (see :func:`method_digest`).
    mirror, fps : the options of the build.
    reference : what all clips depend on, as of ``clips.Stage``.
    """

    method: str
    mirror: bool
    fps: float | None
    reference: str
    skeleton: Body
    clips: list[Clips]
    problems: list[Problem]
    data: str
    format: Literal["onbeat library"] = FORMAT
    version: int = VERSION


class _Version(msgspec.Struct):
    format: str = ""
    version: int = 0


def decode(data: bytes, where: str) -> Manifest:
    """Read a manifest; a ``LibraryError`` says what is wrong with it and to build it again."""
    try:
        found = msgspec.json.decode(data, type=_Version)
        if found.format != FORMAT:
            raise LibraryError(f"{where} is not the manifest of a library; build the library again")
        if found.version != VERSION:
            raise LibraryError(f"{where} is of version {found.version}, {VERSION} is expected; build the library again")
        return msgspec.json.decode(data, type=Manifest)
    except msgspec.DecodeError as error:
        raise LibraryError(f"{where} is damaged ({error}); build the library again") from None


def encode(manifest: Manifest) -> bytes:
    """The same manifest gives the same bytes."""
    return msgspec.json.format(msgspec.json.encode(manifest), indent=1) + b"\n"


@cache
def method_digest() -> str:
    """A digest of the code that reads motion and makes clips and joins: what other code made is not mixed with it."""
    root = Path(__file__).parents[1]
    total = hashlib.sha256(version("onbeat").encode())
    for room in ("formats", "motion", "keyposes", "moves"):
        for file in sorted((root / room).glob("*.py")):
            total.update(file.read_bytes())
    return total.hexdigest()[:16]
