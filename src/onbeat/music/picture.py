"""A picture of what was heard, as a musician reads it: the whole song above, then line by line its bars and chords."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.files import write_atomically
from onbeat.music.song import Song
from onbeat.music.table import bar_numbers

INK, PALE, DOWNBEAT, BEAT = "#3b4a5f", "#8593a6", "#c43d52", "#a9b6c6"
TEMPO, INTENSITY, CONFIDENCE, CHORD = "#2f7f8f", "#e0892f", "#5b8c5a", "#22303f"
SECTIONS = {"intro": "#dbe7f3", "build-up": "#fbe3b9", "break": "#d9ecdf", "main": "#f6d5d2", "ending": "#e2daee"}
WIDTH, DPI = 15.0, 100  # [inch], dots an inch
PLOT = 13.4  # [inch] of it that time runs along
LINE_SECONDS, MOST_LINES = 24.0, 9
POINTS = 2400  # of a waveform along one line
EDGE = 0.3  # [inch] at the right end of a line that a name needs
GRAIN = 0.005  # [s] that the waveform is kept in


class Envelope(NamedTuple):
    """Lowest and highest sample (N,) of each stretch of ``grain`` seconds: what a waveform looks like from afar."""

    lowest: Float32
    highest: Float32
    grain: float

    @classmethod
    def of(cls, blocks: Iterable[Float32], rate: int) -> Envelope:
        """Of mono blocks; only their envelope is kept."""
        size = max(round(GRAIN * rate), 1)
        held, low, high = np.zeros(0, np.float32), [np.zeros(0, np.float32)], [np.zeros(0, np.float32)]
        for block in blocks:
            whole = np.concatenate([held, block])
            cut = len(whole) // size * size
            parts, held = whole[:cut].reshape(-1, size), whole[cut:]
            low.append(parts.min(axis=1))
            high.append(parts.max(axis=1))
        return cls(np.concatenate(low), np.concatenate(high), size / rate)

    def within(self, start: float, end: float) -> tuple[Times, Array, Array]:
        """Times, lowest and highest of a stretch, in at most ``POINTS`` steps."""
        first, last = int(start / self.grain), min(int(np.ceil(end / self.grain)) + 1, len(self.lowest))
        step = max((last - first) // POINTS, 1)
        edges = np.arange(first, max(last, first), step)
        if not len(edges):
            return np.zeros(0), np.zeros(0), np.zeros(0)
        low, high = (
            np.asarray(reduce(values[:last], edges), dtype=np.float64)
            for reduce, values in ((np.minimum.reduceat, self.lowest), (np.maximum.reduceat, self.highest))
        )
        return np.asarray((edges + 0.5 * step) * self.grain, dtype=np.float64), low, high


def write_picture(path: str | os.PathLike[str], blocks: Iterable[Float32], rate: int, song: Song) -> None:
    """Draw a song, given as mono blocks, as a PNG, SVG or PDF file."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    envelope = Envelope.of(blocks, rate)
    kind = Path(path).suffix.lower().lstrip(".") or "png"
    undated = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
    buffer = io.BytesIO()
    with rc_context({"svg.hashsalt": "onbeat", "font.size": 9.0, "font.family": "DejaVu Sans"}):
        figure: Any = Figure(dpi=DPI)
        _draw(figure, envelope, song)
        figure.savefig(buffer, format=kind, metadata=undated.get(kind, {}))
    write_atomically(path, buffer.getvalue())


def line_edges(duration: float) -> list[float]:
    """Where the lines begin, and where the last ends: of 24 s each, or longer, that there are nine at most.

    >>> line_edges(60.0)
    [0.0, 24.0, 48.0, 72.0]
    """
    length = max(LINE_SECONDS, float(np.ceil(duration / MOST_LINES)))
    return [length * line for line in range(max(int(np.ceil(duration / length)), 1) + 1)]


