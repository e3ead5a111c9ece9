"""How well methods find marked keyposes, beside what is simpler and what chance gives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.keyposes.extract import METHODS, PAPER, Keyposes, Options, find_keyposes
from onbeat.keyposes.matching import TOLERANCE, Score, chance, score
from onbeat.keyposes.thresholds import Example

USUAL = Options()


class Row(NamedTuple):
    """A method's mean precision, recall and F over examples, and the F that its times would have at a random phase."""

    name: str
    score: Score
    chance: float


def compare(
    examples: Sequence[Example],
    rng: np.random.Generator,
    tolerance: float = TOLERANCE,
    options: Options = USUAL,
) -> list[Row]:
    """Every method, the weights and energies of the default, and every beat taken for a keypose.

    Parameters
    ----------
    examples : dances whose keyposes are known.
    rng : of the random phases.
    tolerance : seconds.
    options : of the method by energy; the rows below it change one of them each.
    """
    variants: list[tuple[str, str, Options]] = [(name, name, options) for name in METHODS]
    variants += [("energy, mass weights", "energy", replace(options, weights="mass"))]
    variants += [(f"energy, {kind}", "energy", replace(options, kind=kind)) for kind in ("sum", PAPER.kind)]
    variants += [
        (f"energy, {order}", "energy", replace(options, order=order)) for order in ("local-global", "global", "local")
    ]
    rows = [
        _row(name, [_found(example, method, options).times for example in examples], examples, rng, tolerance)
        for name, method, options in variants
    ]
    return [*rows, _row("every beat", [example.reading.beats for example in examples], examples, rng, tolerance)]


def _found(example: Example, method: str, options: Options) -> Keyposes:
    return find_keyposes(example.reading.source, example.reading.beats, method, options)


def _row(
    name: str, found: Sequence[Times], examples: Sequence[Example], rng: np.random.Generator, tolerance: float
) -> Row:
    scores = [score(times, example.truth, tolerance) for times, example in zip(found, examples, strict=True)]
    nulls = [
        chance(times, example.truth, (0.0, example.reading.source.duration), rng, tolerance)[0]
        for times, example in zip(found, examples, strict=True)
    ]
    return Row(name, Score(*(float(v) for v in np.mean(scores, axis=0))), float(np.mean(nulls)))
