"""``onbeat observe``: what stays and what goes when a dance is danced to faster music (2007, Sec. II)."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text
from threadpoolctl import threadpool_limits

from onbeat.cli.keypose_input import NO_BEATS, BeatFlags
from onbeat.cli.observe_input import Dance, chosen_joints, embedded, in_repetition, read_takes
from onbeat.cli.observe_likeness import tell_unlike
from onbeat.cli.observe_score import all_valleys, valley_score
from onbeat.cli.progress import Stages, warnings_as_lines
from onbeat.errors import MetricError
from onbeat.files import make_folder, write_atomically
from onbeat.retime.attenuation import Attenuation, attenuation
from onbeat.retime.observe import Observation, observe
from onbeat.retime.observe_document import ObserveDocument, observe_document
from onbeat.retime.takes import repetitions

WIDE = 160
"""Characters of a line where no screen bounds it."""


def observe_command(
    motions: Annotated[list[Path] | None, cyclopts.Parameter(negative=(), json_list=False)] = None,
    /,
    *,
    speeds: str | None = None,
    flags: BeatFlags = NO_BEATS,
    cycle: int | None = None,
    joints: str | None = None,
    draw: str | None = None,
    keyposes: Path | None = None,
    output: Annotated[Path | None, cyclopts.Parameter(name=["-o", "--output"])] = None,
    seed: int = 0,
    json: Annotated[bool, cyclopts.Parameter(negative=())] = False,
) -> None:
    """Observe takes of a dance at several speeds: which details go in faster music, which poses stay.

    Example: ``onbeat observe slow_1.bvh slow_2.bvh fast_1.bvh fast_2.bvh -o observed``

    Parameters
    ----------
    motions
        Takes of one dance by one body, two or more. Beside each ``NAME.bvh`` lie its beats, ``NAME.beats``, or its
        song, ``NAME.wav``; their first beats are the same place of the dance. Without motions a dancer of the embedded
        troupe dances 15 takes.
    speeds
        How fast the takes are, like ``1.0,1.2,1.5``: one for each, or one for each tempo, slowest first. Without it,
        their tempi by that of the slowest.
    flags
        Where the beats come from, if all takes have the same.
    cycle
        Beats after which the dance repeats: every cycle is a repetition, of single takes, too.
    joints
        Joints that are looked at, by name or role, commas between; without it, the upper body's.
    draw
        The joint whose own curves are drawn; without it, the left shoulder's.
    keyposes
        The dance's known keyposes: seconds of the first motion, one a line, or a ``keyposes.json`` of it. Without it,
        ``NAME.keyposes.csv`` beside that, if there is one.
    output
        A folder for ``observe.json`` and the figures: ``means``, ``variance`` and ``layers``, as PNG and SVG.
    seed
        Draws the takes of the troupe, intervals and chance.
    json
        Print ``observe.json`` on stdout instead of a table.
    """
    if seed < 0:
        raise MetricError(f"--seed {seed} cannot be; give 0 or more")
    with warnings_as_lines(), threadpool_limits(1, "blas"), Stages() as stages:  # bits do not depend on threads
        dance = _read(motions, flags, speeds, keyposes, seed, stages)
        names, drawn = chosen_joints(dance.takes[0].motion.skeleton, joints, draw)
        every = repetitions(
            dance.takes, names, dance.cycle if cycle is None else cycle, progress=lambda share: stages("layers", share)
        )
        stages("comparing", 0.0)
        found = observe(every)
        rng = np.random.default_rng(seed)
        energies = attenuation(every, rng)
        each, common = all_valleys(found)
        known = None
        if dance.keyposes is not None:
            known = in_repetition(dance.keyposes, every.first, float(every.beats[-1]), every.period)
        scores = [valley_score(found, common, known, rng)] if known is not None and len(known) else []
        document = observe_document(found, energies, each, common, drawn, scores)
        tell_unlike([take.label for take in dance.takes], every, document.likeness)
        if output is not None:
            from onbeat.viewer.plots.observe import write_observe_figures

            stages("drawing", 0.0)
            folder = make_folder(output)
            write_atomically(folder / "observe.json", document.to_json())
            write_observe_figures(folder, found, energies, drawn, common, known)
    if json:
        sys.stdout.write(document.to_json().decode())
    else:
        _print(dance, found, energies, document)


def _read(
    motions: list[Path] | None, flags: BeatFlags, speeds: str | None, keyposes: Path | None, seed: int, stages: Stages
) -> Dance:
    if not motions:
        told = [
            name
            for name, value in (
                ("--speeds", speeds), ("--keyposes", keyposes), ("--music", flags.music), ("--beats", flags.beats),
            )
            if value is not None
        ]  # fmt: skip
        if told:
            raise MetricError(f"{', '.join(told)} without a motion: give two takes of the dance or more")
        stages("dancing", 0.0, "the embedded troupe")
        return embedded(seed=seed)
    return read_takes(
        motions,
        flags,
        speeds,
        keyposes,
        lambda number: stages("reading", number / len(motions), motions[number].name),
    )


def _print(dance: Dance, found: Observation, energies: Attenuation, document: ObserveDocument) -> None:
    screen = Console()
    screen = screen if screen.is_terminal else Console(width=WIDE)
    counts = ", ".join(f"{curves.count} at {curves.speed:g}×" for curves in found.speeds)
    kind = "cycles" if found.repetitions.cyclic else "takes"
    length = f"{found.repetitions.beats[-1]:g} beats"
    joints = len(found.repetitions.joints)
    screen.print(Text(f"{dance.title}: {kind} of {length}, {counts}; {joints} joints"))
    if document.likeness and document.likeness_shifted:
        shifted = "{:z.2f} ± {:.2f}".format(*document.likeness_shifted)
        told = f"{np.mean(document.likeness):z.2f}, at least {min(document.likeness):z.2f}"
        screen.print(Text(f"likeness of the {kind}: {told}; shifted by whole beats {shifted}"))
    screen.print(_layers(energies, document))
    screen.print(Text(_valleys(document)))


def _layers(energies: Attenuation, document: ObserveDocument) -> Table:
    """Of each layer the rms, with what takes do not share, at each speed, and what of it is left."""
    table = Table(box=None, pad_edge=False)
    several = len(energies.speeds) > 1
    heads = ["layer", "knots [beat]", *(f"{speed:g}×: rms (noise)" for speed in energies.speeds)]
    others = [k for k in range(len(energies.speeds)) if k != energies.base]
    heads += [f"left at {energies.speeds[k]:g}×" for k in others]
    for head in [*heads, *(["slope [95 %]"] if several else [])]:
        table.add_column(head, justify="right")
    for layer, told in enumerate(document.layers):
        cells = [str(layer + 1), f"{told.spacing:g}"]
        cells += [
            f"{rms:.4f} ({noise:.4f})"
            for rms, noise in zip(energies.rms[:, layer], energies.noise[:, layer], strict=True)
        ]
        cells += [f"{energies.ratios[0][k, layer]:.0%}" for k in others]
        if several:
            slope, low, high = energies.slopes[0, layer]
            cells.append(f"{slope:+.2f}" + (f" [{low:+.2f}, {high:+.2f}]" if np.isfinite(low) else ""))
        table.add_row(*(cell.replace("nan%", "–").replace("nan", "–") for cell in cells))
    return table


def _valleys(document: ObserveDocument) -> str:
    beats = ", ".join(f"{beat:.2f}" for beat in document.valleys)
    lines = [f"valleys of all curves of variance: {len(document.valleys)}" + (f", at beats {beats}" if beats else "")]
    for told in document.scores:
        lines += [
            f"keyposes at beats {', '.join(f'{beat:.2f}' for beat in told.keyposes)}",
            f"as keyposes, within {told.tolerance:g} beat: precision {told.precision:.2f}, recall {told.recall:.2f}, "
            f"F {told.f:.2f}; at a random phase F {told.chance:.2f} ± {told.chance_deviation:.2f}, on other beats "
            f"{told.beat_chance:.2f}",
            "variance at keyposes by that at other times: "
            + ", ".join(
                f"{f'{curves.speed:g}×' if curves.speed else 'all'} {ratio:.2f}"
                for curves, ratio in zip(document.curves, told.contrast, strict=True)
                if ratio
            ),
        ]
    return "\n".join(lines)
