"""Support polygons: the convex hulls of the points that touch the floor, and how far inside a point lies.

A pair of points (a, b) is an edge of the hull where no other point lies to its right; with at most eight points, two
soles' corners, all pairs are tried at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.errors import BodyError

FLAT = 1e-9
"""Metres: nearer points are one, and points nearer to an edge lie on it."""


@dataclass(frozen=True, eq=False)
class Polygons:
    """One convex polygon a frame, of E edges at most: inside are the p with ``normals · p ≤ offsets``.

    Parameters
    ----------
    starts, ends : (F, E, 2) metres of the edges, counter-clockwise; repeated where there are fewer.
    normals : (F, E, 2) to the outside, of length 1.
    offsets : (F, E) metres.

    Examples
    --------
    >>> square = Polygons.around(np.array([[[0.0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]]]))
    >>> square.margins(np.array([[0.5, 0.75]])).tolist(), square.margins(np.array([[4.0, 5.0]])).tolist()
    ([0.25], [-5.0])
    """

    starts: Array
    ends: Array
    normals: Array
    offsets: Array

    @classmethod
    def around(cls, points: Array, touching: Bools | None = None) -> Polygons:
        """The hulls of points (F, K, 2), or of those of them that touch (F, K).

        Raises
        ------
        BodyError
            If on some frame fewer than three points touch, or they lie on a line: nothing can stand on them.
        """
        frames, count = points.shape[:2]
        touching = np.ones((frames, count), np.bool_) if touching is None else touching
        first, second = np.nonzero(~np.eye(count, dtype=np.bool_))
        along = points[:, second] - points[:, first]
        length = np.linalg.norm(along, axis=-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            normals = np.stack((along[..., 1], -along[..., 0]), axis=-1) / length[..., None]
        offsets = np.einsum("fed,fed->fe", normals, points[:, first])
        right = np.einsum("fed,fkd->fek", normals, points) - offsets[..., None] > FLAT
        is_edge = (length > FLAT) & touching[:, first] & touching[:, second] & ~(right & touching[:, None]).any(-1)
        most = int(is_edge.sum(1).max(initial=1))
        order = np.argsort(~is_edge, axis=1, kind="stable")[:, :most]
        # Frames with fewer edges repeat their first.
        order = np.where(np.take_along_axis(is_edge, order, 1), order, order[:, :1])
        chosen = np.arange(frames)[:, None]
        out = cls(
            points[chosen, first[order]], points[chosen, second[order]], normals[chosen, order], offsets[chosen, order]
        )
        _check_area(out, is_edge)
        return out

    def margins(self, points: Array) -> Array:
        """Signed distances (F,) in metres of points (F, 2) from the edges, positive inside."""
        within = (self.offsets - np.einsum("fed,fd->fe", self.normals, points)).min(axis=1)
        along = self.ends - self.starts
        part = np.einsum("fed,fed->fe", points[:, None] - self.starts, along) / np.sum(along**2, axis=-1)
        nearest = self.starts + np.clip(part, 0, 1)[..., None] * along
        away = np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)
        return np.where(within >= 0, within, -away)


def _check_area(polygons: Polygons, is_edge: Bools) -> None:
    middle = polygons.starts.mean(axis=1)
    inside = polygons.offsets - np.einsum("fed,fd->fe", polygons.normals, middle)
    bad = (is_edge.sum(axis=1) < 3) | ~(inside.max(axis=1) > FLAT)
    if bad.any():
        raise BodyError(f"frame {int(np.argmax(bad))}: no polygon to stand on; three touching corners are needed")
