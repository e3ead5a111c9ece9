"""What is asked of a retiming method, and what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Bools, Times, frozen
from onbeat.errors import PlanError
from onbeat.retime.bspline import Spline
from onbeat.retime.lock import TimeMap

EXACT = 1e-9
"""By how much a bound may be past: rounding alone."""


@dataclass(frozen=True, eq=False)
class Demand:
    """A dance in the wanted time, and what the body can do.

    Parameters
    ----------
    wish : n channels over the music's seconds, as they would be had the body no limits; knots one frame apart.
    low, high : (n,) bounds of the values, infinite where there is none.
    speed : (controls − 1, n) bounds of the velocity about each pair of control points, or (n,) for all of them.
    acceleration, jerk : (n,) bounds of the second and third derivative, infinite where there is none.
    keyposes : (K,) seconds of the music at which the dance is to be as it was; in order, and each once, when kept here.
    rhythm : the music's seconds to beats of the dance; layers have their knots on it.

    Raises
    ------
    PlanError
        If shapes disagree, a lower bound is above an upper one, a bound of a derivative is not above 0, there is no
        channel, or something is not a number.
    """

    wish: Spline
    low: Array
    high: Array
    speed: Array
    acceleration: Array
    jerk: Array
    keyposes: Times
    rhythm: TimeMap

    def __post_init__(self) -> None:
        n = self.wish.channels
        if not n or not np.isfinite(self.wish.controls).all():
            raise PlanError(f"a wish of {n} channels{', some no numbers' * bool(n)}; one or more of numbers are needed")
        for name in ("low", "high", "speed", "acceleration", "jerk"):
            shape = (len(self.wish.controls) - 1, n) if name == "speed" else (n,)
            try:
                values = np.broadcast_to(np.asarray(getattr(self, name), dtype=np.float64), shape)
            except ValueError:
                raise PlanError(f"{name} has shape {np.shape(getattr(self, name))}; {shape} is needed") from None
            if np.isnan(values).any() or (name not in ("low", "high") and (values <= 0).any()):
                kind = "numbers" if name in ("low", "high") else "bounds above 0"
                raise PlanError(f"{name} holds {values.min()}; {kind} are needed")
            object.__setattr__(self, name, frozen(values))
        if not np.isfinite(self.keyposes).all():
            raise PlanError(f"keypose {int(np.argmin(np.isfinite(self.keyposes)))} is at no number of seconds")
        object.__setattr__(self, "keyposes", frozen(np.unique(self.keyposes)))
        crossed = (self.low > self.high) | np.isposinf(self.low) | np.isneginf(self.high)
        if crossed.any():
            k = int(np.argmax(crossed))
            raise PlanError(
                f"channel {k} has its lower bound, {self.low[k]}, above its upper one, {self.high[k]}, or nothing "
                "between them; a range is needed"
            )

    @cached_property
    def beat(self) -> float:
        """Seconds of a beat, on the whole."""
        ends = np.array([self.wish.knots.start, self.wish.knots.end])
        return float(np.diff(ends)[0] / np.diff(self.rhythm(ends))[0])

    @cached_property
    def target(self) -> Array:
        """(frames, n) the wish at the knots, with values that are out of bounds brought to the bound."""
        return np.clip(self.wish.samples, self.low, self.high)

    def violated(self, controls: Array, derivatives: bool = True) -> Bools:
        """(controls, n) true where a bound of the values or velocities (or higher) is past about a control point.

        What bounds the hull bounds the spline between its samples; the reverse does not hold, by a hair.
        """
        step = self.wish.knots.step
        pairs = np.abs(np.diff(controls, axis=0)) > step * self.speed * (1 + EXACT)
        for point in ((2 * controls[:-1] + controls[1:]) / 3, (controls[:-1] + 2 * controls[1:]) / 3):
            pairs |= (point < self.low - EXACT) | (point > self.high + EXACT)
        out = np.zeros(controls.shape, dtype=bool)
        out[:-1] |= pairs
        out[1:] |= pairs
        if derivatives:
            out[1:-1] |= np.abs(np.diff(controls, 2, axis=0)) > step**2 * self.acceleration * (1 + EXACT)
            past = np.abs(np.diff(controls, 3, axis=0)) > step**3 * self.jerk * (1 + EXACT)
            out[1:-2] |= past
            out[2:-1] |= past
        return out


@dataclass(frozen=True, eq=False)
class Answer:
    """What a method makes of a demand.

    Parameters
    ----------
    trajectory : the channels, on the wish's knots.
    weights : (frames, layers, n) of the layers, for methods that have any; the coarsest first.
    """

    trajectory: Spline
    weights: Array | None = None


Progress = Callable[[float], None]
"""Told the share that is done, 0 to 1."""
Method = Callable[[Demand, Progress], Answer]
"""Every method is a function of a demand."""


def silent(share: float) -> None:
    """Tells nobody."""
