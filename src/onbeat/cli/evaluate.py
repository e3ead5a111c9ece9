"""``onbeat evaluate``: how well a motion dances to a song."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import cyclopts
import msgspec
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.progress import warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.cli.swapped import refuse_swapped
from onbeat.errors import MetricError, OnbeatError
from onbeat.formats import read_motion
from onbeat.metrics.evaluate import Scores, evaluate_motion
from onbeat.music import Song, listen
from onbeat.music.tempo import danceable_beats, fold_of

VERSION = 1


def _song(path: Path) -> Song:
    """A song document, or the song heard now."""
    if path.suffix.lower() != ".json":
        with Console(stderr=True).status(Text(f"hearing {path.name}")):
            return listen(path)
    try:
        return Song.from_json(path.read_bytes(), str(path))
    except OSError as error:
        raise OnbeatError(f"cannot read {path}: {error.strerror}; give a song or what `onbeat listen` wrote") from None


_ROWS = (
    # module, score, title, digits and unit, chance, how far above it
    ("beats", "f50", "F within 50 ms", ".2f", "f50_jitter_null", "f50_jitter_z"),
    ("beats", "f100", "F within 100 ms", ".2f", "f100_jitter_null", "f100_jitter_z"),
    ("beats", "precision100", "stops on a beat (100 ms)", ".0%", "", ""),
    ("beats", "recall100", "beats with a stop", ".0%", "", ""),
    ("beats", "strong_recall100", "downbeats with a stop", ".0%", "", ""),
    ("beats", "beat_align_fact", "beat-align, FACT", ".2f", "beat_align_fact_null", ""),
    ("beats", "beat_align_bailando", "beat-align, Bailando", ".2f", "beat_align_bailando_null", ""),
    ("intensity", "intensity_pearson", "intensity, Pearson's r", ".2f", "", ""),
    ("intensity", "intensity_spearman", "intensity, Spearman's ρ", ".2f", "", ""),
    ("feet", "contact_part", "a foot on the floor", ".0%", "", ""),
    ("feet", "skate", "foot speed in contact (m/s)", ".3f", "", ""),
    ("feet", "skate_p95", "… its 95th percentile", ".3f", "", ""),
    ("feet", "support", "speed of the slower foot (m/s)", ".3f", "", ""),
    ("feet", "over_reach_m", "legs beyond their reach (m)", ".3f", "", ""),
    ("smoothness", "jerk_hands", "jerk of the hands (m/s³)", ".0f", "", ""),
    ("smoothness", "jerk_feet", "jerk of the feet", ".0f", "", ""),
)


def _table(scores: dict[str, Scores]) -> Table:
    table = Table("", "score", "chance", "z", box=None, pad_edge=False)
    for column in table.columns[1:]:
        column.justify = "right"
    for module, name, title, digits, chance, z in _ROWS:
        found = scores[module]
        table.add_row(
            title, _text(found.get(name), digits), _text(found.get(chance), digits), _text(found.get(z), ".1f")
        )
    return table


def _text(value: float | None, digits: str) -> str:
    return "" if value is None else format(value, digits)


def evaluate_command(
    motion: Path,
    *,
    music: Path,
    start: float = 0.0,
    fps: SourceRate = None,
    seed: int = 0,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Measure how well a motion dances to a song: on the beat, with its intensity, on its feet, smoothly.

    Parameters
    ----------
    motion
        A motion file of any kind that is read (.bvh, .amc, .c3d, .trc, .csv, .npz, .pkl).
    music
        A song, or the ``song.json`` that ``onbeat listen`` wrote.
    start
        The second of the song at which the motion begins.
    fps
        Frames a second of the motion file, where it stores none.
    seed
        Draws the chance levels: what the same stops score on beats moved by up to half an interval (F), or moved as a
        whole by any time (beat-align); z is how many standard deviations a score is above its chance.
    json
        Print everything as JSON on stdout instead of a table.
    """
    refuse_swapped(music, motion, "onbeat evaluate {motion} --music {song}")
    if not start >= 0:
        raise MetricError(f"--start is {start:g} s; give a second of the song, 0 or later")
    with warnings_as_lines():
        danced, song = read_motion(motion, fps), _song(music)
    scores = evaluate_motion(danced, song.cut(start, max(song.duration - start, 0.0)), seed)
    if not scores["beats"]["beats"]:
        told = (
            f"onbeat: none of the {len(song.beats)} beats of {music.name} falls into the motion: its scores on beats "
        )
        told += "say nothing; look at onbeat listen, or say with --start where in the song the motion begins"
        print(told, file=sys.stderr)  # noqa: T201
    if scores["feet"]["skate"] is None:
        part = scores["feet"]["contact_part"] or 0.0
        told = f"onbeat: feet stand still in {part:.0%} of {motion.name}: whether they slide cannot be told; look at "
        told += f"`onbeat info {motion}`"
        print(told, file=sys.stderr)  # noqa: T201
    if json:
        document: dict[str, Any] = {"version": VERSION, "motion": motion.name, "song": music.name, **scores}
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n")
        return
    found = scores["beats"]
    fold = fold_of(song.tempo, danceable_beats(song).tempo)
    folded = f", {fold} of those heard" if fold else ""
    told = f"{motion.name} on {music.name}: {found['stops']} stops, {found['beats']} beats{folded}"
    Console(stderr=True).print(Text(told), soft_wrap=True)
    Console().print(_table(scores))
