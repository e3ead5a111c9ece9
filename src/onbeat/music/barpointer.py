"""The default method: multi-band onsets, the bar-pointer model's beats, downbeats from harmony and accents."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.music.bars import downbeat_log_odds, find_downbeats
from onbeat.music.chords import chord_change, new_harmony
from onbeat.music.decode import decode_beats
from onbeat.music.hearing import Hearing, Progress, hear
from onbeat.music.intensity import intensity, normalised
from onbeat.music.observation import beat_log_odds, unit_power
from onbeat.music.onsets import onset_strength
from onbeat.music.song import Song
from onbeat.music.tempo import beat_space, tempo_of

NAME = "barpointer"
STEADINESS = 60.0  # cost of a change of tempo, per unit of its ratio
PRIOR_WEIGHT = 3.0  # per second
DELAY = 0.0  # [s] of the onset strength's peak behind the onset, calibrated on clicks and drums
CUE_WEIGHTS = np.array([1.0, 0.6, 0.3])  # chord change, bass accent, accent


def refine(beats: Ints, strength: Array, rate: float) -> Times:
    """Beat frames to seconds: each moves to the onset's own peak where that is at most two frames away."""
    peaks: list[float] = []
    for frame in beats:
        low, high = max(frame - 2, 1), min(frame + 3, len(strength) - 1)
        if high <= low:
            peaks.append(float(frame))
            continue
        best = low + int(strength[low:high].argmax())
        left, middle, right = strength[best - 1 : best + 2]
        curve = left - 2.0 * middle + right
        peaks.append(best + (0.5 * (left - right) / curve if curve < 0.0 and middle >= max(left, right) else 0.0))
    return np.maximum.accumulate(np.array(peaks)) / rate


def _harmony_at_onset_frames(hearing: Hearing) -> Array:
    harmony = new_harmony(hearing.tones, hearing.tone_rate)
    times = np.arange(len(hearing.bands)) / hearing.onset_rate
    return np.interp(times, np.arange(len(harmony)) / hearing.tone_rate, harmony)


def accents(flux: Float32, beats: Ints) -> Array:
    """Highest flux of each band within two frames of each beat: (B, bands)."""
    return maximum_filter1d(flux, 5, axis=0)[np.clip(beats, 0, len(flux) - 1)].astype(np.float64)


def listen_barpointer(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Song:
    """Hear a song given as mono blocks."""
    hearing = hear(blocks, rate, progress)
    flux, strength = onset_strength(hearing)
    strength = unit_power(strength)
    log_odds = beat_log_odds(strength, unit_power(_harmony_at_onset_frames(hearing)))
    frames = decode_beats(log_odds, beat_space(hearing.onset_rate, STEADINESS), PRIOR_WEIGHT)
    times = refine(frames, strength, hearing.onset_rate) - DELAY
    inside = (times >= 0.0) & (times < hearing.duration)
    frames, times = frames[inside], times[inside]
    change = chord_change(hearing.tones, hearing.tone_rate, times)
    accent = accents(flux, frames)
    cues = np.stack([change, accent[:, 0] + accent[:, 1], accent.mean(axis=1)], axis=1)
    downbeats, meter = find_downbeats(downbeat_log_odds(cues, CUE_WEIGHTS)) if len(times) else (np.zeros(0, bool), 4)
    intensity_times, values = intensity(hearing.tones, hearing.loudness, hearing.tone_rate, hearing.duration)
    return Song(
        duration=hearing.duration,
        tempo=tempo_of(times),
        meter=meter,
        beats=times,
        downbeats=times[downbeats],
        chord_change=change,
        intensity_times=intensity_times,
        intensity=values,
        method=NAME,
        beat_strength=normalised(accent.mean(axis=1), 0.0),
    )
