"""The search of Shiratori et al. 2006, Sec. V: three seconds ahead, first by rhythm, then by intensity.

From where the dance is, all paths over the next T seconds are compared by how their stops meet the beats,

    MatchEval_beat(t, path) = Σ_τ MC_stop(t + τ; path) · ASC_beat(t + τ)                            (Eq. 11)

and of the best few of these the one is danced that fits the song's intensity best,

    arg max_path  Σ_τ MC_intensity(t + τ; path) · ASC_intensity(t + τ)                              (Eq. 12)

up to and over its first branch, where the next T seconds are looked at. Read so: the best few paths are those of
different first branches, each with its best completion, that come near the best; completions alike in Eq. 11 are told
apart by Eq. 12. ASC_beat is the degree of chord change at each beat (Eq. 6), so that a beat without any counts for
nothing; a song without any chord change at all has beats of degree 1. Motion plays at its own rate, joins cost nothing,
nothing forbids repeats.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Bools, Float32, Ints
from onbeat.dance.greedy import HORIZON, follow
from onbeat.dance.lookahead import IMPOSSIBLE, Branches, Roads
from onbeat.dance.optimal import BARRED, NO_WAY, Path, Problem, score_path
from onbeat.dance.part import Part
from onbeat.dance.score import PHRASE
from onbeat.errors import PlanError
from onbeat.motion.body import Body
from onbeat.motion.features import hand_features, keyframe_component
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

BEST_PATHS = 16
"""How many of the best paths by Eq. 11 are compared by Eq. 12 at most ("several" in the paper)."""
NEAR = 0.95
"""What part of the best path's Eq. 11 they reach at least: where few branches are, not all of them are best."""
LEAD = 60
"""Frames before a kept stretch of another rate from which on its clip may be entered at that rate."""
TIE = 1e-6
"""What Eq. 12 counts beside Eq. 11 where completions of one branch are alike."""


@dataclass(frozen=True, eq=False)
class Components:
    """The four components that Eqs. 11 and 12 correlate.

    Parameters
    ----------
    stop, motion : (N,) MC_stop (Eq. 1) and MC_intensity (Eq. 2, m/s) of each frame of the motion graph.
    beat, music : (T,) ASC_beat (Eq. 6) and ASC_intensity (Eq. 7) of each song frame.
    liked : (N,) what a frame counts in Eq. 11 besides because it is wished for; not in the paper.
    must : (T,) the frame that a song frame must show, −1 where any may be.
    """

    stop: Array
    motion: Array
    beat: Array
    music: Array
    liked: Array | float = 0.0
    must: Ints | None = None

    def rhythm(self, t: int, ahead: int) -> Array:
        """(H, N) terms of Eq. 11 for ``ahead`` song frames from t on, or to the song's end."""
        terms = self.beat[t : t + ahead, None] * self.stop + self.liked
        if self.must is None:
            return terms
        must = self.must[t : t + ahead, None]
        return np.where((must >= 0) & (np.arange(terms.shape[1]) != must), float(BARRED), terms)

    def intensity(self, t: int, ahead: int) -> Array:
        """(H, N) terms of Eq. 12."""
        return self.music[t : t + ahead, None] * self.motion


def components(library: MoveLibrary, song: Song, frames: int, part: Part | None = None) -> Components:
    """Read the components off a library, or a part of it, and a song of ``frames`` song frames."""
    part = Part.whole(library) if part is None else part
    stop = np.zeros(len(library.graph))
    for number in np.unique(part.clip).tolist():
        clip, begin = library.clips[number], int(library.starts[number])
        stops = hand_features(clip.motion, Body.of(clip.motion.skeleton)).stops
        stop[begin : begin + len(clip.poses)] = keyframe_component(stops, np.arange(len(clip.poses)) / GRID)
    degree = song.chord_change if np.any(song.chord_change > 0) else np.ones(len(song.beats))
    beat = np.zeros(frames)
    np.maximum.at(beat, np.clip(np.round(song.beats * GRID).astype(np.int64), 0, frames - 1), degree)
    music = song.intensity_at((np.arange(frames, dtype=np.float64) + 0.5) / GRID)
    music = gaussian_filter1d(music, PHRASE * GRID, mode="nearest")
    return Components(stop[part.frames], library.intensity[part.frames], beat, music)


