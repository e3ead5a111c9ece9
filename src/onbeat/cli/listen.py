"""``onbeat listen``: what is heard in a song."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

import onbeat
from onbeat.cli.corrections import NO_FLAGS, CorrectionFlags
from onbeat.cli.fetching import song_path
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.music import METHODS, Song, listen
from onbeat.music.audio import RATE, audio_duration, native_blocks, read_blocks
from onbeat.music.fixes import Corrections
from onbeat.music.tempo import danceable_beats, fold_of

DOCUMENTS = (".json", ".csv", ".jams")
CLICKS = (".wav", ".flac", ".ogg")
PICTURES = (".png", ".svg", ".pdf")
TOLD = 12  # sections that the table names
UNSURE = 0.5  # median confidence, under which a user is told


def _hear(path: Path, method: str, start: float, seconds: float | None, corrections: Corrections) -> Song:
    """Hear with progress on stderr; a damaged file is warned of in one line there."""
    whole = max(audio_duration(path) - start, 0.0)
    wanted = min(seconds or whole, whole)
    with warnings_as_lines(), Stages(passing=True) as stages:
        stages("hearing", 0.0, path.name)
        return listen(
            path, method, start, seconds, lambda heard: stages("hearing", heard / max(wanted, 1e-9), path.name),
            corrections,
        )  # fmt: skip


def _table(song: Song, told: bool) -> Table:
    """What was heard; ``told`` of a song whose tempo was said, which is danced to as it is."""
    table = Table(show_header=False, box=None, pad_edge=False)
    first = f", the first at {song.downbeats[0]:.3f} s" if len(song.downbeats) else ""
    for name, value in (
        ("song", song.title),
        ("duration", f"{song.duration:.2f} s"),
        (
            "tempo",
            f"{song.tempo:.2f} BPM{_wander(song)}{'' if told else _folded(song)}" if song.tempo else "no beat heard",
        ),
        ("meter", f"{song.meter} beats a bar"),
        ("beats", str(len(song.beats))),
        ("downbeats", f"{len(song.downbeats)}{first}"),
        ("confidence", _sureness(song)),
        ("key", _key(song)),
        ("sections", _sections(song)),
        ("heard by", song.method),
    ):
        if not value:
            continue  # not known
        table.add_row(Text(name, "dim"), Text(value))  # a name may look like markup
    return table


def _clock(seconds: float) -> str:
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def _key(song: Song) -> str:
    tuned = f", tuned {song.tuning:+.0f} cents" if abs(song.tuning) >= 3.0 else ""
    return f"{song.key.replace(':', ' ')}{tuned}" if song.key else ""


def _sections(song: Song) -> str:
    """Where which section begins; of many the first."""
    names = [f"{part.kind} {_clock(part.start)}" for part in song.sections]
    more = len(names) - TOLD
    return ", ".join(names[:TOLD]) + (f" … and {more} more" if more > 0 else "")


def _sureness(song: Song) -> str:
    """Median confidence of the beats, with a word of warning where it is low."""
    if not len(song.confidence):
        return ""
    usual = float(np.median(song.confidence))
    return f"{usual:.2f}" + (" (unsure: listen with --click)" if usual < UNSURE else "")


def _folded(song: Song) -> str:
    """A remark on a tempo that is not danced to as it is."""
    danced = danceable_beats(song).tempo
    fold = fold_of(song.tempo, danced)
    return f", danced to at {fold} of it ({danced:.0f})" if fold else ""


def _wander(song: Song) -> str:
    """A remark where the tempo is far from steady: lowest to highest over eight beats."""
    if len(song.beats) < 24:
        return ""
    local = song.tempo_curve.bpm
    low, high = float(local.min()), float(local.max())
    return f" (between {low:.0f} and {high:.0f})" if high > 1.06 * low else ""


def _write(path: Path, song: Song) -> None:
    kind = path.suffix.lower()
    if kind == ".csv":
        from onbeat.music.table import to_csv

        write_atomically(path, to_csv(song))
    elif kind == ".jams":
        from onbeat.music.jams import to_jams

        write_atomically(path, to_jams(song, f"onbeat {onbeat.__version__}"))
    else:
        write_atomically(path, song.to_json())


def _check_ending(path: Path, endings: tuple[str, ...]) -> None:
    """Refuse a file that cannot be written before the work, not after it."""
    if path.suffix.lower() not in endings:
        known = ", ".join(endings[:-1]) + " or " * (len(endings) > 1) + endings[-1]
        raise OnbeatError(f"{path}: cannot write {path.suffix or 'a file without ending'}; use {known}")


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
    flags: CorrectionFlags = NO_FLAGS,
) -> None:
    """Hear the beats, downbeats, chords, sections and intensity of a song.

    Parameters
    ----------
    song
        A wav, flac, ogg or mp3 file; with the extra ``video`` also m4a, mp4 and others; or ``song:NAME`` of one that
        ``onbeat songs fetch`` fetched.
    output
        Where to write what was heard: ``.json`` (everything), ``.csv`` (a line a beat) or ``.jams`` (for research).
    method
        ``barpointer`` (the default), ``onsets`` (the same without what is learned, quicker) or ``shiratori2006`` (as
        published in 2006).
    click
        Write the song with a click on every beat to this WAV, FLAC or Ogg file, downbeats higher and louder.
    plot
        Draw waveform, sections, bars, beats, chords, tempo and intensity to this PNG, SVG or PDF file.
    start
        Begin so many seconds into the song; all times then count from there.
    seconds
        Hear only so much of it.
    json
        Print the song document on stdout instead of a table.
    flags
        What was heard wrong, and how it is right.
    """
    for path, endings in ((output, DOCUMENTS), (click, CLICKS), (plot, PICTURES)):
        if path:
            _check_ending(path, endings)
    song = song_path(song)
    fixes = flags.corrections()
    heard = _hear(song, method, start, seconds, fixes)
    if output:
        _write(output, heard)
    if click:
        from onbeat.music.clicks import stream_with_clicks

        stream_with_clicks(click, lambda: native_blocks(song, start, seconds), heard)
    if plot:
        from onbeat.music.picture import write_picture

        write_picture(plot, read_blocks(song, start, seconds), RATE, heard)
    if json:
        sys.stdout.write(heard.to_json().decode())
    else:
        Console().print(_table(heard, fixes.tells_tempo))
