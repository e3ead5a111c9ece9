"""The default method: a learned activation and multi-band onsets, the bar-pointer model's beats, bars from all cues."""

from __future__ import annotations

from collections.abc import Iterable

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.music.activation import activation_log_odds
from onbeat.music.bars import downbeat_log_odds, learned_downbeats, likeliest_bars
from onbeat.music.confidence import beat_confidence
from onbeat.music.harmony.chords import harmony_slices
from onbeat.music.heard import heard_song
from onbeat.music.hearing import Hearing, Progress, hear
from onbeat.music.metrical import likeliest_level, metrical_levels
from onbeat.music.observation import beat_log_odds, harmony_at_frames, unit_power
from onbeat.music.onsets import onset_strength
from onbeat.music.song import Song
from onbeat.music.tempo import beat_space
from onbeat.music.timing import accents, learned_times, sounding

NAME = "barpointer"
STEADINESS = 60.0  # cost of a change of tempo, per unit of its ratio
PRIOR_WEIGHT = 1.5  # per second


class _Ear:
    """What is heard of a song at any beats."""

    def __init__(self, hearing: Hearing) -> None:
        self.hearing = hearing
        self.flux, strength = onset_strength(hearing)
        self.learned = activation_log_odds(hearing.bands, hearing.onset_rate)
        self.log_odds = beat_log_odds(self.learned[:, 0], unit_power(strength), harmony_at_frames(hearing))

    def slices(self, times: Times) -> Array:
        """What sounds from each beat to the next (B, semitones)."""
        return harmony_slices(self.hearing.tones, self.hearing.tone_rate, times)

    def downbeats(self, slices: Array, frames: Ints) -> Array:
        """Log odds of a downbeat at each beat (B,)."""
        return downbeat_log_odds(slices, accents(self.flux, frames)[:, 0], learned_downbeats(self.learned, frames))

    def bars(self, frames: Ints) -> float:
        """How much likelier the likeliest bars are than none."""
        slices = self.slices(frames / self.hearing.onset_rate)
        return likeliest_bars(self.downbeats(slices, frames))[2]

    def beats(self) -> Ints:
        """Frames of the beats."""
        space = beat_space(self.hearing.onset_rate, STEADINESS)
        levels = metrical_levels(self.log_odds, space, PRIOR_WEIGHT)
        return likeliest_level(levels, self.log_odds, space, self.bars)


def listen_barpointer(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Song:
    """Hear a song given as mono blocks."""
    hearing = hear(blocks, rate, progress)
    ear = _Ear(hearing)
    frames = ear.beats()
    times = learned_times(hearing, frames, ear.learned[:, 0])
    inside = sounding(hearing, times)
    frames, times = frames[inside], times[inside]
    slices = ear.slices(times)
    sure = beat_confidence(ear.learned[:, 0], frames)
    return heard_song(hearing, NAME, times, slices, accents(ear.flux, frames), ear.downbeats(slices, frames), sure)
