# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""A beam of partial dances over a motion graph of any size, in numba; :mod:`onbeat.dance.candidates` says what for."""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat.dance.score import FINE

LOOK = 120
"""Song frames that a stretch is looked ahead."""
STEP = 3
"""Frames between those at which intensity is looked at: it is smooth."""
TAIL = 12
"""Frames that a stretch is kept beyond the best moment to leave it."""
FAR = 2.0
"""A stretch that has fallen so far behind its best is looked at no further."""
GOALS = 1 << 17  # joins looked at from the frames of one song frame


@njit(cache=True, boundscheck=False)
def _prospect(t, g, least, frames, motion, idle, left, stops, shifts, next_stop, spent, beats, music):
    """What is best earned from frame g on at song frame t, after how many frames (``least`` or more), and after least.

    Less what is to be expected of that time.
    """
    best, when, landed = -1e30, 0, -1e30
    if least == 0:
        best, landed = 0.0, 0.0
    longest = min(left[g] + 1, frames - t, LOOK)
    s, k, earned, value = next_stop[g], 0, 0.0, 0.0
    while k < longest:
        n = min(STEP, longest - k)
        earned += n * (motion[g + k] * music[t + k] - idle[g + k])
        k += n
        while s < len(stops) and stops[s] < g + k:
            earned += beats[(t + stops[s] - g + 4) * FINE + shifts[s]]
            s += 1
        value = earned - (spent[t + k] - spent[t])
        if k == least:
            landed = value
        if k >= least:
            if value > best:
                best, when = value, k
            elif value < best - FAR:
                break
    return best, when, landed


@njit(cache=True, boundscheck=False)
def _threshold(values, count, keep):
    """The value that ``keep`` of the first ``count`` values reach."""
    if count <= keep:
        return -1e29
    ordered = np.sort(values[:count])
    return ordered[count - keep]


