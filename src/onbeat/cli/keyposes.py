"""``onbeat keyposes``: find the keyposes of a dance, learn its thresholds, measure how well they are found."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import cyclopts
import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags, read_dance, read_example
from onbeat.cli.keypose_sound import sound_of, titled
from onbeat.cli.own_song import own_song
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.cli.source_rate import SourceRate
from onbeat.errors import OnbeatError
from onbeat.files import write_atomically
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.document import keyposes_document
from onbeat.keyposes.evaluate import compare
from onbeat.keyposes.extract import Keyposes, Options, find_keyposes
from onbeat.keyposes.matching import TOLERANCE, Score, score
from onbeat.keyposes.threshold_file import DEFAULTS, VERSION, LearnedDocument, read_thresholds
from onbeat.keyposes.thresholds import Example, learn, sweep
from onbeat.motion import Markers, Motion

keyposes_app = cyclopts.App(
    name="keyposes", help="Find the keyposes of a dance: the poses in which it rests on the beat."
)


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class EnergyFlags:
    """How keyposes are looked for; what is not said is as in the thresholds file, else as by default.

    Parameters
    ----------
    energy
        ``rms`` (the default), ``sum`` or ``paper``, as printed in 2009.
    order
        ``global-local`` (the default), ``local-global``, ``global`` or ``local``: whose rest counts first.
    weights
        ``uniform`` (the default) or ``mass``.
    window
        Share of a beat within which a rest belongs to the beat: 0.5 (the default) gives each rest to its nearest beat.
    """

    energy: Literal["rms", "sum", "paper"] | None = None
    order: Literal["global-local", "local-global", "global", "local"] | None = None
    weights: Literal["uniform", "mass"] | None = None
    window: float | None = None

    def over(self, base: Options) -> Options:
        """What is said here, the rest as in ``base``."""
        if self.window is not None and not 0.0 < self.window <= 0.5:
            raise OnbeatError(f"--window {self.window:g} of a beat: give more than 0 and at most 0.5")
        told = {"kind": self.energy, "order": self.order, "weights": self.weights, "window": self.window}
        return replace(base, **{name: value for name, value in told.items() if value is not None})


SCORES = 1
"""Version of the scores as JSON."""
USUAL = EnergyFlags()
"""None was given."""


@keyposes_app.default
def find_command(
    motion: Path,
    *,
    flags: BeatFlags = NO_BEATS,
    output: Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])] = None,
    method: Literal["energy", "paper2009", "shiratori2004", "hands"] = "energy",
    looks: EnergyFlags = USUAL,
    t1: float | None = None,
    t2: float | None = None,
    thresholds: Path | None = None,
    cycle: int | None = None,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Find the keyposes of a motion.

    Example: ``onbeat keyposes dance.bvh --music song.mp3 -o dance_keyposes``

    Parameters
    ----------
    motion
        Any motion file, of a body or of markers.
    flags
        Where the beats come from.
    output
        A folder for ``keyposes.json``, ``keyposes.csv``, the sheet as ``keyposes.png``, ``.svg`` and
        ``.pdf``, and the page ``keyposes.html``.
    method
        ``energy`` (the default), ``paper2009``, ``shiratori2004`` or ``hands``.
    looks
        How keyposes are looked for.
    t1
        Energy under which a rest is a keypose, in units of the mean energy.
    t2
        Rise of the energy on both sides of a rest that makes it a keypose, in the same units.
    thresholds
        A file that ``onbeat keyposes learn`` wrote, instead.
    cycle
        Beats after which the dance repeats: the sheet puts the cycles under each other.
    json
        Print the document on stdout instead of a table.
    """
    if cycle is not None and cycle < 1:
        raise OnbeatError(f"a cycle of {cycle} beats cannot be; give 1 or more")
    options = _options(looks, t1, t2, thresholds)
    _check_method(method, looks, t1, t2, thresholds)
    with warnings_as_lines(), Stages() as stages:
        stages("reading", 0.0, motion.name)
        if song := own_song(motion, flags.music, flags.beats, flags.song_at):
            flags = replace(flags, beats=song)
        source, beats, downbeats = read_dance(motion, flags, "local" in options.order or method != "energy")
        stages("finding", 0.0)
        found = find_keyposes(source, beats, method, options)
        document = keyposes_document(found, motion.stem, options if method == "energy" else None)
        if output:
            title = titled(motion.stem, flags)
            _write(output, found, source, document.to_json(), title, downbeats, cycle, flags, stages)
    if json:
        sys.stdout.write(document.to_json().decode())
    else:
        _print_found(found, motion.name)