def shiratori2006_path(
    problem: Problem,
    library: MoveLibrary,
    song: Song,
    *,
    rhythm_only: bool = False,
    horizon_s: float = HORIZON,
    part: Part | None = None,
    liked: Float32 | None = None,
) -> Path:
    """The paper's dance, scored by ``problem`` so that it can be held against the others.

    Parameters
    ----------
    problem : of ``library`` and ``song``; its objective is not looked at, only its frames and joins.
    rhythm_only : leave Eq. 12 out, as in the paper's Fig. 8, bottom.
    horizon_s : T, seconds looked ahead.
    part : the part of the library that the problem is over; the whole by default.
    liked : (N,) what frames of the problem's graph count in Eq. 11 besides.

    Raises
    ------
    PlanError
        If no dance over the joins is as long as the song, or the problem has no rate of 1.
    """
    roads, shown, begins = _own_rate(problem) if problem.kept is None else _own_rate_and_kept(problem)
    parts = components(library, song, roads.frames, part)
    if liked is not None:
        parts = replace(parts, liked=liked)
    if problem.kept is not None:
        parts = _at_all_rates(parts, problem)
    if rhythm_only:
        parts = replace(parts, motion=np.zeros(len(parts.motion)))
    ahead = max(round(horizon_s * GRID), 1)
    frame = _begin(roads, parts, ahead, begins)
    t, times, entries = 0, [0], [frame]
    while t < roads.frames:
        found, chosen = _chosen(roads, parts, frame, t, ahead)
        t, frame = follow(roads, found, chosen, t, frame, times, entries)
    laid = shown[np.array(entries)]
    return Path(np.array(times), laid, score_path(problem, times, laid))


def _own_rate(problem: Problem) -> tuple[Roads, Ints, Bools]:
    """The graph's own frames as roads without costs, the virtual frame of each at rate 1, and where to begin."""
    laid, graph = problem.frames, problem.graph
    rates = np.flatnonzero(np.abs(laid.rate[laid.entry[:, 0]] - 1.0) < 1e-9)
    if not len(rates):
        raise PlanError("the search of 2006 plays motion at its own rate; the problem has no rate of 1")
    shown = laid.entry[rates[0]]
    nodes, goals = np.arange(len(graph)), problem.goals[0]
    left = laid.left[shown]
    entries = np.where(left[goals] > problem.hold, goals, -1)[None]
    roads = replace(
        Roads.of(problem),
        base=nodes,
        left=left,
        costs=np.zeros(graph.join_count),
        entries=entries,
        seams=_no_seams(graph.join_count),
    )
    return roads, shown, np.ones(len(nodes), bool)


def _own_rate_and_kept(problem: Problem) -> tuple[Roads, Ints, Bools]:
    """All virtual frames as roads without costs, entered at rate 1, or at that of a kept stretch on the way to it."""
    laid, must = problem.frames, problem.must[problem.must >= 0].astype(np.int64)
    open_to = np.abs(laid.rate - 1.0) < 1e-9
    back = np.minimum(LEAD, must[:, None] - _row_starts(laid.left)[must][:, None])
    open_to[(must[:, None] - np.minimum(np.arange(LEAD + 1), back)).ravel()] = True
    entry = np.where((laid.entry >= 0) & open_to[laid.entry], laid.entry, -1)
    own = replace(
        problem,
        frames=replace(laid, entry=entry),
        join_costs=np.zeros(problem.graph.join_count, np.float32),
        seams=None,
    )
    return Roads.of(own), np.arange(len(laid)), open_to


def _row_starts(left: Ints) -> Ints:
    """(M,) where the frames of the same clip and rate begin."""
    return np.concatenate(([0], np.flatnonzero(left == 0) + 1))[np.cumsum(np.concatenate(([0], left[:-1] == 0)))]


