"""The classical method, nothing in it learned: multi-band onsets, the bar-pointer model, downbeats from harmony."""

from __future__ import annotations

from collections.abc import Iterable

from onbeat._shapes import Float32
from onbeat.music.bars import downbeat_log_odds
from onbeat.music.decode import decode_beats
from onbeat.music.harmony.chords import harmony_slices
from onbeat.music.heard import heard_song
from onbeat.music.hearing import Progress, hear
from onbeat.music.observation import harmony_at_frames, onset_log_odds, unit_power
from onbeat.music.onsets import onset_strength
from onbeat.music.song import Song
from onbeat.music.tempo import beat_space
from onbeat.music.timing import accents, attack_times, sounding

NAME = "onsets"
STEADINESS = 60.0  # cost of a change of tempo, per unit of its ratio
PRIOR_WEIGHT = 3.0  # per second


def listen_onsets(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Song:
    """Hear a song given as mono blocks."""
    hearing = hear(blocks, rate, progress)
    flux, strength = onset_strength(hearing)
    log_odds = onset_log_odds(unit_power(strength), harmony_at_frames(hearing))
    frames = decode_beats(log_odds, beat_space(hearing.onset_rate, STEADINESS), PRIOR_WEIGHT)
    times = attack_times(hearing, frames)
    inside = sounding(hearing, times)
    frames, times = frames[inside], times[inside]
    slices = harmony_slices(hearing.tones, hearing.tone_rate, times)
    accent = accents(flux, frames)
    return heard_song(hearing, NAME, times, slices, accent, downbeat_log_odds(slices, accent[:, 0]))
