"""How far a pupil is from a master: element by element, when what is only early or late is taken out.

Both are aligned in time first (dynamic time warping of the whole body, within a band), then each element's places are
compared. Body sizes compare bodies; centimetres are those of the pupil's body. How early or late the pupil is is told
by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.errors import MetricError
from onbeat.recognition.segments import Segments

BAND = 0.2
"""How far a moment may be moved when segments are aligned, as a share of the segment."""
_MOVES = 0.08  # body sizes, a hand's width or two: what keeps within is at rest


@dataclass(frozen=True, eq=False)
class Comparison:
    """A pupil's segments beside a master's.

    Parameters
    ----------
    elements : E names, those that both have.
    errors : (S, T, E) body sizes, how far each element is from the master's at the master's moments, once aligned.
    lateness : (S, T) seconds at the master's tempo, how late the pupil is at each of the master's moments.
    sizes : (S,) metres of the pupil's body size.
    """

    elements: tuple[str, ...]
    errors: Array
    lateness: Array
    sizes: Array

    def __post_init__(self) -> None:
        for name in ("errors", "lateness", "sizes"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def distances(self) -> Array:
        """(E,) body sizes, the root of the mean squared error of each element."""
        return np.sqrt(np.square(self.errors).mean(axis=(0, 1)))

    @property
    def centimetres(self) -> Array:
        """(E,) centimetres on the pupil's body, the root of the mean squared error of each element."""
        return 100.0 * np.sqrt(np.square(self.errors * self.sizes[:, None, None]).mean(axis=(0, 1)))

    @property
    def farthest(self) -> tuple[str, ...]:
        """The elements from the one that is farthest from the master's to the nearest."""
        return tuple(self.elements[i] for i in np.argsort(-self.distances, kind="stable").tolist())


def compare(pupil: Segments, master: Segments, band: float = BAND) -> Comparison:
    """The pupil's segments beside the master's, the first beside the first and so on.

    Parameters
    ----------
    pupil, master : S segments each at T moments; points that one of them lacks are left out.
    band : share of the segment by which a moment may be early or late; 0 aligns nothing.

    Raises
    ------
    MetricError
        If there is no segment, they are not as many, have other moments or no element in common, or the band is not
        between 0 and 1.

    Examples
    --------
    >>> lift, late = np.array([[0, 0, 1, 1, 1, 2, 2, 2.0], [0, 0, 0, 1, 1, 1, 2, 2]])
    >>> def lifts(heights):
    ...     return Segments(heights[None, :, None, None] * np.eye(3)[2], [1.4], ("",), ("",), [0], ("left_wrist",), [6])
    >>> beside, stiff = compare(lifts(late), lifts(lift)), compare(lifts(late), lifts(lift), band=0)
    >>> beside.distances.tolist(), beside.lateness.max().round(3).tolist(), stiff.distances.tolist()
    ([0.0], 0.2, [0.5])
    """
    a, b, elements = _common(pupil, master)
    _check_band(band)
    ways = alignment(a, b, band)
    moments = a.shape[1]
    flat = a.reshape(*a.shape[:2], -1)
    weights = ways / ways.sum(axis=2, keepdims=True)  # (S, T of the master, T of the pupil)
    matched = (weights @ flat).reshape(b.shape)
    lateness = weights @ np.arange(moments) - np.arange(moments)
    seconds = lateness * (master.durations / (moments - 1))[:, None]
    return Comparison(elements, np.linalg.norm(matched - b, axis=-1), seconds, pupil.sizes)


def lateness_by_element(pupil: Segments, master: Segments, band: float = BAND) -> Array:
    """(E,) seconds, how late each element by itself is, the more it moves the more it counts; as :func:`compare`.

    NaN for an element that hardly moves: whether rest is late nobody can tell.

    Examples
    --------
    >>> wave = np.sin(np.linspace(0, 2 * np.pi, 41))
    >>> def waves(late):
    ...     places = np.stack([np.roll(wave, late), 0 * wave], axis=1)[None, ..., None] * np.eye(3)[2]
    ...     return Segments(places, [4.0], ("",), ("",), [0], ("left_wrist", "hips"), [6, 0])
    >>> lateness_by_element(waves(3), waves(0)).round(1).tolist()
    [0.3, nan]
    """
    a, b, elements = _common(pupil, master)
    _check_band(band)
    seconds = master.durations / (a.shape[1] - 1)
    found: list[float] = []
    for element in range(len(elements)):
        mine, wanted = a[:, :, [element]], b[:, :, [element]]
        ways = alignment(mine, wanted, band)
        late = (ways / ways.sum(axis=2, keepdims=True)) @ np.arange(a.shape[1]) - np.arange(a.shape[1])
        moved = np.linalg.norm(np.gradient(wanted[:, :, 0], axis=1), axis=-1)  # (S, T) body sizes a moment
        extent = float(np.linalg.norm(np.ptp(wanted[:, :, 0], axis=1), axis=-1).max())
        found.append(float((late * seconds[:, None] * moved).sum() / moved.sum()) if extent > _MOVES else np.nan)
    return np.array(found)