def _check_method(method: str, looks: EnergyFlags, t1: float | None, t2: float | None, file: Path | None) -> None:
    """Refuse what a method does not look at, rather than pass over it."""
    told = [f"--{name}" for name in ("energy", "order", "window") if getattr(looks, name) is not None]
    if method in ("hands", "shiratori2004"):
        told += ["--weights"] if looks.weights else []
        told += [name for name, value in (("--t1", t1), ("--t2", t2), ("--thresholds", file)) if value is not None]
    if method != "energy" and told:
        raise OnbeatError(
            f"--method {method} does not look at {', '.join(told)}; leave them out, or use the method energy"
        )


def _options(looks: EnergyFlags, t1: float | None, t2: float | None, file: Path | None) -> Options:
    """What is told, over what a file says, over the default."""
    base = DEFAULTS
    if file is not None:
        try:
            base = read_thresholds(file.read_bytes(), str(file))
        except OSError as error:
            raise OnbeatError(
                f"cannot read {file}: {error.strerror}; give what `onbeat keyposes learn -o` wrote"
            ) from None
    chosen = Thresholds(base.t1 if t1 is None else t1, base.t2 if t2 is None else t2)
    if not all(np.isfinite(value) and value >= 0.0 for value in chosen):
        raise OnbeatError(
            f"thresholds {chosen.t1:g} and {chosen.t2:g} cannot be; give 0 or more, in units of the mean energy"
        )
    return looks.over(replace(base.options(), thresholds=chosen))


def _write(
    folder: Path, found: Keyposes, source: Motion | Markers, document: bytes, title: str, downbeats: np.ndarray,
    cycle: int | None, flags: BeatFlags, stages: Stages,
) -> None:  # fmt: skip
    from onbeat.viewer.keypose.poses import fitted
    from onbeat.viewer.keypose.sheet import keypose_pages, save_pages
    from onbeat.viewer.pages.keyposes import write_keypose_page

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OnbeatError(f"cannot make the folder {folder}: {error.strerror}; give another one to -o") from None
    write_atomically(folder / "keyposes.json", document)
    times = "".join(f"{time:.6f}\n" for time in found.times)
    write_atomically(folder / "keyposes.csv", f"# seconds\n{times}".encode())
    stages("drawing", 0.0, "the body")
    shown = fitted(source)
    pages = keypose_pages(found, shown, title=title, downbeats=downbeats, cycle=cycle)
    for done, name in enumerate(("keyposes.png", "keyposes.svg", "keyposes.pdf")):
        stages("drawing", 0.2 + 0.25 * done, name)
        save_pages(pages, folder / name)
    sound = sound_of(flags, len(source) / source.fps)
    page = folder / "keyposes.html"
    write_keypose_page(page, found, shown, title=title, downbeats=downbeats, cycle=cycle, audio=sound)


def _print_found(found: Keyposes, name: str) -> None:
    table = Table(box=None, pad_edge=False)
    for head in ("", "second", "beat", "off the beat", "rests"):
        table.add_column(head, justify="right" if head != "rests" else "left")
    for number, (time, beat, source) in enumerate(zip(found.times, found.beats, found.sources, strict=True), 1):
        off = 1000.0 * (time - found.song_beats[beat])
        table.add_row(str(number), f"{time:.3f}", str(beat + 1), f"{off:+.0f} ms", source)
    screen = Console()
    screen.print(
        Text(
            f"{name}: {len(found)} {'keypose' if len(found) == 1 else 'keyposes'} on {len(found.song_beats)} beats, "
            f"by {found.method}"
        )
    )
    if len(found):
        screen.print(table)
    else:
        screen.print(Text("the body never rests near a beat: try a higher --t1, or check --song-at"))


def _examples(paths: list[Path], options: Options, song_at: float, fps: float | None) -> list[Example]:
    with warnings_as_lines(), Stages() as stages:
        read: list[Example] = []
        for done, path in enumerate(paths):
            stages("reading", done / len(paths), path.name)
            read.append(read_example(path, options, song_at, fps))
    return read


def _score(had: Score) -> str:
    return f"precision {had.precision:.2f}, recall {had.recall:.2f}, F {had.f:.2f}"


Motions = Annotated[list[Path], cyclopts.Parameter(negative=(), json_list=False)]


