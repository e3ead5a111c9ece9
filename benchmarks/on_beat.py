"""How well dances meet their songs: the exact search beside the paper's greedy, greedy on our objective and chance.

Each method dances to each song with the same library; every figure is measured on the finished joints, before the time
warp and after it. Medians over the songs.

    python benchmarks/on_beat.py --moves my_clips song1.ogg song2.ogg song3.ogg song4.ogg
"""

from __future__ import annotations

import argparse
import json
import resource
import time
import warnings
from pathlib import Path

import numpy as np

from onbeat.dance.make import Dance, make_dance
from onbeat.moves.cache import build_or_open
from onbeat.moves.embedded import embedded_library
from onbeat.moves.library import MoveLibrary
from onbeat.music.listen import listen
from onbeat.music.song import Song

METHODS = ("optimal", "greedy", "shiratori2006", "walk")
COLUMNS = {
    "F50": ("beats_before_warp", "f50"),
    "F100": ("beats_before_warp", "f100"),
    "z": ("beats_before_warp", "f50_jitter_z"),
    "F50 w": ("beats", "f50"),
    "F100 w": ("beats", "f100"),
    "fact+": ("beats", "beat_align_fact_margin"),
    "bail+": ("beats", "beat_align_bailando_margin"),
    "r": ("intensity", "intensity_pearson"),
    "rho": ("intensity", "intensity_spearman"),
    "obj": ("search", "objective"),
    "of opt": ("search", "of_optimum"),
    "joins/min": ("variety", "joins_per_minute"),
    "link°": ("smoothness", "link_error_deg"),
    "twice s": ("variety", "repeated_cells_s"),
    "strict s": ("variety", "repeated_cells_s_strict"),
    "rate lo": ("warp", "playback_min"),
    "rate hi": ("warp", "playback_max"),
    "peak": ("warp", "peak_hand_speed_ratio"),
    "skate": ("feet", "skate_ratio"),
    "skate95": ("feet", "skate_p95_ratio"),
    "foot acc": ("feet", "acceleration_ratio"),
    "reach m": ("feet", "over_reach_m"),
    "jerk": ("smoothness", "jerk_all_ratio"),
    "jerk95": ("smoothness", "jerk_all_p95_ratio"),
}
_WORST = {"rate lo": np.min, "rate hi": np.max, "peak": np.max, "reach m": np.max}


def hear(path: Path | None, seconds: float) -> Song:
    """A song, or the embedded one."""
    if path is not None:
        return listen(path, seconds=seconds)
    from onbeat.examples import embedded_song

    return embedded_song(seconds)[0]


def dances(library: MoveLibrary, songs: list[Song], method: str, *, rhythm_only: bool) -> list[Dance]:
    """One dance a song; ``walk`` is danced three times, so that chance is seen."""
    seeds = range(3) if method == "walk" else range(1)
    return [
        make_dance(song, library, method=method, rhythm_only=rhythm_only, seed=seed) for song in songs for seed in seeds
    ]


def row(found: list[Dance]) -> dict[str, float]:
    """Medians over dances (the worst of them where a bound is to be kept)."""
    values: dict[str, float] = {}
    for name, (group, key) in COLUMNS.items():
        known = [v for dance in found if (v := dance.document.metrics[group].get(key)) is not None]
        values[name] = float(_WORST.get(name, np.median)(known)) if known else float("nan")
    values["search s"] = float(np.median([dance.found.seconds for dance in found]))
    return values


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("songs", nargs="*", type=Path)
    parser.add_argument("--moves", type=Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--methods", nargs="+", default=list(METHODS))
    parser.add_argument("--each", action="store_true", help="a row a song, too")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    begun = time.perf_counter()
    library = build_or_open(given.moves) if given.moves else embedded_library()
    opened = time.perf_counter() - begun
    songs = [hear(path, given.seconds) for path in given.songs or [None]]
    table: dict[str, dict[str, float]] = {}
    for method in given.methods:
        name = method.removesuffix("-rhythm")
        found = dances(library, songs, name, rhythm_only=method != name)
        table[method] = row(found)
        if given.each and method != "walk":
            table |= {f"  {song.title[:12]}": row([dance]) for song, dance in zip(songs, found, strict=True)}
    if given.json:
        print(json.dumps(table))
        return
    print(
        f"{len(library.clips)} clips, {library.seconds:.0f} s, {len(library.graph)} frames, "
        f"{library.graph.join_count} joins, ready in {opened:.1f} s; {len(songs)} songs of up to {given.seconds:g} s"
    )
    names = list(table)
    for column in [*COLUMNS, "search s"]:
        if column == "F50":
            print(f"{'':10s}" + "".join(f"{name:>15s}" for name in names))
        print(f"{column:10s}" + "".join(f"{table[name][column]:15.3f}" for name in names))
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
