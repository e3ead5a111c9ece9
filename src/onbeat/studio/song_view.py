"""A song as the page shows it: what was heard, or what the user put in its place."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import AudioError
from onbeat.files import write_atomically
from onbeat.music.song import Song
from onbeat.studio.wire import BeatsData, SongItem, SongView
from onbeat.viewer.contract import CurveData

SONG, CURVES, BEATS = "song.json", "curves.json", "beats.json"
NEAR = 0.12
"""Seconds within which a beat of the user's takes the chord change of one that was heard."""
MOST = 20_000
"""Beats that a song may have."""
CLOSEST = 0.05
"""Seconds between two beats at least."""


class Curves(msgspec.Struct, frozen=True):
    """``curves.json``: the waveform and the intensity of a song."""

    waveform: CurveData
    intensity: CurveData


def song_view(folder: Path, item: SongItem) -> SongView:
    """What is in a song's folder."""
    song = Song.from_json((folder / SONG).read_bytes(), item.name)
    curves = msgspec.json.decode((folder / CURVES).read_bytes(), type=Curves)
    edited = edited_beats(folder)
    return SongView(
        id=item.id,
        name=item.name,
        duration=song.duration,
        tempo=item.tempo,
        meter=item.meter,
        beats=edited.beats if edited else song.beats.tolist(),
        downbeats=edited.downbeats if edited else song.downbeats.tolist(),
        chord_change=(_near(song, edited) if edited else song.chord_change).round(4).tolist(),
        confidence=[] if edited else song.confidence.tolist(),
        intensity=curves.intensity,
        waveform=curves.waveform,
        edited=edited is not None,
        key=song.key,
        heard_beats=song.beats.tolist(),
    )


def edited_beats(folder: Path) -> BeatsData | None:
    """The beats that the user put in the place of those heard, if any."""
    path = folder / BEATS
    return msgspec.json.decode(path.read_bytes(), type=BeatsData) if path.is_file() else None


def keep_beats(folder: Path, beats: BeatsData) -> None:
    """Keep the user's beats beside what was heard."""
    write_atomically(folder / BEATS, msgspec.json.encode(beats))


def checked_beats(told: BeatsData, duration: float) -> BeatsData:
    """The user's beats, in order and to 0.1 ms, each downbeat on its beat.

    Raises
    ------
    AudioError
        If there are fewer than two, or too many, one is outside of the song or too close to another, or a downbeat is
        no beat.

    Examples
    --------
    >>> checked_beats(BeatsData([1.0, 0.5, 1.5], [0.50004]), 2.0)
    BeatsData(beats=[0.5, 1.0, 1.5], downbeats=[0.5])
    """
    if not 2 <= len(told.beats) <= MOST:
        raise AudioError(f"{len(told.beats)} beats; from 2 to {MOST} are needed")
    beats = np.sort(np.round(told.beats, 4))
    if not 0 <= beats[0] <= beats[-1] <= duration:
        bad = beats[0] if beats[0] < 0 else beats[-1]
        raise AudioError(f"a beat at {bad:g} s is outside of the song, which lasts {duration:.2f} s")
    gaps = np.diff(beats)
    if gaps.min() < CLOSEST - 1e-6:
        at = beats[int(gaps.argmin())]
        raise AudioError(f"two beats near {at:.2f} s are {1000 * gaps.min():.0f} ms apart; put 50 ms or more between")
    return BeatsData(beats.tolist(), _on_beats(np.unique(np.round(told.downbeats, 4)), beats).tolist())


def _on_beats(downbeats: Times, beats: Times) -> Times:
    for time in downbeats.tolist():
        if np.abs(beats - time).min() > 0.001:
            raise AudioError(f"the downbeat at {time:.3f} s is on no beat; downbeats are some of the beats")
    return np.array([beats[np.abs(beats - time).argmin()] for time in downbeats.tolist()])


def bar_length(told: BeatsData, heard: int) -> int:
    """Beats in most bars; as many as were heard where no two downbeats tell.

    Examples
    --------
    >>> bar_length(BeatsData([0.0, 1.0, 2.0, 3.0], [0.0, 3.0]), 4)
    3
    """
    places = np.flatnonzero(np.isin(told.beats, told.downbeats))
    return int(np.bincount(np.diff(places)).argmax()) if len(places) > 1 else heard


def _near(song: Song, edited: BeatsData) -> Array:
    """Of each of the user's beats the chord change that was heard near it; the exact one is heard when it is danced."""
    times = np.array(edited.beats)
    if not len(song.beats):
        return np.zeros(len(times))
    nearest = np.abs(times[:, None] - song.beats).argmin(axis=1)
    return np.where(np.abs(song.beats[nearest] - times) <= NEAR, song.chord_change[nearest], 0.0)
