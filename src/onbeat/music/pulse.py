"""Whether there is a beat at all: a tracker finds beats in noise, too, since noise has them as much as it has faces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.ndimage import uniform_filter1d

from onbeat._shapes import Array, Times
from onbeat.music.profile import Profile
from onbeat.music.song import Song

NEAR = 0.07  # [s] around a beat, within which what begins there is looked for
AROUND = 2.0  # [s] whose level a rise is held against
LEAST = 0.07  # rise, as a share of the level, that the upper quarter of beats needs: noise has 0.02–0.06, a band 0.3
FEWEST = 2


def rises(profile: Profile, beats: Times) -> Array:
    """How much of the sound is new at each beat, as a share of the level around it: (B,)."""
    if not len(beats):
        return np.zeros(0)
    level = profile.colours.sum(axis=1, dtype=np.float64)
    usual = uniform_filter1d(level, max(round(AROUND * profile.rate), 1), mode="nearest")
    times = beats + np.linspace(-NEAR, NEAR, 5)[:, None]
    new = np.max([profile.at(profile.news, row) for row in times], axis=0)
    frames = np.arange(len(usual)) / profile.rate
    return new / np.maximum(np.interp(beats, frames, usual), 1e-9)


def has_pulse(profile: Profile, beats: Times) -> bool:
    """Whether anything begins at the beats: not in noise, hum, or after a single click."""
    return len(beats) >= FEWEST and float(np.percentile(rises(profile, beats), 75)) >= LEAST


def without_beats(song: Song) -> Song:
    """The song as one in which no beat is heard."""
    none = np.zeros(0)
    return replace(song, tempo=0.0, beats=none, downbeats=none, chord_change=none, beat_strength=none)
