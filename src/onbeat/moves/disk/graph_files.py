"""The graph of a library on disk: ``graph-HASH/`` with ``indptr.npy``, ``targets.npy`` and ``costs.npy``.

A folder is written under another name and renamed when it is whole, and never changed again.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from onbeat._shapes import Float32, Ints
from onbeat.errors import LibraryError
from onbeat.moves.graph import MotionGraph

PREFIX = "graph-"
KINDS = {"indptr": "<i8", "targets": "<i8", "costs": "<f4"}
LOOKED_AT = 1 << 22
"""Joins up to which each is looked at when a graph is opened; beyond, ``moves verify`` does it."""
Joins = tuple[Ints, Float32]


def write_graph(folder: Path, indptr: Ints, parts: Callable[[], Iterable[Joins]], seal: str) -> str:
    """Write a graph, targets and costs in parts in order; its name follows from its bytes and ``seal``."""
    temporary = Path(tempfile.mkdtemp(prefix=f".{PREFIX}", dir=folder))
    try:
        total = hashlib.sha256(seal.encode())
        joins = int(indptr[-1])
        _write(temporary / "indptr.npy", "<i8", len(indptr), iter([indptr]), total.update)
        _write(temporary / "targets.npy", "<i8", joins, (targets for targets, _ in parts()), total.update)
        _write(temporary / "costs.npy", "<f4", joins, (costs for _, costs in parts()), total.update)
        name = PREFIX + total.hexdigest()[:16]
        os.chmod(temporary, 0o755)
        if _is_whole(folder / name, len(indptr) - 1):
            return name  # somebody may be reading it
        shutil.rmtree(folder / name, ignore_errors=True)
        os.rename(temporary, folder / name)
        return name
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _write(path: Path, kind: str, count: int, parts: Iterator[np.ndarray], add: Callable[[memoryview], None]) -> None:
    with path.open("wb") as file:
        header = {"descr": kind, "fortran_order": False, "shape": (count,)}
        np.lib.format.write_array_header_1_0(file, header)
        for part in parts:
            data = np.ascontiguousarray(part, np.dtype(kind)).data
            add(data)
            file.write(data)
        file.flush()
        os.fsync(file.fileno())


def graph_digest(folder: Path, name: str, seal: str) -> str:
    """The name that a graph's bytes give."""
    total = hashlib.sha256(seal.encode())
    for array in _mapped(folder / name).values():
        for start in range(0, len(array), 1 << 20):
            total.update(np.ascontiguousarray(array[start : start + (1 << 20)]).data)
    return PREFIX + total.hexdigest()[:16]


def _is_whole(path: Path, frames: int) -> bool:
    try:
        _checked(path, frames)
    except LibraryError:
        return False
    return True


def open_graph(folder: Path, name: str, clip_of: Ints) -> MotionGraph:
    """The graph of a library, mapped; a ``LibraryError`` says if it is missing, damaged or leads nowhere."""
    if not name.startswith(PREFIX) or not name.removeprefix(PREFIX).isalnum():
        raise LibraryError(f"the index in {folder} is damaged (graph {name!r}); build the library again")
    arrays = _checked(folder / name, len(clip_of))
    return MotionGraph(clip_of, arrays["indptr"], arrays["targets"], arrays["costs"])


def _checked(path: Path, frames: int) -> dict[str, np.ndarray]:
    arrays = _mapped(path)
    indptr, targets = arrays["indptr"], arrays["targets"]
    expected = {"indptr": frames + 1, "targets": len(targets), "costs": len(targets)}
    for name, array in arrays.items():
        if array.shape != (expected[name],) or array.dtype != np.dtype(KINDS[name]):
            raise LibraryError(
                f"{path / name}.npy holds {array.dtype} {array.shape}, {np.dtype(KINDS[name])} ({expected[name]},) is "
                "expected; build the library again"
            )
    if indptr[0] != 0 or indptr[-1] != len(targets) or np.any(np.diff(indptr) < 0):
        raise LibraryError(f"{path}: the rows of joins are damaged; build the library again")
    if len(targets) <= LOOKED_AT and not lead_somewhere(targets, frames):
        raise LibraryError(f"{path}: joins lead to frames that are not there; build the library again")
    return arrays


def lead_somewhere(targets: Ints, frames: int) -> bool:
    """Whether all joins lead to frames that are there."""
    return not len(targets) or bool(0 <= targets.min() <= targets.max() < frames)


def _mapped(path: Path) -> dict[str, np.ndarray]:
    arrays: dict[str, np.ndarray] = {}
    for name in KINDS:
        file = path / f"{name}.npy"
        try:
            # not `mmap_mode` of an empty array, which cannot be mapped
            array = np.asarray(np.load(file, mmap_mode="r" if file.stat().st_size > 4096 else None))
        except (OSError, ValueError, EOFError) as error:
            raise LibraryError(f"{file} is missing or damaged ({error}); build the library again") from None
        array.setflags(write=False)
        arrays[name] = array
    return arrays


def drop_graphs(folder: Path, kept: str) -> None:
    """Delete the graphs of former generations, and what builders that were stopped left of theirs."""
    for path in folder.iterdir():
        stale = path.name.startswith((PREFIX, f".{PREFIX}")) and path.name != kept
        if stale and path.is_dir() and not path.is_symlink():
            with contextlib.suppress(OSError):
                shutil.rmtree(path)
