"""Which stretches of a recording are danced: all of it, but for glitches of the capture and poses of reference.

Where a joint leaps (``motion.leaps``) the recording is cut and the frames around are left out; each stretch that is
long enough is a clip. A dance so neither joins into a glitch nor passes one.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np

from onbeat.motion.body import Body
from onbeat.motion.held import held_poses
from onbeat.motion.leaps import LEAP, body_leaps, frames_to_use, leaping_joints
from onbeat.motion.motion import Motion
from onbeat.motion.runs import runs
from onbeat.moves.library import SHORTEST

MARK = "@"
"""What stands before the second of its file at which a clip begins, in names and in the index."""
_SUFFIX = re.compile(MARK + r"\d+\.\d\d$")
_KEY = re.compile(MARK + r"(\d+\.\d\d) (\d+)/(\d+)$")


class Stretch(NamedTuple):
    """A part of a recording.

    Parameters
    ----------
    start, end : seconds of the recording, of its first and last frame.
    number, total : which of the recording's stretches it is, from 1, and how many there are.
    """

    start: float
    end: float = math.inf
    number: int = 1
    total: int = 1

    @property
    def suffix(self) -> str:
        """Behind the recording's name in the clip's: where in the file it begins, if it is one of many or late.

        Examples
        --------
        >>> Stretch(0.0, 9.5).suffix, Stretch(0.0, 9.5, 1, 2).suffix, Stretch(3.5).suffix
        ('', '@0.00', '@3.50')
        """
        return f"{MARK}{self.start:.2f}" if self.start > 0 or self.total > 1 else ""

    @property
    def key(self) -> str:
        """What its content has behind the recording's; nothing of one that is all of it.

        Examples
        --------
        >>> Stretch(0.0).key, Stretch(3.5, 7.25, 2, 2).key
        ('', '@3.50 2/2')
        """
        whole = self.start == 0 and math.isinf(self.end)
        return "" if whole else f"{MARK}{self.start:.2f} {self.number}/{self.total}"

    def of(self, motion: Motion) -> Motion:
        """Its frames of the recording at any rate; all of them where it is all of it."""
        if not self.key:
            return motion
        first = math.ceil(self.start * motion.fps - 1e-6)
        last = min(self.end * motion.fps, len(motion) - 1)
        return motion[first : math.floor(last + 1e-6) + 1]

    @classmethod
    def told(cls, content: str) -> Stretch:
        """What the content of a clip tells of its stretch, but for its end.

        Examples
        --------
        >>> Stretch.told("0a1b.bvh@3.50 2/2").number, Stretch.told("0a1b.bvh").key
        (2, '')
        """
        found = _KEY.search(content)
        return cls(float(found[1]), 0.0, int(found[2]), int(found[3])) if found else cls(0.0)


def recording_of(name: str) -> str:
    """The name of the recording that a clip is a stretch of.

    Examples
    --------
    >>> recording_of("salsa@3.95"), recording_of("salsa"), recording_of("me@home")
    ('salsa', 'salsa', 'me@home')
    """
    return _SUFFIX.sub("", name)


class Use(NamedTuple):
    """What of a recording is used, and a note on what is not; nothing ("") where all is."""

    stretches: tuple[Stretch, ...]
    note: str


def use_of(motion: Motion, body: Body) -> Use:
    """The stretches of a recording without leaps that are long enough for a clip.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> dance = embedded_motions()[0]
    >>> use_of(dance, Body.of(dance.skeleton)).note
    ''
    >>> path = dance.root_positions.copy()
    >>> path[240:250] = 0.0
    >>> lost = use_of(dance.replace(root_positions=path), Body.of(dance.skeleton))
    >>> len(lost.stretches)
    2
    """
    held, speeds, fps = held_poses(motion), body_leaps(motion, body), motion.fps
    leaps = np.asarray((speeds > LEAP).any(axis=1))
    if not leaps.any() and held == (0, 0):
        return Use((Stretch(0.0),), "")
    good = frames_to_use(motion.positions, fps, leaps)
    good[: held.first] = False
    good[len(good) - held.last :] = False
    found = [(first, last) for first, last in runs(good) if last - first >= SHORTEST * fps]
    ends = [math.inf if last == len(motion) else (last - 1) / fps for _, last in found]
    stretches = tuple(
        Stretch(first / fps, end, n, len(found)) for n, ((first, _), end) in enumerate(zip(found, ends, strict=True), 1)
    )
    left = (len(motion) - sum(last - first for first, last in found)) / fps
    causes: list[str] = []
    if sum(held):
        causes.append("a pose of reference stands " + ("in front" if held.first else "at the end"))
    if leaps.any():
        frame = int(leaps.argmax())
        joint = motion.skeleton.names[leaping_joints(body)[int(speeds[frame].argmax())]]
        times = len(runs(leaps))
        often = f", the first of {times} times" if times > 1 else ""
        causes.append(f"joints leap ({joint} at {frame / fps:.2f} s{often}: lost frames or noise of the capture)")
    return Use(stretches, f"{left:.2g} s left out where " + " and ".join(causes))
