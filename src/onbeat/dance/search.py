"""From a library and a song to a plan, by a method chosen by name."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from onbeat.dance.bound import most_earned
from onbeat.dance.candidates import find_part
from onbeat.dance.frames import RATES, lay_frames
from onbeat.dance.greedy import greedy_path
from onbeat.dance.lookahead import Roads
from onbeat.dance.optimal import Path, Problem, ValueToGo, best_path, score_path
from onbeat.dance.part import Part, cut_library
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.score import Music, score_music, z_rank
from onbeat.dance.seams import find_seams
from onbeat.dance.shiratori2006 import shiratori2006_path
from onbeat.dance.variety import beam_path
from onbeat.dance.walk import random_walk
from onbeat.dance.wished import Wished
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

JOIN = 0.36
"""What every join costs, in units of a stop on its beat."""
ROUGH = 0.40
"""What a join of pose distance ``ALIKE`` costs besides; it grows with the square of the distance."""
ALIKE = 0.30
METHODS = ("optimal", "shiratori2006", "greedy", "walk")
CHAPTER, AHEAD = 600.0, 15.0
"""Seconds of song searched at once, and seconds beyond them that are known."""
LARGEST = 1_500_000
"""Frames at all rates and joins of a library that is searched as a whole: about 20 s for a minute of song."""
PART = 40_000
"""Frames of the part of a greater one that is searched for a minute of song."""


@dataclass(frozen=True, eq=False)
class Searched:
    """What was searched of a library.

    Parameters
    ----------
    part : its stretches that were searched.
    whole : seconds of the library, mirror images counted.
    bound : what no dance with the whole library can be above (:mod:`onbeat.dance.bound`).
    """

    part: Part
    whole: float
    bound: float

    @property
    def seconds(self) -> float:
        """Seconds of the part."""
        return len(self.part) / GRID


@dataclass(frozen=True)
class Found:
    """A plan and how good it is.

    Parameters
    ----------
    plan : the moves.
    objective : the score of the plan.
    optimum : the score of the best plan of all on the same graph, repeats allowed; None where it was not computed.
    seconds : CPU seconds of the search.
    searched : what was searched of a library too great for the whole; then ``optimum`` is that of the part.
    """

    plan: DancePlan
    objective: float
    optimum: float | None
    seconds: float
    searched: Searched | None = None


def make_problem(
    library: MoveLibrary,
    song: Song,
    *,
    rhythm_only: bool = False,
    rates: tuple[float, ...] = RATES,
    part: Part | None = None,
    intensity_weight: float | None = None,
) -> Problem:
    """What the searches search: the frames and joins of a library or a part, the song's worth, and what joins cost."""
    if song.duration <= 0:
        raise PlanError("the song has no length; choose a stretch of it with --start and --seconds")
    music = score_music(song, rhythm_only=rhythm_only, weight=intensity_weight)
    graph, joins = library.graph, None
    if part is not None:
        graph = part.joins(library.graph)
        joins = part.frames[graph.sources], part.frames[graph.targets]
    costs = JOIN + ROUGH * (graph.costs / ALIKE) ** 2
    return Problem(
        graph, lay_frames(library, rates, part), music, costs.astype(np.float32), seams=find_seams(library, joins)
    )


def optimal(
    problem: Problem, *, variety: bool = True, step: Callable[[float], None] | None = None
) -> tuple[Path, float]:
    """The best path, without repeats or (``variety`` false) with, and the score of the best with.

    A song of up to ``CHAPTER`` seconds is searched as a whole, and one of which a part is kept; a longer one in
    chapters of that length, each knowing ``AHEAD`` seconds of the next, so that memory stays bounded. Then the optimum
    is that of the chapters.
    """
    total, chapter, ahead = problem.music.frames, round(CHAPTER * GRID), round(AHEAD * GRID)
    if problem.kept is not None:
        chapter = total  # what is kept later decides what can be danced now
    times: list[int] = []
    entries: list[int] = []
    begin, optimum, start = 0, 0.0, -1
    while begin < total:
        last = total - begin <= chapter + ahead
        part = problem.part(begin, total if last else begin + chapter + ahead)
        value = ValueToGo(part)
        path = beam_path(part, value, start=start) if variety else best_path(value, start=start)
        cut = len(path.times) if last else _cut(problem, path, chapter, total - begin)
        if not cut:  # nowhere to cut: the rest is searched as a whole
            chapter = total
            continue
        times += (path.times[:cut] + begin).tolist()
        entries += path.entries[:cut].tolist()
        optimum += value.optimum
        if last:
            break
        start, begin = int(path.entries[cut]), begin + int(path.times[cut])
        if step is not None:
            step(begin / total)
    return Path(np.array(times), np.array(entries), score_path(problem, times, entries)), optimum


def _cut(problem: Problem, path: Path, chapter: int, rest: int) -> int:
    """The last join up to ``chapter``, or the first after it, from which ``rest`` frames can be danced; 0 if none."""
    held = np.minimum(path.entries + problem.hold, len(problem.frames) - 1)
    lasting = path.times + problem.hold + Roads.of(problem).survival[held] >= rest
    cuts = np.flatnonzero(lasting[1:]) + 1
    if not len(cuts):
        return 0
    before = cuts[path.times[cuts] <= chapter]
    return int(before[-1] if len(before) else cuts[0])


