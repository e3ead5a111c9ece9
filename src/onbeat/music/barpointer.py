"""The default method: multi-band onsets, the bar-pointer model's beats, downbeats from harmony and accents."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.music.bars import downbeat_log_odds, find_downbeats
from onbeat.music.chords import chord_change, harmony_slices, new_harmony
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
DELAY = 0.0015  # [s] midway between what clicks and drums (5 ms early) and soft attacks (7 ms late) need
AUDIBLE = 1e-4  # of the power of the loud passages
REACH = 0.025  # [s] around a frame of the decoder, in which the attack of the beat is looked for


def refine(times: Times, attacks: Float32, rate: float) -> Times:
    """Each beat moves to the strongest attack within ``REACH`` seconds, to a fraction of a frame; increasing.

    An attack at the edge of the reach counts for half of one at its centre.
    """
    frames = np.round(times * rate).astype(np.int64)
    reach = max(round(REACH * rate), 1)
    near = frames[:, None] + np.arange(-reach, reach + 1)
    weight = 1.0 - 0.5 * np.abs(np.arange(-reach, reach + 1)) / reach
    heard = np.pad(attacks.astype(np.float64), (reach + 1, reach + 2))
    best = frames + (heard[np.clip(near, 0, len(attacks)) + reach + 1] * weight).argmax(axis=1) - reach
    left, middle, right = (heard[np.clip(best, 0, len(attacks)) + reach + 1 + step] for step in (-1, 0, 1))
    curve = left - 2.0 * middle + right
    peaked = (curve < 0.0) & (middle >= left) & (middle >= right)
    shift = np.where(peaked, 0.5 * (left - right) / np.where(peaked, curve, -1.0), 0.0)
    return np.maximum.accumulate(np.where(middle > 0.0, (best + shift) / rate, times))


def sounding_stretch(loudness: Float32, rate: float) -> tuple[float, float]:
    """Seconds between which there is sound: within 40 dB of the loud passages; no beat is heard outside.

    >>> sounding_stretch(np.array([0, 0, 1, 1, 1, 0], np.float32), 10.0)
    (0.1, 0.5)
    """
    sounding = np.flatnonzero(loudness > AUDIBLE * np.percentile(loudness, 95))
    return (float(sounding[0] - 1) / rate, float(sounding[-1] + 1) / rate) if len(sounding) else (0.0, 0.0)


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
    times = refine(frames / hearing.onset_rate, hearing.attacks, hearing.attack_rate) - DELAY
    begin, end = sounding_stretch(hearing.loudness, hearing.tone_rate)
    inside = (times >= max(begin, 0.0)) & (times < min(end, hearing.duration))
    frames, times = frames[inside], times[inside]
    slices = harmony_slices(hearing.tones, hearing.tone_rate, times)
    accent = accents(flux, frames)
    downbeats, meter = find_downbeats(downbeat_log_odds(slices, accent[:, 0]))
    intensity_times, values = intensity(hearing.tones, hearing.loudness, hearing.tone_rate, hearing.duration)
    return Song(
        duration=hearing.duration,
        tempo=tempo_of(times),
        meter=meter,
        beats=times,
        downbeats=times[downbeats],
        chord_change=chord_change(slices),
        intensity_times=intensity_times,
        intensity=values,
        method=NAME,
        beat_strength=normalised(accent.mean(axis=1), 0.0),
    )
