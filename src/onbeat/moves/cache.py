"""Libraries that are kept for the next time, for users who never think of building one."""

from __future__ import annotations

import contextlib
import hashlib
import os
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import platformdirs

from onbeat.errors import OnbeatError
from onbeat.motion.motion import Motion
from onbeat.moves.build import assemble, build_recordings
from onbeat.moves.disk.lock import StorageError
from onbeat.moves.engine import Engine
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.generations import Options
from onbeat.moves.making.steps import Step
from onbeat.moves.methods import method_digest
from onbeat.moves.recordings import Recording, find_recordings, motion_digest
from onbeat.moves.store import is_library, open_library, read_stored


class CacheWarning(UserWarning):
    """A library could not be kept, and will be built again the next time."""


def cache_folder() -> Path:
    """Where libraries are kept: ``ONBEAT_CACHE``, or the user's cache folder."""
    chosen = os.environ.get("ONBEAT_CACHE")
    return (Path(chosen) if chosen else Path(platformdirs.user_cache_dir("onbeat"))) / "libraries"


def build_or_open(
    paths: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    cache: Path | None = None,
    *,
    mirror: bool = True,
    fps: float | None = None,
    step: Step | None = None,
    workers: int = 2,
) -> MoveLibrary:
    """The library at a path: one that was built, or one built now of a folder or file of motion and kept.

    Parameters
    ----------
    paths : a library's folder (options are then not used), or motion files and folders of them.
    cache : folder in which libraries are kept; by default :func:`cache_folder`.
    mirror, fps, step, workers : as of ``build.build_library``.

    Raises
    ------
    LibraryError
        If there is no good motion or the library is damaged. A cache that cannot be written is only warned of
        (``CacheWarning``).
    """
    places = [Path(paths)] if isinstance(paths, str | os.PathLike) else [Path(path) for path in paths]
    if len(places) == 1 and is_library(places[0]):
        return open_library(places[0])
    key = repr(([str(place.resolve()) for place in places], mirror, fps))
    recordings = find_recordings(places, fps)
    return _kept(recordings, _folder(key, cache), Options(mirror, fps), step, workers)


def build_from(
    motions: Callable[[], Sequence[Motion]],
    key: str,
    cache: Path | None = None,
    *,
    mirror: bool = True,
    step: Step | None = None,
    workers: int = 2,
) -> MoveLibrary:
    """The library of motions that a program makes, kept under a key that names them whole (version and seed, say).

    Parameters
    ----------
    motions : makes them; called only if the library is not kept yet. Their names name the clips.
    key : other motions must have another key.
    """
    folder = _folder(repr((key, mirror)), cache)
    with contextlib.suppress(OnbeatError):
        if is_library(folder) and read_stored(folder).generation.method == method_digest():
            return open_library(folder)
    recordings = [Recording(m.name, m.name, motion_digest(m), partial(_same, m)) for m in motions()]
    return _kept(recordings, folder, Options(mirror), step, workers)


def _same(motion: Motion) -> Motion:
    return motion


def _folder(key: str, cache: Path | None) -> Path:
    return (cache or cache_folder()) / hashlib.sha256(key.encode()).hexdigest()[:16]


def _kept(
    recordings: Sequence[Recording], folder: Path, options: Options, step: Step | None, workers: int
) -> MoveLibrary:
    """Build in the cache, or in memory where that cannot be."""
    try:
        return build_recordings(recordings, folder, options, step=step, engine=Engine(workers=workers))
    except StorageError as error:
        reason = str(error).replace("choose another folder", "set ONBEAT_CACHE to another folder")
        warnings.warn(f"the library is not kept for the next time: {reason}", CacheWarning, stacklevel=3)
    return assemble(recordings, options, step=step)
