"""The dances of the 2006 paper's experiments: as published, with rhythm alone, onbeat's, and by chance."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Times
from onbeat.dance.make import Dance, make_dance
from onbeat.dance.realise import realise
from onbeat.dance.warp import fit_warp
from onbeat.errors import OnbeatError
from onbeat.metrics import beats, intensity
from onbeat.motion.features import HandFeatures, hand_features
from onbeat.motion.motion import Motion
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats
from onbeat.reproduce.data import Data
from onbeat.reproduce.p1.songs import Tune

FPS = 30.0
"""Frames a second of the dances, which are measured and drawn, not played."""


@dataclass(frozen=True)
class Method:
    """A way to dance to a song.

    Parameters
    ----------
    search : the method of ``onbeat dance``.
    published : whether the song is heard as in the paper.
    rhythm_only : whether the music's intensity is left out.
    centred : whether it is counted from its mean, which makes of the products that Eq. 12 sums a correlation.
    warp : whether stops are then moved onto beats.
    """

    search: str
    published: bool = False
    rhythm_only: bool = False
    centred: bool = False
    warp: bool = True


METHODS = {
    "published": Method("shiratori2006", published=True, warp=False),
    "published rhythm": Method("shiratori2006", published=True, rhythm_only=True, warp=False),
    "published centred": Method("shiratori2006", published=True, centred=True, warp=False),
    "ours": Method("optimal"),
    "ours rhythm": Method("optimal", rhythm_only=True),
    "walk": Method("walk"),
}
"""The ways that are compared."""


@dataclass(frozen=True, eq=False)
class Danced:
    """A dance and how well it goes with what is true of its song.

    Parameters
    ----------
    tune : the song.
    dance : before any time warp.
    motion : as it is danced, after the warp where there is one.
    features : of ``motion``.
    scores : of ``motion``: beats as :mod:`onbeat.metrics.beats`, intensity as :mod:`onbeat.metrics.intensity`;
        ``heard_f100`` and ``heard_pearson`` are against the beats and the intensity as heard, ``hand_speed`` is the
        hands' mean speed, m/s.
    before : the same before the warp.
    """

    tune: Tune
    dance: Dance
    motion: Motion
    features: HandFeatures
    scores: dict[str, float | None]
    before: dict[str, float | None]


def open_library(data: Data) -> MoveLibrary:
    """The clips and their joins, without mirror images: the paper danced with the clips as captured."""
    from onbeat.moves.cache import build_or_open
    from onbeat.moves.embedded import embedded_library

    if data.embedded:
        return embedded_library(data.seed, mirror=False)
    data.motion_files()  # says what is wrong with the paths
    return build_or_open(data.motions, mirror=False, fps=data.fps)


def true_beats(tune: Tune) -> Times:
    """The true beats that one dances to: of fast songs every other, as the dances have it."""
    return danceable_beats(tune.truth).beats


def dance(tune: Tune, library: MoveLibrary, method: Method, seed: int) -> Danced:
    """Dance to a song by a method and measure it.

    Raises
    ------
    OnbeatError
        If no beats are heard in the song, or the clips cannot fill it.
    """
    song = tune.published if method.published else tune.ours
    if method.centred and len(song.intensity):
        song = replace(song, intensity=song.intensity - song.intensity.mean())
    try:
        plain = make_dance(
            song, library, fps=FPS, seed=seed, method=method.search, rhythm_only=method.rhythm_only, warp=False
        )
    except OnbeatError as error:
        raise type(error)(f"{tune.title}: {error}") from None
    features = hand_features(plain.motion)
    before = score(features, tune, song, seed)
    if not method.warp:
        return Danced(tune, plain, plain.motion, features, before, before)
    motion = _warped(plain, library, features)
    after = hand_features(motion)
    return Danced(tune, plain, motion, after, score(after, tune, song, seed), before)


def score(features: HandFeatures, tune: Tune, heard: Song, seed: int) -> dict[str, float | None]:
    """Beats and intensity of a dance against what is true of its song; also against what was ``heard``."""
    rng, duration = np.random.default_rng(seed), tune.truth.duration
    on_beat = beats.evaluate(features.body_stops, true_beats(tune), duration, rng)
    as_heard = intensity.evaluate_dance(features, heard, duration)["intensity_pearson"]
    return (
        on_beat
        | intensity.evaluate_dance(features, tune.truth, duration)
        | {
            "heard_f100": beats.f_measure(features.body_stops, danceable_beats(heard).beats, 0.1),
            "heard_pearson": as_heard,
            "hand_speed": float(features.speeds.mean()),
        }
    )


def _warped(plain: Dance, library: MoveLibrary, features: HandFeatures) -> Motion:
    """The dance again with its stops moved onto the beats that were heard; only clips that are shown are read."""
    shown = sorted({move.clip for move in plain.plan.moves})
    clips = [library.clips[k if k in shown else shown[0]].motion for k in range(len(library.clips))]
    warp = fit_warp(plain.plan, features.body_stops, plain.song.beats, features.times, features.speeds.max(axis=1))
    return realise(clips, plain.plan, FPS, warp).motion
