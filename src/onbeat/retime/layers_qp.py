"""The layers' weights by a convex programme instead of by lowering them one after the other: ``layers-qp``.

Not in the papers, but over the same weights as 2007's: one of each layer on every beat of the music, with quintic
blends between. The trajectory is linear in them, so the best ones are the solution of

    minimise   Σ_frames (Σ_layers (w − 1) f)² step + KEYPOSE Σ_keyposes (the same there)² + SMOOTH Σ (w's steps)² energy
    subject to 0 ≤ w ≤ 1, position and velocity inside the limits

What the layers leave is one more layer, the finest, so that nothing is lost where nothing has to be. Limits are rows on
control points of the trajectory; few of them are ever near, so rows are taken in as they are found to be past.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix, csr_array, vstack

from onbeat._shapes import Array, Bools, Ints
from onbeat.errors import PlanError
from onbeat.quadratic import minimise
from onbeat.retime.bspline import Spline, basis
from onbeat.retime.demand import Answer, Demand, Progress, silent
from onbeat.retime.hierarchy import ROUNDING
from onbeat.retime.layers2007 import Layered, quintic
from onbeat.retime.reach import keyposes_of

KEYPOSE = 20.0
"""Beats of frames that one keypose weighs as much as: weights of layers cannot keep them all, and more only costs."""
SMOOTH = 0.02
"""Of a step of a weight from beat to beat, beside the energy that the layer has in a beat."""
TIGHTER = 4e-6
"""Share by which bounds are drawn in, for what products of splines leave when they are made splines again."""
SOLVED = 1e-6
"""The solver's tolerance; bounds are drawn in by twice that."""
ROOM = 8 * SOLVED
"""Radians between bounds within which a joint stands at its mean: what moves less is not told from the tolerance."""
NEAR = 0.9
"""Share of a bound from which on a row is taken in."""
ROUNDS = 40
PULL = 1e-3
"""By which weights are drawn to 1 more than the error draws them: else they stand on a bound that nothing presses them
to, and the solver creeps."""
_FADED = 14
"""Frames past a blend's end in which the control points of a product fade away, to 0.268^14."""


