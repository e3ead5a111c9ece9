# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""A dance that does not repeat itself: beam search guided by the exact value to go.

Showing a stretch of source again costs ``REPEAT``, which makes the score depend on the past, so that dynamic
programming no longer finds the best path. A beam of partial dances is kept instead, each with the set of stretches it
has shown, ranked by what they have earned plus the exact value to go *without* the rule: a bound that is never too
low. Of partial dances that reach the same frame at the same time only the best few are kept.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat.dance.optimal import BARRED, Path, Problem, ValueToGo, best_entries, rewards, score_path, seam

BEAM = 600
"""Partial dances kept at each song frame."""
ALIKE = 3
"""Partial dances kept that reach one frame at one time: they have shown different things on the way."""
REPEAT = 3.0
"""What showing one stretch of source (a quarter of a second) again costs: more than any beat can earn there."""


@njit(cache=True, inline="always")
def _shown(history, row, block):
    return (history[row, block >> 6] >> np.uint64(block & 63)) & np.uint64(1)


@njit(cache=True, inline="always")
def _show(history, row, block):
    history[row, block >> 6] |= np.uint64(1) << np.uint64(block & 63)


@njit(cache=True)
def _highest(values, count, keep):
    """A value that at most about ``keep`` of the first ``count`` values exceed, by a histogram."""
    if count <= keep:
        return np.float64(-1e29)
    low, high = np.float64(1e30), np.float64(-1e30)
    for i in range(count):
        if values[i] > -1e29:
            low, high = min(low, values[i]), max(high, values[i])
    if high <= low:
        return low
    low = max(low, high - 40.0)
    bins = np.zeros(2048, np.int64)
    scale = 2047.0 / (high - low)
    for i in range(count):
        if values[i] >= low:
            bins[int((values[i] - low) * scale)] += 1
    total = 0
    for b in range(2047, -1, -1):
        total += bins[b]
        if total > keep:  # many that are alike at the top are all kept: a beam must not lose its best
            return low + (b + 1 if total > bins[b] else b - 0.5) / scale
    return low


@njit(cache=True)
def _seat(frame, mark, earned, gains, free, stamp, place, held):
    """The row for a partial dance that reaches ``frame``: a free one, that of the worst there, or −1 if it is worse."""
    if stamp[frame] != mark:
        stamp[frame], held[frame] = mark, 0
    if held[frame] < ALIKE:
        if free >= len(gains):
            return -1
        place[frame, held[frame]] = free
        held[frame] += 1
        return free
    worst = place[frame, 0]
    for k in range(1, ALIKE):
        if gains[place[frame, k]] < gains[worst]:
            worst = place[frame, k]
    return worst if gains[worst] < earned else -1


