"""From recordings to clips: one body for all of them, everyone on the floor, and mirror images."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from onbeat.errors import LibraryError, OnbeatError
from onbeat.motion.body import Body
from onbeat.motion.mirror import mirrored
from onbeat.motion.motion import Motion
from onbeat.motion.problems import in_place, odd_size
from onbeat.motion.retarget import retarget, stands_in_rest
from onbeat.motion.skeleton import Skeleton
from onbeat.moves.library import CLIP_RATE, SHORTEST, Clip
from onbeat.moves.making.stretches import Stretch, use_of
from onbeat.moves.recordings import Recording

MIRROR_SUFFIX = "~mirror"
UNIT = "(`onbeat convert FILE NEW.npz --source-unit in` makes one that is right, if these are inches)"
LOOKED_AT = 64  # frames of a recording by which its body's size is judged
GUESSED = "no names tell which joints are arms and legs: guessed from the rest pose; a roles file beside it tells them"


@dataclass(frozen=True)
class Read:
    """What is known of a recording that could be read.

    Parameters
    ----------
    recording : which.
    body : digest of its own skeleton.
    seconds : how long it is.
    notes : what its reader warned of, and what is wrong with the motion.
    stretches : what of it is used.
    load : its motion, at ``CLIP_RATE`` at most.
    """

    recording: Recording
    body: str
    seconds: float
    notes: tuple[str, ...]
    stretches: tuple[Stretch, ...]
    load: Callable[[], Motion]


def skeleton_digest(skeleton: Skeleton) -> str:
    """SHA-256 of all of a skeleton, with what is told of its joints."""
    total = hashlib.sha256(repr((skeleton.names, *skeleton.roles.items())).encode())
    for array in (skeleton.parents, skeleton.offsets, skeleton.end_sites):
        total.update(array.tobytes())
    return total.hexdigest()


def read_recording(recording: Recording) -> Read:
    """Read a recording and see that it can be a clip; a ``LibraryError`` gives the reason if it cannot."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", UserWarning)
        try:
            motion = recording.read()
            own = Body.of(motion.skeleton)
        except (OnbeatError, OSError) as error:
            raise LibraryError(_one_line(error, recording)) from None
        finally:
            _refuse_changed(recording)
    if motion.duration < SHORTEST:
        raise LibraryError(f"too short: {motion.duration:.1f} s, at least {SHORTEST:.1f} s are needed")
    body, seconds = skeleton_digest(motion.skeleton), motion.duration
    used = use_of(motion, own)
    if not used.stretches:
        raise LibraryError(f"{used.note}; nowhere are there {SHORTEST:.1f} s without")
    motion = motion if motion.fps <= CLIP_RATE + 1e-6 else motion.resampled(CLIP_RATE)
    notes = tuple(dict.fromkeys(_one_line(warning.message, recording) for warning in noted))
    notes += (GUESSED,) if "guess" in own.how.values() else ()
    notes += _told_size(motion, own)
    notes += tuple(note for note in (used.note, in_place(motion, own)) if note)
    return Read(recording, body, seconds, notes, used.stretches, lambda: motion)


def _told_size(motion: Motion, body: Body) -> tuple[str, ...]:
    """A note on a body of no body's size, as a wrong unit makes it; some frames tell, for archives are large."""
    said = odd_size(motion[:: -(-len(motion) // LOOKED_AT)], body)
    return (f"{said} {UNIT}",) if said else ()


class ChangedError(LibraryError):
    """A file that was written to while it was read: what was read of it is of no moment."""


def _refuse_changed(recording: Recording) -> None:
    if recording.has_changed():
        raise ChangedError("changed while it was read; build again when nobody writes to it")


def _one_line(error: Exception | Warning | str, recording: Recording) -> str:
    """A message without line breaks and without the file's name, which may change and is told beside it."""
    text = " ".join(str(error).split())
    for name in (str(recording.path), recording.file, recording.path.name) if recording.path else (recording.file,):
        text = text.removeprefix(f"{name}: ").replace(name, "the file") if name else text
    return text.encode(errors="replace").decode()  # names of files may be no text


def main_body(bodies: Sequence[tuple[str, float]]) -> str:
    """Digest of the skeleton that most seconds of motion are on, of digests and seconds; of equals the first."""
    seconds: dict[str, float] = {}
    for body, length in bodies:
        seconds[body] = seconds.get(body, 0.0) + length
    return max(seconds, key=lambda body: round(seconds[body], 6))


@dataclass(frozen=True)
class Stage:
    """The body that all clips of a library are put on.

    Parameters
    ----------
    model : the first recording on that body; its motion tells how the body stands where its rest pose does not.
    """

    model: Read

    @cached_property
    def motion(self) -> Motion:
        """The model's motion."""
        return self.model.load()

    @cached_property
    def skeleton(self) -> Skeleton:
        """The library's skeleton."""
        return self.motion.skeleton

    @cached_property
    def reference(self) -> str:
        """What clips depend on besides their own recording: the skeleton and, if it is needed, the model's content."""
        standing = stands_in_rest(Body.of(self.skeleton))
        return skeleton_digest(self.skeleton) + ("" if standing else self.model.recording.digest)

    def clips(self, read: Read, source: int, *, mirror: bool) -> list[tuple[Stretch, Clip]]:
        """The clip of each stretch of a recording, on its floor, and its mirror image."""
        whole = retarget(read.load(), self.skeleton, self.motion)
        clips: list[tuple[Stretch, Clip]] = []
        for stretch in read.stretches:
            name = read.recording.name + stretch.suffix
            motion = stretch.of(whole).replace(name=name)
            clips.append((stretch, Clip.of(motion, name, source)))
            if mirror:
                name += MIRROR_SUFFIX
                clips.append((stretch, Clip.of(mirrored(motion).replace(name=name), name, source, mirrored=True)))
        return clips
