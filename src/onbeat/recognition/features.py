"""What a segment is compared by: views that keep of it what tells tasks, or what tells people.

Tasks and people want opposite things of a segment. Who dances shows in the posture, in how large and how fast the moves
are; what is danced shows in their course, whoever's posture it is danced in. So each view keeps some and drops the
rest, and training chooses which of them each factor is recognised by (:mod:`onbeat.recognition.choice`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.recognition.segments import Segments
from onbeat.recognition.trunk import NEEDED as NEEDED
from onbeat.recognition.trunk import seen_from_trunk

_STILL = 0.01  # body sizes per second: speeds below are as good as none
_SPEED, _TEMPO = 0.3, 0.1  # what a factor of e in an element's speed, and in the tempo, weighs in body sizes


def in_body(segments: Segments) -> Positions:
    """(S, T, E, 3) the places seen from the body's own frame at every moment: only the pose stays.

    Raises
    ------
    MetricError
        If an element that the frame is read off is missing.

    Examples
    --------
    >>> names = (*NEEDED, "left_wrist")
    >>> places = np.array([[0, 0, 0], [-1, 0, 2], [1, 0, 2], [-1, 0, 0], [1, 0, 0], [-1, 1, 1.0]]) + [5, 5, 0]
    >>> one = Segments(np.tile(places, (1, 3, 1, 1)), [1.0], ("",), ("",), [0], names, [0, 4, 4, 1, 1, 6])
    >>> in_body(one)[0, 0, 5].round(6).tolist()
    [-1.0, 1.0, 1.0]
    """
    return seen_from_trunk(segments.positions, segments.elements)


def _posture(inside: Positions, durations: Array) -> Array:
    return inside.mean(axis=1).reshape(len(inside), -1)


def _spread(inside: Positions, durations: Array) -> Array:
    return inside.std(axis=1).reshape(len(inside), -1)


def _liveliness(inside: Positions, durations: Array) -> Array:
    seconds = durations / (inside.shape[1] - 1)
    speeds = np.linalg.norm(np.gradient(inside, axis=1), axis=-1).mean(axis=1) / seconds[:, None]
    return np.concatenate((_SPEED * np.log(speeds + _STILL), _TEMPO * np.log(durations)[:, None]), axis=1)


def _outline(inside: Positions, durations: Array) -> Array:
    parts = (_posture, _spread, _liveliness)
    return np.concatenate([part(inside, durations) for part in parts], axis=1)


def _shape(inside: Positions, durations: Array) -> Array:
    """Mean pose removed, amplitude 1: the course alone, however large and in whatever posture."""
    moved = inside - inside.mean(axis=1, keepdims=True)
    size = np.sqrt((moved**2).sum(axis=(2, 3), keepdims=True).mean(axis=1, keepdims=True))
    return (moved / np.maximum(size, 1e-6)).reshape(*inside.shape[:2], -1)


def _place(inside: Positions, durations: Array) -> Array:
    return inside.reshape(*inside.shape[:2], -1)


def _course(inside: Positions, durations: Array) -> Array:
    return _shape(inside, durations).reshape(len(inside), -1) / np.sqrt(inside.shape[1])


View = Callable[[Positions, Array], Array]
FLAT: Mapping[str, View] = {"outline": _outline, "posture": _posture, "spread": _spread, "course": _course}
"""Views as vectors (S, D), compared in a learned subspace: the posture with how far and how fast each element moves;
the posture alone; how far alone; the course of the moves, mean pose removed and amplitude 1."""
ELASTIC: Mapping[str, View] = {"elastic course": _shape, "elastic poses": _place}
"""Views as paths (S, T, D), compared by elastic alignment: mean pose removed and amplitude 1; the poses as they are."""
VIEWS = (*FLAT, *ELASTIC)


def views_of(segments: Segments, names: Sequence[str]) -> dict[str, Array]:
    """Each view of the segments: (S, D) or, elastic, (S, T, D).

    Examples
    --------
    >>> names = (*NEEDED, "left_wrist")
    >>> some = Segments(np.random.default_rng(0).normal(size=(2, 8, 6, 3)), [1, 1], "ab", "cc", [0, 0], names, [0] * 6)
    >>> {name: view.shape for name, view in views_of(some, ["outline", "elastic course"]).items()}
    {'outline': (2, 43), 'elastic course': (2, 8, 18)}
    """
    inside = in_body(segments)
    every = {**FLAT, **ELASTIC}
    return {name: every[name](inside, segments.durations) for name in names}