def _draw(figure: Any, envelope: Envelope, song: Song) -> None:
    edges = line_edges(song.duration)
    heights = [0.95, 0.8, 0.8] + [1.15] * (len(edges) - 1)
    gaps = [0.08, 0.08, 0.62] + [0.42] * (len(edges) - 2) + [0.0]
    top, bottom = 0.78, 0.5
    height = top + sum(heights) + sum(gaps) + bottom
    figure.set_size_inches(WIDTH, height)
    above = height - top
    rows: list[Any] = []
    for tall, gap in zip(heights, gaps, strict=True):
        above -= tall
        rows.append(figure.add_axes((0.95 / WIDTH, above / height, PLOT / WIDTH, tall / height)))
        above -= gap
    figure.text(0.95 / WIDTH, (height - 0.3) / height, _title(song), fontsize=12, color=INK, weight="bold", va="center")
    _overview(rows[:3], envelope, song)
    for axes, (start, end) in zip(rows[3:], pairwise(edges), strict=True):
        _line(axes, envelope, song, start, end)
    rows[-1].set_xlabel("seconds", color=INK)


def _title(song: Song) -> str:
    tempo = f"{song.tempo:.1f} BPM, {song.meter} beats a bar" if song.tempo else "no beat heard"
    key = f", {song.key.replace(':', ' ')}" if song.key else ""
    return f"{_short(song.title or 'song', 70)}:  {tempo}{key}"


def _short(name: str, longest: int) -> str:
    printable = "".join(letter if letter.isprintable() else "?" for letter in name).replace("$", r"\$")
    return printable if len(printable) <= longest else printable[: longest - 1] + "…"


def _plain(axes: Any, label: str, start: float, end: float) -> None:
    axes.set_xlim(start, end)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(PALE)
    axes.tick_params(colors=PALE, labelcolor=INK, labelsize=8)
    axes.set_ylabel(label, color=INK, fontsize=8.5)
    axes.yaxis.set_label_coords(-0.042, 0.5)


def _overview(rows: list[Any], envelope: Envelope, song: Song) -> None:
    """The whole song: waveform and names of sections; intensity and confidence; tempo."""
    wave, levels, tempo = rows
    for axes, label in ((wave, "sections"), (levels, "intensity"), (tempo, "tempo, BPM")):
        _plain(axes, label, 0.0, song.duration)
        _section_colours(axes, song, 0.0, song.duration)
    _waveform(wave, envelope, 0.0, song.duration)
    _section_names(wave, song, 0.0, song.duration)
    for axes in (wave, levels):
        axes.set_xticklabels([])
    levels.fill_between(song.intensity_times, song.intensity, color=INTENSITY, alpha=0.85, linewidth=0)
    levels.set_ylim(0, 1.05)
    levels.set_yticks([0, 1])
    if len(song.confidence):
        levels.plot(song.beats, _evened(song.confidence), color=CONFIDENCE, linewidth=1.4)
        levels.set_ylabel("intensity,\nconfidence", color=INK, fontsize=8.5)
    curve = song.tempo_curve
    tempo.plot(curve.times, curve.bpm, color=TEMPO, linewidth=1.6)
    middle = float(np.median(curve.bpm)) if len(curve.bpm) else 100.0
    reach = max(float(np.abs(curve.bpm - middle).max(initial=0.0)) * 1.1, 0.06 * middle)
    tempo.set_ylim(middle - reach, middle + reach)


def _evened(values: Array) -> Array:
    """Each with the mean of the seven around it: single beats would be a thicket."""
    padded = np.pad(values, 3, mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, 7).mean(axis=1)


def _waveform(axes: Any, envelope: Envelope, start: float, end: float) -> None:
    times, low, high = envelope.within(start, end)
    loudest = max(float(np.abs(envelope.lowest).max(initial=0.0)), float(envelope.highest.max(initial=0.0)), 1e-9)
    axes.fill_between(times, low / loudest, high / loudest, color=INK, linewidth=0, alpha=0.75, zorder=1)
    axes.set_ylim(-1.02, 1.02)
    axes.set_yticks([])


def _section_colours(axes: Any, song: Song, start: float, end: float) -> None:
    for part in song.sections:
        left, right = max(part.start, start), min(part.end, end)
        if right > left:
            axes.axvspan(left, right, color=SECTIONS.get(part.kind, "#eeeeee"), linewidth=0, zorder=0)
        if start < part.start < end:
            axes.axvline(part.start, color=INK, linewidth=1.0, zorder=3)


