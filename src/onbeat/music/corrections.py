"""Putting right what was heard wrong: beats from a file, taps, another tempo, meter or downbeat."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.errors import AudioError
from onbeat.music.beat_files import BeatList, read_beats
from onbeat.music.fixes import Corrections
from onbeat.music.harmony.chords import harmony_change
from onbeat.music.profile import Profile
from onbeat.music.song import Song
from onbeat.music.table import bar_positions
from onbeat.music.taps import beats_meant, denser
from onbeat.music.tempo import tempo_of

ATTACK = 0.07  # [s] around a beat, within which the new sound there counts for it


def correct(song: Song, profile: Profile, fixes: Corrections, start: float, length: float) -> Song:
    """The song with what is wrong put right, and what is heard at its beats heard anew.

    Parameters
    ----------
    song : as heard, from ``start`` seconds of the sound file on.
    profile : of the same stretch.
    fixes : what to put right.
    start, length : seconds of the sound file where the stretch begins, and of the whole file.

    Raises
    ------
    AudioError
        If a file of beats or taps cannot be read, or too few of them are in this stretch.
    """
    if fixes.beats is not None:
        song = _given(song, profile, _within(fixes.beats, start, song.duration, length))
    if fixes.taps is not None:
        taps = _within(fixes.taps, start, song.duration, length).times
        meant = beats_meant(taps, song.beats, song.duration)
        song = at_beats(song, profile, meant.times, near_old_downbeats(song, meant.times))
    if fixes.tempo:
        song = _TEMPO_FIXES[fixes.tempo](song, profile)
    if fixes.meter is not None:
        song = with_meter(song, fixes.meter)
    return moved_downbeats(song, fixes.downbeat_offset) if fixes.downbeat_offset else song


def _within(path: str | os.PathLike[str], start: float, seconds: float, length: float) -> BeatList:
    """Beats of the file in the stretch, on its clock."""
    given = read_beats(path, length)
    inside = (given.times >= start) & (given.times < start + seconds)
    if inside.sum() < 2:
        raise AudioError(
            f"{path}: {int(inside.sum())} of its {len(given.times)} beats lie between {start:g} and "
            f"{start + seconds:g} s; at least 2 are needed in the stretch that is heard"
        )
    places = None if given.places is None else given.places[inside]
    return BeatList(given.times[inside] - start, places)


def _given(song: Song, profile: Profile, given: BeatList) -> Song:
    if given.places is None:
        return at_beats(song, profile, given.times, near_old_downbeats(song, given.times))
    fixed = at_beats(song, profile, given.times, given.places == 1)
    return replace(fixed, meter=int(given.places.max()))


def at_beats(song: Song, profile: Profile, beats: Times, downbeats: Bools) -> Song:
    """The song with other beats; strengths come from the new sound at them, confidence from the old beats they keep."""
    starts = np.diff(np.flatnonzero(downbeats))
    return replace(
        song,
        tempo=tempo_of(beats),
        meter=int(np.bincount(starts).argmax()) if len(starts) else song.meter,
        beats=beats,
        downbeats=beats[downbeats],
        chord_change=harmony_change(profile.chroma(beats)),
        beat_strength=accents(profile, beats),
        confidence=_kept_confidence(song, beats),
    )


def accents(profile: Profile, beats: Times) -> Array:
    """How much new sound begins at each beat, 0…1: the highest within 70 ms, against the loudest beats."""
    steps = np.linspace(-ATTACK, ATTACK, 5)
    high = np.max([profile.at(profile.news, beats + step) for step in steps], axis=0) if len(beats) else np.zeros(0)
    top = float(np.percentile(high, 95)) if len(beats) else 0.0
    return np.clip(high / top, 0.0, 1.0) if top > 0.0 else np.ones(len(beats))


def _kept_confidence(song: Song, beats: Times) -> Array:
    """Confidence of the old beats that are still there; where others are put between, of the less sure neighbour."""
    if not len(song.confidence) or not np.isin(song.beats, beats).any():
        return np.zeros(0)
    after = np.clip(np.searchsorted(song.beats, beats - 1e-9), 0, len(song.beats) - 1)
    same = np.abs(song.beats[after] - beats) < 1e-6
    return np.where(same, song.confidence[after], np.minimum(song.confidence[after], song.confidence[after - 1]))


def near_old_downbeats(song: Song, beats: Times) -> Bools:
    """Downbeats of new beats: bars as long as those heard, in the phase nearest to the downbeats that were heard."""
    nearest = np.searchsorted(0.5 * (beats[1:] + beats[:-1]), song.downbeats)
    bar = int(np.median(np.diff(nearest))) if len(nearest) > 1 else song.meter
    bar = bar if bar > 1 else max(song.meter, 1)
    phase = int(np.bincount(nearest % bar).argmax()) if len(nearest) else 0
    return np.arange(len(beats)) % bar == phase


def _sparser(every: int) -> Callable[[Song, Profile], Song]:
    def fix(song: Song, profile: Profile) -> Song:
        places = bar_positions(song)
        if song.meter % every == 0 and len(song.downbeats):
            kept = np.flatnonzero((places - 1) % every == 0)
            kept = kept[np.append(np.diff(kept) > 1, True)]  # the last of a bar with a beat too many goes
            downbeats, meter = places[kept] == 1, song.meter // every
        else:
            phases = [song.beat_strength[phase::every].mean() if phase < len(places) else 0.0 for phase in range(every)]
            kept = np.arange(int(np.argmax(phases)), len(places), every)
            downbeats, meter = np.isin(kept, kept[:: song.meter]), song.meter
        return replace(at_beats(song, profile, song.beats[kept], downbeats), meter=max(meter, 1))

    return fix


def _fuller(times: int) -> Callable[[Song, Profile], Song]:
    def fix(song: Song, profile: Profile) -> Song:
        beats = denser(song.beats, times)
        fixed = at_beats(song, profile, beats, np.isin(beats, song.downbeats))
        return replace(fixed, meter=song.meter * times)

    return fix


_TEMPO_FIXES: dict[str, Callable[[Song, Profile], Song]] = {
    "half": _sparser(2),
    "third": _sparser(3),
    "double": _fuller(2),
    "triple": _fuller(3),
}


def with_meter(song: Song, meter: int) -> Song:
    """The song in bars of so many beats, in the phase that keeps most of its downbeats, then changes most chords."""
    was = np.isin(song.beats, song.downbeats) + 0.5 * song.chord_change
    phases = [was[phase::meter].sum() for phase in range(meter)]
    return replace(song, meter=meter, downbeats=song.beats[int(np.argmax(phases)) :: meter])


def moved_downbeats(song: Song, offset: int) -> Song:
    """The song with each downbeat so many beats later, within the bars it has; those before the first bar, too."""
    places = (bar_positions(song) - 1 - offset) % song.meter
    return replace(song, downbeats=song.beats[places == 0])
