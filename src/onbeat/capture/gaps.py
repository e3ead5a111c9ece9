"""Markers that are not seen for a while, or jump: what can be filled from themselves and their neighbours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions
from onbeat.capture.pose import best_turns
from onbeat.motion import rotations as rot
from onbeat.motion.markers import Gap, Markers

SHORT_S = 0.2
"""Seconds up to which a gap is filled from the marker's own path."""
JUMP_M, FASTEST = 0.3, 12.0
"""A marker that goes farther than both from one frame to the next, in metres and at metres a second, has jumped."""
_SLOW = 4.0
_BESIDE_S = 0.05


@dataclass(frozen=True)
class Filled:
    """Markers after filling, and how each gap was filled.

    Parameters
    ----------
    markers : with fewer gaps.
    by_curve, by_neighbours, jumps : (F, M) what was filled by a cubic, what by the markers of the same bone, and what
        was taken as unseen because the marker jumped.
    """

    markers: Markers
    by_curve: Bools
    by_neighbours: Bools
    jumps: Bools


def fill_gaps(markers: Markers, clusters: Sequence[Sequence[int]] = ()) -> Filled:
    """Fill what can be filled without a body; nothing is filled before a marker is first or after it is last seen.

    Gaps of up to 0.2 s are bridged by a cubic that keeps place and speed at both ends. Longer ones follow the other
    markers of the same cluster (three or more of them, indices), moved as one rigid body (Kabsch 1976) and corrected
    linearly so that both ends fit.

    Examples
    --------
    >>> x = np.linspace(0, 1, 11)[:, None, None] * np.ones(3)
    >>> holed = x.copy()
    >>> holed[4:6] = np.nan
    >>> filled = fill_gaps(Markers(("C7",), holed, fps=30))
    >>> bool(np.allclose(filled.markers.positions, x)), filled.by_curve.sum()
    (True, np.int64(2))
    """
    positions = markers.positions.copy()
    jumped = find_jumps(positions, markers.fps)
    positions[jumped] = np.nan
    clean = Markers(markers.names, positions, markers.fps, markers.name)
    curve, neighbours = np.zeros_like(jumped), np.zeros_like(jumped)
    longest = int(np.floor(SHORT_S * markers.fps + 1e-6))
    long: list[Gap] = []
    for gap in clean.gaps():
        if gap.first == 0 or gap.end == len(markers):
            continue
        if gap.end - gap.first > longest:
            long.append(gap)
            continue
        index = markers.index(gap.name)
        reach = max(1, round(_BESIDE_S * markers.fps))
        positions[gap.first : gap.end, index] = _cubic(clean.positions[:, index], gap, reach)
        curve[gap.first : gap.end, index] = True
    before = positions.copy()
    for gap in long:
        index = markers.index(gap.name)
        others = [k for cluster in clusters if index in cluster for k in cluster if k != index]
        if len(others) >= 3 and _follow(before, positions, gap, index, np.array(others)):
            neighbours[gap.first : gap.end, index] = True
    result = Markers(markers.names, positions, markers.fps, markers.name)
    return Filled(result, curve, neighbours, jumped)


def _cubic(path: Positions, gap: Gap, reach: int) -> Positions:
    """Hermite's cubic from the last frame before to the first after the gap; speeds from some frames beside them."""
    a, b, span = gap.first - 1, gap.end, gap.end - gap.first + 1
    chord = (path[b] - path[a]) / span
    out, into = (_speed(path, at, step, chord) * span for at, step in ((a, -reach), (b, reach)))
    t = (np.arange(1, span) / span)[:, None]
    return (
        path[a] * (2 * t**3 - 3 * t**2 + 1)
        + out * (t**3 - 2 * t**2 + t)
        + path[b] * (3 * t**2 - 2 * t**3)
        + into * (t**3 - t**2)
    )


def _speed(path: Positions, at: int, step: int, otherwise: Positions) -> Positions:
    """Metres a frame at one end of a gap, by the parabola through three frames on its far side (or two, or none)."""
    for k in (step, np.sign(step)):
        beside = [at + int(k), at + 2 * int(k)]
        if min(beside) >= 0 and max(beside) < len(path) and np.isfinite(path[beside]).all():
            return (4 * path[beside[0]] - path[beside[1]] - 3 * path[at]) / (2 * int(k))
    return otherwise


def _follow(before: Positions, positions: Positions, gap: Gap, index: int, others: Ints) -> bool:
    """Fill a gap from the other markers of the bone where all of a choice of three or more are seen throughout."""
    frames = slice(gap.first - 1, gap.end + 1)
    others = others[np.isfinite(before[frames][:, others]).all(axis=(0, 2))]
    if len(others) < 3:
        return False
    cloud = before[frames][:, others]
    shape = cloud[0] - cloud[0].mean(axis=0)
    turns, good = best_turns(shape, cloud - cloud.mean(axis=1, keepdims=True), np.ones(cloud.shape[:2]))
    if not good.all():
        return False
    path = cloud.mean(axis=1) + rot.rotate(turns, before[gap.first - 1, index] - cloud[0].mean(axis=0))
    part = (np.arange(len(path)) / (len(path) - 1))[:, None]
    path = path + part * (before[gap.end, index] - path[-1])
    positions[gap.first : gap.end, index] = path[1:-1]
    return True


def find_jumps(positions: Positions, fps: float) -> Bools:
    """(F, M) where a marker is not where it can be: a ghost, or another marker under its label.

    A path is cut where it jumps (:data:`JUMP_M`); from its longest piece on, a piece is believed when the marker can
    have come there from the last one believed.
    """
    jumped = np.zeros(positions.shape[:2], bool)
    limit = max(JUMP_M, FASTEST / fps)
    for index in range(positions.shape[1]):
        frames = np.flatnonzero(np.isfinite(positions[:, index, 0]))
        steps = np.diff(positions[frames, index], axis=0)
        allowed = limit + _SLOW * np.maximum(np.diff(frames) - 1, 0) / fps
        cuts = np.flatnonzero(np.linalg.norm(steps, axis=1) > allowed) + 1
        if len(cuts):
            for piece in _unbelieved(positions[:, index], np.split(frames, cuts), limit, fps):
                jumped[piece, index] = True
    return jumped


def _unbelieved(path: Positions, pieces: list[Ints], limit: float, fps: float) -> list[Ints]:
    start = max(range(len(pieces)), key=lambda k: len(pieces[k]))
    rejected: list[Ints] = []
    for order, last, first in ((range(start + 1, len(pieces)), -1, 0), (range(start - 1, -1, -1), 0, -1)):
        anchor = int(pieces[start][last])
        for piece in (pieces[k] for k in order):
            seconds = (abs(int(piece[first]) - anchor) - 1) / fps
            if np.linalg.norm(path[piece[first]] - path[anchor]) > limit + _SLOW * seconds:
                rejected.append(piece)
            else:
                anchor = int(piece[last])
    return rejected


def trust(seen: Bools, fps: float, seconds: float = 0.1) -> Array:
    """(F, M) weights that fall smoothly to 0 towards a gap, over ``seconds``: no pose jumps where one begins."""
    frames = np.arange(len(seen))[:, None]
    hidden = np.where(seen, -(10**9), frames)
    before = frames - np.maximum.accumulate(hidden, axis=0)
    hidden = np.where(seen, 10**9, frames)
    after = np.minimum.accumulate(hidden[::-1], axis=0)[::-1] - frames
    near = np.clip(np.minimum(before, after) / (seconds * fps + 1.0), 0.0, 1.0)
    return near * near * (3 - 2 * near)
