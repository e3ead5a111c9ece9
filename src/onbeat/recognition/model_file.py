"""A recogniser as a file: arrays in one npz, what they are in a JSON header inside it. Nothing is ever unpickled."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.recognition.choice import Choice, Option
from onbeat.recognition.features import ELASTIC, FLAT, NEEDED
from onbeat.recognition.joined_sides import JoinedSides
from onbeat.recognition.novelty import Novelty
from onbeat.recognition.recogniser import Across, Expert, Learned, Recogniser
from onbeat.recognition.subspace import Basis, Subspace

FORMAT, VERSION = "onbeat recogniser", 2
READ = (1, 2)
"""Versions that are read; in 1 nothing was learned of tasks by new persons."""
LARGEST = 1 << 30
"""Bytes of all arrays together; more is not read."""
_FARTHEST, _LARGEST = 1e15, 1e50  # of places, and of any number
_HEADER = "header"
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the same arrays make the same bytes


_Moderate = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
_Positive = Annotated[float, msgspec.Meta(ge=0, le=1e9)]


class _View(msgspec.Struct, forbid_unknown_fields=True):
    view: str
    shrinkage: _Positive
    scale: Annotated[float, msgspec.Meta(gt=1e-12, le=1e12)]


class _Factor(msgspec.Struct, forbid_unknown_fields=True):
    names: Annotated[list[str], msgspec.Meta(min_length=1)]
    views: Annotated[list[_View], msgspec.Meta(min_length=1)]
    threshold: _Moderate | None
    slope: _Moderate
    sharpness: _Positive
    accuracy: float | None
    auroc: float | None


class _Header(msgspec.Struct):
    format: str
    version: int
    elements: list[str]
    moments: Annotated[int, msgspec.Meta(ge=3)]
    mirrored: Literal["apart", "joined"] = "apart"
    task: _Factor | None = None
    person: _Factor | None = None
    task_across: _Factor | None = None
    person_across: _Factor | None = None


_PARTS = ("task", "person", "task_across", "person_across")


def save_recogniser(recogniser: Recogniser, path: str | os.PathLike[str]) -> None:
    """Write a recogniser; the same one gives the same bytes.

    Raises
    ------
    OnbeatError
        If the file cannot be written; what was there before is kept.
    """
    arrays: dict[str, np.ndarray] = {}
    experts = (recogniser.task, recogniser.person, *recogniser.across)
    factors = {name: _packed(name, expert, arrays) for name, expert in zip(_PARTS, experts, strict=True)}
    sides = "joined" if isinstance(recogniser, JoinedSides) else "apart"
    header = _Header(FORMAT, VERSION, list(recogniser.elements), recogniser.moments, sides, **factors)
    arrays = {_HEADER: np.frombuffer(msgspec.json.encode(header), np.uint8), **arrays}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in arrays.items():
            inner = io.BytesIO()
            np.lib.format.write_array(inner, np.ascontiguousarray(values), allow_pickle=False)
            info = zipfile.ZipInfo(f"{name}.npy", _EPOCH)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, inner.getvalue())
    write_atomically(path, buffer.getvalue())


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _packed(factor: str, expert: Expert | None, arrays: dict[str, np.ndarray]) -> _Factor | None:
    if expert is None:
        return None
    choice = expert.choice
    for number, one in enumerate(expert.learned):
        parts: dict[str, np.ndarray | None] = {"references": one.references, "classes": one.classes}
        if one.basis is not None and one.subspace is not None:
            parts = {"mean": one.basis.mean, "directions": one.basis.directions, "centres": one.subspace.centres}
            parts |= {"whitener": one.subspace.whitener, "outside": np.array([one.subspace.outside])}
        arrays.update({f"{factor}{number}_{name}": part for name, part in parts.items() if part is not None})
    views = [_View(o.view, o.shrinkage, scale) for o, scale in zip(choice.options, choice.scales, strict=True)]
    known = choice.novelty
    return _Factor(
        list(expert.names), views, _finite(known.threshold), known.slope, choice.sharpness,
        _finite(choice.accuracy), _finite(choice.auroc),
    )  # fmt: skip


def load_recogniser(path: str | os.PathLike[str]) -> Recogniser:
    """Read a recogniser; one to which left and right are the same is a :class:`JoinedSides`.

    Raises
    ------
    FormatError
        If there is none, or the file is damaged, another program's or of another version.
    """
    path = Path(path)
    arrays = _arrays(path)
    header = _header(arrays, path)
    try:
        experts = [
            None if factor is None else _unpacked(name, factor, arrays, header)
            for name, factor in zip(
                _PARTS, (header.task, header.person, header.task_across, header.person_across), strict=True
            )
        ]
    except (KeyError, ValueError) as error:
        raise _damaged(path, str(error)) from None
    kind = JoinedSides if header.mirrored == "joined" else Recogniser
    return kind(tuple(header.elements), header.moments, experts[0], experts[1], Across(*experts[2:]))


def _damaged(path: Path, why: str) -> FormatError:
    return FormatError(f"{path} is no whole recogniser ({why}); train it again with `onbeat recognise train`")


def _arrays(path: Path) -> dict[str, np.ndarray]:
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(info.file_size for info in archive.infolist())
            if size > LARGEST:
                raise _damaged(path, f"{size} bytes promised, {LARGEST} at most are read")
        with np.load(path, allow_pickle=False) as stored:
            return {name: np.asarray(stored[name]) for name in stored.files}
    except FileNotFoundError:
        raise FormatError(f"no recogniser {path}; train one with `onbeat recognise train`") from None
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    except FormatError:
        raise
    except Exception as error:  # zip, zlib and numpy raise a dozen kinds on damaged bytes
        raise _damaged(path, f"{type(error).__name__}: {error}") from None


def _header(arrays: Mapping[str, np.ndarray], path: Path) -> _Header:
    stored = arrays.get(_HEADER)
    if stored is None or stored.dtype != np.uint8 or stored.ndim != 1:
        raise _damaged(path, "it has no header, so another program wrote it")
    try:
        said = msgspec.json.decode(stored.tobytes(), type=dict[str, object])
        if said.get("format") != FORMAT:
            raise _damaged(path, f"its header says {said.get('format')!r}, not {FORMAT!r}")
        if said.get("version") not in READ:
            raise FormatError(
                f"{path} is of version {said.get('version')!r}, this program reads {READ[0]} and {READ[1]}; "
                "train it again with `onbeat recognise train`"
            )
        return msgspec.convert(said, _Header)
    except msgspec.MsgspecError as error:
        raise _damaged(path, f"its header: {error}") from None


def _unpacked(name: str, factor: _Factor, arrays: Mapping[str, np.ndarray], header: _Header) -> Expert:
    if len(set(factor.names)) < len(factor.names) or any(n not in header.elements for n in NEEDED):
        raise ValueError("names twice, or elements missing")
    learned = tuple(
        _learned(view.view, f"{name}{number}_", arrays, header, len(factor.names))
        for number, view in enumerate(factor.views)
    )
    threshold = np.inf if factor.threshold is None else factor.threshold
    accuracy, auroc = (np.nan if value is None else value for value in (factor.accuracy, factor.auroc))
    choice = Choice(
        tuple(Option(view.view, view.shrinkage) for view in factor.views), tuple(view.scale for view in factor.views),
        Novelty(threshold, factor.slope), factor.sharpness, accuracy, auroc,
    )  # fmt: skip
    return Expert(tuple(factor.names), choice, learned)


def _learned(view: str, prefix: str, arrays: Mapping[str, np.ndarray], header: _Header, count: int) -> Learned:
    values = 3 * len(header.elements)
    if view in FLAT:
        width = {"outline": 2 * values + len(header.elements) + 1, "course": values * header.moments}.get(view, values)
        directions = _numbers(arrays, prefix + "directions", (width, -1))
        kept = directions.shape[1]
        basis = Basis(_numbers(arrays, prefix + "mean", (width,)), directions)
        centres = _numbers(arrays, prefix + "centres", (count, kept), finite=False)
        told = np.isfinite(centres)
        if not told.all(axis=1).any() or (told.any(axis=1) & ~told.all(axis=1)).any():
            raise ValueError(f"{prefix}centres has no class with members, or one that is infinite in part")
        whitener, outside = (
            _numbers(arrays, prefix + n, s) for n, s in (("whitener", (kept, kept)), ("outside", (1,)))
        )
        return Learned(basis, Subspace(centres, whitener, float(outside[0])))
    if view not in ELASTIC:
        raise ValueError(f"no view {view!r}")
    references = _numbers(arrays, prefix + "references", (-1, header.moments, values))
    classes = arrays[prefix + "classes"]
    if classes.dtype != np.int64 or classes.shape != references.shape[:1]:
        raise ValueError(f"{prefix}classes of {classes.dtype} {classes.shape}")
    if len(classes) and not (classes.min() >= 0 and classes.max() < count):
        raise ValueError(f"{prefix}classes beyond the {count} names")
    return Learned(references=references, classes=classes)


def _numbers(arrays: Mapping[str, np.ndarray], name: str, shape: tuple[int, ...], *, finite: bool = True) -> Array:
    values = arrays[name]
    fits = values.ndim == len(shape) and all(n in (-1, m) for n, m in zip(shape, values.shape, strict=True))
    if values.dtype != np.float64 or not fits:
        raise ValueError(f"{name} is {values.dtype} {values.shape}, not float64 {shape}")
    # Squares of what is farther are no numbers any more; an infinite centre is that of a class without members.
    far = np.abs(values) > (_FARTHEST if name.endswith("references") else _LARGEST)
    if np.isnan(values).any() or (far & (np.isfinite(values) | finite)).any():
        raise ValueError(f"{name} has a value that is not a number, or far beyond all bodies")
    return values
