"""What the trackers of beats say of a song, put together: bars from how each beat sounds, harmony, intensity."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.music.bars import find_downbeats
from onbeat.music.harmony.chords import chord_change
from onbeat.music.hearing import Hearing
from onbeat.music.intensity import intensity, normalised
from onbeat.music.song import Song
from onbeat.music.tempo import tempo_of


def heard_song(
    hearing: Hearing,
    method: str,
    beats: Times,
    slices: Array,
    accent: Array,
    downbeat_odds: Array,
    confidence: Array | None = None,
) -> Song:
    """The song of some beats.

    Parameters
    ----------
    hearing : of the sound.
    method : that found the beats.
    beats : (B,) seconds.
    slices : (B, semitones) what sounds from each beat to the next.
    accent : (B, bands) onset strength at each beat.
    downbeat_odds : (B,) log odds of a downbeat.
    confidence : (B,) 0…1; none where the method has none.
    """
    downbeats, meter = find_downbeats(downbeat_odds)
    times, values = intensity(hearing.tones, hearing.loudness, hearing.tone_rate, hearing.duration)
    return Song(
        duration=hearing.duration,
        tempo=tempo_of(beats),
        meter=meter,
        beats=beats,
        downbeats=beats[downbeats],
        chord_change=chord_change(slices),
        intensity_times=times,
        intensity=values,
        method=method,
        beat_strength=normalised(accent.mean(axis=1), 0.0),
        confidence=np.zeros(0) if confidence is None else confidence,
    )
