"""Left and right steps: told apart as they are, or joined by turning all segments to lead with the same side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.recognition.segments import Segments

_EARLY = (1.5, 0.5)  # how much the first and the last moment count: who moves first leads


def mirrored(segments: Segments) -> Segments:
    """The mirror images: left points are where the right ones were, across the plane between front and up.

    Mirroring twice gives the segments back.

    Examples
    --------
    >>> names = ("left_hand", "right_hand")
    >>> hands = Segments([[[[-1.0, 2, 3], [1, 0, 0]]] * 3], [1.0], ("",), ("",), [0], names, [7, 7])
    >>> mirrored(hands).positions[0, 0].tolist()
    [[-1.0, 0.0, 0.0], [1.0, 2.0, 3.0]]
    """
    flipped = segments.positions[:, :, _partners(segments.elements)] * np.array([-1.0, 1.0, 1.0])
    return replace(segments, positions=flipped + 0.0)  # no −0.0


def joined(segments: Segments) -> Segments:
    """Each segment or its mirror image, whichever leads with the right: steps to the left and right become one.

    A segment and its mirror image give the same. Of segments that hardly lead with either side (a bow) it is by chance
    which image is taken, and the two are nearly the same; do not join what differs in more than its side.
    """
    left = _lead(segments) < 0
    positions = np.where(left[:, None, None, None], mirrored(segments).positions, segments.positions)
    return replace(segments, positions=positions)


def leads_left(segments: Segments) -> Bools:
    """(S,) true where the left side moves more, and earlier, than the right."""
    return _lead(segments) < 0


def _lead(segments: Segments) -> Array:
    """(S,) how much more the right side moves than the left, what is early counting more; odd under mirroring."""
    moved = np.square(np.diff(segments.positions, axis=1)).sum(axis=-1)
    moved = np.einsum("t,ste->se", np.linspace(*_EARLY, moved.shape[1]), moved)
    return moved @ _sides(segments.elements)


def _sides(elements: tuple[str, ...]) -> Array:
    return np.array([float(e.startswith("right_")) - float(e.startswith("left_")) for e in elements])


def _partners(elements: tuple[str, ...]) -> Ints:
    """(E,) the element of the other side, itself where there is none."""
    other = {"left_": "right_", "right_": "left_"}
    swapped = [next((b + e.removeprefix(a) for a, b in other.items() if e.startswith(a)), e) for e in elements]
    return np.array([elements.index(e) if e in elements else i for i, e in enumerate(swapped)], np.int64)
