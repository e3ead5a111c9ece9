"""An earlier dance read back from its ``dance.json``: its plan to the frame, and its time warp.

The document tells where each move is entered and left in its clip and when it is seen, but neither its playback rate
nor its time in the plan. Both follow: the search enters and leaves clips on a grid of its own at each rate, so that
hardly ever more than one rate fits, and the moves must fill the song.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from msgspec import UNSET

from onbeat._shapes import Array, Times
from onbeat.dance.document import DanceDocument, MoveDocument
from onbeat.dance.frames import RATES
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.realise import realise
from onbeat.dance.shown import shown
from onbeat.dance.warp import Warp, fit_warp
from onbeat.errors import PlanError
from onbeat.motion.features import hand_features
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

FITS = 0.01
"""Frames by which a time may be off the search's grid, for the document is rounded."""
LONGEST = 1e5
"""Seconds that no clip and no song lasts."""
ON_TIME = 2e-3
"""Seconds by which a warp may show moves at other times than the document says."""


@dataclass(frozen=True, eq=False)
class Earlier:
    """An earlier dance.

    Parameters
    ----------
    names : of the clips that its moves show, one a move.
    plan : its moves; ``clip`` counts the clip in the library, −1 where the library does not have it.
    spans : (joins,) seconds that each of its blends lasts; NaN where that is not told.
    warp : dance time to plan time.
    """

    names: tuple[str, ...]
    plan: DancePlan
    spans: Array
    warp: Warp


def read_earlier(document: DanceDocument, library: MoveLibrary, beats: Times, duration: float) -> Earlier:
    """Read an earlier dance back.

    Parameters
    ----------
    document : its ``dance.json``.
    library : whose clips it showed.
    beats, duration : seconds, of the song that is danced to now; where the document has the same but for its
        rounding, these are taken.

    Raises
    ------
    PlanError
        If the moves of the document do not fill its song at the playback rates of the search.
    """
    length = duration if abs(duration - document.duration) < 1e-3 else document.duration
    _check(document)
    clips = {clip.name: k for k, clip in enumerate(library.clips)}
    names = tuple(move.clip for move in document.moves)
    moves: list[Move] = []
    at = 0
    rates = _rates(document.moves, length)
    for k, (told, rate) in enumerate(zip(document.moves, rates, strict=True)):
        enters = round(told.from_s / rate * GRID)
        lasts = round((told.to_s - told.from_s) / rate * GRID)
        seconds = length - at / GRID if k + 1 == len(rates) else lasts / GRID
        begin = enters * rate / GRID
        moves.append(Move(clips.get(told.clip, -1), begin, begin + rate * seconds, at / GRID, rate))
        at += lasts
    plan = DancePlan(tuple(moves), length)
    spans = np.array([join.to_s - join.from_s for join in document.joins])
    spans = spans if len(spans) == len(moves) - 1 else np.full(len(moves) - 1, np.nan)
    return Earlier(names, plan, spans, _warp(document, plan, library, beats))


def _check(document: DanceDocument) -> None:
    """Refuse times that no dance has, before anything is computed with them."""
    times = [t for move in document.moves for t in (move.from_s, move.to_s, move.at_s)]
    if not 0 < document.duration < LONGEST or any(not -1 < t < LONGEST for t in times):
        raise PlanError("the earlier dance has times that cannot be; keep stretches of a dance.json of `onbeat dance`")
    if document.warp is UNSET:
        return
    warp = np.array(document.warp)
    ends = len(warp) > 1 and abs(warp[0]) < 1e-3 and abs(warp[-1] - document.duration) < 1e-3
    if not (ends and np.all(np.diff(warp) > 0)):
        raise PlanError("the time warp of the earlier dance does not rise from 0 to its end; its dance.json is damaged")


def _rates(moves: list[MoveDocument], length: float) -> list[float]:
    """The playback rate of each move: such that all lie on the search's grid and fill ``length`` seconds."""
    ways: dict[int, tuple[float, list[float]]] = {0: (0.0, [])} if moves else {}
    for move in moves[:-1]:
        longer: dict[int, tuple[float, list[float]]] = {}
        for at, (off, rates) in ways.items():
            for rate in RATES:
                lasts = (move.to_s - move.from_s) / rate * GRID
                if _on_grid(move.from_s / rate * GRID) and _on_grid(lasts) and lasts > 0.5:
                    end, missed = at + round(lasts), off + abs(move.at_s - at / GRID)
                    if end not in longer or missed < longer[end][0]:
                        longer[end] = missed, [*rates, rate]
        ways = longer
    ends: list[tuple[float, list[float]]] = []
    for at, (off, rates) in ways.items():
        for rate in RATES:
            lasts = (moves[-1].to_s - moves[-1].from_s) / rate
            if _on_grid(moves[-1].from_s / rate * GRID) and abs(at / GRID + lasts - length) < 2e-3:
                ends.append((off + abs(moves[-1].at_s - at / GRID), [*rates, rate]))
    if not ends:
        raise PlanError(
            f"the {len(moves)} moves of the earlier dance do not fill its {length:g} s at the playback rates "
            f"{', '.join(f'{rate:g}' for rate in RATES)}; keep stretches of a dance.json as `onbeat dance` writes it"
        )
    return min(ends, key=lambda end: end[0])[1]


def _on_grid(frames: float) -> bool:
    return abs(frames - round(frames)) < FITS


def _warp(document: DanceDocument, plan: DancePlan, library: MoveLibrary, beats: Times) -> Warp:
    """The warp that the document tells, or the one that is fitted again, or at worst one through its joins."""
    starts = np.array([move.at_s for move in document.moves])
    planned = np.array([move.at_s for move in plan.moves])
    even = np.array([0.0, plan.duration])
    if document.warp is not UNSET:
        return Warp(np.linspace(0.0, plan.duration, len(document.warp)), np.array(document.warp))
    rates = document.metrics.get("warp")
    evenly = isinstance(rates, dict) and rates.get("rate_min") == rates.get("rate_max") == 1.0
    if evenly and np.abs(starts - planned).max() < 1e-4:
        return Warp(even, even)
    if all(move.clip >= 0 for move in plan.moves):
        same = len(beats) == len(document.beats) and np.allclose(beats, document.beats, atol=1e-4)
        again = _fitted(plan, library, beats if same else np.array(document.beats), document.fps)
        if np.abs(again.inverse(planned) - starts).max() < ON_TIME:
            return again
    return Warp(np.append(starts, plan.duration), np.append(planned, plan.duration))


def _fitted(plan: DancePlan, library: MoveLibrary, beats: Times, fps: float) -> Warp:
    few, moved = shown(library, plan)
    features = hand_features(realise([clip.motion for clip in few.clips], moved, fps).motion)
    return fit_warp(moved, features.body_stops, beats, features.times, features.speeds.max(axis=1))