@keyposes_app.command(name="learn")
def learn_command(
    examples: Motions,
    /,
    *,
    output: Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])] = None,
    looks: EnergyFlags = USUAL,
    tolerance: float = TOLERANCE,
    song_at: float = 0.0,
    fps: SourceRate = None,
) -> None:
    """Learn the thresholds from dances whose keyposes are marked.

    Example: ``onbeat keyposes learn folk_1.bvh folk_2.bvh -o thresholds.json``

    Parameters
    ----------
    examples
        Motion files; beside each ``NAME.bvh`` a file ``NAME.keyposes.csv`` with the seconds of its keyposes, one a
        line, and ``NAME.beats`` or a song ``NAME.wav``.
    output
        Where to write the thresholds as JSON, for ``onbeat keyposes MOTION --thresholds``.
    looks
        How keyposes are looked for.
    tolerance
        Seconds by which a keypose may be off.
    song_at
        Second of the motions at which their songs begin.
    fps
        Frames a second of motion files that store none.
    """
    options = looks.over(DEFAULTS.options())
    read = _examples(examples, options, song_at, fps)
    learned = learn(read, tolerance)
    (low1, high1), (low2, high2) = learned.plateau
    screen = Console()
    table = Table(box=None, pad_edge=False, show_header=False)
    every = float(np.mean([score(one.reading.beats, one.truth, tolerance).f for one in read]))
    rows = (
        ("T1", f"{learned.thresholds.t1:g} of the mean energy; as good from {low1:g} to {high1:g}"),
        ("T2", f"{learned.thresholds.t2:g} of the mean energy; as good from {low2:g} to {high2:g}"),
        ("held out", _score(learned.held_out)),
        ("every beat", f"F {every:.2f}" + (": better here; see --tolerance" if every > learned.held_out.f else "")),
    )
    for name, value in rows:
        table.add_row(Text(name, "dim"), Text(value))
    screen.print(table)
    if output:
        write_atomically(
            output,
            LearnedDocument(
                VERSION,
                *learned.thresholds,
                energy=options.kind,
                order=options.order,
                weights=options.weights,
                window=options.window,
                held_out_f=round(learned.held_out.f, 6),
                plateau_t1=[low1, high1],
                plateau_t2=[low2, high2],
                examples=len(examples),
            ).to_json(),
        )


@keyposes_app.command(name="evaluate")
def evaluate_command(
    examples: Motions,
    /,
    *,
    tolerance: float = TOLERANCE,
    looks: EnergyFlags = USUAL,
    thresholds: Path | None = None,
    plot: Path | None = None,
    song_at: float = 0.0,
    fps: SourceRate = None,
    seed: int = 0,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Measure how well every method finds marked keyposes, and how much that depends on the thresholds.

    Example: ``onbeat keyposes evaluate folk_1.bvh folk_2.bvh --tolerance 0.1 --plot sweep.png``

    Parameters
    ----------
    examples
        Motion files with their keyposes and beats beside them, as for ``onbeat keyposes learn``.
    tolerance
        Seconds by which a keypose may be off.
    looks
        How keyposes are looked for.
    thresholds
        A file that ``onbeat keyposes learn`` wrote.
    plot
        Draw precision and recall over T1 and T2 to this PNG, SVG or PDF file.
    song_at
        Second of the motions at which their songs begin.
    fps
        Frames a second of motion files that store none.
    seed
        Of the random phases of the chance column.
    json
        Print the scores as JSON on stdout instead of tables.
    """
    if seed < 0:
        raise OnbeatError(f"--seed {seed}: give 0 or more")
    options = _options(looks, None, None, thresholds)
    chosen = options.thresholds
    read = _examples(examples, options, song_at, fps)
    rows = compare(read, np.random.default_rng(seed), tolerance, options)
    swept = sweep(read, tolerance=tolerance)
    if plot:
        from onbeat.viewer.plots.thresholds import write_threshold_figure

        write_threshold_figure(plot, swept, chosen)
    if json:
        scores: dict[str, Any] = {
            row.name: {**{k: round(v, 4) for k, v in row.score._asdict().items()}, "chance": round(row.chance, 4)}
            for row in rows
        }
        document = {"version": SCORES, "tolerance": tolerance, "thresholds": list(chosen), "scores": scores}
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(document), indent=1).decode() + "\n")
        return
    table = Table(box=None, pad_edge=False)
    for head in (f"within {1000 * tolerance:.0f} ms", "precision", "recall", "F", "by chance"):
        table.add_column(head, justify="left" if head.startswith("within") else "right")
    for row in rows:
        table.add_row(Text(row.name), *(f"{value:.2f}" for value in (*row.score, row.chance)))
    screen = Console()
    screen.print(table)
    (low1, high1), (low2, high2) = swept.plateau()
    best = swept.best()
    screen.print(
        Text(
            f"highest F over both thresholds {swept.f.max():.2f}; about as high with T1 {low1:g}…{high1:g} "
            f"(at T2 {best.t2:g}) and T2 {low2:g}…{high2:g} (at T1 {best.t1:g})"
        )
    )
