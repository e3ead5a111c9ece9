"""What else there is to say of a song whose beats are known: harmony at the beats, key, sections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat.music.harmony.chords import harmony_change
from onbeat.music.harmony.key import find_key
from onbeat.music.harmony.names import name_chords
from onbeat.music.intensity import perceived_intensity
from onbeat.music.profile import Profile
from onbeat.music.sections import find_sections
from onbeat.music.song import Song


def describe(song: Song, profile: Profile) -> Song:
    """The song with chords, key, tuning and sections as its profile has them; its chord changes and beats stay."""
    chroma = profile.chroma(song.beats)
    tones = chroma.sum(axis=1)
    tones /= np.maximum(np.linalg.norm(tones, axis=1, keepdims=True), 1e-9)  # a loud passage says no more than another
    return replace(
        song,
        chord_root=name_chords(chroma, np.isin(song.beats, song.downbeats)),
        key=find_key(tones.sum(axis=0)),
        tuning=profile.tuning,
        sections=find_sections(song, profile),
    )


def as_perceived(song: Song, profile: Profile) -> Song:
    """The song with chord changes in its own tuning and intensity as its loudness is perceived."""
    times, values = perceived_intensity(profile)
    change = harmony_change(profile.chroma(song.beats))
    return replace(song, chord_change=change, intensity_times=times, intensity=values)
