"""The valleys that all curves of variance have in common, held against known keyposes and chance (2007, Insight 2)."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.keyposes.matching import chance, score
from onbeat.retime.observe import Observation
from onbeat.retime.observe_document import ScoreDocument
from onbeat.retime.valleys import common_valleys, contrast, valleys

TOLERANCE = 0.15
"""Beats."""
DRAWS = 2000


def all_valleys(found: Observation) -> tuple[list[Array], Array]:
    """Beats of the valleys of each speed's curve and of that of all together; and of those that all have in common."""
    every = found.repetitions
    each = [valleys(every.beats, curves.pooled, every.cyclic) for curves in (*found.speeds, found.all)]
    repeated = [own for own, curves in zip(each, (*found.speeds, found.all), strict=True) if curves in found.repeated]
    return each, common_valleys(repeated, every.period)


def valley_score(found: Observation, common: Array, keyposes: Array, rng: np.random.Generator) -> ScoreDocument:
    """How right the valleys are as keyposes (K,), which are beats of the repetition.

    Raises
    ------
    MetricError
        If there is no keypose.
    """
    every = found.repetitions
    begin = _between(keyposes, every.period)
    truth, valleys_ = ((beats - begin) % every.period if every.period else beats for beats in (keyposes, common))
    right = score(valleys_, truth, TOLERANCE)
    span = (0.0, float(every.beats[-1]))
    mean, deviation = chance(valleys_, truth, span, rng, TOLERANCE, DRAWS)
    steps = [score((valleys_ + step) % span[1], truth, TOLERANCE).f for step in range(1, round(span[1]))]
    ratios = [contrast(every.beats, each.pooled, keyposes, every.period) for each in (*found.speeds, found.all)]
    return ScoreDocument(
        keyposes=np.round(keyposes, 4).tolist(),
        tolerance=TOLERANCE,
        precision=right.precision,
        recall=right.recall,
        f=right.f,
        chance=mean,
        chance_deviation=deviation,
        beat_chance=float(np.mean(steps)) if steps else mean,
        contrast=np.nan_to_num(ratios).round(4).tolist(),
    )


def _between(keyposes: Array, period: float) -> float:
    """The middle of the longest stretch of a cycle without a keypose: there it can be cut."""
    if not period or not len(keyposes):
        return 0.0
    gaps = np.diff(np.append(np.sort(keyposes), keyposes.min() + period))
    return float(np.sort(keyposes)[gaps.argmax()] + gaps.max() / 2)
