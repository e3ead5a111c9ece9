"""Named arrays out of NumPy's ``.npz`` files, read so that no file can execute anything or fill the memory.

An ``.npz`` is a zip of ``.npy`` members: magic bytes, a header with item type, order and shape, then the raw items.
Sizes are checked before anything is inflated: the directory is small, shape × item size is what the directory declares,
and all that is asked for together is at most 1 GB, beyond 64 MB at most a hundred times the size of the file (motion
packs down to a half or a tenth; what packs down to less is a bomb). Only members that are asked for are inflated, so
objects and other things that nobody asks for do no harm. Item types are plain: booleans, integers, floats, text.
"""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array
from onbeat.errors import FormatError

MAX_BYTES = 1_000_000_000
"""All arrays that are read from one file together."""
FREE_BYTES, MAX_RATIO = 64_000_000, 100
"""Beyond the first, arrays may be so many times as large as their file."""
MAX_MEMBERS, MAX_DIRECTORY = 1000, 1_000_000
_HEADER, _CHUNK = 10_000, 1 << 18
_PLAIN = re.compile(r"[<>|=]?(b1|[iu][1248]|f[248]|[SU][1-9]\d{0,4})")
_TYPE = re.compile(r"""['"]descr['"]\s*:\s*['"]([^'"]*)['"]""")
_ORDER = re.compile(r"""['"]fortran_order['"]\s*:\s*(True|False)""")
_SHAPE = re.compile(r"""['"]shape['"]\s*:\s*\(([\d\s,L]*)\)""")
_DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    OSError,
    ValueError,
    OverflowError,
    NotImplementedError,
)


def plain_dtype(text: str) -> np.dtype[Any] | None:
    """The item type that NumPy writes as ``text``; None for objects, structures and all that is not plain.

    Examples
    --------
    >>> plain_dtype("<f4"), plain_dtype("|O")
    (dtype('float32'), None)
    """
    return np.dtype(text) if _PLAIN.fullmatch(text) else None


def shape_size(shape: tuple[int, ...]) -> int | None:
    """How many items an array of this shape has; None where no array can have it."""
    if len(shape) > 8 or any(not 0 <= n < 2**40 for n in shape):
        return None
    return math.prod(shape)


def has_text_of(array: NDArray[Any]) -> bool:
    """Whether what an array of text (kind U) holds is text: NumPy itself takes any four bytes for a character."""
    if array.dtype.kind != "U":
        return True
    codes = np.ascontiguousarray(array).reshape(-1).view(array.dtype.str[0] + "u4")
    return not np.any((codes > 0x10FFFF) | ((codes >= 0xD800) & (codes < 0xE000)))


def load_arrays(path: str | Path) -> dict[str, NDArray[Any]]:
    """All arrays of an ``.npz`` by their names; :class:`NpzArrays` inflates only those that are asked for.

    Raises
    ------
    FormatError
        If the file is damaged, a bomb, encrypted, or holds objects.
    """
    with NpzArrays(path) as file:
        return {key: file[key] for key in file}


def floats(arrays: Mapping[str, NDArray[Any]], key: str, label: str) -> Array:
    """The array called ``key`` as float64; a ``FormatError`` where it is not of numbers or one is not finite."""
    found = np.asarray(arrays[key])
    if found.dtype.kind not in "biuf":
        raise FormatError(f"{label}: {key!r} has items of type {found.dtype}; numbers are expected")
    with np.errstate(all="ignore"):  # a signalling NaN warns when it is converted
        values = np.asarray(found, np.float64)
    if not np.isfinite(values).all():
        where = np.argwhere(~np.isfinite(values))[0].tolist()
        raise FormatError(f"{label}: {key!r} has a value that is not a number at {where}")
    return values