@njit(cache=True, boundscheck=False)
def _advance(
    begin,
    end,
    frames,
    hold,
    buffer,
    sums,
    rings,
    state,
    nodes,
    free_node,
    left,
    block,
    repeat,
    indptr,
    goal_of,
    costs,
    base,
    ends,
    entries,
    stops,
    worth,
    shift,
    motion,
    idle,
    beats,
    music,
    must,
    seam_ptr,
    seam_at,
    seam_sign,
    promise,
):
    """Move the beam from song frame ``begin`` to ``end``.

    ``state`` is (frame, gain, node, history, count) in ``hold`` + 1 buckets by arrival time; ``nodes`` is (parent,
    time, entry), one a join. ``sums`` are those of frame ``begin`` − 1, ``rings`` the rewards of the frames since.
    """
    where, gain, node, history, count = state
    parent, at, entered = nodes
    slots, width = where.shape
    words = history.shape[2]
    size, goals = len(base), entries.shape[1]
    best, which = np.empty(goals, np.float32), np.empty(goals, np.int32)
    stamp = np.full(size, -1, np.int64)
    place = np.zeros((size, ALIKE), np.int64)
    held = np.zeros(size, np.int64)
    fan = 1
    for i in range(len(indptr) - 1):
        fan = max(fan, indptr[i + 1] - indptr[i])
    candidates = np.empty(width * fan, np.float64)
    origin, target = np.empty(len(candidates), np.int64), np.empty(len(candidates), np.int64)
    scratch = np.zeros((1, words), np.uint64)
    floor = BARRED / 2
    for t in range(begin, end):
        span = min(hold, frames - t)
        if t > 0:  # sums along the diagonals, those at t from those at t − 1
            old = rings[(t - 1) % hold]
            for f in range(size - 1, 0, -1):
                sums[f] = sums[f - 1] - old[f - 1]
            if t - 1 + hold < frames:
                new = rings[(t - 1) % hold]
                rewards(t - 1 + hold, new, stops, worth, shift, motion, idle, beats, music, must)
                for f in range(1, size - hold + 1):
                    sums[f] += new[f + hold - 1]
            sums[0] = 0.0  # no diagonal comes from before the first frame: its sum is made anew
            for k in range(min(span, size)):
                sums[0] += rings[(t + k) % hold][k]
        row_now = rings[t % hold]
        best_entries(sums, buffer[t + span - begin], span, entries, best, which)
        slot = t % slots
        # thin the beam to what the width allows, best bounds first
        n = count[slot]
        for s in range(n):
            candidates[s] = gain[slot, s] + buffer[t - begin, where[slot, s]]
        threshold = max(_highest(candidates, n, width // 2), BARRED / 2)
        kept = 0
        for s in range(n):
            if candidates[s] >= threshold:
                if kept != s:
                    where[slot, kept], gain[slot, kept], node[slot, kept] = where[slot, s], gain[slot, s], node[slot, s]
                    history[slot, kept] = history[slot, s]
                kept += 1
        n = kept
        # joins: candidates by their bound, then the price of what they show again
        many = 0
        for s in range(n):
            i = base[where[slot, s]]
            for e in range(indptr[i], indptr[i + 1]):
                bound = gain[slot, s] - costs[e] + best[goal_of[e]]
                if t > 0 and bound + promise[e] > floor:
                    bound += seam(t, e, seam_ptr, seam_at, seam_sign, beats)
                    candidates[many], origin[many], target[many] = bound, s, which[goal_of[e]]
                    many += 1
        threshold = _highest(candidates, many, width)
        floor = max(
            threshold - 1.5 * repeat, BARRED / 2
        )  # joins far under what was kept a moment ago are not looked at
        for c in range(many):
            if candidates[c] < threshold:
                continue
            g = target[c]
            last = -1
            for k in range(span):
                if block[g + k] != last:
                    last = block[g + k]
                    if must[t + k] < 0 and _shown(history[slot], origin[c], last):
                        candidates[c] -= repeat
        threshold = max(threshold - 0.5 * repeat, _highest(candidates, many, width // 2))
        arrival = (t + span) % slots
        m = count[arrival]
        for s in range(m):
            _seat(where[arrival, s], t, np.inf, gain[arrival], s, stamp, place, held)
        for c in range(many):
            if candidates[c] < threshold:
                continue
            g = target[c]
            reach = g + span
            after = buffer[t + span - begin, reach]
            earned = candidates[c] - after
            row = _seat(reach, t, earned, gain[arrival], m, stamp, place, held)
            if row < 0:
                continue
            m = max(m, row + 1)
            source = origin[c]
            for w in range(words):
                scratch[0, w] = history[slot, source, w]
            for k in range(span):
                _show(scratch, 0, block[g + k])
            for w in range(words):
                history[arrival, row, w] = scratch[0, w]
            if free_node >= len(parent):
                return free_node
            parent[free_node], at[free_node], entered[free_node] = node[slot, source], t, g
            where[arrival, row], gain[arrival, row], node[arrival, row] = reach, earned, free_node
            free_node += 1
        count[arrival] = m
        # those who go on in their clip
        slot_next = (t + 1) % slots
        m = count[slot_next]
        for s in range(m):
            _seat(where[slot_next, s], frames + t, np.inf, gain[slot_next], s, stamp, place, held)
        for s in range(n):
            f = where[slot, s]
            if left[f] == 0 and t + 1 < frames:
                continue
            earned = gain[slot, s] + row_now[f]
            g = f + 1 if left[f] > 0 else f
            fresh = t > 0 and block[f] != block[f - 1]  # f is shown now, and f − 1 was shown before it
            if fresh and must[t] < 0 and _shown(history[slot], s, block[f]):
                earned -= repeat
            row = _seat(g, frames + t, earned, gain[slot_next], m, stamp, place, held)
            if row < 0:
                continue
            m = max(m, row + 1)
            where[slot_next, row], gain[slot_next, row], node[slot_next, row] = g, earned, node[slot, s]
            for w in range(words):
                history[slot_next, row, w] = history[slot, s, w]
            if fresh:
                _show(history[slot_next], row, block[f])
        count[slot_next] = m
        count[slot] = 0
    return free_node


def beam_path(
    problem: Problem, value: ValueToGo, beam: int | None = None, repeat: float | None = None, start: int = -1
) -> Path:
    """The best of ``beam`` partial dances, led by ``value``, that (nearly) never shows a stretch of source twice."""
    beam, repeat = beam or BEAM, REPEAT if repeat is None else repeat
    frames = value.total
    laid = problem.frames
    slots, width, words = problem.hold + 1, 2 * beam, (laid.blocks + 63) // 64
    state = (
        np.zeros((slots, width), np.int64),
        np.zeros((slots, width)),
        np.zeros((slots, width), np.int64),
        np.zeros((slots, width, words), np.uint64),
        np.zeros(slots, np.int64),
    )
    most = frames * width + width
    nodes = (np.zeros(most, np.int32), np.zeros(most, np.int32), np.zeros(most, np.int32))
    _, _, rows = value.stretch(0)
    starts = np.argsort(-rows[0], kind="stable")[:width] if start < 0 else np.array([start])
    held = 0 if start < 0 else min(problem.hold, frames)  # a given start has just been joined: it must be danced first
    for s, f in enumerate(starts.tolist()):
        state[0][held, s], state[2][held, s] = f + held, s
        nodes[0][s], nodes[1][s], nodes[2][s] = -1, 0, f
        for block in np.unique(laid.block[f : f + max(held, 1)]).tolist():
            state[3][held, s, block >> 6] |= np.uint64(1) << np.uint64(block & 63)
        for block in kept_blocks(problem).tolist():
            state[3][held, s, block >> 6] |= np.uint64(1) << np.uint64(block & 63)
    state[4][held] = len(starts)
    free, t = len(starts), 0
    rings = np.zeros((problem.hold, len(laid)), np.float32)
    sums = _first_sums(problem, rings)
    while t < frames:
        begin, end, rows = value.stretch(t)
        free = _advance(
            begin, end, frames, problem.hold, rows, sums, rings, state, nodes, free,
            laid.left, laid.block, repeat, *problem.arrays,
        )  # fmt: skip
        t = end
    last = frames % slots
    winner = int(np.argmax(state[1][last, : state[4][last]]))
    return _walk_back(problem, nodes, int(state[2][last, winner]))


def kept_blocks(problem: Problem) -> np.ndarray:
    """The stretches of source that kept frames show wholly: no other part of the dance is to show them again."""
    must = problem.must[problem.must >= 0].astype(np.int64)
    runs = np.split(problem.frames.block[must], np.flatnonzero(np.diff(must) != 1) + 1)
    inside = [run[(run != run[0]) & (run != run[-1])] for run in runs if len(run)]
    return np.unique(np.concatenate([*inside, np.zeros(0, np.int64)]))


def _first_sums(problem: Problem, rings: np.ndarray) -> np.ndarray:
    """Sums of the first rewards along the diagonals from song frame 0; ``rings`` takes the rewards."""
    size = len(problem.frames)
    sums = np.zeros(size)
    for k in range(min(problem.hold, problem.music.frames)):
        rewards(k, rings[k], *problem.worth)
        sums[: size - k] += rings[k][k:]
    return sums


def _walk_back(problem: Problem, nodes: tuple[np.ndarray, np.ndarray, np.ndarray], node: int) -> Path:
    times: list[int] = []
    entries: list[int] = []
    while node >= 0:
        times.append(int(nodes[1][node]))
        entries.append(int(nodes[2][node]))
        node = int(nodes[0][node])
    times, entries = times[::-1], entries[::-1]
    return Path(np.array(times), np.array(entries), score_path(problem, times, entries))
