"""What is measured of a finished dance: on the beat, with the music's intensity, on its feet, smooth, varied.

The warp flatters the beat scores of anything, so they are given before it and after it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.dance.realise import Realised
from onbeat.dance.search import Found
from onbeat.dance.warp import Warp
from onbeat.metrics import beats, feet, intensity, smoothness, variety
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.features import HandFeatures, hand_features
from onbeat.motion.motion import Motion
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

Scores = dict[str, float | None]


@dataclass(frozen=True, eq=False)
class Measured:
    """The figures of a dance.

    Parameters
    ----------
    metrics : by group, as in ``dance.json``.
    stops : seconds of the stops of the finished dance.
    link_errors : degrees, of each join.
    """

    metrics: dict[str, Scores]
    stops: Times
    link_errors: Array


def measure(
    library: MoveLibrary, song: Song, found: Found, first: Realised, done: Realised, warp: Warp | None, seed: int
) -> Measured:
    """Measure a dance on its joints: ``first`` as it was before the time warp, ``done`` as it is."""
    before, after = hand_features(first.motion), hand_features(done.motion)
    plan, clips = found.plan, library.clips
    spans = [(move.clip, move.from_s, move.to_s) for move in plan.moves]
    source = shown_stretches(library, found)
    errors = smoothness.join_link_errors([clip.motion for clip in clips], spans)
    joins = np.array(done.windows).reshape(-1, 2)
    strong = np.intersect1d(song.beats, song.downbeats)
    metrics: dict[str, Scores] = {
        "search": _searched(found),
        "beats_before_warp": _beats(before, song, strong, seed),
        "beats": _beats(after, song, strong, seed),
        "warp": _warped(before, after, warp, found),
        "intensity": intensity.evaluate_dance(after, song, song.duration),
        "feet": feet.evaluate(done.motion, done.contacts, joins, source),
        "smoothness": smoothness.evaluate(done.motion, joins, [motion for motion, _ in source]),
        "variety": dict(variety.evaluate(spans, song.duration, [clip.source for clip in clips])),
    }
    metrics["smoothness"] |= {"link_error_deg": float(errors.mean()) if len(errors) else None}
    rounded = {group: {name: _rounded(value) for name, value in scores.items()} for group, scores in metrics.items()}
    return Measured(rounded, after.body_stops, errors)


def shown_stretches(library: MoveLibrary, found: Found) -> list[tuple[Motion, Bools]]:
    """The stretches of the clips that the dance shows, with their contacts: what the dance is held against."""
    stretches: list[tuple[Motion, Bools]] = []
    contacts: dict[int, Bools] = {}
    for move in found.plan.moves:
        motion = library.clips[move.clip].motion
        if move.clip not in contacts:
            contacts[move.clip] = foot_contacts(motion).feet
        low, high = int(move.from_s * motion.fps), int(np.ceil(move.to_s * motion.fps)) + 1
        stretches.append((motion[low:high], contacts[move.clip][low:high]))
    return stretches


def _beats(features: HandFeatures, song: Song, strong: Times, seed: int) -> Scores:
    return beats.evaluate(
        features.body_stops, song.beats, song.duration, np.random.default_rng(seed), strong if len(strong) else None
    )


def _searched(found: Found) -> Scores:
    """How good the plan is; of a part of a library also what part it was, and how far below the bound at most."""
    gap = None if not found.optimum else found.objective / found.optimum
    scores: Scores = {"objective": found.objective, "optimum_with_repeats": found.optimum, "of_optimum": gap}
    if found.searched is None:
        return scores
    part, bound, best = found.searched, found.searched.bound, found.optimum or found.objective
    below = 1 - best / bound if bound > 0 else None
    return scores | {"searched_s": part.seconds, "library_s": part.whole, "bound": bound, "gap_at_most": below}


def _warped(before: HandFeatures, after: HandFeatures, warp: Warp | None, found: Found) -> Scores:
    """Rates of the warp, and of clips as they are seen (the plan's own rates included)."""
    rates = np.ones(1) if warp is None else warp.rates
    own = seen = np.array([move.rate for move in found.plan.moves])
    if warp is not None:
        middles = (warp.knots[:-1] + warp.knots[1:]) / 2
        seen = rates * own[found.plan.clip_times(warp(middles))[0]]
    peak = float(before.speeds.max(initial=0.0))
    return {
        "rate_min": float(rates.min()),
        "rate_max": float(rates.max()),
        "playback_min": float(seen.min()),
        "playback_max": float(seen.max()),
        "peak_hand_speed_ratio": float(after.speeds.max()) / peak if peak > 0 else None,
    }


def _rounded(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value), 5)
