"""Fetching a source whole: downloaded, checked, unpacked, with its licence and receipt, and only then in its place."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

import msgspec

from onbeat.errors import FetchError
from onbeat.fetch.downloading import ResumingDownloader
from onbeat.fetch.known import key_of, known_checksums, remember
from onbeat.fetch.places import by_hand, data_folder, folder_of
from onbeat.fetch.receipts import (
    LICENCE,
    RECEIPT,
    Got,
    Receipt,
    digest,
    licence_text,
    receipt_for,
    receipt_of,
    wrong_files,
)
from onbeat.fetch.sources import RemoteFile, Source
from onbeat.fetch.unpacking import Unpacked, unpack
from onbeat.files import lock_file, make_folder, write_atomically

Step = Callable[[str, float, str], None]
"""Called with what is done, its share done 0…1, and a detail."""
Tell = Callable[[str], None]
"""Called with a line that a user should read."""
WHOLE, LOADED, LOCK = "whole", "loaded", ".lock"
MISMATCH = re.compile(r"expected (\w+) but got (\w+)")


def _silent(what: str, share: float, detail: str) -> None: ...


def _untold(line: str) -> None: ...


def fetch(
    source: Source,
    folder: Path | None = None,
    *,
    when: str = "",
    mirror: str = "",
    renew: bool = False,
    step: Step = _silent,
    tell: Tell = _untold,
) -> Receipt:
    """Fetch a source into a folder; what lies there whole already is checked and left.

    A download that was stopped goes on. The folder has all of it or is not there: everything is loaded, checked and
    unpacked beside it and then renamed.

    Parameters
    ----------
    source : what to fetch.
    folder : where to; by default the source's place in :func:`onbeat.fetch.places.data_folder`.
    when : the time now, ISO 8601 in UTC, for the receipt.
    mirror : address of a mirror that is tried first.
    renew : fetch again, and trust what comes now where no publisher tells a checksum.
    step, tell : are told of the progress, and of what the user has to know.

    Raises
    ------
    FetchError
        If it may not be fetched by a program, somebody fetches it now, the network or a server fails, what comes is
        not what is expected, or there is no room. The folder is then as it was.
    """
    if source.by_hand:
        raise FetchError(by_hand(source))
    place = Path(os.path.abspath(folder_of(source) if folder is None else folder))
    with _storage(place):
        if not renew and (there := _whole_already(source, place, step, tell)) is not None:
            return there
        _check_place(place)
        with _working(place) as work:
            job = _Job(source, work, mirror, renew, step, tell)
            receipt = job.load(when)
            _put_in_place(work / WHOLE, place, work)
            remember(data_folder(), job.new)
    return receipt


@contextlib.contextmanager
def _storage(place: Path) -> Generator[None]:
    """What the disk refuses, in a sentence."""
    try:
        yield
    except OSError as error:
        raise FetchError(f"cannot keep data in {place}: {error.strerror or error}; make room or choose another folder"
                         ) from None  # fmt: skip


def _whole_already(source: Source, place: Path, step: Step, tell: Tell) -> Receipt | None:
    """The receipt of what is there, if it is this source and every file is as it came."""
    there = receipt_of(place)
    if there is None or (there.kind, there.name) != (source.kind, source.name):
        return None
    total, checked = sum(got.bytes for got in there.files) or 1, 0

    def told(length: int) -> None:
        nonlocal checked
        checked += length
        step("checking", checked / total, "")

    wrong = wrong_files(place, there, told)
    if wrong:
        tell(
            f"{place}: {len(wrong)} of {len(there.files)} files are not as they came ({wrong[0]}); it is fetched again"
        )
    else:
        tell(f"{place} is here already, every file as it came")
    return None if wrong else there


def _check_place(place: Path) -> None:
    """Refuse a folder that holds anything that was not fetched."""
    if not place.exists():
        return
    if not place.is_dir():
        raise FetchError(f"{place} is a file; choose a folder")
    there = receipt_of(place)
    ours = {RECEIPT, LICENCE, *(got.path for got in (there.files if there else ()))}
    for folder, _, names in os.walk(place):
        found = [(Path(folder) / name).relative_to(place).as_posix() for name in names]
        if others := [path for path in found if path not in ours]:
            raise FetchError(f"{place} holds other files ({others[0]}), which are not touched; choose another folder")


@contextlib.contextmanager
def _working(place: Path) -> Generator[Path]:
    """A folder beside the place in which this process alone works; it stays where the work is not done, to go on."""
    work = make_folder(place.parent / f".{place.name}.part")
    lock = work / LOCK
    handle = os.open(lock, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        try:
            lock_file(handle)
            if os.stat(lock).st_ino != os.fstat(handle).st_ino:
                raise FileNotFoundError
        except OSError:
            raise FetchError(f"{place} is being fetched by another process; wait until it is done") from None
        try:
            yield work
        except BaseException:
            if any(path.is_file() and path.name != LOCK for path in work.rglob("*")):
                raise  # what came is kept, to go on
            shutil.rmtree(work, ignore_errors=True)
            raise
        shutil.rmtree(work, ignore_errors=True)
    finally:
        os.close(handle)


def _put_in_place(whole: Path, place: Path, work: Path) -> None:
    old = work / "old"
    shutil.rmtree(old, ignore_errors=True)
    if place.exists():
        os.replace(place, old)
    try:
        os.replace(whole, place)
    except OSError:
        if old.exists():
            os.replace(old, place)
        raise


@dataclass
class _Job:
    """One fetching of a source in a folder of its own."""

    source: Source
    work: Path
    mirror: str
    renew: bool
    step: Step
    tell: Tell
    new: dict[str, str] = field(default_factory=dict[str, str])
    same: list[str] = field(default_factory=list[str])
    others: list[str] = field(default_factory=list[str])
    done: int = 0

    def load(self, when: str) -> Receipt:
        """Load, check and unpack all files; the whole then lies in ``work/whole``."""
        self._check_room()
        if self.renew:
            shutil.rmtree(self.work / LOADED, ignore_errors=True)
        (self.work / "parts").mkdir(exist_ok=True)
        known = {} if self.renew else known_checksums(data_folder())
        got = [self._file(number, file, known) for number, file in enumerate(self.source.files)]
        self._tell_trust(got)
        whole = self.work / WHOLE
        shutil.rmtree(whole, ignore_errors=True)
        whole.mkdir()
        files, archives = self._spread(got, whole)
        receipt = receipt_for(self.source, when, files, archives)
        write_atomically(whole / LICENCE, licence_text(receipt).encode())
        write_atomically(whole / RECEIPT, msgspec.json.format(msgspec.json.encode(receipt), indent=1) + b"\n")
        return receipt

    def _check_room(self) -> None:
        size, free = self.source.size or 0, shutil.disk_usage(self.work).free
        if size > free:
            raise FetchError(f"{self.source.name} takes {size:,} bytes, {self.work.parent} has room for {free:,}; "
                             "make room or choose another folder")  # fmt: skip

    def _file(self, number: int, file: RemoteFile, known: dict[str, str]) -> Got:
        """A file, loaded or found loaded, its checksum held against what is known of it."""
        first = known.get(key_of(self.source, file))
        expected, held = (file.sha256, "publisher") if self.source.sure and file.sha256 else (first, "first download")
        url = self._load(number, file, expected)
        path = self.work / LOADED / file.path
        found = digest(path)
        if expected is None:
            held = "first seen now"
            self.new[key_of(self.source, file)] = found
            if file.sha256 is not None:
                (self.same if file.sha256 == found else self.others).append(file.path)
        self.done += path.stat().st_size
        return Got(file.path, path.stat().st_size, found, url, held)

    def _load(self, number: int, file: RemoteFile, expected: str | None) -> str:
        """Load a file from the first place that has it; from which."""
        came, places = self.work / "parts" / f"{number}.url", self.source.addresses(file, self.mirror)
        if (self.work / LOADED / file.path).exists() and came.exists():
            places = [came.read_text(encoding="utf-8"), *places]  # loaded before the work was stopped
        for url, following in zip(places, [*places[1:], ""], strict=True):
            try:
                self._load_from(url, number, file, expected)
            except FetchError as error:
                if not following:
                    raise
                self.tell(f"{error}; now {following} is tried")
            else:
                came.write_text(url, encoding="utf-8")
                return url
        raise FetchError(f"no place is known for {file.path}")

    def _load_from(self, url: str, number: int, file: RemoteFile, expected: str | None) -> None:
        import pooch

        pooch.get_logger().setLevel("ERROR")
        target = self.work / LOADED / file.path
        part = self.work / "parts" / f"{number}.part"
        downloader = ResumingDownloader(part, file.size, lambda here, whole: self._progress(number, file, here, whole))
        while True:
            downloader.resumed = False
            try:
                pooch.retrieve(url, expected, target.name, target.parent, downloader=cast("Any", downloader))
                return
            except ValueError as error:
                if not downloader.resumed:  # else parts of two versions may have met: once more, from the beginning
                    raise FetchError(self._unexpected(url, file, expected, str(error))) from None

    def _unexpected(self, url: str, file: RemoteFile, expected: str | None, said: str) -> str:
        found = MISMATCH.search(said)
        what = f"its SHA-256 is {found[2][:12]}…, expected is {(expected or '')[:12]}…" if found else said
        if self.source.sure and file.sha256:
            return f"{url} is not the file that its publisher made known: {what}; nothing was kept"
        return (
            f"{url} is not the file that came the first time: {what}; if its publisher changed it, fetch with --renew"
        )

    def _progress(self, number: int, file: RemoteFile, here: int, whole: int | None) -> None:
        total = self.source.size
        count = len(self.source.files)
        share = (self.done + here) / total if total else (number + here / (whole or 10 * here or 1)) / count
        self.step("fetching", min(share, 1.0), f"{megabytes(self.done + here)}, {file.path}")

    def _tell_trust(self, got: list[Got]) -> None:
        """Say what was taken on trust."""
        if not self.new:
            return
        tested = f"; {len(self.same)} of them are as onbeat was tested with" if self.same else ""
        self.tell(
            f"no publisher tells a checksum of {len(self.new)} of {len(got)} files: what came now is recorded and "
            f"held against from now on{tested}"
        )
        if self.others:
            self.tell(f"{len(self.others)} of them ({self.others[0]}) are not as onbeat was tested with")

    def _spread(self, got: list[Got], whole: Path) -> tuple[list[Got], list[Got]]:
        """What is in the whole folder, and the archives that some of it came from."""
        files, archives = list[Got](), list[Got]()
        for file, one in zip(self.source.files, got, strict=True):
            loaded = self.work / LOADED / file.path
            if not file.unpack:
                _link(loaded, whole / file.path)
                files.append(one)
                continue
            archives.append(one)
            files += [Got(*unpacked, one.url, "unpacked") for unpacked in self._unpack(loaded, whole, file)]
        return files, archives

    def _unpack(self, loaded: Path, whole: Path, file: RemoteFile) -> list[Unpacked]:
        try:
            return unpack(loaded, whole, file.keep, lambda share: self.step("unpacking", share, ""))
        except FetchError:
            loaded.unlink()  # loaded again the next time
            raise


def _link(source: Path, target: Path) -> None:
    """A file at a second place, without a copy where that can be."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def megabytes(size: int) -> str:
    """A number of bytes for people.

    >>> megabytes(14_800_000)
    '14.8 MB'
    """
    return f"{size / 1e9:.2f} GB" if size >= 1e9 else f"{size / 1e6:.1f} MB" if size >= 1e5 else f"{size / 1e3:.0f} kB"
