"""``onbeat listen``: what is heard in a song."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import warnings_as_lines
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.music import METHODS, Song, listen
from onbeat.music.audio import audio_duration, read_audio, read_stereo


def _hear(path: Path, method: str, start: float, seconds: float | None) -> Song:
    """Hear with a progress bar on stderr; a damaged file is warned of in one line there."""
    whole = max(audio_duration(path) - start, 0.0)
    screen = Console(stderr=True)
    columns = (TextColumn("hearing {task.fields[song]}", markup=False), BarColumn(), TimeRemainingColumn())
    with (
        warnings_as_lines(),
        Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar,
    ):
        task = bar.add_task("", total=min(seconds or whole, whole) or None, song=path.name)
        return listen(path, method, start, seconds, lambda heard: bar.update(task, completed=heard))


def _table(song: Song) -> Table:
    table = Table(show_header=False, box=None, pad_edge=False)
    first = f"{song.downbeats[0]:.3f} s" if len(song.downbeats) else "none"
    steadiness = _wander(song)
    for name, value in (
        ("song", song.title),
        ("duration", f"{song.duration:.2f} s"),
        ("tempo", f"{song.tempo:.2f} BPM{steadiness}" if song.tempo else "no beat heard"),
        ("meter", f"{song.meter} beats a bar"),
        ("beats", str(len(song.beats))),
        ("downbeats", f"{len(song.downbeats)}, the first at {first}"),
        ("heard by", song.method),
    ):
        table.add_row(Text(name, "dim"), Text(value))  # a name may look like markup
    return table


def _wander(song: Song) -> str:
    """A remark where the tempo is far from steady: lowest to highest over eight beats."""
    if len(song.beats) < 24:
        return ""
    local = 8.0 * 60.0 / (song.beats[8:] - song.beats[:-8])
    low, high = float(local.min()), float(local.max())
    return f" (between {low:.0f} and {high:.0f})" if high > 1.06 * low else ""


def _write(path: Path, song: Song) -> None:
    if path.suffix.lower() == ".csv":
        from onbeat.music.table import to_csv

        write_atomically(path, to_csv(song))
    elif path.suffix.lower() == ".json":
        write_atomically(path, song.to_json())
    else:
        raise OnbeatError(f"{path}: cannot write {path.suffix or 'a file without ending'}; use .json or .csv")


def listen_command(
    song: Path,
    *,
    output: Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])] = None,
    method: str = METHODS[0],
    click: Path | None = None,
    plot: Path | None = None,
    start: float = 0.0,
    seconds: float | None = None,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Hear the beats, downbeats, chord changes and intensity of a song.

    Parameters
    ----------
    song
        A wav, flac, ogg or mp3 file; with the extra ``video`` also m4a, mp4 and others.
    output
        Where to write what was heard: ``.json`` (everything) or ``.csv`` (time, place in the bar, chord change).
    method
        ``barpointer`` (the default) or ``shiratori2006`` (as published in 2006).
    click
        Write the song with a click on every beat to this WAV file, downbeats higher.
    plot
        Draw waveform, onsets, beats, chord changes and intensity to this PNG file.
    start
        Begin so many seconds into the song; all times then count from there.
    seconds
        Hear only so much of it.
    json
        Print the song document on stdout instead of a table.
    """
    heard = _hear(song, method, start, seconds)
    if output:
        _write(output, heard)
    if click:
        from onbeat.music.clicks import write_with_clicks

        write_with_clicks(click, *read_stereo(song, start, seconds), heard)
    if plot:
        from onbeat.music.picture import write_picture

        write_picture(plot, read_audio(song, start, seconds), heard)
    if json:
        sys.stdout.write(heard.to_json().decode())
    else:
        Console().print(_table(heard))