class NpzArrays(Mapping[str, NDArray[Any]]):
    """The arrays of an ``.npz``, each inflated when it is asked for; a context manager that closes the file.

    Raises
    ------
    FormatError
        If the file is no ``.npz``; when asked for an array that is damaged, too large, encrypted or not plain.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._read: dict[str, NDArray[Any]] = {}
        self._inflated = 0
        try:
            self._file = _Sparing(io.FileIO(self.path))
        except OSError as error:
            raise FormatError(f"cannot read {self.path}: {error.strerror or error}") from None
        self.size = self._file.seek(0, io.SEEK_END)
        try:
            self._zip = zipfile.ZipFile(self._file)
            self._members = self._named()
        except _DAMAGED as error:
            self._file.close()
            raise FormatError(f"cannot read {self.path} as an .npz of arrays: {error}") from None

    def _named(self) -> dict[str, zipfile.ZipInfo]:
        infos = self._zip.infolist()
        if len(infos) > MAX_MEMBERS:
            raise ValueError(f"it has {len(infos)} members; a motion has at most {MAX_MEMBERS}")
        named = {info.filename.removesuffix(".npy"): info for info in infos if info.filename.endswith(".npy")}
        if len({info.filename for info in infos}) < len(infos):
            raise ValueError("two members have the same name; save the arrays again")
        return named

    def __enter__(self) -> NpzArrays:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file; arrays that were read stay."""
        self._zip.close()
        self._file.close()

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __contains__(self, key: object) -> bool:
        return key in self._members

    def __getitem__(self, key: str) -> NDArray[Any]:
        if key not in self._read:
            self._read[key] = self._inflate(key, self._members[key])
        return self._read[key]

    def _inflate(self, key: str, info: zipfile.ZipInfo) -> NDArray[Any]:
        label = f"{self.path}: array {key!r}"
        self._check(label, info)
        try:
            with self._zip.open(info) as member:
                dtype, fortran, shape = _header(member, info.file_size, label)
                flat = np.empty(math.prod(shape), dtype)
                _fill(flat, member)
                if not has_text_of(flat):
                    raise FormatError(f"{label} holds text with characters that do not exist")
                return flat.reshape(shape, order="F" if fortran else "C")
        except FormatError:
            raise
        except (*_DAMAGED, RuntimeError) as error:
            raise FormatError(f"{label} is damaged: {error}") from None

    def _check(self, label: str, info: zipfile.ZipInfo) -> None:
        if info.flag_bits & 1:
            raise FormatError(f"{label} is encrypted; save it without a password")
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise FormatError(f"{label} is packed by method {info.compress_type}; NumPy stores or deflates")
        limit = min(MAX_BYTES, max(FREE_BYTES, MAX_RATIO * self.size))
        self._inflated += info.file_size
        if self._inflated > limit:
            raise FormatError(
                f"{label} would be {info.file_size:,} bytes out of a file of {self.size:,}; at most {limit:,} are read "
                "from it in all: cut the motion into shorter ones"
            )


class _Sparing(io.BufferedReader):
    """A file that refuses to read a zip directory larger than any motion's.

    The zip reader asks for a directory at once, and would ask for a promised gigabyte; members are read in chunks.
    """

    def read(self, size: int | None = -1, /) -> bytes:
        if size is not None and size > MAX_DIRECTORY:
            raise ValueError(f"its directory is of {size:,} bytes; a motion has few members")
        return super().read(size)


class _Header(NamedTuple):
    dtype: np.dtype[Any]
    fortran: bool
    shape: tuple[int, ...]


def _header(member: IO[bytes], size: int, label: str) -> _Header:
    """What the head of an ``.npy`` says, which has to agree with the ``size`` of the member."""
    start = member.read(12)
    if start[:6] != b"\x93NUMPY" or len(start) < 12 or start[6] not in (1, 2, 3):
        raise FormatError(f"{label} is no array: it does not begin as an .npy does")
    taken, length = (10, start[8] + 256 * start[9]) if start[6] == 1 else (12, int.from_bytes(start[8:12], "little"))
    if length > _HEADER:
        raise FormatError(f"{label} has a header of {length} bytes; at most {_HEADER} are expected")
    rest = member.read(max(0, taken + length - 12))
    text = (start[taken:] + rest).decode("latin-1")
    found = _parse(text, label)
    bytes_ = (shape_size(found.shape) or 0) * found.dtype.itemsize
    if shape_size(found.shape) is None or bytes_ + taken + length != size:
        raise FormatError(
            f"{label} of shape {_shown(found.shape)} and type {found.dtype} does not fit its {size:,} bytes"
        )
    return found


def _parse(text: str, label: str) -> _Header:
    kind, order, shape = _TYPE.search(text), _ORDER.search(text), _SHAPE.search(text)
    dtype = plain_dtype(kind[1]) if kind else None
    if dtype is None:
        named = "Python objects" if kind and kind[1].endswith("O") else ""
        found = named or (f"items of type {kind[1][:40]!a}" if kind else "structures")
        raise FormatError(
            f"{label} holds {found}, which are not read, and nothing was executed; save plain arrays "
            "of numbers (np.savez of np.asarray(x, float))"
        )
    if order is None or shape is None:
        raise FormatError(f"{label} has a header that does not tell its order and shape: {text[:80]!a}")
    sizes = tuple(int(word[:20].rstrip("L")) for word in shape[1].replace(",", " ").split() if word.rstrip("L"))
    return _Header(dtype, order[1] == "True", sizes)


def _shown(shape: tuple[int, ...]) -> str:
    return f"({', '.join(map(str, shape[:8]))}{', …' if len(shape) > 8 else ''})"


def _fill(flat: NDArray[Any], member: IO[bytes]) -> None:
    """Read the items in chunks, to the end, where the zip reader compares the checksum."""
    if not flat.nbytes:
        return
    view, at = flat.view(np.uint8).data, 0
    while at < len(view):
        chunk = member.read(min(_CHUNK, len(view) - at))
        if not chunk:
            raise EOFError(f"it ends after {at:,} of {len(view):,} bytes")
        view[at : at + len(chunk)] = chunk
        at += len(chunk)
    member.read(1)
