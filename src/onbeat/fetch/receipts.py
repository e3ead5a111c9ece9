"""Receipts: what was fetched, from where, when, with which checksums, under which licence; kept beside the data."""

from __future__ import annotations

import fnmatch
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import msgspec

from onbeat.errors import FetchError
from onbeat.fetch.sources import Source

RECEIPT, LICENCE = "fetched.json", "LICENCE.txt"
FORMAT, VERSION = "onbeat fetched", 1
LARGEST = 50_000_000  # bytes of a receipt


class Got(msgspec.Struct, frozen=True):
    """A file that was fetched, or unpacked from one: its path in the folder, bytes, checksum, and where it came from.

    ``held_against`` says which checksum it was held against: its publisher's, that of the first download, or none, as
    this was the first.
    """

    path: str
    bytes: int
    sha256: str
    url: str
    held_against: Literal["publisher", "first download", "first seen now", "unpacked"]


class Receipt(msgspec.Struct, frozen=True):
    """What lies in a folder that was fetched; see :class:`onbeat.fetch.sources.Source` for what is not told here.

    Parameters
    ----------
    when : the time of the download, ISO 8601 in UTC.
    files : what is in the folder.
    archives : what some of it was unpacked from, not kept.
    """

    format: str
    version: int
    kind: str
    name: str
    title: str
    page: str
    licence: str
    licence_url: str
    credit: str
    genre: str
    performers: dict[str, str]
    body: str
    fps: float | None
    fps_stored: bool
    mind: tuple[str, ...]
    when: str
    files: tuple[Got, ...]
    archives: tuple[Got, ...] = ()

    def performer_of(self, file: str) -> str | None:
        """Who dances in a file, by its name; None where that is not told."""
        return next((who for pattern, who in self.performers.items() if fnmatch.fnmatchcase(file, pattern)), None)


def receipt_for(source: Source, when: str, got: list[Got], archives: list[Got]) -> Receipt:
    """The receipt of a source that was fetched now."""
    return Receipt(
        FORMAT,
        VERSION,
        source.kind,
        source.name,
        source.title,
        source.page,
        source.licence,
        source.licence_url,
        source.credit,
        source.genre,
        source.performers,
        source.body,
        source.fps,
        source.fps_stored,
        source.mind,
        when,
        tuple(got),
        tuple(archives),
    )


def receipt_of(folder: Path) -> Receipt | None:
    """The receipt in a folder; None where there is none.

    Raises
    ------
    FetchError
        If there is a receipt of onbeat that cannot be read.
    """
    path = folder / RECEIPT
    try:
        if not path.is_file() or path.stat().st_size > LARGEST:
            return None
        data = path.read_bytes()
        if FORMAT.encode() not in data[:200]:
            return None  # a file of others that has this name
        return msgspec.json.decode(data, type=Receipt)
    except OSError:
        return None
    except msgspec.MsgspecError as error:
        raise FetchError(f"{path} is damaged ({error}); delete {folder} and fetch it again") from None


def receipt_above(file: Path) -> Receipt | None:
    """The receipt of the folder that a file is in, or of one above it."""
    for folder in file.absolute().parents:
        if (found := receipt_of(folder)) is not None:
            return found
    return None


def licence_text(receipt: Receipt) -> str:
    """What has to be known of a licence, for people."""
    lines = [
        receipt.title,
        f"Licence: {receipt.licence}{f' ({receipt.licence_url})' if receipt.licence_url else ''}",
        f"Credit: {receipt.credit}",
        f"From: {receipt.page}",
        f"Fetched: {receipt.when}",
        *(f"Mind: {line}" for line in receipt.mind),
    ]
    return "\n".join(lines) + "\n"


def digest(path: Path, told: Callable[[int], None] | None = None) -> str:
    """SHA-256 of a file; ``told`` is called with the bytes of each block."""
    total = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            total.update(block)
            if told is not None:
                told(len(block))
    return total.hexdigest()


def wrong_files(folder: Path, receipt: Receipt, told: Callable[[int], None] | None = None) -> list[str]:
    """The files of a receipt that are not in the folder as they came."""
    wrong: list[str] = []
    for got in receipt.files:
        path = folder / got.path
        try:
            good = path.stat().st_size == got.bytes and digest(path, told) == got.sha256
        except OSError:
            good = False
        if not good:
            wrong.append(got.path)
    return wrong