@njit(cache=True, boundscheck=False)
def walk(
    frames, hold, width, indptr, targets, costs, join, rough,
    motion, idle, left, stops, shifts, next_stop, spent, beats, music,
):  # fmt: skip
    """Walk from the song's beginning to its end.

    Returns for each stretch passed its parent, the song frame and the library's frame at which it is entered, the
    frames it is best danced, and by how much it is less than the best that is danced at that time.
    """
    size, slots, fresh = len(left), hold + 1, width // 4
    room = 2 * width + fresh
    where, node, until = (
        np.zeros((slots, room), np.int64),
        np.zeros((slots, room), np.int64),
        np.zeros((slots, room), np.int64),
    )
    gain, peak = np.zeros((slots, room)), np.zeros((slots, room))
    count = np.zeros(slots, np.int64)
    most = width + frames * fresh
    parent, time, entry = np.empty(most, np.int32), np.empty(most, np.int32), np.empty(most, np.int32)
    length, worth = np.empty(most, np.int32), np.empty(most)
    free = 0
    stamp, place = np.full(size, -1, np.int32), np.zeros(size, np.int32)
    score, origin, landing = np.empty(GOALS), np.empty(GOALS, np.int64), np.empty(GOALS)
    goal, lasts, promise = np.empty(GOALS, np.int64), np.empty(GOALS, np.int64), np.empty(GOALS)
    top = np.full(frames + 1, -1e30)
    # the best beginnings
    begin = np.empty(size)
    for g in range(size):
        begin[g] = -1e30
        if g % 2 == 0 and left[g] >= hold:
            begin[g] = _prospect(0, g, hold, frames, motion, idle, left, stops, shifts, next_stop, spent, beats, music)[
                0
            ]
    least = _threshold(begin, size, width)
    for g in range(size):
        if begin[g] >= least and begin[g] > -1e29 and free < width:
            best, when, _ = _prospect(
                0, g, hold, frames, motion, idle, left, stops, shifts, next_stop, spent, beats, music
            )
            parent[free], time[free], entry[free], length[free], worth[free] = -1, 0, g, when, best
            where[0, free], node[0, free], until[0, free], gain[0, free], peak[0, free] = g, free, when, 0.0, best
            free += 1
    count[0] = free
    for t in range(frames):
        slot, n = t % slots, 0
        mark = 2 * t
        for s in range(count[slot]):  # of those at one frame the best stays
            f = where[slot, s]
            if until[slot, s] <= t:
                best, when, _ = _prospect(
                    t, f, 0, frames, motion, idle, left, stops, shifts, next_stop, spent, beats, music
                )
                peak[slot, s], until[slot, s] = gain[slot, s] + best, t + max(when, 1)
            row = n
            if stamp[f] == mark:
                row = place[f]
                if gain[slot, row] >= gain[slot, s]:
                    continue
            else:
                stamp[f], place[f] = mark, n
                n += 1
            where[slot, row], node[slot, row], until[slot, row] = f, node[slot, s], until[slot, s]
            gain[slot, row], peak[slot, row] = gain[slot, s], peak[slot, s]
        for s in range(n):
            score[s] = peak[slot, s]
            top[t] = max(top[t], score[s])
        least = _threshold(score, n, width)
        # joins from where they stand: each goal from the best of those that lead there
        many = 0
        mark = 2 * t + 1
        limit = -1e29
        if 0 < t <= frames - hold:
            for s in range(n):
                if peak[slot, s] < least:
                    continue
                i = where[slot, s]
                for e in range(indptr[i], indptr[i + 1]):
                    g = targets[e]
                    if left[g] < hold:
                        continue
                    left_with = gain[slot, s] - (join + rough * costs[e] * costs[e])
                    if stamp[g] == mark:
                        c = place[g]
                        if score[c] < left_with + promise[c]:
                            landing[c] += left_with + promise[c] - score[c]
                            score[c], origin[c] = left_with + promise[c], s
                        continue
                    if many == len(goal):
                        continue
                    best, when, landed = _prospect(
                        t, g, hold, frames, motion, idle, left, stops, shifts, next_stop, spent, beats, music
                    )
                    stamp[g], place[g] = mark, many
                    goal[many], origin[many], lasts[many], promise[many] = g, s, when, best
                    score[many], landing[many] = left_with + best, left_with + landed
                    many += 1
            limit = _threshold(score, many, fresh)
        arrival = (t + hold) % slots
        m = count[arrival]
        for c in range(many):
            if score[c] < limit or free >= most or m >= room:
                continue
            parent[free], time[free], entry[free], length[free], worth[free] = (
                node[slot, origin[c]],
                t,
                goal[c],
                lasts[c],
                score[c],
            )
            where[arrival, m], node[arrival, m], until[arrival, m] = goal[c] + hold, free, t + lasts[c]
            gain[arrival, m], peak[arrival, m] = landing[c], score[c]
            m += 1
            free += 1
        count[arrival] = m
        # those who go on in their clip
        following = (t + 1) % slots
        m = count[following]
        for s in range(n):
            f = where[slot, s]
            if peak[slot, s] < least or left[f] == 0 or m >= room:
                continue
            earned = motion[f] * music[t] - idle[f] - (spent[t + 1] - spent[t])
            k = next_stop[f]
            if k < len(stops) and stops[k] == f:
                earned += beats[(t + 4) * FINE + shifts[k]]
            where[following, m], node[following, m], until[following, m] = f + 1, node[slot, s], until[slot, s]
            gain[following, m], peak[following, m] = gain[slot, s] + earned, peak[slot, s]
            m += 1
        count[following] = m
        count[slot] = 0
    for k in range(free):
        worth[k] = top[time[k]] - worth[k]
    last, best, winner = frames % slots, -1e30, 0
    for s in range(count[last]):  # the way that is best at the end comes before all
        if gain[last, s] > best:
            best, winner = gain[last, s], node[last, s]
    if best > -1e29:
        worth[winner] = -1e30
    return parent[:free], time[:free], entry[:free], length[:free], worth[:free]


@njit(cache=True, boundscheck=False)
def mark_ways(parent, time, entry, length, order, left, frames, kept):
    """Set ``kept`` where stretches and the ways to them lie, in ``order``, until ``frames`` are set."""
    done = np.zeros(len(parent), np.bool_)
    total = 0
    for k in order:
        if total >= frames:
            return
        node, lasts = k, length[k]
        while node >= 0:
            g = entry[node]
            for f in range(g, g + min(lasts + TAIL, left[g]) + 1):
                if not kept[f]:
                    kept[f] = True
                    total += 1
            if done[node]:
                break
            done[node] = True
            above = parent[node]
            if above >= 0:
                lasts = time[node] - time[above]
            node = above