def plan_of(problem: Problem, library: MoveLibrary, path: Path, duration: float) -> DancePlan:
    """A path as a plan in seconds."""
    laid = problem.frames
    at = [t / GRID for t in path.times.tolist()]
    moves: list[Move] = []
    for f, start, end in zip(path.entries.tolist(), at, [*at[1:], duration], strict=True):
        clip, rate, second = int(problem.graph.clip_of[laid.base[f]]), float(laid.rate[f]), float(laid.second[f])
        moves.append(Move(clip, second, second + rate * (end - start), start, rate))
    return DancePlan(tuple(moves), duration)


def search(
    library: MoveLibrary,
    song: Song,
    *,
    method: str = "optimal",
    rhythm_only: bool = False,
    variety: bool = True,
    seed: int = 0,
    wished: Wished | None = None,
    intensity_weight: float | None = None,
    step: Callable[[float], None] | None = None,
) -> Found:
    """Plan a dance.

    Parameters
    ----------
    library, song : what to dance with and to; ``song.beats`` are the beats to be met.
    method : ``optimal``, ``greedy`` (three seconds ahead on the same objective), ``shiratori2006`` or ``walk``.
    rhythm_only : leave intensity out.
    variety : for ``optimal``, do not show a stretch of a clip twice.
    seed : of ``walk``.
    wished : what a user wishes; ``walk`` listens to no favourites.
    intensity_weight : λ; by default ``score.INTENSITY``. The search of 2006 weighs nothing against intensity.
    step : called with the share of the song that is planned.

    Raises
    ------
    PlanError
        If there is no such method, or no dance as long as the song.
    """
    begun = time.process_time()
    if method not in METHODS:
        raise PlanError(f"no search method {method!r}; there are {', '.join(METHODS)}")
    settings = Settings(method, rhythm_only, variety, seed, step, wished, intensity_weight)
    found = settings.whole(library, song) if fits(library) else settings.part(library, song)
    return replace(found, seconds=time.process_time() - begun)


def fits(library: MoveLibrary) -> bool:
    """Whether a library is searched as a whole, frame by frame and join by join."""
    return len(library.graph) * sum(1 / rate for rate in RATES) + library.graph.join_count <= LARGEST


@dataclass(frozen=True)
class Settings:
    """How is searched, as :func:`search` takes it."""

    method: str
    rhythm_only: bool
    variety: bool
    seed: int
    step: Callable[[float], None] | None
    wished: Wished | None = None
    intensity_weight: float | None = None

    def whole(self, library: MoveLibrary, song: Song) -> Found:
        """By the method asked for, over all frames and joins, or over those of clips that are not forbidden."""
        part = None
        if self.wished is not None and self.wished.marks.forbidden.any():
            part = Part.of(self.wished.allowed(library), library.graph.clip_of)
        return self.within(library, song, part)

    def within(self, library: MoveLibrary, song: Song, part: Part | None) -> Found:
        """By the method asked for, over a library or a part of it."""
        problem = make_problem(
            library, song, rhythm_only=self.rhythm_only, part=part, intensity_weight=self.intensity_weight
        )
        if self.wished is not None:
            problem = self.wished.wanted(problem, part)
        optimum = None
        if self.method == "optimal":
            path, optimum = optimal(problem, variety=self.variety, step=self.step)
        elif self.method == "greedy":
            path = greedy_path(problem)
        elif self.method == "shiratori2006":
            liked = None if self.wished is None else self.wished.liked(part)
            path = shiratori2006_path(problem, library, song, rhythm_only=self.rhythm_only, part=part, liked=liked)
        else:
            path = random_walk(problem, np.random.default_rng(self.seed))
        return Found(plan_of(problem, library, path, song.duration), path.score, optimum, 0.0)

    def part(self, library: MoveLibrary, song: Song) -> Found:
        """Over the part of a great library that is worth it."""
        music = score_music(song, rhythm_only=self.rhythm_only, weight=self.intensity_weight)
        part = candidates(library, music, wished=self.wished)
        bound = float(most_earned(music, z_rank(library.intensity)).sum())
        if self.wished is not None:
            bound += music.frames * max(float((self.wished.favour + self.wished.taste).max()), 0.0)
        searched = Searched(part, len(library.graph) / GRID, bound)
        if self.method == "optimal" or self.wished is not None:
            return replace(self.within(library, song, part), searched=searched)
        found = self.whole(cut_library(library, part), song)
        return replace(found, plan=_within(found.plan, library, part), searched=searched)


def candidates(library: MoveLibrary, music: Music, frames: int | None = None, wished: Wished | None = None) -> Part:
    """The part of a great library that is worth searching for a song; by default ``PART`` frames for each minute."""
    minutes = max(1.0, music.frames / GRID / 60)
    count = round(PART * minutes) if frames is None else frames
    return find_part(library, music, (JOIN, ROUGH / ALIKE**2), count, wished=wished)


def _within(plan: DancePlan, library: MoveLibrary, part: Part) -> DancePlan:
    """A plan over the stretches of a part as one over the library's clips."""
    later = (part.first - library.starts[part.clip]) / GRID
    moves = [
        replace(
            move,
            clip=int(part.clip[move.clip]),
            from_s=move.from_s + float(later[move.clip]),
            to_s=move.to_s + float(later[move.clip]),
        )
        for move in plan.moves
    ]
    return DancePlan(tuple(moves), plan.duration)
