"""What came into a session, kept, so that it can be danced again to the bit.

A recording is a folder: ``session.json`` (what the session was set up with, how many ticks it lasted, and a digest of
all poses; before it ends neither), ``sound.f32`` (the ticks that had sound, one after the other, 441 little-endian
float32 each), ``ticks.bin`` (a byte a tick: 1 with sound, 0 without) and ``told.jsonl`` (what was told: its tick, and
what). It is written beside its name, into ``NAME.part``, and gets its name when the session ends; what was killed can
be danced again as it is.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import msgspec
import numpy as np

from onbeat._shapes import Float32
from onbeat.errors import OnbeatError
from onbeat.live.protocol import Clocked, Command, Pose
from onbeat.live.session import NOTHING_TOLD, Told

VERSION = 1
TICK = 441
"""Samples of a tick."""
PARTS = ("sound.f32", "told.jsonl", "ticks.bin")
"""In the order in which a tick is written: it counts when its last part is there."""
LARGEST = 1 << 20
"""Bytes that ``session.json`` may have."""


class Kept(msgspec.Struct, frozen=True):
    """What ``session.json`` says."""

    version: int
    settings: dict[str, Any]
    ticks: int
    poses: str


class _Line(msgspec.Struct, frozen=True):
    tick: int
    what: Command | Clocked


class Digest:
    """A digest of all poses, to the bit."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()

    def add(self, samples: Float32 | None, told: Told, poses: Sequence[Pose]) -> None:
        """The poses of one tick."""
        del samples, told
        for pose in poses:
            for part in (pose.root, pose.rotations, pose.angles, pose.points):
                self._digest.update(np.ascontiguousarray(part).tobytes())

    def hexdigest(self) -> str:
        """In hexadecimal digits."""
        return self._digest.hexdigest()


class Recording:
    """Writes a recording as it happens; one that cannot be written further ends, and the session goes on.

    Parameters
    ----------
    folder : to be made; nothing of its name may be there.
    settings : what the session was set up with.

    Attributes
    ----------
    ticks : kept so far.
    failed : why no more are kept; empty while all is well.

    Raises
    ------
    OnbeatError
        If it is there already or cannot be written.
    """

    def __init__(self, folder: Path, settings: dict[str, Any]) -> None:
        self.folder, self._settings = folder, settings
        self._part = folder.with_name(f"{folder.name}.part")
        if folder.exists() or self._part.exists():
            raise OnbeatError(f"{folder} or {self._part.name} is there already; choose another name, or remove it")
        self.ticks, self.failed = 0, ""
        self._digest = Digest()
        self._files: dict[str, BinaryIO] = {}
        self._sizes: dict[str, int] = dict.fromkeys(PARTS, 0)
        try:
            self._part.mkdir(parents=True)
            for name in PARTS:
                self._files[name] = (self._part / name).open("wb", buffering=0)
            self._tell("")
        except OSError as error:
            self.drop()
            raise OnbeatError(f"cannot record into {self._part}: {error.strerror or error}") from None

    def add(self, samples: Float32 | None, told: Told, poses: Sequence[Pose]) -> None:
        """One tick."""
        if self.failed:
            return
        lines = [msgspec.json.encode(_Line(self.ticks, what)) + b"\n" for what in (*told.commands, *told.clocked)]
        sound = b"" if samples is None else np.asarray(samples, "<f4").tobytes()
        try:
            for name, data in zip(PARTS, (sound, b"".join(lines), b"\1" if sound else b"\0"), strict=True):
                self._write(name, data)
        except OSError as error:
            self.failed = f"nothing more is recorded: {error.strerror or error}; {self.ticks / 100:.1f} s are kept"
            self._cut()
            return
        for name, size in zip(PARTS, (len(sound), sum(map(len, lines)), 1), strict=True):
            self._sizes[name] += size
        self._digest.add(samples, told, poses)
        self.ticks += 1

    def _write(self, name: str, data: bytes) -> None:
        if data and self._files[name].write(data) != len(data):
            raise OSError(28, "No space left on device")

    def _cut(self) -> None:
        """Back to whole ticks."""
        for name, file in self._files.items():
            with contextlib.suppress(OSError):
                file.truncate(self._sizes[name])

    def _tell(self, poses: str) -> None:
        kept = Kept(VERSION, self._settings, self.ticks, poses)
        data = msgspec.json.format(msgspec.json.encode(kept)) + b"\n"
        temporary = self._part / "session.json.new"
        temporary.write_bytes(data)
        os.replace(temporary, self._part / "session.json")

    def close(self) -> Path:
        """End it, and give it its name; where it is, for what is left of it is kept in any case.

        Raises
        ------
        OnbeatError
            If it cannot get its name.
        """
        try:
            for file in self._files.values():
                file.close()
            try:
                self._tell(self._digest.hexdigest())
            except OSError:
                if not self.failed:  # on a full disk what was told at the beginning stays
                    raise
            os.replace(self._part, self.folder)
        except OSError as error:
            where = f"{self._part} can be danced again as it is"
            raise OnbeatError(f"cannot record into {self.folder}: {error.strerror or error}; {where}") from None
        return self.folder

    def drop(self) -> None:
        """Leave nothing behind."""
        for file in self._files.values():
            with contextlib.suppress(OSError):
                file.close()
        shutil.rmtree(self._part, ignore_errors=True)