@dataclass(frozen=True, eq=False)
class Products:
    """Each weight's part in the trajectory: weight (beat m, layer i) multiplies ``φ_m(t) f_i(t)``.

    Parameters
    ----------
    beats : (frames,) from 0.
    values : (frames, layers, n).
    """

    beats: Array
    values: Array

    @property
    def count(self) -> int:
        """Beats that have weights."""
        return max(int(np.ceil(self.beats[-1] - ROUNDING)), 1) + 1

    @cached_property
    def apart(self) -> int:
        """Weights so many beats apart have nothing to do with each other: 3, and more where a beat has few frames."""
        most = float(np.diff(self.beats).max())
        return min(max(2 * int(np.ceil(_FADED * most + 0.5)) + 1, 3), 2 * self.count - 1)

    @cached_property
    def blends(self) -> Array:
        """(frames, count) the partition of unity φ."""
        low = np.minimum(np.floor(self.beats).astype(np.int64), self.count - 2)
        share = quintic(self.beats - low)
        out = np.zeros((len(self.beats), self.count))
        out[np.arange(len(low)), low] = share
        out[np.arange(len(low)), low + 1] = 1.0 - share
        return out

    @cached_property
    def controls(self) -> Array:
        """(apart, controls, layers, n) control points of the products, those so many beats apart added up."""
        frames, layers, channels = self.values.shape
        out = list[Array]()
        for phase in range(self.apart):
            blend = self.blends[:, phase :: self.apart].sum(axis=1)
            product = (blend[:, None, None] * self.values).reshape(frames, -1)
            out.append(Spline.through(product, 1.0).controls.reshape(frames + 2, layers, channels))
        return np.stack(out)

    def matrix(self, table: Array, beats: Array) -> csr_array:
        """Rows (N, count · layers): phase p's values (apart, N, layers) are of the nearest of beats p, p + apart …"""
        rows, layers = table.shape[1:]
        near = np.round(beats).astype(np.int64)
        columns, values = list[Ints](), list[Array]()
        for offset in range(-(self.apart // 2), self.apart // 2 + 1):
            beat = near + offset
            inside = (beat >= 0) & (beat < self.count)
            part = table[np.mod(beat, self.apart), np.arange(rows)] * inside[:, None]
            columns.append(np.clip(beat, 0, self.count - 1)[:, None] * layers + np.arange(layers))
            values.append(part)
        index = np.concatenate(columns, axis=1)
        starts = np.arange(rows + 1) * index.shape[1]
        shape = (rows, self.count * layers)
        out = csr_array((np.concatenate(values, axis=1).ravel(), index.ravel(), starts), shape=shape)
        out.sum_duplicates()
        return out


def weigh(demand: Demand, progress: Progress = silent) -> Answer:
    """The layers' sum with the smallest change that brings position and velocity inside the limits.

    Raises
    ------
    PlanError
        If the solver finds no weights for a channel, though all at 0 would do.
    """
    layered = Layered.of(demand)
    rest = demand.wish.samples - layered.mean - layered.values.sum(axis=1)
    products = Products(layered.beats, np.concatenate((layered.values, rest[:, None]), axis=1))
    layers, channels = products.values.shape[1:]
    weights = np.ones((products.count, layers, channels))
    busy = np.flatnonzero((_excess(demand, demand.wish.controls) > 0).any(axis=0))
    controls = demand.wish.controls.copy()
    steps = np.concatenate(([0.0], layered.beats, layered.beats[-1:]))
    for done, channel in enumerate(busy.tolist()):
        progress(done / len(busy))
        found = _Channel(demand, products, steps, layered.mean, channel).solved()
        weights[:, :, channel] = found
        samples = layered.mean[channel] + np.einsum(
            "fm,mi,fi->f", products.blends, found, products.values[:, :, channel]
        )
        controls[:, channel] = Spline.through(samples[:, None], 1.0).controls[:, 0]
    progress(1.0)
    shown = np.einsum("fm,min->fin", products.blends, weights)
    return Answer(demand.wish.with_controls(controls), shown)


def _excess(demand: Demand, controls: Array) -> Array:
    """(controls − 1, n) by how much bounds are past about each pair: rad, or rad a step."""
    pairs = np.abs(np.diff(controls, axis=0)) - demand.wish.knots.step * demand.speed * (1 + 1e-9)
    for point in ((2 * controls[:-1] + controls[1:]) / 3, (controls[:-1] + 2 * controls[1:]) / 3):
        pairs = np.maximum(pairs, np.maximum(demand.low - point, point - demand.high) - 1e-9)
    return pairs


class _Channel:
    """The programme of one channel."""

    def __init__(self, demand: Demand, products: Products, steps: Array, mean: Array, channel: int) -> None:
        self.demand, self.products, self.channel = demand, products, channel
        self.mean = float(mean[channel])
        self.layers = products.values.shape[1]
        self.count = products.count * self.layers
        self.map = products.matrix(products.controls[..., channel], steps)
        self.pair = csr_array(self.map[1:] - self.map[:-1])
        self.inner = [
            csr_array((2 * self.map[:-1] + self.map[1:]) / 3),
            csr_array((self.map[:-1] + 2 * self.map[1:]) / 3),
        ]
        self.speed = demand.wish.knots.step * demand.speed[:, channel] * (1 - TIGHTER)
        gap = min(2 * SOLVED, float(demand.high[channel] - demand.low[channel]) / 4)
        self.low, self.high = (
            float(demand.low[channel]) + gap - self.mean,
            float(demand.high[channel]) - gap - self.mean,
        )
        self.cost = self._cost()

    def solved(self) -> Array:
        """(count, layers) the best weights; rows are taken in until none that is left out is past its bound."""
        if self.high - self.low <= ROOM:
            return np.zeros((self.products.count, self.layers))
        weights = np.ones(self.count)
        taken = np.zeros((3, len(self.speed)), dtype=bool)
        for _ in range(ROUNDS):
            past = self._past(weights, 1.0)
            if not past.any():
                return weights.reshape(-1, self.layers)
            taken |= self._past(weights, NEAR)
            weights = self._solve(taken)
        raise PlanError(f"channel {self.channel}: no weights of the layers found that keep its limits")

    def _past(self, weights: Array, share: float) -> Bools:
        """(3, controls − 1) rows that are past ``share`` of the way from the middle to their bounds."""
        middle, half = (self.low + self.high) / 2, (self.high - self.low) / 2
        out = [np.abs(self.pair @ weights) > self.speed * (share + 2 * SOLVED)]
        for matrix in self.inner:
            at = matrix @ weights
            if np.isfinite(half):
                out.append(np.abs(at - middle) > share * half + 1.5 * SOLVED)
            else:
                out.append((at > self.high + 1.5 * SOLVED) | (at < self.low - 1.5 * SOLVED))
        return np.stack(out)

    def _solve(self, taken: Bools) -> Array:
        # Rows in shares of their bounds, and costs about 1: the solver's tolerance is absolute.
        speed, inside = self.speed[taken[0]], int(taken[1:].sum())
        rows = [
            csr_array(self.pair[taken[0]].multiply(1 / speed[:, None])),
            *(m[t] for m, t in zip(self.inner, taken[1:], strict=True)),
        ]
        lower = np.concatenate((np.full(len(speed), -1.0), np.full(inside, self.low)))
        upper = np.concatenate((np.full(len(speed), 1.0), np.full(inside, self.high)))
        count = self.count
        cost = self.cost / float(self.cost.diagonal().mean())
        found = minimise(
            cost,
            -cost @ np.ones(count) - PULL * cost.diagonal(),
            vstack(rows),
            (lower, upper),
            box=(np.zeros(count), np.ones(count)),
            tolerance=SOLVED,
            gap=10 * SOLVED,
            iterations=80,
            # It may creep at the end where weights stand on their bounds; what it has then is inside all the same.
            creeping=True,
        )
        if found is None:
            raise PlanError(f"channel {self.channel}: no weights of the layers found that keep its limits")
        return np.clip(found, 0.0, 1.0)

    def _cost(self) -> csc_matrix:
        """The quadratic cost of weights away from 1."""
        products, knots = self.products, self.demand.wish.knots
        blends, values = products.blends, products.values[:, :, self.channel]
        phases = np.stack([blends[:, p :: products.apart].sum(axis=1) for p in range(products.apart)])
        at = products.matrix(phases[:, :, None] * values, products.beats)
        asked = keyposes_of(self.demand)
        times = asked.times[asked.feasible[:, self.channel]]
        interval, part = knots.places(times)
        keys = sum(
            (self.map[interval + a] * basis(part)[:, a, None] for a in range(4)), csr_array((len(times), self.count))
        )
        energy = np.square(values).mean(axis=0) * knots.step * len(values) / products.count
        return csc_matrix(
            knots.step * at.T @ at
            + KEYPOSE * self.demand.beat * keys.T @ keys
            + _smooth(products.count, SMOOTH * energy)
        )


def _smooth(count: int, weights: Array) -> csr_array:
    """The cost of steps from beat to beat; a grain of weight on everything, for layers that are empty."""
    layers = len(weights)
    steps = csr_array(
        (
            np.tile([-1.0, 1.0], (count - 1) * layers),
            np.stack((np.arange((count - 1) * layers), np.arange((count - 1) * layers) + layers), axis=1).ravel(),
            np.arange((count - 1) * layers + 1) * 2,
        ),
        shape=((count - 1) * layers, count * layers),
    )
    each = csr_array(np.diag(np.tile(weights, count - 1))) if count > 1 else csr_array((0, 0))
    grain = 1e-7 * csr_array(np.eye(count * layers))
    return csr_array(steps.T @ each @ steps + grain)
