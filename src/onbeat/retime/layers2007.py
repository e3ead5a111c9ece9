"""Temporal scaling as in 2007 (Sec. III-B, Eqs. 13-17): weights of the layers are lowered until the limits are kept.

Every segment, one beat of the music, starts with all weights 1. Where a limit is past, its weights are lowered, a tenth
at a time and the finest layer first; neighbouring segments are blended with the quintic α(t) = −6t⁵ + 15t⁴ − 10t³ + 1;
and so on until nothing is past a limit.

**Guarded.** Printed as it is, the method fails where the coarsest layer has to shrink: ``w f₁`` draws the angle towards
0 radians, whatever 0 means on that joint (71° off at keyposes on real arms). Here the layers go on two octaves below
the beat, to knots a bar apart, and they are counted from the channel's mean, so that at the end of all lowering the
joint stands at its mean, which is inside its limits. ``literal`` is as printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.errors import PlanError
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import EXACT, Answer, Demand, Progress, silent
from onbeat.retime.hierarchy import LAYERS, ROUNDING, decompose

BAR = 4.0
"""Beats between the knots of the guarded method's coarsest layer."""
BLEND = 0.5
"""Beats about a segment's end over which it is blended with the next (L of Eq. 16)."""
INSIDE = 1e-5
"""Radians by which the mean is kept inside its bounds, where these leave the room."""
STEP = 0.1
"""By how much weights are lowered at a time."""


@dataclass(frozen=True, eq=False)
class Layered:
    """A demand's wish as layers at its frames.

    Parameters
    ----------
    mean : (n,) what the layers are counted from.
    values : (frames, layers, n), the coarsest first.
    beats : (frames,) the frames on the rhythm, from 0.
    """

    mean: Array
    values: Array
    beats: Array

    @classmethod
    def of(cls, demand: Demand, guarded: bool = True) -> Layered:
        """Seven layers from a bar's knots about the mean, or the five of 2007 about 0."""
        knots = demand.wish.knots
        gap = np.minimum(INSIDE, (demand.high - demand.low) / 4)
        mean = np.clip(demand.wish.samples.mean(axis=0), demand.low + gap, demand.high - gap) * guarded
        beats = demand.rhythm(knots.times)
        octaves = int(np.log2(BAR)) if guarded else 0
        layers = decompose(
            demand.wish.with_controls(demand.wish.controls - mean),
            demand.rhythm,
            demand.rhythm(demand.keyposes),
            LAYERS + octaves,
            BAR if guarded else 1.0,
        )
        values = np.ascontiguousarray(layers(beats).transpose(1, 0, 2))
        return cls(mean, values, np.maximum(beats - np.floor(beats[0] + ROUNDING), 0.0))

    @property
    def segments(self) -> int:
        """How many there are, one a beat."""
        return int(self.beats[-1] - ROUNDING) + 1


def quintic(t: Array) -> Array:
    """α of Eq. 17, 1 before 0 and 0 after 1.

    Examples
    --------
    >>> quintic(np.array([-1.0, 0.0, 0.5, 1.0])).tolist()
    [1.0, 1.0, 0.5, 0.0]
    """
    t = np.clip(t, 0.0, 1.0)
    return 1.0 - t**3 * (10.0 - 15.0 * t + 6.0 * t**2)


def lower(demand: Demand, progress: Progress = silent, guarded: bool = True) -> Answer:
    """The layers' sum with weights lowered until position and velocity are inside the limits.

    Raises
    ------
    PlanError
        If limits are past with all weights at 0, which happens to the literal method where 0 rad is no position.
    """
    layered = Layered.of(demand, guarded)
    layers, channels = layered.values.shape[1:]
    depth = np.full((layered.segments, channels), float(layers))
    active = np.arange(channels)
    first, second, share = _blending(layered.beats, layered.segments)
    samples = layered.mean + layered.values.sum(axis=1)
    while len(active):
        weights = _weights(depth[:, active], first, second, share, layers)
        samples[:, active] = layered.mean[active] + np.einsum("fln,fln->fn", weights, layered.values[:, :, active])
        controls = Spline.through(samples[:, active], 1.0).controls
        past = _within(demand, controls, active)
        busy = past.any(axis=0)
        if (depth[:, active[busy]].max(axis=0, initial=0.0) <= 0).any():
            raise PlanError(f"channel {int(active[busy][0])}: its limits are past with all layers taken away")
        depth[:, active[busy]] = _lowered(depth[:, active[busy]], past[:, busy], first, second)
        active = active[busy]
        progress(1.0 - float(depth[:, active].mean() / layers) if len(active) else 1.0)
    weights = _weights(depth, first, second, share, layers)
    return Answer(demand.wish.with_controls(Spline.through(samples, 1.0).controls), weights)


literal = partial(lower, guarded=False)
"""The method as printed."""


def _blending(beats: Array, segments: int) -> tuple[Ints, Ints, Array]:
    """Of each frame the segment, the one it is blended with, and the share (frames,) of the first."""
    border = np.round(beats)
    place = (beats - border) / BLEND + 0.5
    first = np.clip(np.where(np.abs(place - 0.5) <= 0.5, border - 1, np.floor(beats)), 0, segments - 1).astype(np.int64)
    second = np.clip(np.where(np.abs(place - 0.5) <= 0.5, border, np.floor(beats)), 0, segments - 1).astype(np.int64)
    return first, second, quintic(place)


def _weights(depth: Array, first: Ints, second: Ints, share: Array, layers: int) -> Array:
    """(frames, layers, n) weights from how many layers each segment (segments, n) has left."""
    each = np.clip(depth[:, None] - np.arange(layers)[:, None], 0.0, 1.0)
    return each[second] + share[:, None, None] * (each[first] - each[second])


def _within(demand: Demand, controls: Array, channels: Ints) -> Bools:
    """(frames, n) true where position or velocity is past its bound."""
    step = demand.wish.knots.step
    pairs = np.abs(np.diff(controls, axis=0)) > step * demand.speed[:, channels] * (1 + EXACT)
    low, high = demand.low[channels] - EXACT, demand.high[channels] + EXACT
    for point in ((2 * controls[:-1] + controls[1:]) / 3, (controls[:-1] + 2 * controls[1:]) / 3):
        pairs |= (point < low) | (point > high)
    return pairs[:-1] | pairs[1:]


def _lowered(depth: Array, past: Bools, first: Ints, second: Ints) -> Array:
    """Depths with those of the segments lowered that are past a limit, and of the nearest that still can be."""
    hit = np.zeros(depth.shape, dtype=bool)
    np.logical_or.at(hit, first, past)
    np.logical_or.at(hit, second, past)
    while (spent := hit.any(axis=0) & ~(hit & (depth > 0)).any(axis=0)).any():
        grown = hit.copy()
        grown[1:] |= hit[:-1] & spent
        grown[:-1] |= hit[1:] & spent
        hit = grown
    return np.maximum(depth - STEP * hit, 0.0)