def pairing(pupil: Segments, master: Segments, band: float = BAND) -> Array:
    """(S, T) moments, counted from 0: where the master is at each of the pupil's; as :func:`compare`."""
    a, b, _ = _common(pupil, master)
    _check_band(band)
    ways = alignment(b, a, band)
    return (ways / ways.sum(axis=2, keepdims=True)) @ np.arange(a.shape[1], dtype=np.float64)


def _check_band(band: float) -> None:
    if not 0 <= band <= 1:
        raise MetricError(f"a band of {band} found; 0 to 1 is needed")


def alignment(pupil: Array, master: Array, band: float = BAND) -> Array:
    """(S, T, T) 1 where a moment of the master (second axis) is paired with one of the pupil (third axis), else 0.

    The cheapest way from the first moments to the last by steps of one moment on either side or both, no further
    than ``band`` off the diagonal (Sakoe & Chiba 1978), all segments at once.

    Parameters
    ----------
    pupil, master : (S, T, E, 3).
    band : share of T.
    """
    a, b = (values.reshape(*values.shape[:2], -1) for values in (pupil, master))
    costs = np.square(b).sum(-1)[:, :, None] + np.square(a).sum(-1)[:, None] - 2.0 * (b @ a.transpose(0, 2, 1))
    moments = np.arange(a.shape[1])
    off = np.abs(moments[:, None] - moments) > np.ceil(band * len(moments) - 1e-9)
    return _walk(_totals(np.where(off, np.inf, np.maximum(costs, 0.0))))


def _totals(costs: Array) -> Array:
    """(S, T + 1, T + 1) the cost of the cheapest way to each pair, with a rim of infinity; row by row of diagonals."""
    count, moments, _ = costs.shape
    totals = np.full((count, moments + 1, moments + 1), np.inf)
    totals[:, 0, 0] = 0.0
    for diagonal in range(2 * moments - 1):
        i = np.arange(max(0, diagonal - moments + 1), min(diagonal, moments - 1) + 1)
        j = diagonal - i
        before = np.minimum(np.minimum(totals[:, i, j], totals[:, i, j + 1]), totals[:, i + 1, j])
        totals[:, i + 1, j + 1] = costs[:, i, j] + before
    return totals


def _walk(totals: Array) -> Array:
    """(S, T, T) 1 on the cheapest way, followed back from the end; both sides step where that is as cheap."""
    count, moments = len(totals), totals.shape[1] - 1
    every = np.arange(count)
    i, j = np.full(count, moments), np.full(count, moments)
    ways = np.zeros((count, moments, moments))
    for _ in range(2 * moments - 1):
        ways[every, np.maximum(i, 1) - 1, np.maximum(j, 1) - 1] = 1.0
        choices = np.stack((totals[every, i - 1, j - 1], totals[every, i - 1, j], totals[every, i, j - 1]))
        step = choices.argmin(axis=0)
        i, j = np.maximum(i - (step != 2), 1), np.maximum(j - (step != 1), 1)
    return ways


def _common(pupil: Segments, master: Segments) -> tuple[Array, Array, tuple[str, ...]]:
    """The positions of the elements that both have."""
    if not len(pupil) or len(pupil) != len(master) or pupil.positions.shape[1] != master.positions.shape[1]:
        raise MetricError(
            f"{len(pupil)} segments of the pupil at {pupil.positions.shape[1]} moments beside {len(master)} of the "
            f"master at {master.positions.shape[1]}; as many of each are needed, one at least"
        )
    elements = tuple(name for name in master.elements if name in pupil.elements)
    if not elements:
        raise MetricError(
            f"the pupil's {', '.join(pupil.elements)} and the master's {', '.join(master.elements)} have no point in "
            "common"
        )
    of = [segments.positions[:, :, [segments.elements.index(e) for e in elements]] for segments in (pupil, master)]
    return of[0], of[1], elements
