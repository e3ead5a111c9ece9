"""All scores of a motion that is danced to a song, in one call."""

from __future__ import annotations

import numpy as np

from onbeat.errors import MetricError
from onbeat.metrics import beats, feet, intensity, smoothness
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.features import hand_features
from onbeat.motion.motion import Motion
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats

NO_JOINS = np.zeros(0)
_PLANNED = ("_joins", "_source", "_ratio")  # names of what only the plan of a dance can tell

SOME_CONTACT = 0.1
"""Part of the frames in which a foot has to bear on the floor, for the speed of feet that do to say something."""

Scores = dict[str, float | None]
"""Of one module: None where a number cannot be had."""


def _unplanned(scores: Scores) -> Scores:
    """The scores that need no plan; without joins, ``elsewhere`` is all of the motion."""
    kept = {name: value for name, value in scores.items() if not any(part in name for part in _PLANNED)}
    return {name.replace("_elsewhere", ""): value for name, value in kept.items()}


def evaluate_motion(motion: Motion, song: Song, seed: int = 0) -> dict[str, Scores]:
    """All scores of a motion that begins with the song, over the time both last, by the module that gives them.

    Beats too fast or slow to dance to are halved or doubled as the planner of dances does.

    Parameters
    ----------
    motion : the dance.
    song : it is danced to; what of it was played before the motion begins is cut off (``song.cut``).
    seed : draws the chance levels.

    Raises
    ------
    MetricError
        If they have no time in common.

    Examples
    --------
    >>> from onbeat.examples import embedded_song
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[3], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> scores = evaluate_motion(clip.motion, embedded_song(seconds=9.0)[0])
    >>> sorted(scores), scores["feet"]["over_reach_m"]
    (['beats', 'feet', 'intensity', 'smoothness'], 0.0)
    """
    duration = min(motion.duration, song.duration)
    if duration <= 0:
        raise MetricError("the motion begins after the song has ended; choose an earlier start")
    heard = danceable_beats(song).cut(0.0, duration)
    features = hand_features(motion)
    rng = np.random.default_rng(seed)
    scores: dict[str, Scores] = {
        "beats": beats.evaluate(features.body_stops, heard.beats, duration, rng, heard.downbeats),
        "intensity": intensity.evaluate_dance(features, heard, duration),
        "feet": _feet(motion),
        "smoothness": _unplanned(smoothness.evaluate(motion, NO_JOINS)),
    }
    return {module: {name: _rounded(value) for name, value in found.items()} for module, found in scores.items()}


def _feet(motion: Motion) -> Scores:
    """Scores of the feet, with ``contact_part``, the part of the frames in which one bears on the floor.

    Where hardly any does, the few moments would make a perfect ``skate``: there is none then.
    """
    contacts = foot_contacts(motion).feet
    scores = _unplanned(feet.evaluate(motion, contacts, NO_JOINS))
    part = float(contacts.any(axis=1).mean())
    untold = {name: None for name in scores if name.startswith("skate") and part < SOME_CONTACT}
    return {"contact_part": part, **scores, **untold}


def _rounded(value: float | None) -> float | None:
    return round(value, 6) if isinstance(value, float) else value