def _section_names(axes: Any, song: Song, start: float, end: float) -> None:
    """Names above the axes, where each has room."""
    inch = PLOT / (end - start)
    free = -1.0
    for part in song.sections:
        left = (max(part.start, start) - start) * inch
        room = (min(part.end, end) - start) * inch - left
        if part.end <= start or part.start >= end or room < 0.085 * len(part.kind) or left < free:
            continue
        axes.text(start + left / inch, 1.06, part.kind, fontsize=8.5, color=INK, style="italic", va="bottom",
                  transform=axes.get_xaxis_transform())  # fmt: skip
        free = left + 0.085 * len(part.kind)


def _line(axes: Any, envelope: Envelope, song: Song, start: float, end: float) -> None:
    """A line of the song: waveform, beats, bars with their numbers above, chords below."""
    _plain(axes, "", start, end)
    axes.spines[["left"]].set_visible(False)
    _section_colours(axes, song, start, end)
    _waveform(axes, envelope, start, min(end, song.duration))
    inside = (song.beats >= start) & (song.beats < end)
    inch = PLOT / (end - start)
    strong = np.isin(song.beats, song.downbeats)
    _strokes(axes, song.beats[inside & ~strong], BEAT, 0.9, inch)
    _strokes(axes, song.beats[inside & strong], DOWNBEAT, 1.3, inch)
    _numbers(axes, song.beats[inside & strong], bar_numbers(song)[inside & strong], start, inch)
    if song.chord_root:
        _chords(axes, song, start, end, inch)
    if len(song.confidence):
        axes.bar(song.beats[inside], 0.3 * song.confidence[inside], 0.05 / inch, -1.02, color=CONFIDENCE, zorder=4)
    axes.set_xticks([tick for tick in axes.get_xticks() if start <= tick <= min(end, song.duration)])
    axes.spines["bottom"].set_bounds(start, min(end, song.duration))
    axes.tick_params(axis="x", pad=1)


def _strokes(axes: Any, times: Times, colour: str, width: float, inch: float) -> None:
    """Upright lines at times, unless they lie closer than can be told apart."""
    if len(times) > 1 and float(np.median(np.diff(times))) * inch < 0.03:
        return
    axes.vlines(times, 0, 1, transform=axes.get_xaxis_transform(), color=colour, linewidth=width, zorder=2)


def _numbers(axes: Any, times: Times, numbers: Array | np.ndarray, start: float, inch: float) -> None:
    """Numbers of bars above their lines, as many as have room."""
    free = -1.0
    for time, number in zip(times.tolist(), numbers.tolist(), strict=True):
        place = (time - start) * inch
        width = 0.07 * len(str(number))
        side = "left" if place < PLOT - EDGE else "right"
        if place - (width if side == "right" else 0.0) < free:
            continue
        axes.text(time, 1.03, str(number), fontsize=7.5, color=DOWNBEAT, ha=side, va="bottom", clip_on=False,
                  transform=axes.get_xaxis_transform())  # fmt: skip
        free = place + 0.09 + width


def _chords(axes: Any, song: Song, start: float, end: float, inch: float) -> None:
    """A chord's name where it begins, if it has room; inside of the line, at its top."""
    names = [_chord(name) for name in song.chord_root]
    free = -1.0
    for index, (time, name) in enumerate(zip(song.beats.tolist(), names, strict=True)):
        place = (time - start) * inch
        goes_on = index > 0 and names[index - 1] == name
        if not start <= time < end or (goes_on and song.beats[index - 1] >= start) or not free <= place < PLOT - EDGE:
            continue
        axes.text(time + 0.03 / inch, 0.97, name, fontsize=8.5, color=CHORD, weight="bold", va="top", zorder=5,
                  transform=axes.get_xaxis_transform(),
                  bbox={"facecolor": "white", "alpha": 0.72, "edgecolor": "none", "pad": 0.8})  # fmt: skip
        free = place + 0.1 + 0.085 * len(name)


def _chord(name: str) -> str:
    """``Am`` for ``A:min``, as on a lead sheet.

    >>> _chord("A:min"), _chord("Eb:maj"), _chord("N")
    ('Am', 'Eb', '–')
    """
    root, _, triad = name.partition(":")
    return "–" if root == "N" else root.replace("#", "♯").replace("b", "b") + ("m" if triad == "min" else "")
