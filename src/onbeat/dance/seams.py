# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""What a join does to the stops of the hands beside it.

A stop is a slow moment between two movements, so a join near it makes it or unmakes it. Each join's blend is therefore
looked at before the search: near a join at s the hands move as

    v(t) = (1 − Φ(t)) v_A(t) + Φ(t) v_B(t) + D S′(t),      D = p_B(s) − p_A(s)

with S the quintic of the blend, and Φ the step at s, both seen through the smoothing of the speed. The stops found in
this speed are held against those that the two clips have by themselves; the search earns the difference.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.special import ndtr

from onbeat._shapes import Array, Float32, Ints
from onbeat.dance.score import FINE
from onbeat.motion.features import DIP, MOVING, SMOOTHING, TOGETHER, hand_paths
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

RATE = 60.0  # Hz at which joins are looked at
SEEN = 1.2  # s on each side of a join in which movements are followed
CHANGED = 0.45  # s on each side in which stops may change
SPAN = 0.35  # s; the usual length of a blend
SAME = 0.03  # s; a stop moved by less is the same stop


@dataclass(frozen=True)
class Seams:
    """Stops made (+1) and unmade (−1) by each join.

    Parameters
    ----------
    indptr : (joins + 1,) int32; those of join e are ``indptr[e]:indptr[e + 1]``.
    at : int32 when, in units of 1 / (GRID · FINE) s after the join.
    sign : float32 +1 or −1.
    """

    indptr: NDArray[np.int32]
    at: NDArray[np.int32]
    sign: Float32


def find_seams(library: MoveLibrary, joins: tuple[Ints, Ints] | None = None) -> Seams:
    """Look at all joins of a library, or at ``joins`` from frames to frames of its graph."""
    leave, enter = (library.graph.sources, library.graph.targets) if joins is None else joins
    if len(leave) == 0:  # no way from one clip into another is left: each is danced for itself
        return Seams(np.zeros(1, np.int32), np.zeros(0, np.int32), np.zeros(0, np.float32))
    clip_of = library.graph.clip_of
    used = np.unique(np.concatenate((clip_of[leave], clip_of[enter]))) if joins else np.arange(len(library.clips))
    paths, speeds, starts = _hands(library, used)
    place = np.zeros(len(library.clips), np.int64)
    place[used] = np.arange(len(used))
    leaving, entering = clip_of[leave], clip_of[enter]
    leave, enter = leave - library.starts[leaving], enter - library.starts[entering]
    leaving, entering = place[leaving], place[entering]
    left = starts[leaving] + np.round(leave * RATE / GRID).astype(np.int64)
    right = starts[entering] + np.round(enter * RATE / GRID).astype(np.int64)
    half = round(SEEN * RATE)
    times = np.arange(-half, half + 1) / RATE
    stops = [library.clips[clip].stops for clip in used.tolist()]
    stop_ptr = np.concatenate(([0], np.cumsum([len(s) for s in stops]))).astype(np.int64)
    count, at, sign = _compare(
        paths, speeds, starts, left, right, leaving, entering, leave / GRID, enter / GRID,
        stop_ptr, np.concatenate([*stops, np.zeros(1)]), ndtr(times / SMOOTHING), _easing(times), half,
    )  # fmt: skip
    indptr = np.concatenate(([0], np.cumsum(count))).astype(np.int32)
    return Seams(indptr, np.round(at * GRID * FINE).astype(np.int32), sign)


def _hands(library: MoveLibrary, used: Ints) -> tuple[Array, Array, Ints]:
    """Paths (n, 2, 3) m and velocities m/s of the hands at ``RATE``, smoothed, clips in a row; and their starts."""
    paths: list[Array] = []
    for clip in used.tolist():
        motion = library.clips[clip].motion
        motion = motion if motion.fps == RATE else motion.at(_times(motion.duration))
        paths.append(gaussian_filter1d(hand_paths(motion), SMOOTHING * RATE, axis=0, mode="nearest"))
    speeds = [np.gradient(path, axis=0) * RATE for path in paths]
    starts = np.concatenate(([0], np.cumsum([len(path) for path in paths]))).astype(np.int64)
    return np.concatenate(paths), np.concatenate(speeds), starts


def _times(duration: float) -> Array:
    return np.arange(max(2, int(duration * RATE))) / RATE


def _easing(times: Array) -> Array:
    """S′ in 1/s: how fast the offset between two clips is eased, seen through the smoothing."""
    fine = np.arange(-SEEN, SEEN, 0.001)
    u = np.clip(fine / SPAN + 0.5, 0.0, 1.0)
    slope = 30 * u**2 * (1 - u) ** 2 / SPAN
    return np.interp(times, fine, gaussian_filter1d(slope, SMOOTHING / 0.001))


