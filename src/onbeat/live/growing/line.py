"""The timeline of a dance that is made up while it is danced.

Moves, stretches of clips, are added at its end and may be cut off again, as long as they are not settled. What is asked
for is made when it is asked for, and only what a change can reach is made anew; what is settled never changes, to the
bit.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.sources import Pose, Sources
from onbeat.dance.windows import LONGEST, ROOM, link_speeds
from onbeat.errors import PlanError
from onbeat.live.growing.end import CONTEXT, grown
from onbeat.live.growing.frames import Frames
from onbeat.live.growing.placing import Dancers, Placed
from onbeat.motion.body import Body
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.motion import Motion

BACK = 1.5
"""Seconds before a join from which on feet may still be led elsewhere for its sake."""
LEAST = LONGEST / 2 / ROOM
"""Seconds that a join needs before it for the longest window."""
MARGIN = LEAST + LONGEST + 0.1
"""Seconds after what is settled, the most that ``Line.margin`` ever is."""
BRIEF = 0.4
"""Seconds; a move that is no longer would leave its joins no time, and is left out."""
KEPT = 0.1
"""Seconds before what is forgotten that are kept, to read poses between frames."""
SLOWEST, QUICKEST = 0.2, 2.5
"""Rates that a move may have."""
SHORTEST = 1e-3
"""Seconds, the shortest move."""


class Line:
    """A dance's own timeline, growing at its end.

    Parameters
    ----------
    clips : motions of one skeleton.
    peaks : (J,) rad/s, the fastest each joint's bone may turn in a join; by default the fastest it turns in the clips.
    fps : frames per second that are made; poses are read between them.

    Raises
    ------
    FormatError
        If the clips have different skeletons.
    PlanError
        If there are no clips.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> line = Line(embedded_motions()[:2])
    >>> line.add(0, 2.0, 4.0), line.add(1, 3.0, 5.0)
    (None, None)
    >>> line.settle(1.0)
    >>> line.cut(3.0)
    >>> line.end, line.showing(2.5), line.pose(np.array([0.5, 2.5])).roots.shape
    (3.0, (1, 3.5), (2, 3))
    """

    def __init__(self, clips: Sequence[Motion], peaks: Array | None = None, fps: float = 60.0) -> None:
        if not clips:
            raise PlanError("there are no clips to dance; give one or more")
        at = np.concatenate(([0.0], np.cumsum([clip.duration for clip in clips])))
        everything = tuple(Move(n, 0.0, clip.duration, float(at[n])) for n, clip in enumerate(clips))
        Sources.of(clips, DancePlan(everything, float(at[-1])))
        body = Body.of(clips[0].skeleton)
        standing = [foot_contacts(clip, body).feet for clip in clips]
        self.dancers = Dancers(clips, body, standing, _fastest(clips) if peaks is None else peaks)
        self.fps = fps
        self._moves: list[Placed] = []
        self._count = 0
        self._frames = Frames.none(len(body.skeleton))
        self._changed: float | None = None
        self._settled = 0.0
        self._fixed = 0

    @property
    def end(self) -> float:
        """Second up to which moves are known; 0 at first."""
        return self._moves[-1].end if self._moves else 0.0

    @property
    def settled(self) -> float:
        """Second before which nothing ever changes."""
        return self._settled

    @property
    def margin(self) -> float:
        """Seconds after what is settled from which on a cut may lie now; at most ``MARGIN``."""
        return self._fixed / self.fps + LEAST - self._settled

    def settle(self, before: float) -> None:
        """What comes before a second never changes again.

        Raises
        ------
        PlanError
            If the second is within ``MARGIN`` of the end: there would be no room for the next join.
        """
        if before <= self._settled:
            return
        if not before <= self.end - MARGIN + 1e-9:
            raise PlanError(
                f"{before:.3f} s is to settle and {self.end:.3f} s of the dance are known; they must be known "
                f"{MARGIN:.2f} s further: add a move first"
            )
        self._made()
        self._settled = before
        self._fixed = max(self._fixed, self._free_from(int(np.ceil(before * self.fps)) + 3))

    def add(self, clip: int, from_s: float, to_s: float, rate: float = 1.0) -> None:
        """Show a stretch of a clip at the end; what goes on as the last move does only prolongs it.

        Parameters
        ----------
        clip : its place among the clips.
        from_s, to_s : seconds in it.
        rate : clip seconds a second.

        Raises
        ------
        PlanError
            If there is no such clip or stretch.
        """
        self._check(clip, from_s, to_s, rate)
        move = Move(clip, from_s, to_s, self.end, rate)
        if self._moves and self._moves[-1].goes_on_as(move):
            self._prolong(self.end + (to_s - from_s) / rate)
            return
        move = self._without_brief(move)
        self._change(move.at_s)
        self._count += 1
        last = self._moves[-1:]
        self._moves.append(self.dancers.next(last[0], move, self._count) if last else self.dancers.first(move))

    def cut(self, at: float) -> None:
        """Forget what comes after a second.

        Raises
        ------
        PlanError
            If the second is earlier than ``margin`` after what is settled, or later than the end.
        """
        if not (at <= self.end + 1e-9 and (at >= self._settled + self.margin - 1e-9)):
            raise PlanError(
                f"a cut at {at:.3f} s cannot be; from {self._settled + self.margin:.3f} s (what is settled, and room "
                f"for a join) to {self.end:.3f} s (the end) it can"
            )
        while self._moves and self._moves[-1].move.at_s > at - SHORTEST:
            self._change(max(self._moves.pop().move.at_s - LONGEST, 0.0))
        if self._moves and at < self._moves[-1].end:
            self._change(max(self._moves[-1].move.at_s, at - LONGEST))
            self._moves[-1] = self._moves[-1].until(at)

    def pose(self, times: Times) -> Pose:
        """Local rotations (N, J, 4) and root positions (N, 3) in metres at seconds (N,); outside the dance its ends'.

        Raises
        ------
        PlanError
            If nothing is there yet, or a second is forgotten or not a number.
        """
        return self._made().pose(self._asked(times))

    def contacts(self, times: Times) -> Bools:
        """(N, 2) true where the left, right foot is meant to rest on the floor at seconds (N,); raises as ``pose``."""
        return self._made().resting(self._asked(times))

    def showing(self, time: float) -> tuple[int, float]:
        """The clip shown at a second and the second of the clip; raises as ``pose``."""
        self._asked(np.array([time]))
        which = bisect_right(self._moves, time + 1e-9, key=lambda placed: placed.move.at_s) - 1
        placed = self._moves[max(which, 0)]
        return placed.move.clip, placed.second(min(time, placed.end))

    def forget(self, before: float) -> None:
        """Drop what comes before a second, as far as it is settled: it is not asked for again."""
        if not np.isfinite(before):
            return
        keep = int((min(before, self._settled) - KEPT) * self.fps)
        self._frames = self._frames.between(max(keep, self._frames.first), self._frames.after)
        over = sum(placed.end < self._frames.first / self.fps for placed in self._moves[:-1])
        del self._moves[:over]

    def _prolong(self, end: float) -> None:
        """Show the last move up to another second."""
        last = self._moves[-1]
        self._change(max(last.move.at_s, last.end - LONGEST))
        self._moves[-1] = last.until(end)

    def _without_brief(self, move: Move) -> Move:
        """The last move left out if it is too brief for a join before and one behind it.

        The one before it goes on in its place or, where its clip is over, the one to come begins earlier.
        """
        if len(self._moves) < 2 or self.end - self._moves[-1].move.at_s > BRIEF:
            return move
        before, end, fixed = self._moves[-2], self.end, self._fixed / self.fps
        earlier = replace(move, at_s=before.end, from_s=move.from_s - move.rate * (end - before.end))
        goes_on = before.second(end) <= self.dancers.clips[before.move.clip].duration + 1e-6 and before.end > fixed
        if not goes_on and not (earlier.from_s >= 0.0 and before.end >= fixed + LEAST):
            return move
        self._moves.pop()
        self._change(before.end - LONGEST)
        if goes_on:
            self._prolong(end)
        return move if goes_on else earlier

    def _change(self, at: float) -> None:
        """Frames from a second on are to be made anew."""
        self._changed = at if self._changed is None else min(at, self._changed)

    def _made(self) -> Frames:
        """The frames, those made anew that are to be."""
        if self._changed is not None and self._moves:
            first = self._joined_before(int((self._changed - BACK) * self.fps))
            which = bisect_right(self._moves, first / self.fps + 1e-9, key=lambda placed: placed.move.at_s) - 1
            moves = self._moves[max(which, 0) :]
            self._frames = self._frames.followed_by(grown(self.dancers, moves, self._frames, first, self.fps))
            self._changed = None
        return self._frames

    def _joined_before(self, frame: int) -> int:
        """The last frame up to this one, not fixed, before which no window of a join is open."""
        frame = max(min(frame, self._frames.after), self._fixed)
        while frame > self._fixed and (self._opens(frame) or self._joins_after(frame)):
            frame -= 1
        return frame

    def _joins_after(self, frame: int) -> bool:
        """Whether a join follows a frame so soon that its window may need more room."""
        soon = bisect_right(self._moves, frame / self.fps + LEAST, key=lambda placed: placed.move.at_s)
        return soon > 0 and self._moves[soon - 1].move.at_s > frame / self.fps

    def _free_from(self, frame: int) -> int:
        """The first frame from this one on before which no window of a join is open."""
        while self._opens(frame):
            frame += 1
        return frame

    def _opens(self, frame: int) -> bool:
        """Whether a frame, or one of those just before it, is inside the window of a join."""
        near = frame - self._frames.first
        return bool(self._frames.joining[max(near - CONTEXT, 0) : near + 1].any())

    def _asked(self, times: Times) -> Array:
        """Frame numbers (N,) of seconds."""
        times = np.asarray(times, np.float64)
        if not self._moves:
            raise PlanError("the dance has no moves yet; add one first")
        early = self._frames.first / self.fps + KEPT / 2 if self._frames.first else -np.inf
        if not (times >= early - 1e-9).all():
            raise PlanError(f"{np.min(times):.3f} s is asked for; the dance is remembered from {early:.3f} s on")
        return np.clip(times, 0.0, self.end) * self.fps

    def _check(self, clip: int, from_s: float, to_s: float, rate: float) -> None:
        if not 0 <= clip < len(self.dancers.clips):
            raise PlanError(f"clip {clip} is to be added; there are {len(self.dancers.clips)}, counted from 0")
        length = self.dancers.clips[clip].duration
        stretch = from_s >= -1e-6 and to_s <= length + 1e-6 and to_s - from_s >= SHORTEST * rate
        if not (stretch and SLOWEST <= rate <= QUICKEST):
            raise PlanError(
                f"{from_s:.3f}…{to_s:.3f} s of clip {clip} at rate {rate:g} are to be added; it lasts {length:.3f} s: "
                ""
                f"give a stretch of it, and a rate from {SLOWEST} to {QUICKEST}"
            )


def _fastest(clips: Sequence[Motion]) -> Array:
    """(J,) rad/s, the fastest each bone turns in the clips."""
    speeds = [link_speeds(c.skeleton, c.positions, c.times).max(axis=0, initial=0.0) for c in clips]
    return np.max(speeds, axis=0)
