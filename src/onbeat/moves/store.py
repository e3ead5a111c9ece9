"""A library on disk: a manifest and arrays that are mapped into memory.

The arrays lie in a sub-folder named by their content. It is written first, the manifest is renamed into place after
it, and older sub-folders go last: a reader sees the old library or the new one, and a build that was stopped leaves the
old one as it was. Nothing is ever unpickled.
"""

from __future__ import annotations

import hashlib
import io
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from onbeat._shapes import Float32, Ints
from onbeat.errors import FormatError, LibraryError, OnbeatError
from onbeat.files import write_atomically
from onbeat.motion.motion import Motion
from onbeat.moves import manifest as documents
from onbeat.moves.graph import MotionGraph
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.moves.lock import StorageError
from onbeat.moves.manifest import Manifest

MANIFEST = "library.json"
_DATA = "data-"
_NAMES = (
    "rotations",
    "root_positions",
    "stops",
    "keyposes",
    "intensity",
    "poses",
    "first",
    "second",
    "distance",
    "indptr",
    "targets",
    "costs",
)
Arrays = Mapping[str, np.ndarray]
Pairs = tuple[Ints, Ints, Float32]


def is_library(folder: Path) -> bool:
    """Whether a folder holds a library."""
    return (folder / MANIFEST).is_file()


def open_library(folder: str | os.PathLike[str]) -> MoveLibrary:
    """Open a library that was built.

    Raises
    ------
    LibraryError
        If there is none, or it is damaged or of another version: then it is to be built again.
    """
    found, arrays = read_stored(Path(folder))
    return library_from(found, arrays)


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a library's folder."""
    path = folder / MANIFEST
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise LibraryError(f"no library in {folder}; build one with `onbeat moves build FOLDER -o {folder}`") from None
    except OSError as error:
        raise LibraryError(f"cannot read {path}: {error.strerror or error}") from None
    return documents.decode(data, str(path))


def read_stored(folder: Path) -> tuple[Manifest, Arrays]:
    """Manifest and arrays, checked against each other; read again where a builder has just replaced them."""
    found = read_manifest(folder)
    try:
        return found, _mapped(folder, found)
    except LibraryError:
        newer = read_manifest(folder)
        if newer.data == found.data:
            raise
        return newer, _mapped(folder, newer)


def _mapped(folder: Path, found: Manifest) -> Arrays:
    arrays: dict[str, np.ndarray] = {}
    for name in _NAMES:
        path = folder / found.data / f"{name}.npy"
        try:
            # not `mmap_mode` of an empty array, which cannot be mapped
            arrays[name] = np.asarray(np.load(path, mmap_mode="r" if path.stat().st_size > 4096 else None))
        except (OSError, ValueError, EOFError) as error:
            raise LibraryError(f"{path} is missing or damaged ({error}); build the library again") from None
    _check(folder, found, arrays)
    return arrays


def _check(folder: Path, found: Manifest, arrays: Arrays) -> None:
    joints, clips = len(found.skeleton.names), found.clips
    frames, poses = sum(clip.frames for clip in clips), sum(clip.poses for clip in clips)
    pairs, joins = len(arrays["first"]), len(arrays["targets"])
    expected: dict[str, tuple[str, tuple[int, ...]]] = {
        "rotations": ("f8", (frames, joints, 4)),
        "root_positions": ("f8", (frames, 3)),
        "stops": ("f8", (sum(clip.stops for clip in clips),)),
        "keyposes": ("f8", (sum(clip.keyposes for clip in clips),)),
        "intensity": ("f8", (poses,)),
        "poses": ("f4", (poses, arrays["poses"].shape[-1])),
        "first": ("i8", (pairs,)),
        "second": ("i8", (pairs,)),
        "distance": ("f4", (pairs,)),
        "indptr": ("i8", (poses + 1,)),
        "targets": ("i8", (joins,)),
        "costs": ("f4", (joins,)),
    }
    for name, (kind, shape) in expected.items():
        array = arrays[name]
        if array.shape != shape or array.dtype != np.dtype(kind):
            raise LibraryError(
                f"{folder / found.data / name}.npy holds {array.dtype} {array.shape}, {np.dtype(kind)} {shape} is "
                "expected; build the library again"
            )
    if arrays["indptr"][-1] != joins or (joins and not 0 <= arrays["targets"].min() <= arrays["targets"].max() < poses):
        raise LibraryError(f"{folder / found.data}: joins lead to frames that are not there; build the library again")


