"""What ``onbeat dance`` tells: the table of its figures, what is to be known beside them, and what to try next."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.dance.make import Dance
from onbeat.dance.remarks import remarks
from onbeat.moves.library import MoveLibrary

TOLD = 5  # files left out that are told one by one
LARGE = 10e6  # bytes of a page that takes its time to open


def tell_made(dance: Dance, output: Path, then: str) -> None:
    """The table of a dance that lies in ``output``, where its page is, and the command to try ``then``."""
    screen = Console()
    screen.print(_table(dance, output))
    page = output / "dance.html"
    size = page.stat().st_size
    large = "; it takes a while to open" if size > LARGE else ""
    after = f"Look at it: open {page} ({size / 1e6:.1f} MB{large})\nThen try: {then}"
    screen.print(Text(after), soft_wrap=True)


def tell_remarks(dance: Dance, library: MoveLibrary, output: Path) -> None:
    """What is to be known of a dance beside its figures, a line each on stderr."""
    lines = remarks(dance.document, library)
    if dance.document.heard_bpm:  # told first
        song = shlex.quote(str(output / "song.json"))
        lines[0] += f"; `onbeat keyposes` and others are told the beats danced to by --beats {song}"
    for line in lines:
        print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201


def next_command(words: Sequence[str], song: bool, moves: bool, film: bool) -> str:
    """What to try next: with one's own song, with one's own clips, with a film, by rhythm alone.

    Parameters
    ----------
    words : those of this command, all of which are kept.
    song, moves, film : whether they are among them.

    Examples
    --------
    >>> next_command(["dance", "a song.mp3", "--start", "30"], song=True, moves=False, film=False)
    "onbeat dance 'a song.mp3' --start 30 --moves YOUR_CLIPS/"
    """
    if not song:
        return "onbeat dance YOUR_SONG.mp3"
    more = "--moves YOUR_CLIPS/" if not moves else "--rhythm-only" if film else "--video"
    return "onbeat dance --help" if more in words else f"onbeat {shlex.join(words)} {more}"


def tell_left_out(library: MoveLibrary) -> None:
    """What is not in the library and what was assumed, a line each on stderr, of many the first."""
    lines = [*library.notes, *(f"left out {problem}" for problem in library.problems)]
    more = len(lines) - TOLD
    if more > 1:
        lines[TOLD:] = [f"… and {more} more; `onbeat moves build` tells all"]
    for line in lines:
        print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201


def _table(dance: Dance, output: Path) -> Table:
    metrics = dance.document.metrics
    source = metrics["feet"]["skate_source"]
    mirrored = metrics["variety"]["repeated_s_strict"] - metrics["variety"]["repeated_s"]
    before, after, variety = metrics["beats_before_warp"], metrics["beats"], metrics["variety"]
    song = dance.song
    heard = dance.document.heard_bpm
    tempo = f"{song.tempo:.0f} BPM" + (f" ({heard:.0f} heard)" if heard else "")
    table = Table(title=Text(f"{song.title}: {song.duration:.1f} s at {tempo} → {output}"))
    table.add_column("figure")
    table.add_column("value", justify="right")
    table.add_column("what it says")
    rows = (
        (
            "on the beat, ±50 ms",
            after["f50"],
            ".2f",
            f"F-measure of stops and beats; {before['f50']:.2f} before the warp",
        ),
        ("on the beat, ±100 ms", after["f100"], ".2f", f"{before['f100']:.2f} before the warp"),
        ("against chance", after["f50_jitter_z"], ".1f", "standard deviations above beats shifted at random"),
        ("with the intensity", metrics["intensity"]["intensity_pearson"], ".2f", "correlation of hands and music"),
        ("joins a minute", variety["joins_per_minute"], ".0f", "from one clip to another"),
        ("feet at joins", metrics["feet"]["skate_joins"], ".3f", f"m/s of planted feet; {_of(source)} in the clips"),
        (
            "shown twice",
            variety["repeated_s"],
            ".1f",
            f"seconds of clips seen again; {mirrored:.1f} more as mirror images",
        ),
    )
    for name, value, digits, meaning in rows:
        table.add_row(name, "–" if value is None else format(value, digits), meaning)
    return table


def _of(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