def _at_all_rates(parts: Components, problem: Problem) -> Components:
    """Components of virtual frames instead of the graph's, and what must be shown."""
    base, liked = problem.frames.base, np.asarray(parts.liked)
    return replace(
        parts,
        stop=parts.stop[base],
        motion=parts.motion[base],
        liked=liked[base] if liked.ndim else 0.0,
        must=problem.must,
    )


def _no_seams(joins: int) -> tuple[NDArray[np.int32], NDArray[np.int32], Float32, Float32]:
    """Joins that change no stops."""
    return np.zeros(joins + 1, np.int32), np.zeros(0, np.int32), np.zeros(0, np.float32), np.zeros(joins, np.float32)


def _begin(roads: Roads, parts: Components, ahead: int, begins: Bools) -> int:
    """The frame to begin with: the ``BEST_PATHS`` best by Eq. 11, of these the best by Eq. 12."""
    rhythm, intensity = parts.rhythm(0, ahead), parts.intensity(0, ahead)
    table = rhythm + TIE * intensity
    values = roads.values(0, table)
    worth = np.where(begins, values[0], IMPOSSIBLE)
    if worth.max() < BARRED / 2:
        raise PlanError(NO_WAY)
    best = _best(worth)
    sums = [_along(roads, (table, intensity, values), 0, int(f), 0) for f in best]
    return int(best[int(np.argmax(sums))])


def _chosen(roads: Roads, parts: Components, frame: int, t: int, ahead: int) -> tuple[Branches, int]:
    """The branches from ``frame`` and which of them is danced."""
    rhythm, intensity = parts.rhythm(t, ahead), parts.intensity(t, ahead)
    table = rhythm + TIE * intensity
    values = roads.values(t, table, roads.hold)
    found = roads.branches(t, frame, table, values)
    best = _best(found.value)
    before = np.concatenate(([0.0], np.cumsum(_diagonal(intensity, 0, frame, roads.left[frame] + 1))))
    sums = [
        before[wait] + (_entered(roads, (table, intensity, values), t, entry, wait) if entry >= 0 else 0.0)
        for wait, entry in zip(found.wait[best].tolist(), found.entry[best].tolist(), strict=True)
    ]
    return found, int(best[int(np.argmax(sums))])


def _best(values: Array) -> Ints:
    """Places of the ``BEST_PATHS`` highest values that are ``NEAR`` the highest."""
    best = np.argsort(-values, kind="stable")[:BEST_PATHS]
    top = float(values[best[0]])
    return best[values[best] >= (NEAR * top if top >= 0 else top / NEAR)]


def _diagonal(table: Array, k: int, frame: int, most: int) -> Array:
    """Terms of a run through one clip from row k and ``frame`` on, at most ``most`` of them, within the horizon."""
    steps = np.arange(min(most, len(table) - k))
    return table[k + steps, frame + steps]


def _entered(roads: Roads, tables: tuple[Array, Array, Array], t: int, entry: int, k: int) -> float:
    """Eq. 12 from a join at row k to ``entry`` on, along the best completion by Eq. 11."""
    held = float(_diagonal(tables[1], k, entry, roads.hold).sum())
    if k + roads.hold >= len(tables[0]):
        return held
    return held + _along(roads, tables, t, entry + roads.hold, k + roads.hold)


def _along(roads: Roads, tables: tuple[Array, Array, Array], t: int, frame: int, k: int) -> float:
    """Eq. 12 from ``frame`` at row k on, along the best completion by Eq. 11.

    ``tables`` are Eq. 11's terms, Eq. 12's, and the values to the horizon; row 0 is song frame t.
    """
    table, intensity, values = tables
    total = 0.0
    while k < len(table):
        found = roads.branches(t + k, frame, table[k:], values[k:])
        best = int(np.argmax(found.value))
        wait, entry = int(found.wait[best]), int(found.entry[best])
        total += float(_diagonal(intensity, k, frame, wait).sum())
        k += wait
        if entry < 0:
            break
        total += float(_diagonal(intensity, k, entry, roads.hold).sum())
        k, frame = k + roads.hold, entry + roads.hold
    return total
