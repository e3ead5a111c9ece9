"""The main job in one call: a song and a motion library in, a dance on the music out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import msgspec
import numpy as np
from threadpoolctl import threadpool_limits

from onbeat._shapes import Times
from onbeat.dance.document import VERSION, DanceDocument, JoinDocument, MoveDocument
from onbeat.dance.plan import DancePlan
from onbeat.dance.realise import Realised, realise
from onbeat.dance.report import Measured, measure
from onbeat.dance.search import Found, search
from onbeat.dance.shown import shown
from onbeat.dance.warp import KNOT, Warp, fit_warp
from onbeat.dance.wished import Wished
from onbeat.dance.wishes import NO_WISHES, Wishes
from onbeat.errors import PlanError
from onbeat.motion.features import hand_features
from onbeat.motion.motion import Motion
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats, fold_of

LONGEST = 1200.0
"""Seconds of song that one dance may last: its motion is held in memory whole."""
Step = Callable[[str, float], None]


def clock(seconds: float) -> str:
    """Minutes and seconds, with its unit; a part of a second counts as one.

    Examples
    --------
    >>> clock(1229.2)
    '20:30 minutes'
    """
    whole = math.ceil(seconds)
    return f"{whole // 60}:{whole % 60:02d} minutes"


@dataclass(frozen=True, eq=False)
class Dance:
    """A dance and how it came about.

    Parameters
    ----------
    motion : exactly as long as the song, at the asked rate.
    song : with the beats that are danced to.
    plan : the moves, before the time warp.
    warp : dance time to plan time; None where it was not asked for.
    realised : the motion with its joins and contacts.
    found : what the search says of its plan.
    stops : seconds at which the hands come to rest, found on the finished motion.
    document : ``dance.json``.
    """

    motion: Motion
    song: Song
    plan: DancePlan
    warp: Warp | None
    realised: Realised
    found: Found
    stops: Times
    document: DanceDocument


def make_dance(
    song: Song,
    library: MoveLibrary,
    *,
    fps: float | None = None,
    seed: int = 0,
    method: str = "optimal",
    rhythm_only: bool = False,
    warp: bool = True,
    wishes: Wishes = NO_WISHES,
    intensity_weight: float | None = None,
    as_told: bool = False,
    step: Step | None = None,
) -> Dance:
    """Dance to a song with the moves of a library.

    Parameters
    ----------
    song : as heard by ``onbeat.listen``; its tempo is folded to one that is danced to, unless ``as_told``.
    library : clips and the graph that joins them.
    fps : frames per second of the dance; by default those of the library's clips.
    seed : of the random nulls in the metrics, and of the method ``walk``; where a stretch is kept, of what is liked
        a little better in the rest of the dance.
    method : one of ``search.METHODS``.
    rhythm_only : leave intensity out (the ablation of Shiratori et al. 2006, Fig. 8).
    warp : move stops onto beats by a small time warp.
    wishes : clips never to show or to show rather, stretches of earlier dances to dance again.
    intensity_weight : λ, how much following the music's intensity counts; by default ``score.INTENSITY``.
    as_told : dance to the beats of the song as they are: somebody has said that they are right.
    step : called with what is done now and the share of all done, 0…1.

    Raises
    ------
    PlanError
        If the song has no beats or is too long, the library cannot fill it, or a wish cannot be met.

    Examples
    --------
    >>> from onbeat.examples import embedded_song
    >>> from onbeat.moves.embedded import embedded_library
    >>> dance = make_dance(embedded_song(seconds=8.0)[0], embedded_library(), fps=30)
    >>> len(dance.motion), dance.document.method
    (240, 'optimal')
    """
    say = step or _silent
    heard, song = song.tempo, danceable(song, as_told)
    fps = max(clip.fps for clip in library.clips) if fps is None else fps
    if not 1.0 <= fps <= 1000.0:
        raise PlanError(f"{fps:g} frames a second cannot be; give a rate from 1 to 1000")
    with threadpool_limits(1, "blas"):  # products of matrices on more threads differ in their last bits
        say("searching", 0.0)
        wished = Wished.of(wishes, library, song, seed) if wishes else None
        found = search(
            library, song, method=method, rhythm_only=rhythm_only, seed=seed, wished=wished,
            intensity_weight=intensity_weight, step=lambda s: say("searching", s),
        )  # fmt: skip
        few, plan = shown(library, found.plan)
        clips = [clip.motion for clip in few.clips]
        say("dancing", 0.0)
        first = realise(clips, plan, fps)
        features = hand_features(first.motion)
        done, fitted = first, None
        held, spans = ((), None) if wished is None else (wished.held(), wished.spans(plan))
        if warp or held:
            say("warping", 0.0)
            beats = song.beats if warp else song.beats[:0]
            fitted = fit_warp(plan, features.body_stops, beats, features.times, features.speeds.max(axis=1), held=held)
            done = realise(clips, plan, fps, fitted, spans=spans)
        say("measuring", 0.0)
        measured = measure(few, song, replace(found, plan=plan), first, done, fitted, seed)
    document = _document(library, song, found, done, fitted, measured, fps, seed, method)
    if fold_of(heard, song.tempo):
        document = msgspec.structs.replace(document, heard_bpm=round(heard, 2))
    if wished is not None:
        document = _with_wishes(document, wished, found.plan, library, fitted)
    say("measuring", 1.0)
    return Dance(done.motion, song, found.plan, fitted, done, found, measured.stops, document)


def _with_wishes(
    document: DanceDocument, wished: Wished, plan: DancePlan, library: MoveLibrary, warp: Warp | None
) -> DanceDocument:
    """The document with what came of the wishes, and the warp, so that the dance can be kept in its turn."""
    metrics = document.metrics | {"wishes": wished.told(plan, library)}
    if warp is None:
        return msgspec.structs.replace(document, metrics=metrics)
    even = np.linspace(0.0, plan.duration, round(plan.duration / KNOT) + 1)
    return msgspec.structs.replace(document, metrics=metrics, warp=[round(t, 7) for t in warp(even).tolist()])


def danceable(song: Song, as_told: bool = False) -> Song:
    """The song with the beats that are danced to; arguments as of :func:`make_dance`.

    Raises
    ------
    PlanError
        If it is too long for one dance, or has fewer than two beats.
    """
    if song.duration > LONGEST:
        raise PlanError(
            f"the song lasts {clock(song.duration)}; a dance lasts at most {clock(LONGEST)}: "
            "choose a stretch with --start and --seconds"
        )
    song = song if as_told else danceable_beats(song)
    if len(song.beats) < 2:
        count = "one beat is" if len(song.beats) else "no beat is"
        raise PlanError(
            f"{count} heard in {song.duration:.1f} s of {song.title or 'the song'}; at least 2 are needed: choose "
            "another stretch with --start and --seconds, or say where the beats are with --beats or --tap"
        )
    return song


def _silent(what: str, share: float) -> None:
    """Nobody watches."""


def _document(
    library: MoveLibrary,
    song: Song,
    found: Found,
    done: Realised,
    warp: Warp | None,
    measured: Measured,
    fps: float,
    seed: int,
    method: str,
) -> DanceDocument:
    joined = found.plan.join_times if warp is None else warp.inverse(found.plan.join_times)
    shown = [0.0, *joined.tolist()]
    moves = [
        MoveDocument(library.clips[move.clip].name, round(move.from_s, 4), round(move.to_s, 4), round(start, 4))
        for move, start in zip(found.plan.moves, shown, strict=True)
    ]
    joins = [
        JoinDocument(round(start, 4), round(end, 4), round(float(error), 2))
        for (start, end), error in zip(done.windows, measured.link_errors.tolist(), strict=True)
    ]
    return DanceDocument(
        version=VERSION,
        fps=fps,
        duration=round(song.duration, 4),
        seed=seed,
        method=method,
        beats=[round(beat, 4) for beat in song.beats.tolist()],
        stops=[round(stop, 4) for stop in measured.stops.tolist()],
        moves=moves,
        metrics=measured.metrics,
        title=song.title,
        joins=joins,
    )
