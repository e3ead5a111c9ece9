"""Hierarchical B-splines on musical rhythm (2007, Sec. II-A and III-A).

The coarsest layer has a knot on every beat; it is fitted to the curve by least squares, the next one, with half the
spacing, to what the first leaves, and so on, so that fast music can omit the fine layers one by one. Near keyposes the
curve is sampled densely, elsewhere sparsely, and rows ``0 = N_vel Q`` ask every layer to stand still on them (Eqs.
10-12), so that keyposes are in the coarse layers. All fits are banded: cost grows with length alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded
from scipy.sparse import csr_array

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.retime.bspline import Knots, Spline, differences
from onbeat.retime.lock import TimeMap

LAYERS = 5
SPACING = 1.0
"""Beats between the knots of the coarsest layer."""
NEAR = 0.25
"""Beats from a keypose within which the curve is sampled densely."""
DENSE = 4
"""Samples between two knots of the finest layer near a keypose; elsewhere there is one."""
STILL = 1.0
"""Weight of a row that asks for no velocity (a unit a beat) at a keypose, beside a sample's."""
ROUNDING = 1e-6
"""Share of a spacing by which a curve may begin before a knot, or end after one, and need no more knots."""
LOOSE = 1e-6
"""Weight of the second differences of the control points, which only decides where there are no samples."""


@dataclass(frozen=True, eq=False)
class Layers:
    """A curve as a sum of splines over beats, the coarsest first.

    Examples
    --------
    >>> curve = Spline.through(np.sin(np.linspace(0, 6, 121))[:, None], 20.0)
    >>> layers = decompose(curve, TimeMap.steady(2.0), keyposes=np.zeros(0))
    >>> [layer.knots.step for layer in layers.splines]
    [1.0, 0.5, 0.25, 0.125, 0.0625]
    >>> at = np.linspace(0, 6, 7)
    >>> bool(np.abs(layers(2.0 * at).sum(axis=0) - curve(at)).max() < 1e-3)
    True
    """

    splines: tuple[Spline, ...]

    def __len__(self) -> int:
        return len(self.splines)

    def __call__(self, beats: Array, derivative: int = 0) -> Array:
        """(layers, N, n) what each layer adds, or its derivatives by beats, at beats (N,)."""
        return np.stack([layer(beats, derivative) for layer in self.splines])

    def upto(self, layers: int, beats: Array) -> Array:
        """(N, n) the curve of the coarsest ``layers`` alone."""
        return self(beats)[:layers].sum(axis=0)


def decompose(
    curve: Spline,
    rhythm: TimeMap,
    keyposes: Times,
    layers: int = LAYERS,
    spacing: float = SPACING,
    still: float = STILL,
) -> Layers:
    """The layers of a curve.

    Parameters
    ----------
    curve : n channels over seconds.
    rhythm : seconds to beats.
    keyposes : (K,) beats at which they are; the curve is sampled evenly where there are none.
    layers : how many, each with half the knot spacing of the one before.
    spacing : beats between the knots of the coarsest.
    still : weight of standing still at keyposes, 0 for none.

    Raises
    ------
    PlanError
        If there is less than one layer, or the spacing is not above 0.
    """
    if layers < 1 or not spacing > 0:
        raise PlanError(f"{layers} layers from {spacing} beats on; 1 or more layers and a spacing above 0 are needed")
    first, last = rhythm(np.array([curve.knots.start, curve.knots.end]))
    start = float(np.floor(first / spacing + ROUNDING)) * spacing
    intervals = max(int(np.ceil((last - start) / spacing - ROUNDING)), 1)
    inside = keyposes[(keyposes >= first) & (keyposes <= last)]
    beats = _sampled(float(first), float(last), inside, spacing / 2 ** (layers - 1))
    rest = curve(np.clip(rhythm.inverse(beats), curve.knots.start, curve.knots.end))
    found = list[Spline]()
    for layer in range(layers):
        knots = Knots(start, spacing / 2**layer, intervals * 2**layer)
        found.append(Spline(knots, _least_squares(knots, beats, rest, inside, still)))
        rest = rest - found[-1](beats)
    return Layers(tuple(found))


def _sampled(first: float, last: float, keyposes: Array, finest: float) -> Array:
    """Beats at which the curve is looked at (Fig. 5): densely about keyposes, else once a knot of the finest layer."""
    grid = first + finest / DENSE * np.arange(max(int(np.ceil((last - first) / finest * DENSE)), 1) + 1)
    grid[-1] = last
    kept = np.arange(len(grid)) % DENSE == 0
    after, ends = np.searchsorted(keyposes, grid), np.concatenate(([-np.inf], keyposes, [np.inf]))
    kept |= np.minimum(grid - ends[after], ends[after + 1] - grid) <= NEAR
    kept[-1] = True
    return np.asarray(grid[kept], dtype=np.float64)


def _least_squares(knots: Knots, beats: Array, values: Array, still_at: Array, still: float) -> Array:
    """Control points (controls, n) of Eq. 12, by banded normal equations."""
    at, stay = knots.design(beats), knots.design(still_at, 1) * np.sqrt(still)
    bend = differences(knots.controls, 2) * np.sqrt(LOOSE)
    normal = csr_array(at.T @ at + stay.T @ stay + bend.T @ bend)
    bands = np.zeros((4, knots.controls))
    for q in range(4):
        bands[3 - q, q:] = normal.diagonal(q)
    return np.asarray(solveh_banded(bands, at.T @ values), dtype=np.float64)
