"""What came into a session, kept, so that it can be danced again to the bit.

A recording is a folder: ``session.json`` (what the session was set up with, how many ticks it lasted, and a digest of
all poses), ``sound.f32`` (the ticks that had sound, one after the other, 441 little-endian float32 each), ``ticks.bin``
(a byte a tick: 1 with sound, 0 without) and ``told.jsonl`` (what was told: its tick, and what). It is written beside its
name, into ``NAME.part``, and gets its name when the session ends.
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
    """Writes a recording as it happens.

    Parameters
    ----------
    folder : to be made; nothing of its name may be there.
    settings : what the session was set up with.

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
        self._ticks, self._digest = 0, Digest()
        self._files: dict[str, BinaryIO] = {}
        try:
            self._part.mkdir(parents=True)
            for name in ("sound.f32", "ticks.bin", "told.jsonl"):
                self._files[name] = (self._part / name).open("wb")
        except OSError as error:
            self.drop()
            raise OnbeatError(f"cannot record into {self._part}: {error.strerror or error}") from None

    def add(self, samples: Float32 | None, told: Told, poses: Sequence[Pose]) -> None:
        """One tick."""
        try:
            self._files["ticks.bin"].write(b"\0" if samples is None else b"\1")
            if samples is not None:
                self._files["sound.f32"].write(np.asarray(samples, "<f4").tobytes())
            for what in (*told.commands, *told.clocked):
                self._files["told.jsonl"].write(msgspec.json.encode(_Line(self._ticks, what)) + b"\n")
        except OSError as error:
            raise OnbeatError(f"cannot record into {self._part}: {error.strerror or error}") from None
        self._digest.add(samples, told, poses)
        self._ticks += 1

    def close(self) -> Path:
        """End it, and give it its name."""
        kept = Kept(VERSION, self._settings, self._ticks, self._digest.hexdigest())
        try:
            for file in self._files.values():
                file.close()
            (self._part / "session.json").write_bytes(msgspec.json.format(msgspec.json.encode(kept)) + b"\n")
            os.replace(self._part, self.folder)
        except OSError as error:
            raise OnbeatError(f"cannot record into {self.folder}: {error.strerror or error}") from None
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
            data = (folder / "session.json").read_bytes()[:LARGEST]
            self._flags = np.frombuffer((folder / "ticks.bin").read_bytes(), np.uint8)
            told = (folder / "told.jsonl").read_bytes()
            size = (folder / "sound.f32").stat().st_size
            self._sound = np.memmap(folder / "sound.f32", "<f4", "r") if size else np.zeros(0, np.float32)
        except (OSError, ValueError) as error:
            raise OnbeatError(f"{folder} is no recording of a live session: {error}") from None
        try:
            self.kept = msgspec.json.decode(data, type=Kept)
            lines = [msgspec.json.decode(line, type=_Line) for line in told.splitlines()]
        except msgspec.DecodeError as error:
            raise OnbeatError(f"{folder} is a damaged recording: {error}") from None
        if self.kept.version != VERSION:
            raise OnbeatError(f"{folder} is of version {self.kept.version}; this onbeat reads {VERSION}")
        if len(self._flags) != self.kept.ticks or int((self._flags != 0).sum()) * TICK != len(self._sound):
            raise OnbeatError(
                f"{folder} is a damaged recording: {self.kept.ticks} ticks are told, {len(self._flags)} are there, "
                f"with sound for {len(self._sound) / TICK:g}"
            )
        self._told: dict[int, list[Command | Clocked]] = {}
        for line in lines:
            self._told.setdefault(line.tick, []).append(line.what)

    def __len__(self) -> int:
        return self.kept.ticks

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