@njit(cache=True, nogil=True)
def _stops(speed, times, moving, dip, out):
    """As ``features.find_stops``, into ``out``; how many were found."""
    count, peak, valley, place = 0, 0.0, 1e9, -1
    for i in range(len(speed)):
        value = speed[i]
        if value > peak and place < 0:
            peak = value
        elif peak >= moving:
            if value < valley:
                valley, place = value, i
            if valley <= dip * peak and value >= max(moving, valley / dip):
                shift = 0.0
                if 0 < place < len(speed) - 1:
                    bend = speed[place - 1] - 2 * speed[place] + speed[place + 1]
                    if bend > 1e-12:
                        shift = 0.5 * (speed[place - 1] - speed[place + 1]) / bend
                if count < len(out):
                    out[count] = times[0] + (place + shift) * (times[1] - times[0])
                    count += 1
                peak, valley, place = value, 1e9, -1
            elif value >= peak:
                peak, valley, place = value, 1e9, -1
    return count


@njit(cache=True, nogil=True)
def _merge(left, n, right, m, together, out):
    """As ``features.merge_stops``, into ``out``."""
    i = j = count = 0
    while (i < n or j < m) and count < len(out):
        if i < n and j < m and abs(left[i] - right[j]) <= together:
            out[count] = (left[i] + right[j]) / 2
            i, j = i + 1, j + 1
        elif j >= m or (i < n and left[i] < right[j]):
            out[count] = left[i]
            i += 1
        else:
            out[count] = right[j]
            j += 1
        count += 1
    return count


@njit(cache=True, nogil=True)
def _compare(
    paths, speeds, starts, left, right, leave_clip, enter_clip, leave_s, enter_s, stop_ptr, stops, step, easing, half
):
    """For each join how many stops change, and the changes one after the other."""
    joins, size = len(left), 2 * half + 1
    times = (np.arange(size) - half) / RATE
    count = np.zeros(joins, np.int64)
    at, sign = np.empty(joins * 4 + 16), np.empty(joins * 4 + 16, np.float32)
    total = 0
    speed = np.empty(size)
    found = np.empty((2, 16))
    made, own = np.empty(32), np.empty(32)
    for e in range(joins):
        a_low, a_high = starts[leave_clip[e]], starts[leave_clip[e] + 1] - 1
        b_low, b_high = starts[enter_clip[e]], starts[enter_clip[e] + 1] - 1
        numbers = (0, 0)
        for hand in range(2):
            i0, j0 = min(left[e], a_high), min(right[e], b_high)
            dx = paths[j0, hand, 0] - paths[i0, hand, 0]
            dy = paths[j0, hand, 1] - paths[i0, hand, 1]
            dz = paths[j0, hand, 2] - paths[i0, hand, 2]
            for k in range(size):
                a, b = min(max(i0 + k - half, a_low), a_high), min(max(j0 + k - half, b_low), b_high)
                w, s = step[k], easing[k]
                x = (1 - w) * speeds[a, hand, 0] + w * speeds[b, hand, 0] + s * dx
                y = (1 - w) * speeds[a, hand, 1] + w * speeds[b, hand, 1] + s * dy
                z = (1 - w) * speeds[a, hand, 2] + w * speeds[b, hand, 2] + s * dz
                speed[k] = np.sqrt(x * x + y * y + z * z)
            n = _stops(speed, times, MOVING, DIP, found[hand])
            numbers = (n, numbers[1]) if hand == 0 else (numbers[0], n)
        many = _merge(found[0], numbers[0], found[1], numbers[1], TOGETHER, made)
        few = 0
        for k in range(stop_ptr[leave_clip[e]], stop_ptr[leave_clip[e] + 1]):
            time = stops[k] - leave_s[e]
            if -CHANGED < time < 0 and few < len(own):
                own[few] = time
                few += 1
        for k in range(stop_ptr[enter_clip[e]], stop_ptr[enter_clip[e] + 1]):
            time = stops[k] - enter_s[e]
            if 0 <= time < CHANGED and few < len(own):
                own[few] = time
                few += 1
        if total + many + few > len(at):
            more = np.empty(2 * len(at) + 64)
            more[:total] = at[:total]
            at = more
            signs = np.empty(len(more), np.float32)
            signs[:total] = sign[:total]
            sign = signs
        for m in range(many):
            if abs(made[m]) < CHANGED:
                same = False
                for k in range(few):
                    if abs(own[k] - made[m]) < SAME:
                        same = True
                        own[k] = 1e9  # each stop is matched once
                        break
                if not same:
                    at[total], sign[total] = made[m], 1
                    total += 1
                    count[e] += 1
        for k in range(few):
            if own[k] < 1e8:
                at[total], sign[total] = own[k], -1
                total += 1
                count[e] += 1
    return count, at[:total], sign[:total]