class Replay:
    """A recording, read again.

    Parameters
    ----------
    folder : of the recording.

    Raises
    ------
    OnbeatError
        If it is none, of another version, or its parts do not fit together.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            with (folder / "session.json").open("rb") as file:
                data = file.read(LARGEST)
            self._flags = np.frombuffer((folder / "ticks.bin").read_bytes(), np.uint8)
            told = (folder / "told.jsonl").read_bytes()
            size = (folder / "sound.f32").stat().st_size
            count = int((self._flags != 0).sum()) * TICK
            whole = count and size >= 4 * count
            self._sound = np.memmap(folder / "sound.f32", "<f4", "r", shape=(count,)) if whole else np.zeros(size // 4)
        except (OSError, ValueError) as error:
            raise OnbeatError(f"{folder} is no recording of a live session: {error}") from None
        try:
            self.kept = msgspec.json.decode(data, type=Kept)
            lines = [msgspec.json.decode(line, type=_Line) for line in told.splitlines()]
        except msgspec.DecodeError as error:
            raise OnbeatError(f"{folder} is a damaged recording: {error}") from None
        if self.kept.version != VERSION:
            raise OnbeatError(f"{folder} is of version {self.kept.version}; this onbeat reads {VERSION}")
        ended = bool(self.kept.poses)  # one that was killed has more than its beginning told
        if (ended and len(self._flags) != self.kept.ticks) or len(self._sound) != count:
            raise OnbeatError(
                f"{folder} is a damaged recording: {self.kept.ticks} ticks are told, {len(self._flags)} are there, "
                f"with sound for {len(self._sound) / TICK:g}"
            )
        self._told: dict[int, list[Command | Clocked]] = {}
        for line in lines:
            self._told.setdefault(line.tick, []).append(line.what)

    def __len__(self) -> int:
        return len(self._flags)

    def ticks(self) -> Iterator[tuple[Float32 | None, Told]]:
        """Sound and what was told, tick by tick."""
        at = 0
        for tick, flag in enumerate(self._flags.tolist()):
            samples = None
            if flag:
                samples = np.array(self._sound[at : at + TICK], np.float32)
                at += TICK
            yield samples, self.told_at(tick)

    def told_at(self, tick: int) -> Told:
        """What was told in a tick."""
        told = self._told.get(tick)
        if not told:
            return NOTHING_TOLD
        commands = tuple(what for what in told if isinstance(what, Command))
        return Told(commands, tuple(what for what in told if isinstance(what, Clocked)))