def library_from(found: Manifest, arrays: Arrays) -> MoveLibrary:
    """The library that manifest and arrays describe."""
    clips = stored_clips(found, arrays)
    clip_of = np.repeat(np.arange(len(clips)), [clip.poses for clip in found.clips])
    graph = MotionGraph(clip_of, *(np.array(arrays[name]) for name in ("indptr", "targets", "costs")))
    return MoveLibrary(
        tuple(clips), graph, tuple(f"{p.file}: {p.reason}" for p in found.problems), tuple(notes_of(found))
    )


def notes_of(found: Manifest) -> list[str]:
    """What readers warned of, each warning once with the number of files."""
    files: dict[str, list[str]] = {}
    for clip in found.clips:
        for note in clip.notes if not clip.mirrored else []:
            files.setdefault(note, []).append(clip.file)
    return [f"{names[0] if len(names) == 1 else f'{len(names)} files'}: {note}" for note, names in files.items()]


def stored_clips(found: Manifest, arrays: Arrays) -> list[Clip]:
    """The clips of a library, in order; a ``LibraryError`` says if they are damaged."""
    try:
        return _clips(found, arrays)
    except FormatError as error:
        raise LibraryError(f"the library is damaged ({error}); build it again") from None


def _clips(found: Manifest, arrays: Arrays) -> list[Clip]:
    skeleton = found.skeleton.skeleton()
    clips: list[Clip] = []
    frame = pose = stop = key = 0
    for row in found.clips:
        moves, steps = slice(frame, frame + row.frames), slice(pose, pose + row.poses)
        motion = Motion(skeleton, arrays["rotations"][moves], arrays["root_positions"][moves], row.fps, row.name)
        stops = arrays["stops"][stop : stop + row.stops]
        keyposes = arrays["keyposes"][key : key + row.keyposes]
        intensity, poses = arrays["intensity"][steps], arrays["poses"][steps]
        clips.append(Clip(motion, row.name, row.source, row.mirrored, stops, intensity, poses, keyposes))
        frame, pose, stop, key = frame + row.frames, pose + row.poses, stop + row.stops, key + row.keyposes
    return clips


def arrays_of(clips: Sequence[Clip], pairs: Pairs, graph: MotionGraph) -> dict[str, np.ndarray]:
    """The arrays of a library that is to be stored."""
    first, second, distance = pairs
    parts: dict[str, Any] = {
        "rotations": np.concatenate([clip.motion.rotations for clip in clips]),
        "root_positions": np.concatenate([clip.motion.root_positions for clip in clips]),
        "stops": np.concatenate([clip.stops for clip in clips]).astype(np.float64),
        "keyposes": np.concatenate([clip.keyposes for clip in clips]).astype(np.float64),
        "intensity": np.concatenate([clip.intensity for clip in clips]),
        "poses": np.concatenate([clip.poses for clip in clips]),
        "first": first,
        "second": second,
        "distance": distance,
        "indptr": graph.indptr,
        "targets": graph.targets,
        "costs": graph.costs,
    }
    return parts


def content_name(arrays: Arrays) -> str:
    """The name of the sub-folder of these arrays."""
    total = hashlib.sha256()
    for name in _NAMES:
        total.update(f"{name} {arrays[name].dtype.str} {arrays[name].shape}".encode())
        total.update(np.ascontiguousarray(arrays[name]).data)
    return _DATA + total.hexdigest()[:16]


def write_library(folder: Path, found: Manifest, arrays: Arrays) -> None:
    """Put a library into place; to be called with the folder's lock held."""
    try:
        if not _is_there(folder, found):
            _write_arrays(folder / found.data, arrays)
        write_atomically(folder / MANIFEST, documents.encode(found))
    except OSError as error:
        raise StorageError(f"cannot write in {folder}: {error.strerror or error}; choose another folder") from None
    except OnbeatError as error:
        raise StorageError(str(error)) from None
    for old in folder.iterdir():
        stale = old.name.startswith((_DATA, f".{_DATA}")) and old.name != found.data
        if stale and old.is_dir() and not old.is_symlink():
            shutil.rmtree(old, ignore_errors=True)


def _is_there(folder: Path, found: Manifest) -> bool:
    """Whether the arrays are there already, whole: then they are left alone, for somebody may be reading them."""
    try:
        return content_name(_mapped(folder, found)) == found.data
    except LibraryError:
        return False


def _write_arrays(target: Path, arrays: Arrays) -> None:
    """Write the sub-folder whole or not at all; a damaged one that is there is replaced."""
    temporary = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        os.chmod(temporary, 0o755)
        for name in _NAMES:
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(arrays[name]), allow_pickle=False)
            (temporary / f"{name}.npy").write_bytes(buffer.getbuffer())
        if target.exists():
            shutil.rmtree(target)
        os.rename(temporary, target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
