"""The body's own frame, read off the points of a segment: where the trunk is and how it is turned, moment by moment."""

from __future__ import annotations

from collections.abc import Sequence

from onbeat._shapes import Positions, Rotations
from onbeat.errors import MetricError
from onbeat.motion import rotations as rot
from onbeat.motion.body import frames_from

NEEDED = ("hips", "left_shoulder", "right_shoulder", "left_hip", "right_hip")
"""The elements that the body's own frame is read off."""


def trunk(points: Positions, elements: Sequence[str]) -> tuple[Rotations, Positions]:
    """The body-centre frame of points: rotations (..., 4) and origins (..., 3).

    Its origin are the hips, z points to the middle of the shoulders, x across both shoulders and both hip joints.

    Parameters
    ----------
    points : (..., E, 3).
    elements : the E names of the points.

    Raises
    ------
    MetricError
        If an element that the frame is read off is missing.

    Examples
    --------
    >>> import numpy as np
    >>> points = np.array([[0, 0, 0], [-1, 0, 2], [1, 0, 2], [-1, 0, 0], [1, 0, 0.0]]) + [5, 5, 0]
    >>> turn, origin = trunk(points, NEEDED)
    >>> turn.round(6).tolist(), origin.tolist()
    ([1.0, 0.0, 0.0, 0.0], [5.0, 5.0, 0.0])
    """
    missing = [name for name in NEEDED if name not in elements]
    if missing:
        raise MetricError(
            f"the segments have no {', '.join(missing)}, which tell where the body faces; "
            f"they have {', '.join(elements)}"
        )
    hips, shoulder_l, shoulder_r, hip_l, hip_r = (points[..., list(elements).index(name), :] for name in NEEDED)
    return frames_from((shoulder_l + shoulder_r) / 2 - hips, shoulder_r - shoulder_l + hip_r - hip_l), hips


def seen_from_trunk(points: Positions, elements: Sequence[str]) -> Positions:
    """(..., E, 3) the points seen from :func:`trunk`: only the pose stays."""
    frames, origins = trunk(points, elements)
    return rot.rotate(rot.inverse(frames)[..., None, :], points - origins[..., None, :])
