"""A picture of what was heard: waveform, onset strength, beats, chord changes, intensity."""

from __future__ import annotations

import io
import os
from typing import Any

import numpy as np

from onbeat._shapes import Array
from onbeat.files import write_atomically
from onbeat.music.audio import Audio
from onbeat.music.song import Song

INK, BEAT, DOWNBEAT, CHORD, INTENSITY = "#44546a", "#9db2c9", "#d1495b", "#3f8f8b", "#e0892f"
ENVELOPE_POINTS = 2000


def _envelope(audio: Audio) -> tuple[Array, Array, Array]:
    """Times, lowest and highest sample of short stretches: what a waveform looks like from afar."""
    size = max(len(audio.samples) // ENVELOPE_POINTS, 1)
    whole = audio.samples[: len(audio.samples) // size * size].reshape(-1, size)
    times = (np.arange(len(whole)) + 0.5) * size / audio.rate
    return times, whole.min(axis=1).astype(np.float64), whole.max(axis=1).astype(np.float64)


def _onsets(audio: Audio) -> tuple[Array, Array]:
    from onbeat.music.hearing import hear
    from onbeat.music.onsets import onset_strength

    hearing = hear([audio.samples], audio.rate)
    strength = onset_strength(hearing)[1]
    return np.arange(len(strength)) / hearing.onset_rate, strength


def _beat_lines(axes: Any, song: Song) -> None:
    axes.vlines(song.beats, 0, 1, transform=axes.get_xaxis_transform(), color=BEAT, linewidth=0.7, alpha=0.8)
    axes.vlines(song.downbeats, 0, 1, transform=axes.get_xaxis_transform(), color=DOWNBEAT, linewidth=0.9)


def _draw(figure: Any, audio: Audio, song: Song) -> None:
    rows: Any = figure.subplots(4, 1, sharex=True, gridspec_kw={"height_ratios": [1.1, 1.1, 0.8, 0.8]})
    times, lowest, highest = _envelope(audio)
    rows[0].fill_between(times, lowest, highest, color=INK, linewidth=0)
    rows[0].set_ylabel("waveform")
    onset_times, onsets = _onsets(audio)
    _beat_lines(rows[1], song)
    rows[1].plot(onset_times, onsets, color=INK, linewidth=0.7)
    rows[1].set_ylim(0, max(float(np.percentile(onsets, 99.8)), 1e-6))
    rows[1].set_ylabel("onset strength")
    rows[2].vlines(song.beats, 0, song.chord_change, color=CHORD, linewidth=1.6)
    rows[2].plot(song.downbeats, np.full(len(song.downbeats), -0.06), "^", color=DOWNBEAT, markersize=4, clip_on=False)
    rows[2].set_ylim(0, 1.05)
    rows[2].set_ylabel("chord change")
    rows[3].fill_between(song.intensity_times, song.intensity, color=INTENSITY, alpha=0.75, linewidth=0)
    rows[3].set_ylim(0, 1.05)
    rows[3].set_ylabel("intensity")
    rows[3].set_xlabel("seconds")
    rows[0].set_title(
        f"{song.title or 'song'}: {song.tempo:.1f} BPM, {song.meter} beats a bar, {len(song.beats)} beats "
        f"(grey; downbeats red), heard by {song.method}",
        fontsize=10,
        loc="left",
    )
    rows[3].set_xlim(0, song.duration)
    for axes in rows:
        axes.spines[["top", "right"]].set_visible(False)
        axes.yaxis.set_label_coords(-0.045, 0.5)


def write_picture(path: str | os.PathLike[str], audio: Audio, song: Song) -> None:
    """Draw a song as a PNG file; short stretches show single beats best."""
    from matplotlib.figure import Figure

    figure: Any = Figure(figsize=(13, 7), dpi=110, layout="constrained")
    _draw(figure, audio, song)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", metadata={"Software": None})
    write_atomically(path, buffer.getvalue())
